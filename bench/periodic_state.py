#!/usr/bin/env python3
"""What a periodic initial state costs against a simulated run-up.

    periodic_state.py PROGRAM [TURNS]    PROGRAM is the built pleuel; 50 turns by default

Prints for each mechanism the seconds of both (the better of two runs), their ratio, and by how much the peaks of the last
turn of the run-up differ, relative to the largest.
"""

import json
import math
import subprocess
import sys
from pathlib import Path

PROBLEMS = Path(__file__).resolve().parents[1] / "problems"
TURN = 2 * math.pi / 50

DRIVE = '{"type": "constant-speed", "speed": "50 rad/s"}'
MECHANISMS = {
    "slider_crank": [f"/scene/joints/bearing/drive={DRIVE}", "/simulation/step=0.25 ms"]
    + [f"/scene/bodies/{body}/damping/stiffness=0.2 ms" for body in ("crank", "rod")],
    "four_bar": [f"/scene/joints/crank_bearing/drive={DRIVE}"]
    + [f"/scene/bodies/{body}/damping/stiffness=0.2 ms" for body in ("crank", "coupler", "rocker")],
    "running_press": [],
}


def simulate(program, name, turns, overrides):
    arguments = [program, "simulate", str(PROBLEMS / f"{name}.json"), "--json"]
    for override in overrides + [f"/simulation/end_time={turns * TURN!r} s", "/simulation/resolution_check=false"]:
        arguments += ["--set", override]
    runs = [json.loads(subprocess.run(arguments, check=True, capture_output=True, text=True).stdout) for _ in range(2)]
    return min(runs, key=lambda run: run["seconds"])


def last_turn(name, turns):
    """Overrides that take responses over the last turn only."""
    responses = json.loads((PROBLEMS / f"{name}.json").read_text())["responses"]
    return [f"/responses/{response}/from={(turns - 1) * TURN!r}" for response, of in responses.items() if "over_time" in of]


def main():
    program, turns = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 50
    for name, overrides in MECHANISMS.items():
        steady = simulate(program, name, 1, overrides + ["/simulation/initial_state=periodic"])
        run_up = simulate(program, name, turns, overrides + ["/simulation/initial_state=consistent"] + last_turn(name, turns))
        difference = max(
            abs(value["value"] - run_up["responses"][response]["value"]) / abs(value["value"])
            for response, value in steady["responses"].items()
            if value["value"]
        )
        print(
            f"{name}: {steady['seconds']:.3f} s against {run_up['seconds']:.3f} s of {turns} turns, "
            f"{run_up['seconds'] / steady['seconds']:.1f} times; values differ by {difference:.1e}"
        )


if __name__ == "__main__":
    main()
