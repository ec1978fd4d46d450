#!/usr/bin/env python3
"""What it costs to check the numbers of `simulate`, as a multiple of the simulation with its responses.

    check_costs.py PROGRAM [REPETITIONS [PROBLEM …]]    PROGRAM is the built pleuel; 5 repetitions, all problems by default

Processor times, the least of runs that alternate between one without checks, the usual and all of them. The simulation is the
program without checks, with its reading and writing but without what it takes to start at all.
"""

import resource
import subprocess
import sys
import tempfile
from pathlib import Path

PROBLEMS = Path(__file__).resolve().parents[1] / "problems"
MOST = 2.5
KINDS = {"none": ["--no-checks"], "usual": [], "all": ["--all-checks"]}


def processor_seconds():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def seconds_of(arguments):
    begin = processor_seconds()
    subprocess.run(arguments, capture_output=True)
    return processor_seconds() - begin


def simulation(program, path, options):
    with tempfile.TemporaryDirectory() as folder:
        return seconds_of([program, "simulate", str(path), "--json", "--no-report", "-o", folder + "/run", *options])


def main():
    program, repetitions = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 5
    files = sorted(path for path in PROBLEMS.rglob("*.json") if '"simulation"' in path.read_text())
    names = sys.argv[3:] or [str(path.relative_to(PROBLEMS).with_suffix("")) for path in files if "schema" not in path.name]
    print("| problem | simulation | usual checks | all checks |\n|---|---|---|---|")
    start = min(seconds_of([program, "--version"]) for _ in range(5))
    above = 0
    for name in names:
        least = {kind: float("inf") for kind in KINDS}
        for _ in range(repetitions):
            for kind, options in KINDS.items():
                least[kind] = min(least[kind], simulation(program, PROBLEMS / f"{name}.json", options))
        alone = least["none"] - start
        ratios = {kind: 1.0 + (least[kind] - least["none"]) / alone for kind in KINDS}
        above += ratios["usual"] > MOST
        print(f"| {name} | {1e3 * alone:.1f} ms | {ratios['usual']:.2f} | {ratios['all']:.2f} |", flush=True)
    print(f"\n{above} of {len(names)} above {MOST}.")


if __name__ == "__main__":
    main()
