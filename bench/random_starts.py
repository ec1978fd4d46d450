#!/usr/bin/env python3
"""Whether optimizations end well from anywhere: problems × backends × random starts between the bounds of
the variables, with a coarse step so that it is cheap. Prints a table: how many runs end verified at the
best known objective (the lowest one that any run of the problem verified), verified elsewhere, within
the limits but unproven, infeasible, failed; the largest number of evaluations, and the mean.

    bench/random_starts.py PLEUEL [--starts N] [--seed S] [--backends A,B] [--details] [NAME|FILE[:STEP] …]

A backend "-" is the choice of the program. Starts are the same for all backends.
"""

import argparse
import json
import os
import random
import re
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor

# name: step at which the problem is simulated [s]
PROBLEMS = {"slider_crank_round": 2e-4, "slider_crank": 2e-4, "slider_crank_tapered": 2e-4,
            "four_bar": 1e-3, "spatial_slider_crank": 4e-4, "robot_arm": 2e-3}
BACKENDS = ["-", "nlopt-slsqp", "nlopt-mma", "nlopt-ccsaq", "ipopt"]
SAME = 1e-3  # relative difference of objectives that count as one optimum


def numbered(text):
    """3.2, "mm" of "3.2 mm" or 3.2."""
    if isinstance(text, (int, float)):
        return float(text), ""
    match = re.match(r"\s*([-+0-9.eE]+)\s*(.*)", text)
    return float(match.group(1)), match.group(2)


class Problem:
    def __init__(self, text):
        name, _, step = text.partition(":")
        self.name = os.path.basename(name).removesuffix(".json")
        self.file = name if name.endswith(".json") else os.path.join(
            os.path.dirname(__file__), "..", "problems", name + ".json")
        with open(self.file, encoding="utf-8") as file:
            self.variables = json.load(file)["variables"]
        self.step = float(step) if step else PROBLEMS.get(self.name)

    def start(self, generator):
        overrides = []
        for name, variable in self.variables.items():
            lower, unit = numbered(variable["lower"])
            upper, _ = numbered(variable["upper"])
            value = lower + generator.random() * (upper - lower)
            overrides.append(f"/variables/{name}/start={value:.6g} {unit}")
        return overrides


def optimize(program, problem, backend, overrides, folder):
    command = [program, "optimize", problem.file, "--json", "--no-report", "--overwrite", "-o", folder,
               "--set", "/simulation/resolution_check=false"]
    if problem.step:
        command += ["--set", f"/simulation/step={problem.step} s"]
    if backend != "-":
        command += ["--backend", backend]
    for override in overrides:
        command += ["--set", override]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    try:
        document = json.loads(done.stdout)
    except json.JSONDecodeError:
        return {"status": "failed", "message": done.stderr.strip(), "evaluations": 0}
    return document if "status" in document else {
        "status": "failed", "message": str(document), "evaluations": 0}


def kind(result, best):
    if result["status"] != "verified":
        return {"unresolved": "verified elsewhere"}.get(result["status"], result["status"])
    value = result["objective"]["value"]
    return "best known" if best is not None and value <= best + SAME * abs(best) else "verified elsewhere"


KINDS = ["best known", "verified elsewhere", "stalled", "infeasible", "failed"]


def report(arguments, problem, folder):
    generator = random.Random(arguments.seed)
    starts = [problem.start(generator) for _ in range(arguments.starts)]
    tasks = [(backend, i) for backend in arguments.backends for i in range(len(starts))]

    def run(task):
        backend, i = task
        return optimize(arguments.program, problem, backend, starts[i],
                        os.path.join(folder, f"{problem.name}{backend}{i}"))

    with ThreadPoolExecutor(arguments.jobs) as pool:
        results = dict(zip(tasks, pool.map(run, tasks)))
    best = min((one["objective"]["value"] for one in results.values() if one["status"] == "verified"),
               default=None)
    for backend in arguments.backends:
        of_backend = [results[backend, i] for i in range(len(starts))]
        kinds = [kind(one, best) for one in of_backend]
        effort = [one["evaluations"] for one in of_backend]
        counts = " | ".join(str(kinds.count(one)) for one in KINDS)
        print(f"| {problem.name} | {'default' if backend == '-' else backend} | {counts} | "
              f"{sum(effort) / len(effort):.0f} | {max(effort)} |", flush=True)
        if not arguments.details:
            continue
        for i, one in enumerate(of_backend):
            if kinds[i] != "best known":
                value = one.get("objective", {}).get("value")
                print(f"    {kinds[i]} {value} (best {best}), {one['evaluations']} evaluations, from "
                      f"{', '.join(starts[i])}: {one['message']}", flush=True)
    return results


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("problems", nargs="*", default=list(PROBLEMS))
    parser.add_argument("--starts", type=int, default=5)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time")
    parser.add_argument("--backends", type=lambda text: text.split(","), default=BACKENDS)
    parser.add_argument("--details", action="store_true", help="what is said of all but the best")
    arguments = parser.parse_intermixed_args()
    print("| problem | backend | " + " | ".join(KINDS) + " | mean evaluations | most |")
    print("|---" * (4 + len(KINDS)) + "|")
    with tempfile.TemporaryDirectory() as folder:
        for name in arguments.problems:
            report(arguments, Problem(name), folder)


main()
