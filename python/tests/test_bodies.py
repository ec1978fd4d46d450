"""Bodies that functions make (pleuel.load(bodies=…)), against the same bodies from files."""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
from sample import QUICK, ROOT, crank

import pleuel

PLANAR_ROD = str(ROOT / "docs" / "invariants" / "planar_rod.py")


def made(height):
    """A rod from a program that stands for a finite-element code, as text."""
    line = json.dumps({"variables": {"rod_height": height}})
    command = [sys.executable, PLANAR_ROD, "-", "--elements", "4"]
    return subprocess.run(command, input=line, capture_output=True, text=True, check=True).stdout


def problem(**rod):
    document = json.loads((ROOT / "docs" / "invariants" / "slider_crank.json").read_text())
    body = document["scene"]["bodies"]["rod"]
    for key in ("file", "other_designs"):
        del body[key]
    body.update(rod)
    document["responses"]["rod_bow"]["at"] = "node 2"
    return document


GENERATOR = {"variables": {"rod_height": "m"}, "derivatives": "given"}


class TestBodies(unittest.TestCase):
    def load(self, function):
        return pleuel.load(problem(generator=GENERATOR), set=QUICK, bodies={"rod": function})

    def test_a_function_is_as_good_as_a_file(self):
        calls = []

        def rod(x):
            calls.append(x[0])
            body = json.loads(made(x[0]))
            body["invariants"]["mass"] = np.float64(body["invariants"]["mass"])  # as NumPy programs have it
            return body

        ours = self.load(rod)
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "rod.json").write_text(made(0.03))
            theirs = pleuel.load(problem(file="rod.json"), set=QUICK, folder=folder)
        self.assertEqual(ours.response_values(), theirs.response_values())
        np.testing.assert_array_equal(ours.jacobian(), theirs.jacobian())
        ours.response_values({"rod_height": 0.025})
        self.assertEqual(calls, [0.03, 0.025])  # once for each design

    def test_what_it_raises_fails_the_design(self):
        def rod(x):
            if x[0] < 0.02:
                raise ValueError("too thin to be meshed")
            return made(x[0])

        crank = self.load(rod)
        with self.assertRaisesRegex(pleuel.SimulationError, "rod_height = 0.015 m: ValueError: too thin to be meshed"):
            crank.response_values({"rod_height": 0.015})
        self.assertGreater(crank.response_values()["rod_stress"], 0.0)

    def test_garbage_is_an_error_of_the_problem(self):
        for garbage in ("no JSON", {"format": "pleuel invariants", "version": 1}, {"x": object()}):
            with self.assertRaisesRegex(pleuel.InputError, "/scene/bodies/rod/generator"):
                self.load(lambda x, text=garbage: text)

    def test_without_a_function_or_permission_nothing_is_made(self):
        program = {**GENERATOR, "command": [sys.executable, PLANAR_ROD, "-"]}
        for generator, expected in ((GENERATOR, 'needs a "command"'), (program, "--allow-programs")):
            text = json.dumps(problem(generator=generator)).replace('"rod"', '"unregistered"')
            with self.assertRaisesRegex(pleuel.InputError, expected):
                pleuel.load(json.loads(text), set=QUICK)


class TestByInvariants(unittest.TestCase):
    """python/examples/sheet_thickness.py: a finite-element program with derivatives of its own."""

    def test_the_chain_rule_gives_what_differences_give(self):
        import sheet_thickness as example

        sheet = example.Sheet(8, 2, modes=2)
        thickness = np.linspace(5e-3, 15e-3, 16)
        # Second order in a step of a thousandth; measured 3e-7.
        self.assertLess(example.check(example.Rod(sheet), thickness, sheet.basis(thickness)), 5e-6)

    def test_another_kind_of_body_is_refused(self):
        with self.assertRaisesRegex(pleuel.InputError, "/scene/bodies/rod is no body of the type"):
            crank().by_invariants("rod")


if __name__ == "__main__":
    unittest.main()
