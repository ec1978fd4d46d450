#!/usr/bin/env python3
"""How often optimize calls the program that makes a body: the table of docs/from-a-cad-part.md.

    bench/body_calls.py [--program PLEUEL] [--reference] [NAME …]

Each problem runs in a folder of its own. With --reference SciPy's SLSQP looks for the same optimum with a body that is
made for every design that it asks for (needs the library and SciPy).
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
CONROD = ROOT / "problems" / "conrod"
ONE = ['/variables={"height": {"start": "30 mm", "lower": "6 mm", "upper": "60 mm"}}',
       '/scene/bodies/rod/generator/variables={"height": "m"}',
       '/constraints={"strength": {"response": "rod_stress", "upper": "150 MPa"}, '
       '"stiffness": {"response": "rod_bow", "upper": "0.2 mm"}}']
#: The crank may be as thin as its bounds allow: it becomes so high that shear bends it.
FREE = ['/scene/bodies/crank/shear=true',
        '/constraints={"crank_strength": {"response": "crank_stress", "upper": "200 MPa"}, '
        '"rod_strength": {"response": "rod_stress", "upper": "200 MPa"}, '
        '"rod_stiffness": {"response": "rod_bow", "upper": "0.2 mm"}, '
        '"crank_stiffness": {"response": "crank_tip", "upper": "0.5 mm"}}']
MADE_ROD = ROOT / "docs" / "invariants" / "made_rod.json"
#: name: (file, overrides, calls for one design)
PROBLEMS = {
    "planar_rod": (MADE_ROD, [], 1),
    "planar_rod, any crank": (MADE_ROD, FREE, 1),
    "block, one variable": (CONROD / "block.json", ONE, 2),
    "block, three variables": (CONROD / "block.json", [], 4),
    "conrod": (CONROD / "conrod.json", [], 4),
}


def optimized(program, file, overrides):
    """The document of optimize, how many calls it made, and what it took [s]."""
    with tempfile.TemporaryDirectory() as folder:
        words = [word for override in overrides for word in ("--set", override)]
        start = time.monotonic()
        done = subprocess.run([program, "optimize", str(file), *words, "--allow-programs", "--json", "--no-report", "-o", "run"],
                              cwd=folder, capture_output=True, text=True)
        seconds = time.monotonic() - start
        if not done.stdout:
            sys.exit(done.stderr)
        return json.loads(done.stdout), len(list((Path(folder) / "runs" / "bodies").glob("*.json"))), seconds


def reference(file, overrides):
    """The optimum with a body that is made for every design, and how many designs that were."""
    sys.path[:0] = [str(ROOT / "python")]
    sys.path[:0] = [str(ROOT / "python" / "examples")]
    import scipy_slsqp

    import pleuel

    with tempfile.TemporaryDirectory() as folder:
        before = os.getcwd()
        os.chdir(folder)
        problem = pleuel.load(file, set=dict(override.split("=", 1) for override in overrides), allow_programs=True)
        best = problem.evaluate(scipy_slsqp.optimum(problem))
        calls = len(list(Path("runs/bodies").glob("*.json")))
        os.chdir(before)
    return best.objective, calls


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help=f"of {', '.join(PROBLEMS)}")
    parser.add_argument("--program", default=str(ROOT / "pleuel"))
    parser.add_argument("--reference", action="store_true")
    arguments = parser.parse_args()
    for name, (file, overrides, of_design) in PROBLEMS.items():
        if arguments.names and name not in arguments.names:
            continue
        if file != MADE_ROD and shutil.which("ccx") is None:
            print(f"{name}: ccx is not installed (problems/conrod/install-programs)")
            continue
        document, calls, seconds = optimized(arguments.program, file, overrides)
        line = (f"{name}: {document['status']}, {document['objective']['value']:.6f} kg, {calls} calls for {calls // of_design} "
                f"designs, {seconds:.0f} s, {document['evaluations']} evaluations")
        if arguments.reference:
            objective, others = reference(file, overrides)
            line += f"; called for every design: {objective:.6f} kg, {others} calls"
        print(line, flush=True)


if __name__ == "__main__":
    main()
