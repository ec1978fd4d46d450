#!/usr/bin/env python3
"""Two builds of Pleuel beside each other: processor time of whole commands in interleaved pairs (A B A B …), the median of the
ratios B/A with their quartiles.

    bench/compare_programs.py OLD NEW [--commands simulate,gradient,optimize] [--pairs 9] [FILE …]

OLD, NEW: programs, as build/release/bin/pleuel, each in the build that made it: a copy still loads the library of that build. Both
with the page of reports or both without. FILE: problems; without, those that come with Pleuel.
"""

import argparse
import os
import pathlib
import statistics
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent


def processor_time(command, folder):
    child = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, _, usage = os.wait4(child.pid, 0)
    child.returncode = 0
    return usage.ru_utime + usage.ru_stime


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs=2)
    parser.add_argument("files", nargs="*")
    parser.add_argument("--commands", default="simulate,gradient,optimize")
    parser.add_argument("--pairs", type=int, default=9)
    options = parser.parse_intermixed_args()
    programs = [os.path.abspath(program) for program in options.programs]
    files = [os.path.abspath(file) for file in options.files] or [
        str(file) for file in sorted((ROOT / "problems").glob("*.json")) if "schema" not in file.name and
        file.name != "catalogue.json"]
    print(f"{'':34} {'old [s]':>8} {'new [s]':>8} {'new/old':>8}  quartiles")
    for file in files:
        for command in options.commands.split(","):
            with tempfile.TemporaryDirectory() as folder:
                pairs = [[processor_time([program, command, file, "--json"], folder) for program in programs]
                         for _ in range(options.pairs)]
            low, ratio, high = statistics.quantiles([new / old for old, new in pairs], n=4)
            old, new = (statistics.median(times) for times in zip(*pairs))
            name = f"{pathlib.Path(file).stem} {command}"
            print(f"{name:34} {old:8.2f} {new:8.2f} {ratio:8.3f}  {low:.3f} … {high:.3f}", flush=True)


main()
