#!/usr/bin/env python3
"""Runs the commands of pages of the documentation, and compares what they print with what the pages say.

    commands.py PROGRAM [PAGE…]         PROGRAM is the built pleuel; by default all pages
    commands.py --slow PROGRAM [PAGE…]  those marked as slow, too

Each page has a fresh folder with links `pleuel`, `problems` and `catalogue.json`; its blocks run from top to bottom:

    ```sh                    each line is a command, which must end with the exit code 0
    ```sh exit=2             the last line must end with this code
    ```sh slow               takes more than some seconds
    ```sh by hand            is not run: it installs, builds, or has no end
    ```text                  behind a block that ran: what it printed; see below
    ```json FILE             becomes the file; so do blocks of python, c and cpp
    ```json FILE /POINTER    its members are put into the object there, the rest of the file stays
    ```json FILE … wrong     the same, until the next commands are done

Of a quoted output "…" stands for anything, as a line for any lines; numbers may differ by 0.1 %. Spaces
count as one, and what is before and behind the quotation may be anything.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from markdown import Block, blocks

ROOT = Path(__file__).resolve().parents[2]
NUMBER = r"[-+−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
TOLERANCE = 1e-3


class Wrong(Exception):
    pass


def number(text: str) -> float:
    return float(text.replace("−", "-"))


def is_close(said: str, printed: str) -> bool:
    return abs(number(said) - number(printed)) <= TOLERANCE * abs(number(said))


def matches(said: str, printed: str) -> bool:
    """Whether a line of the page is that of the program."""
    said, printed = " ".join(said.split()), " ".join(printed.split())
    pattern, values = "", []
    for part in re.split(rf"(…|{NUMBER})", said):
        if part == "…":
            pattern += ".*?"
        elif re.fullmatch(NUMBER, part):
            pattern += rf"({NUMBER})"
            values.append(part)
        else:
            pattern += re.escape(part)
    found = re.fullmatch(pattern, printed)
    return found is not None and all(map(is_close, values, found.groups()))


def find(said: list[str], printed: list[str], begin: int, may_skip: bool) -> int | None:
    """The line behind the first place where these lines stand, from `begin` on."""
    last = len(printed) - len(said) if may_skip else begin
    for start in range(begin, last + 1):
        part = printed[start : start + len(said)]
        if len(part) == len(said) and all(map(matches, said, part)):
            return start + len(said)
    return None


def compare(quoted: str, output: str) -> None:
    printed = [line for line in output.splitlines() if line.strip()]
    groups: list[list[str]] = [[]]
    for line in quoted.splitlines():
        if line.strip() == "…":
            groups.append([])
        elif line.strip():
            groups[-1].append(line)
    position = 0
    for group in filter(None, groups):
        found = find(group, printed, position, may_skip=True)
        if found is None:
            said = "\n".join(group)
            raise Wrong(f"the page says\n{said}\nbut the program printed\n{output}")
        position = found


def merged(old: str, block: Block) -> str:
    """The file with the members of a block in the object that its third word points to."""
    document = json.loads(old)
    place = document
    pointers = [word for word in block.words[2:] if word.startswith("/")]
    for key in pointers[0].split("/")[1:] if pointers else []:
        place = place[key]
    place.update(json.loads("{" + block.text.strip().rstrip(",") + "}"))
    return json.dumps(document, indent=2, ensure_ascii=False) + "\n"


def library_of(program: Path) -> dict[str, str]:
    """Where compilers, the loader and Python find what is installed elsewhere."""
    libraries = str(program.parent.parent / "lib")
    python = [ROOT / "python", ROOT / "python/examples"]
    frameworks = subprocess.run([shutil.which("python3", path="/usr/bin"), "-c", "import openmdao, pyoptsparse"], capture_output=True)
    if frameworks.returncode != 0:
        python.append(ROOT / "python/tests/stand_in")  # which says so
    return {
        "CPATH": str(ROOT / "include"),
        "LIBRARY_PATH": libraries,
        "LD_LIBRARY_PATH": libraries,
        "PYTHONPATH": ":".join([*map(str, python), os.environ.get("PYTHONPATH", "")]),
        "PYTHONDONTWRITEBYTECODE": "1",
    }


class Page:
    def __init__(self, page: Path, program: Path, folder: Path, with_slow: bool):
        self.page, self.folder, self.with_slow = page, folder, with_slow
        self.output: str | None = None  # of the block before, if it ran
        self.spoiled: dict[Path, str] = {}  # files to be put right
        (folder / "pleuel").symlink_to(program)
        (folder / "problems").symlink_to(ROOT / "problems")
        (folder / "catalogue.json").symlink_to(ROOT / "problems/catalogue.json")
        self.environment = dict(
            os.environ,
            PATH=f"{folder}:/usr/bin:{os.environ['PATH']}",  # Python is the system's, with its packages
            **library_of(program),
            PLEUEL_REPORT_TEMPLATE=str(ROOT / "tests/cli/report_template.html"),
        )

    def run(self) -> None:
        for block in blocks(self.page):
            kind = block.words[0] if block.words else ""
            try:
                if kind == "sh":
                    self.run_commands(block)
                elif kind == "text" and self.output is not None:
                    compare(block.text, self.output)
                elif kind in ("json", "python", "c", "cpp") and len(block.words) > 1:
                    self.write(block)
                if kind != "sh":
                    self.output = None
            except (Wrong, ValueError, KeyError) as error:
                raise Wrong(f"{self.page}:{block.line}: {error}") from None

    def write(self, block: Block) -> None:
        file = self.folder / block.words[1]
        old = file.read_text(encoding="utf-8") if file.exists() else ""
        if "wrong" in block.words:
            self.spoiled.setdefault(file, old)
        is_whole = block.words[0] != "json" or block.text.lstrip().startswith("{")
        file.write_text(block.text if is_whole else merged(old, block), encoding="utf-8")

    def run_commands(self, block: Block) -> None:
        self.output = None
        if block.words[1:3] == ["by", "hand"] or ("slow" in block.words and not self.with_slow):
            return
        commands = block.text.replace("\\\n", " ").splitlines()
        commands = [line for line in commands if line.split("#")[0].strip()]
        codes = [int(word[5:]) for word in block.words if word.startswith("exit=")]
        self.output = ""
        for command in commands:
            code = codes[0] if codes and command is commands[-1] else 0
            begin = time.monotonic()
            done = subprocess.run(
                ["bash", "-c", command], cwd=self.folder, env=self.environment, text=True,
                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                check=False,
            )  # fmt: skip
            print(f"{time.monotonic() - begin:6.1f} s  {command.strip()}")
            self.output += done.stdout
            if done.returncode != code:
                raise Wrong(
                    f"{command.strip()} ended with {done.returncode}, not {code}:\n{done.stdout}"
                )
        for file, text in self.spoiled.items():
            file.write_text(text, encoding="utf-8")
        self.spoiled.clear()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--slow", action="store_true", help="run those marked as slow, too")
    parser.add_argument("--keep", type=Path, help="run in this folder, and leave it")
    parser.add_argument("program", type=Path)
    parser.add_argument("pages", type=Path, nargs="*")
    arguments = parser.parse_args()
    all_pages = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
    wrong = 0
    for page in arguments.pages or all_pages:
        folder = arguments.keep or Path(tempfile.mkdtemp())
        folder.mkdir(exist_ok=True)
        try:
            Page(page, arguments.program.resolve(), folder, arguments.slow).run()
        except Wrong as error:
            print(error)
            wrong += 1
        finally:
            if not arguments.keep:
                shutil.rmtree(folder)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
