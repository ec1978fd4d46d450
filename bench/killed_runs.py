#!/usr/bin/env python3
"""Kills runs of optimize, several starts and pareto at random instants and resumes them.

    bench/killed_runs.py [--program build/release/bin/pleuel] [--kills 200] [--seed 1] [--jobs 2]

Every run that is resumed to its end must have the digits of one that was not disturbed, but for times,
and as many evaluations on record. Prints one line a kind; exit code 1 if any differs.
"""

import argparse
import csv
import json
import random
import sqlite3
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
QUICK = ["--set", "/simulation/step=0.2 ms", "--set", "/simulation/end_time=20 ms",
         "--set", "/scene/joints/bearing/drive/ramp=20 ms",
         "--set", "/optimizer/backend=nlopt-mma", "--no-report"]


def timeless(value):
    if isinstance(value, dict):
        return {k: timeless(v) for k, v in value.items() if k not in ("seconds", "choice_seconds")}
    if isinstance(value, list):
        return [timeless(one) for one in value]
    return value


def rows(path):
    with open(path, newline="", encoding="utf-8") as file:
        return [{k: v for k, v in row.items() if k != "seconds"} for row in csv.DictReader(file)]


def outcome(folder, table):
    connection = sqlite3.connect(folder / "run.sqlite")
    count = connection.execute("SELECT count(*) FROM evaluations").fetchone()[0]
    connection.close()
    result = json.loads((folder / "result.json").read_text(encoding="utf-8"))
    return timeless(result), rows(folder / table), count


def run(command):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))} ended with {done.returncode}:\n{done.stderr}")


def kill_after(command, seconds):
    """Whether the run was still at work then."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    time.sleep(seconds)
    was_at_work = process.poll() is None
    process.kill()
    process.wait()
    return was_at_work


def try_kind(name, words, table, kills, folder):
    begin = time.monotonic()
    run([*words, "-o", folder / "whole"])
    longest = time.monotonic() - begin
    expected = outcome(folder / "whole", table)
    killed, resumed, wrong = 0, 0, 0
    while killed < kills:
        one = folder / f"killed{resumed}"
        command = [*words, "-o", one, "--resume"]
        for _ in range(random.randint(1, 5)):
            killed += kill_after(command, random.uniform(0.0, longest))
        run(command)
        resumed += 1
        wrong += outcome(one, table) != expected
    print(f"{name}: {killed} kills, {resumed} runs resumed to their end, {wrong} differ", flush=True)
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=ROOT / "build/release/bin/pleuel")
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", default="2")
    options = parser.parse_args()
    random.seed(options.seed)
    problem = ROOT / "problems/slider_crank_round.json"
    program, jobs = options.program, ["--jobs", options.jobs]
    kinds = [
        ("optimize", [program, "optimize", problem, *QUICK], "history.csv"),
        ("starts", [program, "optimize", problem, *QUICK, "--starts", "3", *jobs], "history.csv"),
        ("pareto", [program, "pareto", problem, *QUICK, "--set", "/pareto/points=4", *jobs],
         "pareto.csv"),
    ]
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        for name, words, table in kinds:
            home = Path(folder) / name
            home.mkdir()
            wrong += try_kind(name, words, table, -(-options.kills // len(kinds)), home)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
