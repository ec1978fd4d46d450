"""Pages of the documentation: their fenced blocks, headings and links."""

import re
import textwrap
from dataclasses import dataclass
from pathlib import Path


@dataclass
class Block:
    line: int  # of the opening fence, from 1
    words: list[str]  # of the info string: ["sh", "exit=2"]
    text: str


def blocks(page: Path) -> list[Block]:
    found, fence, begin, words, lines = [], None, 0, [], []
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        mark = re.match(r" *(`{3,})\s*(.*)$", line)  # indented within a list
        if fence is None:
            if mark:
                fence, begin, words, lines = mark.group(1), number, mark.group(2).split(), []
        elif mark and mark.group(1) == fence and not mark.group(2):
            found.append(Block(begin, words, textwrap.dedent("\n".join(lines)) + "\n"))
            fence = None
        else:
            lines.append(line)
    if fence is not None:
        raise ValueError(f"{page}:{begin}: the block is not closed")
    return found


def prose(page: Path) -> list[tuple[int, str]]:
    """The lines outside of fenced blocks, without spans of code."""
    lines, is_code = [], False
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        if line.lstrip().startswith("```"):
            is_code = not is_code
        elif not is_code and not line.startswith("    "):
            lines.append((number, line))
    return lines


def anchors(page: Path) -> set[str]:
    """What a link to a part of the page may name, by GitHub's rules."""
    found: set[str] = set()
    for _, line in prose(page):
        heading = re.match(r"#+\s+(.*?)\s*#*$", line)
        if not heading:
            continue
        title = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading.group(1))
        slug = re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")
        name, count = slug, 0
        while name in found:
            count += 1
            name = f"{slug}-{count}"
        found.add(name)
    return found


def links(page: Path) -> list[tuple[int, str]]:
    return [
        (number, target)
        for number, line in prose(page)
        for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`]*`", "", line))
    ]
