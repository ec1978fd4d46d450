#!/usr/bin/env python3
"""Optimizations with many variables: the slider-crank whose crank and rod have so many segments, each with a
diameter and a limit on its stress. Prints a table: status, objective, evaluations, processor time, mean wall time of an
evaluation of values and of one with gradients (from run.sqlite), and the largest memory of the process. Then processor time
and memory of `check` and of one simulation, without its checks and with them.

    bench/scale.py PLEUEL [--variables 40,100,200] [--backends nlopt-slsqp,nlopt-mma,ipopt] [--keep DIR]
"""

import argparse
import json
import os
import sqlite3
import tempfile


def beam(name, begin, end, count, frame):
    segments = [{"section": {"type": "circle", "diameter": {"variable": f"{name}_{i}"}}, "elements": 1}
                for i in range(count)]
    return {"type": "beam", "from": [begin, 0, 0], "to": [end, 0, 0], "material": "steel", "segments": segments,
            "frame": frame, "damping": {"stiffness": "1e-5 s"}}


def problem(variables):
    """The crank is driven from rest to 200 rad/s within 20 ms, and on for 10 ms."""
    half = variables // 2
    names = [("crank", i) for i in range(half)] + [("rod", i) for i in range(variables - half)]
    stress = {f"{body}_stress_{i}": {"type": "stress", "body": body, "segment": i, "over_time": "max"}
              for body, i in names}
    return {
        "name": f"slider-crank, {variables} segments",
        "scene": {
            "materials": {"steel": {"young": "210 GPa", "poisson": 0.3, "density": "7850 kg/m^3"}},
            "bodies": {"crank": beam("crank", 0, "120 mm", half, "tangent"),
                       "rod": beam("rod", "120 mm", "300 mm", variables - half, "chord"),
                       "slider": {"type": "point-mass", "at": ["300 mm", 0, 0], "mass": "0.2826 kg"}},
            "joints": {
                "bearing": {"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0], "axis": [0, 0, 1],
                            "drive": {"type": "ramp-to-speed", "speed": "200 rad/s", "ramp": "20 ms"}},
                "crank_pin": {"type": "revolute", "bodies": ["crank", "rod"], "at": ["120 mm", 0, 0],
                              "axis": [0, 0, 1]},
                "piston_pin": {"type": "revolute", "bodies": ["rod", "slider"], "at": ["300 mm", 0, 0],
                               "axis": [0, 0, 1]},
                "guide": {"type": "point-on-line", "bodies": ["ground", "slider"], "at": ["300 mm", 0, 0],
                          "axis": [1, 0, 0]}}},
        "simulation": {"end_time": "30 ms", "step": "0.25 ms", "resolution_check": False},
        "variables": {f"{body}_{i}": {"start": "20 mm", "lower": "4 mm", "upper": "40 mm"} for body, i in names},
        "responses": {"mass": {"type": "mass"}, **stress},
        "objective": {"minimize": "mass"},
        "constraints": {name: {"response": name, "upper": "60 MPa"} for name in stress}}


def measure(command):
    """Exit code, processor time [s] and largest memory [MB] of a command."""
    child = os.fork()
    if child == 0:
        quiet = os.open(os.devnull, os.O_WRONLY)
        os.dup2(quiet, 1)
        os.dup2(quiet, 2)
        os.execv(command[0], command)
    _, status, usage = os.wait4(child, 0)
    return os.waitstatus_to_exitcode(status), usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def read(path):
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError):
        return {}


def mean_seconds(path, request):
    """Of the evaluations of a record."""
    try:
        with sqlite3.connect(f"file:{path}?mode=ro", uri=True) as record:
            answer = record.execute("SELECT avg(seconds) FROM evaluations WHERE request = ?", (request,)).fetchone()
            return answer[0] or float("nan")
    except sqlite3.Error:
        return float("nan")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--variables", default="40,100,200")
    parser.add_argument("--backends", default="nlopt-slsqp,nlopt-mma,ipopt")
    parser.add_argument("--keep", help="folder of the runs")
    arguments = parser.parse_args()
    folder = arguments.keep or tempfile.mkdtemp(prefix="scale")
    os.makedirs(folder, exist_ok=True)
    print("variables  backend      status      mass [kg]   evaluations  gradients  processor [s]  values [s]  "
          "with gradients [s]  memory [MB]")
    for count in (int(one) for one in arguments.variables.split(",")):
        file = os.path.join(folder, f"{count}.json")
        with open(file, "w", encoding="utf-8") as stream:
            json.dump(problem(count), stream)
        for backend in arguments.backends.split(","):
            out = os.path.join(folder, f"{count}-{backend}")
            _, seconds, memory = measure([os.path.abspath(arguments.program), "optimize", file, "--backend", backend,
                                          "-o", out, "--overwrite", "--no-report", "--jobs", "1"])
            record = os.path.join(out, "run.sqlite")
            result = read(os.path.join(out, "result.json"))
            print(f"{count:9d}  {backend:11s}  {result.get('status', '-'):10s}"
                  f"  {result.get('objective', {}).get('value', float('nan')):9.6f}"
                  f"  {result.get('evaluations', 0):11d}  {result.get('gradient_evaluations', 0):9d}"
                  f"  {seconds:13.1f}  {mean_seconds(record, 'values'):10.2f}"
                  f"  {mean_seconds(record, 'gradients'):18.2f}  {memory:11.0f}", flush=True)
        run = ["-o", os.path.join(folder, f"{count}-other"), "--overwrite", "--no-report"]
        for words in (["check", file, "--jobs", "1"], ["simulate", file, "--no-checks", *run], ["simulate", file, *run]):
            _, seconds, memory = measure([os.path.abspath(arguments.program), *words])
            name = " ".join([words[0], *(["--no-checks"] if "--no-checks" in words else [])])
            print(f"{count:9d}  {name:20s} {seconds:8.2f} s  {memory:6.0f} MB", flush=True)


if __name__ == "__main__":
    main()
