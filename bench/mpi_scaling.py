#!/usr/bin/env python3
"""Starts, a front and samples with one process, two worker processes, and under mpirun: wall times, and whether the
digits are the same. Then what the process that hands out tasks spends on each evaluation (processor time), and what
follows from it for more ranks.

    bench/mpi_scaling.py PLEUEL [--repeat 1] [--messages build/bench/bin/rank_messages]
"""

import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROBLEM = ROOT / "problems/slider_crank_round.json"
QUICK = ["--set", "/simulation/step=0.2 ms", "--set", "/optimizer/backend=nlopt-mma",
         "--set", "/sensitivity/method=direct", "--no-report"]
PARAMETERS = '"parameters": {"rod_diameter": {"deviation": "0.1 mm"}}'
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def samples(count):
    return ["--set", "/uncertainty={%s, \"samples\": %d}" % (PARAMETERS, count)]


CASES = [("8 starts", ["optimize", PROBLEM, *QUICK, "--starts", "8"], "history.csv"),
         ("front of 16 points", ["pareto", PROBLEM, *QUICK, "--set", "/pareto/points=16"], "pareto.csv"),
         ("400 samples", ["uncertainty", PROBLEM, *QUICK, *samples(400)], "uncertainty.csv")]
WAYS = [("--jobs 1", 0, 1), ("--jobs 2", 0, 2), ("2 ranks", 2, 1), ("4 ranks", 4, 1)]


def ranks_of(count):
    return ["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(count)] if count else []


def run(command, folder):
    """Wall time, and the processor time of the process itself, without those that it has made [s]."""
    begin, used = time.monotonic(), 0.0
    with open(folder / "log", "w", encoding="utf-8") as log:
        process = subprocess.Popen(list(map(str, command)), env=ENVIRONMENT, stdout=log, stderr=log)
        while process.poll() is None:
            try:
                numbers = Path(f"/proc/{process.pid}/stat").read_text(encoding="utf-8").rsplit(")", 1)[1].split()
                used = (int(numbers[11]) + int(numbers[12])) / os.sysconf("SC_CLK_TCK")
            except (OSError, IndexError):
                pass
            time.sleep(0.01)
    if process.returncode not in (0, 4):
        sys.exit((folder / "log").read_text(encoding="utf-8"))
    return time.monotonic() - begin, used


def timeless(value):
    if isinstance(value, dict):
        return {k: timeless(v) for k, v in value.items() if k not in ("seconds", "choice_seconds")}
    return [timeless(one) for one in value] if isinstance(value, list) else value


def outcome(folder, table):
    with open(folder / table, newline="", encoding="utf-8") as file:
        rows = [{k: v for k, v in row.items() if k != "seconds"} for row in csv.DictReader(file)]
    return timeless(json.loads((folder / "result.json").read_text(encoding="utf-8"))), rows


def compare(program, repeat, folder):
    print("| wall time [s] | " + " | ".join(name for name, _, _ in WAYS) + " |\n|---" + "|---" * len(WAYS) + "|")
    for case, words, table in CASES:
        times = {name: [] for name, _, _ in WAYS}
        expected = None
        for i in range(repeat):
            for name, ranks, jobs in WAYS:
                target = folder / f"{case}{name}{i}".replace(" ", "")
                seconds, _ = run([*ranks_of(ranks), program, *words, "--jobs", jobs, "-o", target], folder)
                times[name].append(seconds)
                found = outcome(target, table)
                expected = expected or found
                if found != expected:
                    sys.exit(f"{case}, {name}: other digits than with one process")
        print(f"| {case} | " + " | ".join(f"{min(times[name]):.1f}" for name, _, _ in WAYS) + " |", flush=True)
    print("\nAll have the same digits.")


def writer_seconds(program, folder):
    """Of an evaluation: what 800 samples more take of the process that hands them out."""
    used = []
    for count in (80, 880):
        words = ["uncertainty", PROBLEM, *QUICK, *samples(count), "--jobs", "2", "-o", folder / f"writer{count}"]
        used.append(run([program, *words], folder)[1])
    return (used[1] - used[0]) / 800


def show_model(writer):
    """A task of so many seconds has so many evaluations of 50 ms, or is one; a message costs 1 ms, a task 10 ms."""
    print(f"\nThe process of rank 0 spends {1e3 * writer:.2f} ms on an evaluation.")
    counts = (2, 16, 128, 1024)
    print("\n| task [s] | evaluation [s] | " + " | ".join(f"{n} workers" for n in counts) + " |\n|---|---" +
          "|---" * len(counts) + "|")
    for task, evaluation in ((0.05, 0.05), (0.4, 0.05), (5, 0.05), (60, 0.05), (60, 1.0), (60, 60)):
        cells = []
        for workers in counts:
            alone = 0.01 + task / evaluation * (evaluation + 0.002)  # of a worker
            served = task / evaluation * writer + 0.001              # of rank 0
            cells.append(f"{task / max(alone / workers, served) / workers:.2f}")
        print(f"| {task} | {evaluation} | " + " | ".join(cells) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--repeat", type=int, default=1)
    parser.add_argument("--messages", help="bench/rank_messages, which measures messages")
    options = parser.parse_args()
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}\n")
    if options.messages:
        subprocess.run([*ranks_of(2), options.messages], env=ENVIRONMENT, check=True)
        print()
    with tempfile.TemporaryDirectory() as name:
        compare(options.program, options.repeat, Path(name))
        show_model(writer_seconds(options.program, Path(name)))


if __name__ == "__main__":
    main()
