"""Pleuel: gradient-based design optimization of flexible mechanisms.

    import pleuel
    p = pleuel.load("slider_crank.json", set={"/simulation/step": "0.2 ms"})
    e = p.evaluate(derivatives=True)       # objective, limits and their derivatives at the start
    best = p.optimize()

All numbers are in SI units. docs/from-python.md says more.
"""

from ._border import library as _library
from ._border import stop
from .backends import Search, register_backend
from .errors import CallError, Error, Fault, InputError, Interrupted, SimulationError, Stopped
from .problem import Problem, load, run
from .results import Document, Evaluation, History, Optimum, Progress

__all__ = [
    "CallError", "Document", "Error", "Evaluation", "Fault", "History", "InputError", "Interrupted", "Optimum",
    "Problem", "Progress", "Search", "SimulationError", "Stopped", "load", "register_backend", "run", "stop", "version",
]


def version() -> str:
    """Of the library: version, commit, compiler and flags."""
    return _library.pleuel_version().decode()
