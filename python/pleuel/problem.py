"""A problem that is open: evaluated, differentiated and optimized from Python."""

from __future__ import annotations

import ctypes as c
import html
import json
import os
import pathlib
import tempfile
from typing import Any, Callable, Mapping, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _border as border
from .errors import CallError, Interrupted
from .results import Array, Document, Evaluation, History, Optimum, Progress, shown, table

Design = Union[npt.ArrayLike, Mapping[str, float]]
BodyFunction = Callable[[Array], Union[str, Mapping[str, Any]]]


def _override(name: str, value: Any) -> str:
    return f"{name}={value if isinstance(value, str) else json.dumps(value)}"


def _place(name: str, names: list[str], kind: str) -> int:
    if name not in names:
        raise KeyError(f"{name!r} is no {kind}; there are {', '.join(names)}")
    return names.index(name)


def _pointer(array: Optional[Array]) -> Optional[int]:
    return None if array is None else array.ctypes.data


class Problem:
    """Made by load(). All numbers are in SI units, derivatives in the unit of the value over that of the variable.

    Threads may share a problem: its evaluations wait for each other. Problems of their own, or copies by pickle
    or copy.deepcopy(), are evaluated at the same time.
    """

    def __init__(self, file: str, text: Optional[str], overrides: list[str], case: Optional[str]) -> None:
        self._source = (file, text, overrides, case)
        self._number = 0
        number = c.c_uint64()
        border.call(
            "pleuel_open", os.fsencode(file), text and text.encode(), border.c_texts(overrides), len(overrides),
            case and case.encode(), c.byref(number),
        )
        self._number = number.value
        self.file: str = file  #: how messages name it
        self.variables: list[str] = self._names(border.VARIABLES)
        self.responses: list[str] = self._names(border.RESPONSES)  #: of all load cases
        self.limits: list[str] = self._names(border.LIMITS)
        self.cases: list[str] = self._names(border.CASES)
        self.bodies: list[str] = self._names(border.BODIES)
        self.joints: list[str] = self._names(border.JOINTS)
        self.objective: Optional[str] = next(iter(self._names(border.OBJECTIVE)), None)  #: its response
        self.start, self.lower, self.upper = (np.empty(len(self.variables)) for _ in range(3))
        border.call("pleuel_bounds", self._number, *map(_pointer, (self.start, self.lower, self.upper)), len(self.variables))
        self.limit_lower, self.limit_upper = (np.empty(len(self.limits)) for _ in range(2))
        border.call("pleuel_limits", self._number, *map(_pointer, (self.limit_lower, self.limit_upper)), len(self.limits))

    # ---- one design ----

    def evaluate(self, x: Optional[Design] = None, derivatives: bool = False) -> Evaluation:
        """Objective and limits of a design, with their derivatives if they are asked for.

        x: one number a variable, or {name: number}, where others are those of the start; None: the start
        """
        x = self.design(x)
        objective, values = np.empty(1), np.empty(len(self.limits))
        gradient = np.empty(x.size) if derivatives else None
        jacobian = np.empty((values.size, x.size)) if derivatives else None
        border.call(
            "pleuel_evaluate", self._number, _pointer(x), x.size, _pointer(objective), _pointer(values),
            values.size, _pointer(gradient), _pointer(jacobian),
        )
        return Evaluation(float(objective[0]), values, gradient, jacobian)

    def jacobian(self, x: Optional[Design] = None) -> Array:
        """Derivatives of all responses, responses × variables."""
        return self._respond(x, True)[1]

    def response_values(self, x: Optional[Design] = None) -> dict[str, float]:
        """Values of all responses by their names."""
        return dict(zip(self.responses, self._respond(x, False)[0].tolist()))

    def histories(self, *names: str, x: Optional[Design] = None, derivatives: bool = False) -> Union[History, dict[str, History]]:
        """How responses go over time: of one name its History, else {name: History}; of no name all that have one.

        The curve of a response of many places is the largest of them at each instant; with derivatives, it is that of the
        place of the peak.
        """
        x = self.design(x)
        found = {name: self._history(_place(name, self.responses, "response"), x, derivatives) for name in names or self.responses}
        if len(names) == 1:
            return found[names[0]]
        return {name: history for name, history in found.items() if names or history.time.size > 0}

    def motion(self, x: Optional[Design] = None) -> list[dict[str, Any]]:
        """How all bodies move, one entry a load case (pleuel_motion in include/pleuel.h)."""
        x = self.design(x)
        document = c.c_void_p()
        border.call("pleuel_motion", self._number, _pointer(x), x.size, c.byref(document))
        return border.taken(document)

    def by_invariants(self, body: str, x: Optional[Design] = None) -> dict[str, dict[str, Any]]:
        """Derivatives of all responses by each number of a body of the type "invariants": {response: {"invariants",
        "places", …}}, arranged as the derivatives of a file of invariants, by which a finite-element program has those by
        its own variables (docs/invariants.md)."""
        x = self.design(x)
        document = c.c_void_p()
        border.call("pleuel_by_invariants", self._number, _pointer(x), x.size, body.encode(), c.byref(document))
        return border.taken(document)["responses"]

    def unit(self, name: str) -> str:
        """The SI unit of a variable, a response or a limit; empty for plain numbers."""
        for kind, names in ((border.VARIABLES, self.variables), (border.RESPONSES, self.responses), (border.LIMITS, self.limits)):
            if name in names:
                return self._text("pleuel_unit", kind, names.index(name))
        raise KeyError(f"{name!r} is no variable, response or limit; there are {', '.join(self.variables + self.responses + self.limits)}")

    # ---- searches and studies ----

    def optimize(
        self, x: Optional[Design] = None, *, callback: Optional[Callable[[Progress], Optional[bool]]] = None, **options: Any
    ) -> Optimum:
        """Finds the optimum, and proves or doubts it, as `pleuel optimize` does.

        x:        where the search begins
        callback: hears of each evaluation; True ends the search with the best design so far
        options:  backend, tolerance, max_iterations, starts, jobs, checks (pleuel_optimize in include/pleuel.h)

        Ctrl-C raises Interrupted, whose `optimum` has the best design so far.
        """
        x = self.design(x)
        document, listener = c.c_void_p(), _Listener(callback)
        try:
            border.call(
                "pleuel_optimize", self._number, _pointer(x), x.size, json.dumps(options).encode(),
                listener.observer, None, c.byref(document),
            )
        finally:
            if listener.failure is not None:
                if document:
                    border.library.pleuel_free(document)
                raise listener.failure
        optimum = Optimum(border.taken(document))
        if optimum["status"] == "interrupted" and not listener.has_ended and border.was_interrupted():
            raise Interrupted(optimum)
        return optimum

    def pareto(self, *words: str) -> Document:
        """The front between two goals: the document of `pleuel pareto`, whose options the words are."""
        return self._study("pareto", words)

    def accuracy(self, *words: str) -> Document:
        """What accuracy costs: the document of `pleuel accuracy`."""
        return self._study("accuracy", words)

    def uncertainty(self, *words: str) -> Document:
        """What scatter does: the document of `pleuel uncertainty`."""
        return self._study("uncertainty", words)

    # ---- the object ----

    def design(self, x: Optional[Design]) -> Array:
        """A design as an array: without a copy where it is a contiguous array of float64."""
        if x is None:
            return self.start.copy()
        if isinstance(x, Mapping):
            values = self.start.copy()
            for name, value in x.items():
                if isinstance(value, str):
                    raise CallError(f"{name!r}: a design has numbers in SI units, got {value!r}")
                values[_place(name, self.variables, "variable")] = value
            return values
        return np.ascontiguousarray(x, dtype=np.float64).reshape(-1)

    def close(self) -> None:
        """Gives its memory back; calls afterwards raise CallError."""
        number, self._number = self._number, 0
        if number:
            border.checked(border.library.pleuel_close(number))

    def __enter__(self) -> Problem:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def __del__(self) -> None:
        if getattr(self, "_number", 0):
            border.library.pleuel_close(self._number)

    def __reduce__(self):
        return Problem, self._source

    def __deepcopy__(self, memo: dict) -> Problem:
        return Problem(*self._source)

    def __repr__(self) -> str:
        return f"<pleuel.Problem {self.file}: {self.objective} by {len(self.variables)} variables under {len(self.limits)} limits>"

    def _repr_html_(self) -> str:
        variables = zip(self.variables, *([shown(float(v)) for v in a] for a in (self.start, self.lower, self.upper)), map(self.unit, self.variables))
        limits = zip(self.limits, *([shown(float(v)) for v in a] for a in (self.limit_lower, self.limit_upper)), map(self.unit, self.limits))
        return (
            f"<p><b>{html.escape(self.file)}</b>: {html.escape(str(self.objective))}</p>"
            + table(("variable", "start", "lower", "upper", "unit"), variables)
            + table(("limit", "lower", "upper", "unit"), limits)
        )

    def _names(self, kind: int) -> list[str]:
        count = c.c_size_t()
        border.call("pleuel_count", self._number, kind, c.byref(count))
        return [self._text("pleuel_name", kind, i) for i in range(count.value)]

    def _text(self, function: str, kind: int, index: int) -> str:
        text = c.c_char_p()
        border.call(function, self._number, kind, index, c.byref(text))
        return text.value.decode()

    def _respond(self, x: Optional[Design], derivatives: bool) -> tuple[Array, Optional[Array]]:
        x = self.design(x)
        values = np.empty(len(self.responses))
        jacobian = np.empty((values.size, x.size)) if derivatives else None
        border.call("pleuel_responses", self._number, _pointer(x), x.size, _pointer(values), values.size, _pointer(jacobian))
        return values, jacobian

    def _history(self, response: int, x: Array, derivatives: bool) -> History:
        size = c.c_size_t()
        border.call("pleuel_history_size", self._number, _pointer(x), x.size, response, c.byref(size))
        time, values = np.empty(size.value), np.empty(size.value)
        by_x = np.empty((size.value, x.size)) if derivatives else None
        border.call(
            "pleuel_history", self._number, _pointer(x), x.size, response, _pointer(time), _pointer(values),
            size.value, _pointer(by_x),
        )
        return History(time, values, by_x)

    def _study(self, command: str, words: tuple[str, ...]) -> Document:
        file, text, overrides, case = self._source
        with tempfile.TemporaryDirectory() as folder:
            if not os.path.isfile(file):
                file = str(pathlib.Path(folder) / pathlib.Path(file).name)
                pathlib.Path(file).write_text(text or "", encoding="utf-8")
            sets = [word for override in overrides for word in ("--set", override)]
            cases = ["--case", case] if case else []
            return run(command, file, *sets, *cases, "-o", str(pathlib.Path(folder) / "run"), "--no-report", *words)


