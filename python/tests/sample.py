"""The problem of the tests."""

import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "python" / "examples")]

import pleuel  # noqa: E402

FILE = str(ROOT / "problems" / "slider_crank.json")
#: The ramp only, in coarse steps: some milliseconds of simulation.
QUICK = {"/simulation/step": "0.2 ms", "/simulation/end_time": "20 ms", "/scene/joints/bearing/drive/ramp": "20 ms"}


def crank(**more) -> "pleuel.Problem":
    return pleuel.load(FILE, set={**QUICK, **more})
