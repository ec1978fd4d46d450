#!/usr/bin/env python3
"""Links of the documentation lead to files and headings that are there, and from docs/README.md every page
can be reached.
"""

import sys
from pathlib import Path

from markdown import anchors, links

ROOT = Path(__file__).resolve().parents[2]


def pages() -> list[Path]:
    top = [ROOT / "README.md", ROOT / "problems/README.md", ROOT / "tests/data/README.md"]
    return top + sorted((ROOT / "docs").rglob("*.md"))


def target_of(page: Path, link: str) -> tuple[Path, str]:
    name, _, anchor = link.partition("#")
    return ((page.parent / name).resolve() if name else page), anchor


def is_outside(link: str) -> bool:
    return "://" in link or link.startswith("mailto:")


def dead_links(page: Path) -> list[str]:
    found = []
    for line, link in links(page):
        if is_outside(link):
            continue
        target, anchor = target_of(page, link)
        place = f"{page.relative_to(ROOT)}:{line}: {link}"
        if not target.exists():
            found.append(f"{place}: there is no such file")
        elif anchor and target.suffix == ".md" and anchor not in anchors(target):
            found.append(f"{place}: there is no such heading")
    return found


def reached_from(contents: Path) -> set[Path]:
    return {target_of(contents, link)[0] for _, link in links(contents) if not is_outside(link)}


def main() -> int:
    complaints = [line for page in pages() for line in dead_links(page)]
    contents = ROOT / "docs/README.md"
    reached = reached_from(contents) | {contents}
    for page in pages():
        if page.is_relative_to(ROOT / "docs") and page not in reached:
            complaints.append(f"{page.relative_to(ROOT)}: is not in docs/README.md")
    print("\n".join(complaints))
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
