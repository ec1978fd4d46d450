#!/usr/bin/env python3
"""What an accuracy that is asked for costs: every shipped problem is optimized with the steps of its
file, and with --accuracy 1 % and 0.1 %. Prints a table: the optimum with its error bar, the setting at
the end, evaluations, and processor time of the whole command; and whether all bars of one problem
overlap.

    bench/accurate_optima.py PLEUEL [NAME …]
"""

import json
import os
import subprocess
import sys
import tempfile

PROBLEMS = ["slider_crank", "slider_crank_round", "four_bar", "spatial_slider_crank", "robot_arm"]
TARGETS = [None, "1%", "0.1%"]


def run(program, name, target, folder):
    file = os.path.join(os.path.dirname(__file__), "..", "problems", name + ".json")
    output = os.path.join(folder, name + str(target))
    command = [program, "optimize", file, "--jobs", "1", "--json", "-o", output]
    if target:
        command += ["--accuracy", target]
    before = os.times()
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    after = os.times()
    seconds = after.children_user - before.children_user
    return json.loads(done.stdout), seconds


def main():
    program, names = sys.argv[1], sys.argv[2:] or PROBLEMS
    print("| problem | accuracy | optimum [kg] | known to | step at the end | evaluations | processor time | status |")
    print("|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            intervals = []
            for target in TARGETS:
                result, seconds = run(program, name, target, folder)
                value = result["objective"]["value"]
                bar = result["objective"]["error"]["total"]
                known = f"{100 * bar / value:.2g} %" if bar is not None else "not resolved"
                intervals.append((value - (bar or 0.0), value + (bar or 0.0)))
                print(f"| {name} | {target or 'of the file'} | {value:.6g} | {known} "
                      f"| {1e3 * result['setting']['step']:.3g} ms | {result['evaluations']} "
                      f"| {seconds:.1f} s | {result['status']} |", flush=True)
            overlap = max(low for low, _ in intervals) <= min(high for _, high in intervals)
            print(f"| {name} | | bars {'overlap' if overlap else 'DO NOT OVERLAP'} | | | | | |")


main()