#: Functions that the library knows: they stay as long as it may call them.
_body_makers: list[Any] = []


def register_body(body: str, function: BodyFunction) -> None:
    """Has the body of this name made by a function, in problems that are opened from now on: load(bodies=…)."""
    kept = [b""]  # the text of the last call

    def make(values: Any, variables: int, text: Any, _: Any) -> int:
        try:
            made = function(np.ctypeslib.as_array(values, (variables,)).copy())
            kept[0] = (made if isinstance(made, str) else json.dumps(made, default=_plain)).encode()
        except BaseException as failure:  # the design fails
            kept[0] = f"{type(failure).__name__}: {failure}".encode()
            return 1
        finally:
            text[0] = kept[0]
        return 0

    maker = border.BODY_MAKER(make)
    _body_makers.append(maker)
    border.call("pleuel_register_body", body.encode(), maker, None)


def _plain(value: Any) -> Any:
    """Arrays and numbers of NumPy as JSON has them."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} is nothing that a file of invariants has")


class _Listener:
    """A callback as the library calls it: its exceptions wait here until the search has ended."""

    def __init__(self, callback: Optional[Callable[[Progress], Optional[bool]]]) -> None:
        self.callback, self.failure, self.has_ended = callback, None, False
        self.observer = border.OBSERVER(self._hear) if callback else border.OBSERVER()

    def _hear(self, progress: Any, _: Any) -> int:
        try:
            self.has_ended = bool(self.callback(_progress(progress.contents)))
        except BaseException as failure:  # also KeyboardInterrupt
            self.failure = failure
        return int(self.has_ended or self.failure is not None)


def _progress(seen: border.Progress) -> Progress:
    x = np.ctypeslib.as_array(seen.x, (seen.variables,)).copy()
    limits = np.ctypeslib.as_array(seen.values, (seen.limits,)).copy() if seen.limits else np.empty(0)
    return Progress(seen.evaluation, seen.iteration, x, seen.objective, limits, seen.max_violation, seen.failure.decode())


def load(
    problem: Union[str, os.PathLike, Mapping[str, Any]],
    *,
    set: Optional[Mapping[str, Any]] = None,  # noqa: A002  the word of the command
    case: Optional[str] = None,
    folder: Union[str, os.PathLike] = ".",
    bodies: Optional[Mapping[str, BodyFunction]] = None,
    allow_programs: bool = False,
) -> Problem:
    """Reads and checks a problem.

    problem: the name of a file, or a problem as a dict
    set:     {"/json/pointer" or variable: value}, as --set of the command: {"/simulation/step": "0.1 ms"}
    case:    the only load case that is meant; None: all
    folder:  where files are looked for that a dict names
    bodies:  {body: function} in place of the programs of their generators: the function takes the values of the
             generator's variables as an array, in their order, and returns a file of invariants, as a dict or a text
             (docs/invariants.md). What it raises fails the design. It stays for later problems, too.
    allow_programs: whether programs that the problem names may run
    """
    for body, function in (bodies or {}).items():
        register_body(body, function)
    border.call("pleuel_allow_programs", int(allow_programs))
    overrides = [_override(name, value) for name, value in (set or {}).items()]
    if isinstance(problem, Mapping):
        return Problem(str(pathlib.Path(folder) / "problem.json"), json.dumps(problem), overrides, case)
    file = os.fspath(problem)
    try:
        text = pathlib.Path(file).read_text(encoding="utf-8")  # what is pickled is what was read
    except (OSError, UnicodeDecodeError):
        text = None  # the library says why
    return Problem(file, text, overrides, case)


def run(*words: str) -> Document:
    """Runs a command of the program: run("simulate", "slider_crank.json", "-o", "out").

    Returns the document that it prints with --json. Lines of progress go to standard error.
    """
    code, document = c.c_int(), c.c_void_p()
    border.call("pleuel_run", border.c_texts(words), len(words), c.byref(code), c.byref(document))
    answer = Document(border.taken(document) or {})
    answer.exit_code = code.value
    return answer
