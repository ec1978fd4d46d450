"""What the generators of this folder share: a mesh -> CalculiX -> pleuel reduce -> a file of invariants.

A generator reads {"variables": {NAME: value}}, in SI units, from standard input, and writes the file to standard output
(docs/invariants.md). It needs ccx (Debian package calculix-ccx).
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
CHECKOUT = HERE.parents[1] / "pleuel"
PLEUEL = os.environ.get("PLEUEL", str(CHECKOUT) if CHECKOUT.exists() else "pleuel")


def require(*programs):
    """Ends with a message where one of the (program, Debian package) is missing."""
    for program, package in programs:
        if shutil.which(program) is None:
            sys.exit(f"{program} is not installed; problems/conrod/install-programs does it (Debian package {package})")


def run(command, folder):
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0 or "*ERROR" in done.stdout:
        sys.exit(f"{' '.join(command)}: {done.stdout[-1000:]}")


def write_input(path, kind, nodes, elements, sets):
    """The mesh with sets of nodes, of steel, and a step in which CalculiX writes its matrices."""
    # CalculiX reads no more than 20 letters of a number.
    lines = ["*NODE"] + [f"{n}, {x:.12e}, {y:.12e}, {z:.12e}" for n, (x, y, z) in sorted(nodes.items())]
    lines.append(f"*ELEMENT, TYPE={kind}, ELSET=body")
    for i, element in enumerate(elements):
        numbers = [str(n) for n in (i + 1, *element)]
        lines += [", ".join(numbers[:11]) + ("," if len(numbers) > 11 else "")]
        if len(numbers) > 11:
            lines.append(", ".join(numbers[11:]))
    for name, members in sets.items():
        lines += [f"*NSET, NSET={name}"] + [f"{n}," for n in members]
    lines += ["*MATERIAL, NAME=steel", "*ELASTIC", "210e9, 0.3", "*DENSITY", "7850.",
              "*SOLID SECTION, ELSET=body, MATERIAL=steel", "*STEP", "*FREQUENCY, SOLVER=MATRIXSTORAGE", "6", "*END STEP"]
    path.write_text("\n".join(lines) + "\n")


def reduced(folder, kind, nodes, elements, sets, model):
    """The file of invariants of a mesh, as text."""
    write_input(folder / "rod.inp", kind, nodes, elements, sets)
    whole = {"mesh": "rod.inp", "matrices": {"calculix": "rod"}, "units": "m-kg-s", **model}
    (folder / "model.json").write_text(json.dumps(whole))
    run(["ccx", "rod"], folder)
    run([PLEUEL, "reduce", "model.json", "-o", "body.json"], folder)
    return (folder / "body.json").read_text()


def generate(make, first):
    """Has make(design, folder) write the body of the design on standard input. What is not there is as in `first`."""
    design = {**first, **json.load(sys.stdin)["variables"]}
    with tempfile.TemporaryDirectory() as folder:
        sys.stdout.write(make(design, Path(folder)))
