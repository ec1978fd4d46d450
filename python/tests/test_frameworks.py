"""Inside OpenMDAO and pyOptSparse: with the packages where they are installed, else with stand-ins that say so."""

import importlib.util
import pathlib
import sys
import unittest

import numpy as np
from sample import crank

for package in ("openmdao", "pyoptsparse"):
    if importlib.util.find_spec(package) is None:
        sys.path.append(str(pathlib.Path(__file__).parent / "stand_in"))
import openmdao.api as om  # noqa: E402
import pyoptsparse  # noqa: E402

from pleuel.openmdao import PleuelComponent, add_optimization  # noqa: E402
from pleuel.pyoptsparse import optimization  # noqa: E402


def name_of(package, name):
    """For the output of the tests."""
    return f"the stand-in for {name}" if getattr(package, "IS_STAND_IN", False) else name


def model_of(problem):
    model = om.Problem(reports=None)
    model.model.add_subsystem("crank", PleuelComponent(problem=problem), promotes=["*"])
    add_optimization(model.model, problem)
    model.driver = om.ScipyOptimizeDriver(optimizer="SLSQP", tol=1e-9)
    model.driver.options["disp"] = False
    model.setup()
    return model


class TestFrameworks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        print(f"with {name_of(om, 'OpenMDAO')} and {name_of(pyoptsparse, 'pyOptSparse')}", file=sys.stderr)
        cls.problem = crank()
        cls.best = cls.problem.optimize(checks=False, tolerance=1e-9)
        assert cls.best.is_verified, cls.best["message"]

    def test_check_partials_of_the_component(self):
        """Central differences: h² = 1e-13 over x² of the third derivative, some 1e-9, and round-off, some 1e-8, of a value over x."""
        model = model_of(self.problem)
        for factors in ([1.0, 1.0, 1.0, 1.0], [1.0, 1.1, 0.9, 1.0]):
            x = self.problem.start * factors
            model.set_val("x", x)
            model.run_model()
            data = model.check_partials(out_stream=None, method="fd", form="central", step=3e-7, step_calc="abs")["crank"]
            self.assertEqual(set(data), {("objective", "x"), ("limits", "x")})
            for (of, _), one in data.items():
                size = np.abs(one["J_fwd"]) + np.abs(model[of])[:, None] / x
                self.assertLess((np.abs(one["J_fwd"] - one["J_fd"]) / size).max(), 1e-6, of)

    def test_a_model_of_openmdao_reaches_the_optimum(self):
        model = model_of(self.problem)
        model.run_driver()
        self.assertAlmostEqual(float(model["objective"][0]) / self.best.objective, 1.0, delta=1e-6)
        np.testing.assert_allclose(model["x"], self.best.x, rtol=1e-3)

    def test_designs_that_cannot_be_simulated_are_analysis_errors(self):
        model = model_of(self.problem)
        model.set_val("x", self.problem.start * [1.0, 1.0, -1.0, 1.0])
        with self.assertRaises(om.AnalysisError):
            model.run_model()

    def test_pyoptsparse_reaches_the_optimum(self):
        described, derivatives = optimization(self.problem)
        found = pyoptsparse.SLSQP(options={"ACC": 1e-9, "IPRINT": -1})(described, sens=derivatives)
        x = np.array(found.xStar["x"])
        self.assertAlmostEqual(self.problem.evaluate(x).objective / self.best.objective, 1.0, delta=1e-6)
        np.testing.assert_allclose(x, self.best.x, rtol=1e-3)


if __name__ == "__main__":
    unittest.main()
