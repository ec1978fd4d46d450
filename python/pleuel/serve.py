"""A problem as a model of UM-Bridge (https://um-bridge-benchmarks.readthedocs.io): values and derivatives of its responses by HTTP, for
MUQ, PyMC, R and others that speak it.

    python3 -m pleuel.serve crank.json --set "/simulation/step=0.1 ms"

The model "pleuel" has one input, the design [SI], and one output, all responses [SI]. One request is answered at a time.
"""

from __future__ import annotations

import argparse
import http.server
import ipaddress
import json
import sys
import threading
import time
from typing import Any, Callable, Optional

import numpy as np

from ._border import stop
from .errors import Error, SimulationError, Stopped
from .problem import Problem, load

MODEL = "pleuel"


class Refusal(Exception):
    """What is told to a client in place of an answer."""

    def __init__(self, code: int, kind: str, message: str) -> None:
        super().__init__(message)
        self.code, self.kind = code, kind


class Model:
    """The answers, by the names that UM-Bridge has for the questions."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.questions: dict[str, Callable[[dict[str, Any]], dict[str, Any]]] = {
            "/InputSizes": lambda _: {"inputSizes": [len(problem.variables)]},
            "/OutputSizes": lambda _: {"outputSizes": [len(problem.responses)]},
            "/ModelInfo": lambda _: {"support": {"Evaluate": True, "Gradient": True, "ApplyJacobian": True, "ApplyHessian": False}},
            "/Evaluate": lambda asked: {"output": [list(problem.response_values(self._design(asked)).values())]},
            "/Gradient": lambda asked: {"output": (self._vector(asked, "sens", problem.responses) @ self._jacobian(asked)).tolist()},
            "/ApplyJacobian": lambda asked: {"output": (self._jacobian(asked) @ self._vector(asked, "vec", problem.variables)).tolist()},
        }

    def answer(self, path: str, asked: Any) -> dict[str, Any]:
        if path not in self.questions:
            raise Refusal(404, "UnsupportedFeature", f"{path} is not one of {', '.join(self.questions)}")
        if not isinstance(asked, dict) or asked.get("name") != MODEL:
            raise Refusal(400, "ModelNotFound", f'"name" must be "{MODEL}"')
        if asked.get("config"):
            raise Refusal(400, "InvalidInput", '"config" must be empty: the problem is set by --set when it is served')
        return self.questions[path](asked)

    def _design(self, asked: dict[str, Any]) -> np.ndarray:
        given = asked.get("input")
        if not isinstance(given, list) or len(given) != 1:
            raise Refusal(400, "InvalidInput", '"input" must be a list of one list, the design')
        return self._vector({"input": given[0]}, "input", self.problem.variables)

    def _jacobian(self, asked: dict[str, Any]) -> np.ndarray:
        if (asked.get("outWrt"), asked.get("inWrt")) != (0, 0):
            raise Refusal(400, "InvalidInput", '"outWrt" and "inWrt" must be 0: there is one output and one input')
        return self.problem.jacobian(self._design(asked))

    @staticmethod
    def _vector(asked: dict[str, Any], key: str, names: list[str]) -> np.ndarray:
        given = asked.get(key)
        is_number = [isinstance(one, (int, float)) and not isinstance(one, bool) for one in given or []] if isinstance(given, list) else []
        if len(is_number) != len(names) or not all(is_number):
            raise Refusal(400, "InvalidInput", f'"{key}" must be {len(names)} numbers, of {", ".join(names)}')
        vector = np.array(given, dtype=np.float64)
        if not np.isfinite(vector).all():
            raise Refusal(400, "InvalidInput", f'"{key}" must be finite')
        return vector


class Handler(http.server.BaseHTTPRequestHandler):
    """One request, within the limits of the server."""

    server: Server
    timeout = 10.0  # [s] of a connection that says nothing

    def do_GET(self) -> None:  # noqa: N802  the name that the standard library has
        self._reply(lambda: self._information())

    def do_POST(self) -> None:  # noqa: N802
        self._reply(lambda: self.server.model.answer(self.path, self._question()))

    def log_message(self, *_: Any) -> None:
        pass

    def _information(self) -> dict[str, Any]:
        if self.path != "/Info":
            raise Refusal(404, "UnsupportedFeature", f"{self.path} is not /Info")
        return {"protocolVersion": 1.0, "models": [MODEL]}

    def _question(self) -> Any:
        try:
            size = int(self.headers.get("Content-Length", ""))
        except ValueError:
            raise Refusal(411, "InvalidInput", "Content-Length is missing") from None
        most = self.server.size_limit
        text = self._read(min(size, 2 * most))  # a client that is cut off while it sends hears no refusal
        if not 0 <= size <= most:
            raise Refusal(413, "InvalidInput", f"a question may have {most} bytes, this one has {size}")
        try:
            return json.loads(text)
        except (ValueError, RecursionError):
            raise Refusal(400, "InvalidInput", "the question is no JSON") from None

    def _read(self, size: int) -> bytes:
        end, text = time.monotonic() + self.timeout, b""
        while len(text) < size:
            part = self.rfile.read1(size - len(text))
            if not part or time.monotonic() > end:
                raise Refusal(408, "InvalidInput", f"{len(text)} of {size} bytes have come")
            text += part
        return text

    def _reply(self, work: Callable[[], dict[str, Any]]) -> None:
        try:
            self._require_host()
            code, answer = 200, self.server.limited(work)
        except Refusal as refusal:
            code, answer = refusal.code, {"error": {"type": refusal.kind, "message": str(refusal)}}
        except Error as error:
            code = 500 if isinstance(error, SimulationError) else 400
            answer = {"error": {"type": type(error).__name__, "message": str(error)}}
        self.close_connection = True
        text = json.dumps(answer).encode()
        self.send_response(code)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(text)))
        self.end_headers()
        self.wfile.write(text)

    def _require_host(self) -> None:
        """A page in a browser that made its own name one of this machine is not who is served."""
        host = self.headers.get("Host", "").rsplit(":", 1)[0]
        if self.server.is_local and host not in ("localhost", "127.0.0.1", "[::1]"):
            raise Refusal(403, "InvalidInput", f"this server is for this machine, not for {host!r}")


class Server(http.server.HTTPServer):
    def __init__(self, problem: Problem, host: str, port: int, time_limit: float, size_limit: int) -> None:
        self.model, self.time_limit, self.size_limit = Model(problem), time_limit, size_limit
        self.is_local = ipaddress.ip_address(host).is_loopback
        super().__init__((host, port), Handler)

    def handle_error(self, *of_request: Any) -> None:
        if not isinstance(sys.exc_info()[1], OSError):  # else the client has gone
            super().handle_error(*of_request)

    def limited(self, work: Callable[[], dict[str, Any]]) -> dict[str, Any]:
        """What takes longer is stopped."""
        timer = threading.Timer(self.time_limit, stop)
        timer.start()
        try:
            return work()
        except Stopped:
            raise Refusal(503, "TimeLimit", f"the simulation took longer than {self.time_limit:g} s") from None
        finally:
            timer.cancel()


def main(words: Optional[list[str]] = None) -> None:
    parser = argparse.ArgumentParser(prog="python3 -m pleuel.serve", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("problem", help="a problem file")
    parser.add_argument("--set", action="append", default=[], metavar="PLACE=VALUE", help="as of the command pleuel")
    parser.add_argument("--case", help="one of several load cases")
    parser.add_argument("--host", default="127.0.0.1", help="an address; another one than this machine's own lets others ask (%(default)s)")
    parser.add_argument("--port", type=int, default=4242, help="0: any (%(default)s)")
    parser.add_argument("--time-limit", type=float, default=600.0, metavar="SECONDS", help="of one answer (%(default)s)")
    parser.add_argument("--size-limit", type=int, default=1_000_000, metavar="BYTES", help="of one question (%(default)s)")
    options = parser.parse_args(words)
    try:
        problem = load(options.problem, set=dict(one.split("=", 1) for one in options.set), case=options.case)
        server = Server(problem, options.host, options.port, options.time_limit, options.size_limit)
    except (Error, OSError, ValueError) as error:
        parser.exit(2, f"{error}\n")
    print(f'the model "{MODEL}" at http://{options.host}:{server.server_port}; Ctrl-C ends it', flush=True)
    try:
        server.serve_forever()
    except KeyboardInterrupt:
        pass


if __name__ == "__main__":
    main()
