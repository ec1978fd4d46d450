"""Packages of others reach the optimum that Pleuel proves, or a number that is known in another way."""

import glob
import importlib
import sys
import unittest

import numpy as np
from sample import crank

import pleuel

sys.path += glob.glob("/usr/lib/petscdir/*/*-real/lib/python3/dist-packages")  # where Debian has petsc4py


def example(package, debian_package, name):
    """python/examples/NAME.py, where the package that it uses is installed."""
    try:
        importlib.import_module(package)
    except ImportError:
        raise unittest.SkipTest(f"{package} is not installed (Debian: {debian_package})") from None
    return importlib.import_module(name)


class TestOptimizers(unittest.TestCase):
    """Each against the optimum that Pleuel's own search verified: relative differences are below 1e-6 (measured; trust-constr keeps
    a barrier of 5e-8 for each of 14 limits and bounds)."""

    @classmethod
    def setUpClass(cls):
        cls.problem = crank()
        cls.best = cls.problem.optimize(checks=False, tolerance=1e-9)
        assert cls.best.is_verified, cls.best["message"]

    def expect_backend(self, module):
        """Its functions, named by the options of a search: Pleuel proves what they find."""
        pleuel.register_backend("example", module.minimum)
        try:
            found = self.problem.optimize(backend="example", checks=False)
        finally:
            pleuel.register_backend("example", None)
        self.assertTrue(found.is_verified, found["message"])
        self.assertEqual(found["backend"], "example")
        self.expect_optimum(found.x, 1e-5)

    def expect_optimum(self, x, objective):
        """objective: its relative tolerance"""
        found = self.problem.evaluate(x)
        self.assertAlmostEqual(found.objective / self.best.objective, 1.0, delta=objective)
        excess = np.maximum(found.limits - self.problem.limit_upper, 0.0)
        magnitudes = np.where(self.problem.limit_upper != 0, np.abs(self.problem.limit_upper), 0.01)
        self.assertLess((excess / magnitudes).max(), objective)

    def test_scipy_slsqp(self):
        module = example("scipy", "python3-scipy", "scipy_slsqp")
        self.expect_optimum(module.optimum(self.problem), 1e-6)
        self.expect_backend(module)

    def test_scipy_trust_constr(self):
        module = example("scipy", "python3-scipy", "scipy_trust_constr")
        self.expect_optimum(module.optimum(self.problem), 1e-5)
        self.expect_backend(module)

    def test_nlopt_slsqp(self):
        module = example("nlopt", "python3-nlopt", "nlopt_slsqp")
        self.expect_optimum(module.optimum(self.problem), 1e-6)
        self.expect_backend(module)

    def test_petsc_tao(self):
        """Not as a backend: its augmented Lagrangian gets no better for longer than a search waits (docs/from-python.md)."""
        self.expect_optimum(example("petsc4py", "python3-petsc4py", "petsc_tao").optimum(self.problem), 1e-5)


class TestOtherPackages(unittest.TestCase):
    def test_lmfit_finds_the_numbers_that_a_history_was_made_with(self):
        identified = example("lmfit", "python3-lmfit", "lmfit_identification").identified
        problem, true = crank(), {"rod_width": 0.016, "crank_height": 0.034}
        measured = problem.histories("torque_peak", x=true).values
        found = identified(problem, "torque_peak", list(true), measured).params.valuesdict()
        for name, value in true.items():
            self.assertAlmostEqual(found[name] / value, 1.0, delta=1e-5)

    def test_openturns_form_is_that_of_uncertainty_where_a_response_is_linear(self):
        """The mass is linear in each width: β = (threshold - mean) / deviation, whose deviation `uncertainty` tells."""
        index = example("openturns", "python3-openturns", "openturns_form").reliability_index
        scatter = {"/uncertainty": {"parameters": {"rod_width": {"deviation": "0.1 mm"}, "crank_width": {"deviation": "0.2 mm"}}}}
        problem = crank(**scatter)
        deviation = problem.uncertainty()["responses"]["crank_and_rod"]["deviation"]
        mean = problem.response_values()["crank_and_rod"]
        found = index(problem, "crank_and_rod", mean + 2.5 * deviation, {"rod_width": 1e-4, "crank_width": 2e-4})
        self.assertAlmostEqual(found, 2.5, delta=1e-6)


if __name__ == "__main__":
    unittest.main()
