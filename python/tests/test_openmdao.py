"""The component of OpenMDAO: with the package where it is installed, else with a stand-in that says so."""

import pathlib
import sys
import unittest

import numpy as np
from sample import crank

try:
    import openmdao.api as om
except ImportError:
    sys.path.insert(0, str(pathlib.Path(__file__).parent / "stand_in"))
    import openmdao.api as om

from pleuel.openmdao import PleuelComponent

IS_STAND_IN = getattr(om, "IS_STAND_IN", False)


def limits_at(problem, x):
    return problem.evaluate(x).limits


@unittest.skipIf(IS_STAND_IN, "openmdao is not installed: the tests with the stand-in run in its place")
class TestWithOpenMDAO(unittest.TestCase):
    def test_check_partials(self):
        model = om.Problem()
        model.model.add_subsystem("crank", PleuelComponent(problem=crank()), promotes=["*"])
        model.setup()
        model.run_model()
        data = model.check_partials(out_stream=None, method="fd", form="central", step=1e-7, step_calc="abs")
        for errors in data["crank"].values():
            self.assertLess(errors["rel error"][0], 1e-6)


@unittest.skipUnless(IS_STAND_IN, "openmdao is installed: it is tested itself")
class TestWithStandInForOpenMDAO(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        print("openmdao is not installed: PleuelComponent runs against a stand-in", file=sys.stderr)

    def test_partials_are_those_of_differences(self):
        problem = crank()
        x = problem.start * [1.0, 1.1, 0.9, 1.0]
        outputs, partials = om.run(PleuelComponent(problem=problem), x)
        np.testing.assert_array_equal(outputs["limits"], limits_at(problem, x))
        for j, h in enumerate(3e-6 * x):  # errors h² f''' of some 1e-9 and of round-off, some 1e-8, of a value over x
            step = h * np.eye(4)[j]
            slope = (limits_at(problem, x + step) - limits_at(problem, x - step)) / (2 * h)
            size = np.abs(partials["limits", "x"][:, j]) + np.abs(outputs["limits"]) / x[j]
            self.assertLess((np.abs(slope - partials["limits", "x"][:, j]) / size).max(), 1e-6)
        np.testing.assert_array_equal(partials["objective", "x"], problem.evaluate(x, derivatives=True).gradient)


if __name__ == "__main__":
    unittest.main()
