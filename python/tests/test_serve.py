"""A problem served to UM-Bridge: the answers are those of the problem, and whatever is asked, it goes on."""

import http.client
import json
import os
import pathlib
import socket
import subprocess
import sys
import unittest

import numpy as np
from sample import FILE, QUICK, ROOT, crank


class Served:
    """A server of the problem of the tests, in a process of its own."""

    def __init__(self, *more):
        words = [word for item in QUICK.items() for word in ("--set", "=".join(item))]
        self.process = subprocess.Popen(
            [sys.executable, "-m", "pleuel.serve", FILE, *words, "--port", "0", *more], stdout=subprocess.PIPE, text=True,
            env={**os.environ, "PYTHONPATH": str(ROOT / "python")},
        )
        self.port = int(self.process.stdout.readline().split(";")[0].rsplit(":", 1)[1])

    def ask(self, path, body=None, headers=None, method="POST"):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        text = body if isinstance(body, bytes) else json.dumps(body).encode()
        connection.request(method, path, text if method == "POST" else None, headers or {})
        reply = connection.getresponse()
        answer = json.loads(reply.read())
        connection.close()
        return reply.status, answer

    def end(self):
        self.process.terminate()
        self.process.wait()
        self.process.stdout.close()


class TestServe(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.served, cls.problem = Served("--time-limit", "20", "--size-limit", "1000"), crank()
        cls.x = (cls.problem.start * [1.0, 1.1, 0.9, 1.0]).tolist()

    @classmethod
    def tearDownClass(cls):
        cls.served.end()

    def asked(self, path, **more):
        return self.served.ask(path, {"name": "pleuel", "config": {}, **more})

    def test_it_says_what_it_is(self):
        self.assertEqual(self.served.ask("/Info", method="GET")[1], {"protocolVersion": 1.0, "models": ["pleuel"]})
        self.assertEqual(self.asked("/InputSizes")[1], {"inputSizes": [4]})
        self.assertEqual(self.asked("/OutputSizes")[1], {"outputSizes": [8]})
        self.assertTrue(self.asked("/ModelInfo")[1]["support"]["Gradient"])

    def test_its_numbers_are_those_of_the_problem(self):
        jacobian, sens, vec = self.problem.jacobian(self.x), np.arange(8.0), np.arange(4.0)
        where = {"input": [self.x], "outWrt": 0, "inWrt": 0}
        self.assertEqual(self.asked("/Evaluate", input=[self.x])[1], {"output": [list(self.problem.response_values(self.x).values())]})
        np.testing.assert_array_equal(self.asked("/Gradient", **where, sens=sens.tolist())[1]["output"], sens @ jacobian)
        np.testing.assert_array_equal(self.asked("/ApplyJacobian", **where, vec=vec.tolist())[1]["output"], jacobian @ vec)

    def test_what_is_wrong_is_told(self):
        good = {"name": "pleuel", "input": [self.x]}
        for code, word, path, body in [
            (400, "no JSON", "/Evaluate", b"{"),
            (400, "no JSON", "/Evaluate", b"[" * 999),
            (400, "name", "/Evaluate", {**good, "name": "other"}),
            (400, "name", "/Evaluate", []),
            (400, "4 numbers", "/Evaluate", {**good, "input": [[1.0]]}),
            (400, "4 numbers", "/Evaluate", {**good, "input": [["a"] * 4]}),
            (400, "4 numbers", "/Evaluate", {**good, "input": [None]}),
            (400, "one list", "/Evaluate", {**good, "input": self.x}),
            (400, "finite", "/Evaluate", {**good, "input": [[float("nan")] * 4]}),
            (400, "config", "/Evaluate", {**good, "config": {"step": 1}}),
            (400, "outWrt", "/Gradient", {**good, "outWrt": 1, "inWrt": 0, "sens": [0.0] * 8}),
            (400, "8 numbers", "/Gradient", {**good, "outWrt": 0, "inWrt": 0, "sens": [0.0]}),
            (404, "/Evaluate", "/ApplyHessian", good),
            (413, "1000 bytes", "/Evaluate", b" " * 1001),
            (500, "SimulationError", "/Evaluate", {**good, "input": [[0.02, 0.03, -1.0, 0.03]]}),
        ]:
            status, answer = self.served.ask(path, body)
            self.assertEqual(status, code, answer)
            self.assertIn(word, answer["error"]["message"] + answer["error"]["type"])
        self.assertEqual(self.served.ask("/else", method="GET")[0], 404)
        self.assertEqual(self.served.ask("/Info", method="GET", headers={"Host": "else.where"})[0], 403)

    def test_other_bytes_do_not_end_it(self):
        for text in (b"\r\n\r\n", b"\x00" * 100, b"POST /Evaluate HTTP/1.1\r\nContent-Length: -1\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n"):
            with socket.create_connection(("127.0.0.1", self.served.port)) as one:
                one.sendall(text)
        self.assertEqual(self.served.ask("/Info", method="GET")[0], 200)

    def test_what_takes_too_long_is_stopped(self):
        slow = Served("--time-limit", "0.5", "--set", "/simulation/step=0.1 us")  # minutes
        try:
            status, answer = slow.ask("/Evaluate", {"name": "pleuel", "input": [self.x]})
            self.assertEqual((status, answer["error"]["type"]), (503, "TimeLimit"))
            self.assertEqual(slow.ask("/Info", method="GET")[0], 200)
        finally:
            slow.end()

    def test_a_file_that_is_none_is_told(self):
        ran = subprocess.run(
            [sys.executable, "-m", "pleuel.serve", "no_such.json"], capture_output=True, text=True,
            env={**os.environ, "PYTHONPATH": str(pathlib.Path(ROOT) / "python")},
        )
        self.assertEqual(ran.returncode, 2)
        self.assertIn("no_such.json", ran.stderr)


if __name__ == "__main__":
    unittest.main()
