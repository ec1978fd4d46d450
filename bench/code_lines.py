#!/usr/bin/env python3
"""Code lines by room: C++ and TypeScript, without comments and blank lines, tests apart.

    bench/code_lines.py [--depth 3] [--under core/scene] [--files]

A room is a folder. Counted are the files that git knows; a line counts where something other than blanks is left of it
when comments are gone.
"""

import argparse
import collections
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
SUFFIXES = {".cpp", ".hpp", ".ts"}
# Texts come first: what looks like a comment inside of them is none. Of raw ones of C++ the delimiter is kept in mind.
TOKENS = re.compile(
    r"""R"(?P<mark>[^\s()\\]{0,16})\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])+'|`(?:\\.|[^`\\])*`"""
    r"""|(?P<comment>//[^\n]*|/\*.*?\*/)""",
    re.DOTALL,
)


def without_comments(text):
    """A comment leaves its line breaks behind, so that those of it alone are blank."""

    def kept(match):
        comment = match.group("comment")
        return match.group(0) if comment is None else "\n" * comment.count("\n")

    # 1'000'000 is a number, no character
    return TOKENS.sub(kept, re.sub(r"(?<=\d)'(?=\d)", "_", text))


def code_lines(path):
    return sum(1 for line in without_comments(path.read_text(encoding="utf-8")).split("\n") if line.strip())


def sources():
    """Paths of the files that are counted, from the root of the repository."""
    known = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    for name in known.splitlines():
        path = pathlib.PurePosixPath(name)
        is_test = "tests" in path.parts or "test" in path.parts
        if path.suffix in SUFFIXES and not is_test and (ROOT / path).is_file():
            yield path


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--depth", type=int, default=3, help="folders below these are counted with them")
    parser.add_argument("--under", default="", help="this folder only")
    parser.add_argument("--files", action="store_true", help="every file, not every folder")
    options = parser.parse_args()

    lines, files = collections.Counter(), collections.Counter()
    for path in sources():
        if not path.is_relative_to(options.under):
            continue
        room = str(path) if options.files else "/".join(path.parent.parts[: options.depth]) or "."
        lines[room] += code_lines(ROOT / path)
        files[room] += 1
    for room in sorted(lines):
        print(f"{lines[room]:7d}  {files[room]:5d}  {room}")
    print(f"{sum(lines.values()):7d}  {sum(files.values()):5d}  all")


if __name__ == "__main__":
    main()
