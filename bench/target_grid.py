#!/usr/bin/env python3
"""Whether `--accuracy` chooses well: for every shipped problem, at its start design, the setting that
is chosen for 1 %, 0.1 % and 0.01 % against a full grid of steps and elements. Prints a table: the
chosen setting, its true error (against a quarter of the finest step and twice the most elements), the
processor time of one simulation, those of the fastest setting of the grid within the target, and what
choosing took, in simulations of the chosen setting.

    bench/target_grid.py PLEUEL [NAME …]
"""

import json
import os
import resource
import subprocess
import sys
import tempfile

PROBLEMS = ["slider_crank", "slider_crank_round", "slider_crank_tapered", "four_bar",
            "spatial_slider_crank", "robot_arm"]
TARGETS = ["1%", "0.1%", "0.01%"]
STEPS = [2.0 ** (0.5 * i) for i in range(-4, 11)]  # times the step of the file
ELEMENTS = [0.25, 0.5, 1, 2, 4]  # times those of the file
REPETITIONS = 3


def processor_time():
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime


def value_at(document, pointer):
    for key in pointer.split("/")[1:]:
        document = document[int(key)] if isinstance(document, list) else document[key]
    return document


class Problem:
    def __init__(self, program, name, folder):
        self.program, self.folder = program, folder
        self.file = os.path.join(os.path.dirname(__file__), "..", "problems", name + ".json")
        with open(self.file, encoding="utf-8") as text:
            document = json.load(text)
        self.elements, self.fractions = {}, []
        for pointer, value in json.loads(self.run([], "--accuracy", "1%")[1])["setting"]["overrides"].items():
            if pointer.endswith("/elements"):
                self.elements[pointer] = value_at(document, pointer)
            if pointer.endswith("/length_fraction"):
                self.fractions.append((pointer, value))
        self.asked = {limit["response"] for limit in document["constraints"].values()
                      if "response" in limit}
        self.asked.add(document["objective"]["minimize"])

    def run(self, overrides, *options):
        command = [self.program, "simulate", self.file, "--json", "--no-report", "--overwrite", "-o",
                   self.folder, *options]
        for pointer, value in overrides:
            command += ["--set", f"{pointer}={value}"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout

    def simulate(self, overrides, repetitions=1):
        """Values and the processor time of the whole command; none where it fails."""
        best, values = float("inf"), None
        for _ in range(repetitions):
            before = processor_time()
            code, text = self.run(overrides, "--no-checks")
            if code not in (0, 4):
                return None, best
            document = json.loads(text)
            best = min(best, processor_time() - before)
            values = {name: one["value"] for name, one in document["responses"].items()}
        return values, best

    def divided(self, step, factor):
        return [("/simulation/step", f"{step} s"), *self.fractions] + [
            (pointer, max(1, round(factor * n))) for pointer, n in self.elements.items()]

    def error(self, values, exact):
        return max(abs(values[name] - exact[name]) / max(abs(exact[name]), 1e-30)
                   for name in self.asked)


def report(program, name, folder):
    problem = Problem(program, name, folder)
    with open(problem.file, encoding="utf-8") as text:
        simulation = json.load(text)["simulation"]
    number, unit = (simulation["step"].split() + [""])[:2] if isinstance(
        simulation["step"], str) else (simulation["step"], "")
    file_step = float(number) * {"": 1.0, "s": 1.0, "ms": 1e-3, "us": 1e-6}[unit]
    exact, _ = problem.simulate(
        problem.divided(0.25 * STEPS[0] * file_step, 2 * ELEMENTS[-1]))
    before = processor_time()
    subprocess.run([program, "--version"], capture_output=True, check=True)
    start_up = processor_time() - before
    grid = []
    for factor in ELEMENTS:
        for step in STEPS:
            overrides = problem.divided(step * file_step, factor)
            values, seconds = problem.simulate(overrides)
            if values:
                grid.append((seconds, problem.error(values, exact), step * file_step, factor, overrides))
    for target in TARGETS:
        bound = float(target.rstrip("%")) / 100
        before = processor_time()
        setting = json.loads(problem.run([], "--accuracy", target, "--no-checks")[1])["setting"]
        with_choice = processor_time() - before
        values, seconds = problem.simulate(list(setting["overrides"].items()), REPETITIONS)
        error = problem.error(values, exact)
        fast = sorted(one for one in grid if one[1] <= bound)[:3]
        best = min(((problem.simulate(one[4], REPETITIONS)[1],) + one[1:4] for one in fast),
                   default=None)
        of_grid = (f"{1e3 * best[2]:.3g} ms × {best[3]:g} | {100 * best[1]:.2g} % | "
                   f"{1e3 * best[0]:.3g} ms | {seconds / best[0]:.2f}") if best else "none | | | "
        choosing = (with_choice - seconds) / (seconds - start_up)
        print(f"| {name} | {target} | {'' if setting['met'] else 'not known: '}"
              f"{1e3 * setting['step']:.3g} ms, {setting['elements']} | {100 * error:.2g} % | "
              f"{1e3 * seconds:.3g} ms | {of_grid} | {choosing:.1f} |", flush=True)


def main():
    print("| problem | target | chosen: step, elements in all | its error | its time | best of the grid: "
          "step × elements | its error | its time | ratio | choosing |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name in sys.argv[2:] or PROBLEMS:
            report(sys.argv[1], name, os.path.join(folder, "run"))


main()
