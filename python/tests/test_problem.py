"""The package against itself by other ways, and against the program."""

import copy
import json
import os
import pathlib
import pickle
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
from sample import FILE, QUICK, ROOT, crank

import pleuel


def evaluated(problem, x):
    return problem.evaluate(x, derivatives=True)


def is_same(one, other):
    return all(np.array_equal(a, b) for a, b in zip(one, other))


class TestProblem(unittest.TestCase):
    def test_names_bounds_and_units_are_those_of_the_file(self):
        problem, file = crank(), json.loads(pathlib.Path(FILE).read_text())
        self.assertEqual(problem.variables, list(file["variables"]))
        self.assertEqual(problem.responses, list(file["responses"]))
        self.assertEqual(problem.limits, list(file["constraints"]))
        self.assertEqual(problem.bodies, list(file["scene"]["bodies"]))
        self.assertEqual((problem.objective, problem.cases), ("crank_and_rod", []))
        np.testing.assert_array_equal(problem.start, [0.02, 0.03, 0.02, 0.03])
        np.testing.assert_array_equal(problem.upper, [0.06] * 4)
        self.assertEqual([problem.unit(name) for name in ("rod_width", "rod_stress", "rod_stiffness")], ["m", "Pa", "m"])

    def test_derivatives_are_those_of_differences(self):
        problem = crank()
        found = evaluated(problem, None)
        for j, h in enumerate(1e-5 * problem.start):
            step = h * np.eye(4)[j]
            above, below = problem.evaluate(problem.start + step), problem.evaluate(problem.start - step)
            # h² of the third derivative and round-off over h: some 1e-7 of a limit over a width
            allowed = 1e-5 * np.abs(found.limits) / problem.start[j] + 1e-9
            slope = (above.limits - below.limits) / (2 * h)
            self.assertTrue((np.abs(slope - found.jacobian[:, j]) <= allowed).all(), (slope, found.jacobian[:, j]))
            self.assertAlmostEqual((above.objective - below.objective) / (2 * h), found.gradient[j], delta=1e-6)

    def test_numbers_are_those_of_the_program(self):
        problem = crank()
        with tempfile.TemporaryDirectory() as folder:
            words = [word for item in QUICK.items() for word in ("--set", "=".join(item))]
            document = pleuel.run("simulate", FILE, *words, "-o", folder + "/run", "--no-report", "--no-checks")
        self.assertEqual(document.exit_code, 0)
        for name, value in problem.response_values().items():
            self.assertEqual(document["responses"][name]["value"], value)

    def test_histories_have_the_peaks_of_responses(self):
        problem = crank()
        stress = problem.histories("rod_stress", derivatives=True)
        self.assertEqual(stress.derivatives.shape, (stress.time.size, 4))
        self.assertAlmostEqual(stress.values.max() / problem.response_values()["rod_stress"], 1.0, delta=0.05)
        self.assertNotIn("crank_and_rod", problem.histories())  # a mass has none
        torque = problem.histories("torque_peak")
        above = problem.histories("torque_peak", x={"rod_width": 0.02 + 1e-7})
        below = problem.histories("torque_peak", x={"rod_width": 0.02 - 1e-7})
        slope = problem.histories("torque_peak", derivatives=True).derivatives[:, 2]
        np.testing.assert_allclose((above.values - below.values) / 2e-7, slope, atol=1e-4 * np.abs(slope).max())
        self.assertEqual(torque.time[-1], 0.02)

    def test_motion_has_the_positions_of_the_bodies(self):
        (motion,) = crank().motion()
        self.assertEqual([body["name"] for body in motion["bodies"]], ["crank", "rod", "slider"])
        self.assertEqual(len(motion["time"]), len(motion["bodies"][0]["positions"]))
        np.testing.assert_allclose(motion["bodies"][2]["positions"][0], [0.3, 0, 0], atol=1e-9)

    def test_dicts_and_files_are_the_same_problem(self):
        document = json.loads(pathlib.Path(FILE).read_text())
        document["simulation"].update(step="0.2 ms", end_time="20 ms")
        document["scene"]["joints"]["bearing"]["drive"]["ramp"] = "20 ms"
        self.assertTrue(is_same(evaluated(pleuel.load(document), None), evaluated(crank(), None)))

    def test_copies_by_pickle_have_the_same_digits(self):
        problem = crank()
        x = problem.start * [1.1, 1.0, 0.9, 1.0]
        for other in (pickle.loads(pickle.dumps(problem)), copy.deepcopy(problem)):
            self.assertTrue(is_same(evaluated(problem, x), evaluated(other, x)))

    def test_two_threads_and_two_processes_have_the_same_digits(self):
        problem = crank()
        designs = [problem.start * factor for factor in (1.0, 1.05, 0.95, 1.1)]
        alone = [evaluated(problem, x) for x in designs]
        for kind in (ThreadPoolExecutor, ProcessPoolExecutor):
            with kind(2) as pool:
                copies = [pickle.loads(pickle.dumps(problem)) for _ in designs]
                for one, other in zip(alone, pool.map(evaluated, copies, designs)):
                    self.assertTrue(is_same(one, other), kind)

    def test_what_the_notebook_shows_names_everything(self):
        text = crank()._repr_html_()
        for word in ("rod_width", "rod_strength", "2e+08"):
            self.assertIn(word, text)


