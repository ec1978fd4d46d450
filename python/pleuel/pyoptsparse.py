"""A problem for the optimizers of pyOptSparse; needs the package pyoptsparse."""

from __future__ import annotations

from typing import Any, Callable, Optional

import numpy as np
import pyoptsparse

from .errors import SimulationError
from .problem import Problem
from .results import Array
from .scaled import limit_magnitudes, variable_magnitudes


def _bounds(numbers: Array) -> list[Optional[float]]:
    """Its optimizers compute with infinities, to NaN."""
    return [float(one) if np.isfinite(one) else None for one in numbers]


def optimization(problem: Problem) -> tuple[pyoptsparse.Optimization, Callable[..., Any]]:
    """The problem, and the function of its derivatives: SLSQP()(optimization, sens=derivatives).

    Variables: "x" [SI]. Objective: "objective". Constraints: "limits" [SI]; all scaled by their magnitudes. A design
    that cannot be simulated is told as failed.
    """

    def values(design):
        try:
            found = problem.evaluate(design["x"])
        except SimulationError:
            return {}, True
        return {"objective": found.objective, "limits": found.limits}, False

    def derivatives(design, _):
        try:
            found = problem.evaluate(design["x"], derivatives=True)
        except SimulationError:
            return {}, True
        return {"objective": {"x": found.gradient}, "limits": {"x": found.jacobian}}, False

    first = problem.evaluate()
    described = pyoptsparse.Optimization(problem.file, values)
    described.addVarGroup(
        "x", problem.start.size, "c", value=problem.start, lower=_bounds(problem.lower), upper=_bounds(problem.upper),
        scale=1.0 / variable_magnitudes(problem),
    )
    described.addObj("objective", scale=1.0 / (abs(first.objective) or 1.0))
    if problem.limits:
        described.addConGroup(
            "limits", len(problem.limits), lower=_bounds(problem.limit_lower), upper=_bounds(problem.limit_upper),
            scale=1.0 / limit_magnitudes(problem, first.limits),
        )
    return described, derivatives
