#!/usr/bin/env python3
"""What building costs: processor time and wall time from scratch, of the program and of the tests on top, and after a
change of single files. Works on a copy of the last commit in a folder of its own, without ccache; takes a quarter of an hour.

    bench/build_times.py [--folder DIR] [--parts program,tests,change] [--change FILE …] [--dearest 20]

program   ./pleuel --version in a fresh copy, npm included
tests     ./pleuel test -N on top
change    each FILE gets a comment, then what depends on it is built and linked: program and tests
"""

import argparse
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
CHANGED = ["core/effects/geometric_stiffening.cpp", "core/base/dual.hpp"]


def timed(command, **options):
    """Exit code, wall time and processor time [s] of a command and all that it waits for."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    code = subprocess.run(command, **options).returncode
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return code, time.monotonic() - start, (after.ru_utime + after.ru_stime) - (before.ru_utime + before.ru_stime)


def record(log, command):
    """As the launcher of the compiler: runs it, and adds a line to the log."""
    code, _, processor = timed(command)
    output = command[command.index("-o") + 1] if "-o" in command else command[-1]
    with open(log, "a") as file:
        file.write(f"{processor:.2f} {output}\n")
    return code


def unit_name(output):
    """core/model/CMakeFiles/pleuel_model.dir/Unity/unity_0_cxx.cxx.o → core/model Unity/unity_0_cxx.cxx"""
    return re.sub(r"/?CMakeFiles/[^/]*\.dir/", " ", output).removesuffix(".o")


def print_dearest(log, count):
    rows = sorted(((float(a), unit_name(b)) for a, b in (line.split() for line in open(log))), reverse=True)
    print(f"  {len(rows)} files compiled, {sum(a for a, _ in rows):.0f} s of processor time; the dearest:")
    for processor, name in rows[:count]:
        print(f"  {processor:7.1f} s  {name}")


def measure(title, command, folder, log, dearest):
    log.unlink(missing_ok=True)
    environment = {**os.environ, "CMAKE_CXX_COMPILER_LAUNCHER": f"{sys.executable};{__file__};--record;{log}",
                   "CCACHE_DISABLE": "1"}
    code, wall, processor = timed(command, cwd=folder, env=environment, stdout=subprocess.DEVNULL)
    if code != 0:
        sys.exit(f"{title}: {' '.join(command)} failed")
    print(f"{title}: {processor:.0f} s of processor time, {wall:.0f} s of wall time", flush=True)
    if log.exists():
        print_dearest(log, dearest)


def main():
    if sys.argv[1:2] == ["--record"]:
        sys.exit(record(sys.argv[2], sys.argv[3:]))
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--folder", type=pathlib.Path, help="for the copy; kept. Without: a temporary one")
    parser.add_argument("--parts", default="program,tests,change")
    parser.add_argument("--change", nargs="*", default=CHANGED)
    parser.add_argument("--dearest", type=int, default=20)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.folder or pathlib.Path(temporary) / "pleuel"
        log = pathlib.Path(temporary) / "units"
        if not folder.exists():
            subprocess.run(["git", "clone", "--quiet", str(ROOT), str(folder)], check=True)
        parts = options.parts.split(",")
        if "program" in parts:
            measure("program", ["./pleuel", "--version"], folder, log, options.dearest)
        if "tests" in parts:
            measure("tests", ["./pleuel", "test", "-N"], folder, log, options.dearest)
        for name in options.change if "change" in parts else []:
            with open(folder / name, "a") as file:
                file.write("// changed\n")
            measure(f"change of {name}", ["ninja", "-C", "build/release"], folder, log, options.dearest)


main()
