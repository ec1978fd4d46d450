"""Optimizers of Python as backends: Pleuel judges what they find, and tells what they raise."""

import pathlib
import sys
import unittest

import numpy as np
from sample import crank

import pleuel


class TestBackends(unittest.TestCase):
    def setUp(self):
        self.addCleanup(self.forget)

    @staticmethod
    def forget():
        try:
            pleuel.register_backend("mine", None)
        except pleuel.InputError:
            pass  # the test has done so

    def optimize(self, backend, **options):
        pleuel.register_backend("mine", backend)
        return crank().optimize(backend="mine", checks=False, **options)

    def test_what_is_no_optimum_is_not_believed(self):
        self.assertFalse(self.optimize(lambda search: search.start).is_verified)

    def test_functions_have_the_derivatives_of_differences(self):
        """Errors of some h² = 1e-8 and of round-off, 1e-11 / h, in numbers of order one."""
        seen = []

        def check(search):
            y, h = search.start, 1e-4
            for j in range(y.size):
                step = h * np.eye(y.size)[j]
                slope = (search.violations(y + step) - search.violations(y - step)) / (2 * h)
                np.testing.assert_allclose(slope, search.jacobian(y)[:, j], rtol=1e-5, atol=1e-5)
                slope = (search.objective(y + step) - search.objective(y - step)) / (2 * h)
                self.assertAlmostEqual(slope, search.gradient(y)[j], delta=1e-6)
            seen.append((search.equalities(y).size, search.tolerance))
            return y

        self.optimize(check, tolerance=1e-5)
        self.assertEqual(seen[0], (0, 1e-5))

    def test_what_it_raises_is_the_cause_of_the_error(self):
        def fail(search):
            raise LookupError("no way down")

        with self.assertRaisesRegex(pleuel.CallError, 'the backend "mine" failed: LookupError: no way down') as caught:
            self.optimize(fail)
        self.assertIsInstance(caught.exception.__cause__, LookupError)
        with self.assertRaises(pleuel.CallError) as caught:  # of another cause
            crank().evaluate([1.0])
        self.assertIsNone(caught.exception.__cause__)

    def test_what_it_returns_is_checked(self):
        for wrong in (None, [1.0], np.zeros((2, 2)), "text"):
            with self.assertRaisesRegex(pleuel.CallError, 'the backend "mine" failed'):
                self.optimize(lambda search, wrong=wrong: wrong)

    def test_designs_that_cannot_be_simulated_are_walls(self):
        seen = []

        def run_into(search):
            y = search.start.copy()
            before = search.objective(y)
            y[2] *= 0.35  # a tube of 7 mm with a wall of 4 mm
            seen.append((search.objective(y) - before, search.violations(y).min(), search.jacobian(y).any()))
            return search.start

        tube = {"type": "tube", "outer_diameter": {"variable": "rod_width"}, "thickness": {"variable": "rod_height"}}
        wall = {"start": "4 mm", "lower": "4 mm", "upper": "5 mm"}
        pleuel.register_backend("mine", run_into)
        crank(**{"/scene/bodies/rod/section": tube, "/variables/rod_height": wall}).optimize(backend="mine", checks=False)
        for higher, violation, has_slopes in seen:
            self.assertGreaterEqual(higher, 10.0 - 1e-12)
            self.assertGreaterEqual(violation, 10.0)
            self.assertFalse(has_slopes)
        self.assertGreater(len(seen), 0)

    def test_it_ends_when_the_search_does(self):
        def wander(search):
            y = search.start
            while True:
                search.gradient(y)
                y = 1.001 * y

        pleuel.register_backend("mine", wander)
        best = crank().optimize(backend="mine", checks=False, callback=lambda progress: progress.evaluation == 5)
        self.assertEqual((best["status"], best["evaluations"]), ("interrupted", 5))
        self.assertNotEqual(self.optimize(wander, max_iterations=6)["status"], "interrupted")

    def test_problems_name_it(self):
        calls = []
        pleuel.register_backend("mine", lambda search: calls.append(1) or search.start)
        crank(**{"/optimizer/backend": "mine"}).optimize(checks=False)
        self.assertGreater(len(calls), 0)
        pleuel.register_backend("mine", None)
        with self.assertRaisesRegex(pleuel.InputError, 'no optimizer backend "mine"'):
            crank().optimize(backend="mine")

    def test_several_starts_are_searched_from(self):
        starts = []
        best = self.optimize(lambda search: starts.append(tuple(search.start)) or search.start, starts=3, jobs=2)
        self.assertIn("starts", best)
        self.assertGreaterEqual(len(set(starts)), 3)


if __name__ == "__main__":
    unittest.main()