class TestErrors(unittest.TestCase):
    def test_a_wrong_number_is_told_with_file_place_and_rule(self):
        with self.assertRaises(pleuel.InputError) as caught:
            crank(**{"/scene/bodies/slider/mass": -1})
        self.assertEqual((caught.exception.file, caught.exception.pointer), (FILE, "/scene/bodies/slider/mass"))
        self.assertIn("-1", caught.exception.rule)
        again = pickle.loads(pickle.dumps(caught.exception))
        self.assertEqual(again.pointer, caught.exception.pointer)

    def test_a_missing_file_is_told(self):
        with self.assertRaisesRegex(pleuel.InputError, "no_such.json"):
            pleuel.load("no_such.json")

    def test_designs_that_are_none_are_told(self):
        problem = crank()
        with self.assertRaisesRegex(pleuel.CallError, "4 variables, got the size 3"):
            problem.evaluate([0.02, 0.03, 0.02])
        with self.assertRaisesRegex(pleuel.CallError, "rod_width"):
            problem.evaluate({"rod_width": float("nan")})
        with self.assertRaises(pleuel.SimulationError):
            problem.evaluate({"rod_width": -1.0})

    def test_closed_problems_are_told(self):
        with crank() as problem:
            pass
        with self.assertRaises(pleuel.CallError):
            problem.evaluate()

    def test_arrays_of_any_kind_are_taken(self):
        problem = crank()
        wide = np.repeat(problem.start, 2)[::2]  # not contiguous
        self.assertEqual(problem.evaluate(wide).objective, problem.evaluate(wide.tolist()).objective)


class TestOptimize(unittest.TestCase):
    def test_the_callback_sees_each_evaluation(self):
        seen = []
        best = crank().optimize(callback=seen.append, checks=False)
        self.assertTrue(best.is_verified, best["message"])
        self.assertEqual(len(seen), best["evaluations"])
        self.assertEqual([one.evaluation for one in seen], list(range(1, len(seen) + 1)))
        self.assertIn("rod_width", best._repr_html_())

    def test_the_callback_ends_it(self):
        best = crank().optimize(callback=lambda progress: progress.evaluation == 4)
        self.assertEqual((best["status"], best["evaluations"]), ("interrupted", 4))

    def test_what_the_callback_raises_comes_out(self):
        def fail(progress):
            raise LookupError("of the callback")

        with self.assertRaisesRegex(LookupError, "of the callback"):
            crank().optimize(callback=fail)

    def test_unknown_options_are_told(self):
        with self.assertRaisesRegex(pleuel.InputError, "did you mean \"backend\""):
            crank().optimize(backends="ipopt")

    def test_studies_return_the_documents_of_the_commands(self):
        document = crank(**{"/uncertainty/samples": 2}).uncertainty()
        self.assertIn("responses", document)


class TestInterrupts(unittest.TestCase):
    def test_control_c_ends_a_long_evaluation(self):
        problem = crank(**{"/simulation/step": "0.1 us"})  # minutes
        timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
        begin = time.monotonic()
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            problem.evaluate()
        self.assertLess(time.monotonic() - begin, 20.0)
        self.assertGreater(crank().evaluate().objective, 0.0)  # the next call is not affected

    def test_control_c_leaves_the_best_design_of_an_optimization(self):
        problem = crank(**{"/simulation/step": "0.5 us"})
        timer = threading.Timer(3.0, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt) as caught:
            problem.optimize()
        if isinstance(caught.exception, pleuel.Interrupted):  # else not even the start was simulated
            self.assertEqual(caught.exception.optimum.x.size, 4)


class TestProgram(unittest.TestCase):
    def test_the_package_has_the_version_of_the_library(self):
        version = re.search(r'^version = "(.+)"$', (ROOT / "python/pyproject.toml").read_text(), re.MULTILINE)
        self.assertEqual(pleuel.version().split()[1], version[1])

    def test_the_module_is_the_program(self):
        ran = subprocess.run(
            [sys.executable, "-m", "pleuel", "--version"], capture_output=True, text=True, check=True,
            env={**os.environ, "PYTHONPATH": str(ROOT / "python")},
        )
        self.assertEqual(ran.stdout.strip(), pleuel.version())


if __name__ == "__main__":
    unittest.main()
