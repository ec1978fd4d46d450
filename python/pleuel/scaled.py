"""Problems as optimizers want them: numbers of order one, limits on one side."""

from __future__ import annotations

import numpy as np

from .problem import Problem
from .results import Array, Evaluation


def variable_magnitudes(problem: Problem) -> Array:
    """Of starts or, where these are 0, of bounds; 1 at last [SI]."""
    return _first_positive(np.abs(problem.start), _largest_bounds(problem.lower, problem.upper))


def limit_magnitudes(problem: Problem, values: Array) -> Array:
    """Of bounds or, where these are 0, of values; 1 at last [SI]."""
    return _first_positive(_largest_bounds(problem.limit_lower, problem.limit_upper), np.abs(values))


def _largest_bounds(lower: Array, upper: Array) -> Array:
    bounds = np.abs(np.stack([lower, upper]))
    return np.where(np.isfinite(bounds), bounds, 0.0).max(axis=0)


def _first_positive(sizes: Array, others: Array) -> Array:
    found = np.where(sizes > 0.0, sizes, others)
    return np.where(found > 0.0, found, 1.0)


class Functions:
    """minimize objective(y)   subject to   violations(y) <= 0,   lower <= y <= upper

    The last design is kept, so that functions and derivatives of one design cost one evaluation.
    """

    start: Array
    lower: Array
    upper: Array

    def __init__(self) -> None:
        self._last: tuple[bytes, Evaluation] = (b"", Evaluation(0.0, np.empty(0)))

    def objective(self, y: Array) -> float:
        return self._at(y).objective

    def gradient(self, y: Array) -> Array:
        return self._at(y).gradient

    def violations(self, y: Array) -> Array:
        """One for each finite side of a limit; 0 or less: it is kept."""
        return self._at(y).limits

    def jacobian(self, y: Array) -> Array:
        """violations × variables"""
        return self._at(y).jacobian

    def _at(self, y: Array) -> Evaluation:
        y = np.ascontiguousarray(y, dtype=np.float64)
        if self._last[0] != y.tobytes():
            self._last = (y.tobytes(), self._evaluated(y))
        return self._last[1]

    def _evaluated(self, y: Array) -> Evaluation:
        """With derivatives."""
        raise NotImplementedError


class Scaled(Functions):
    """A problem for optimizers of other packages, with y between 0 and 1.

    y is the design between its bounds, x = lower + y (upper - lower), which must be finite. The objective is divided
    by its magnitude at the start, each limit by its limit_magnitudes().
    """

    def __init__(self, problem: Problem) -> None:
        super().__init__()
        self.problem = problem
        self.span = problem.upper - problem.lower
        self.start = (problem.start - problem.lower) / self.span
        self.lower, self.upper = np.zeros(self.span.size), np.ones(self.span.size)
        first = problem.evaluate()
        self._unit = abs(first.objective) or 1.0
        sides = [(1.0, problem.limit_upper), (-1.0, problem.limit_lower)]
        rows = [(sign, i, limits[i]) for sign, limits in sides for i in np.flatnonzero(np.isfinite(limits))]
        self._indices = np.array([i for _, i, _ in rows], dtype=int)
        self._signs = np.array([sign for sign, _, _ in rows]) / limit_magnitudes(problem, first.limits)[self._indices]
        self._bounds = np.array([limit for _, _, limit in rows])

    def design(self, y: Array) -> Array:
        """x [SI]"""
        return self.problem.lower + np.asarray(y, dtype=float) * self.span

    def _evaluated(self, y: Array) -> Evaluation:
        found = self.problem.evaluate(self.design(y), derivatives=True)
        return Evaluation(
            found.objective / self._unit,
            self._signs * (found.limits[self._indices] - self._bounds),
            found.gradient * self.span / self._unit,
            self._signs[:, None] * found.jacobian[self._indices] * self.span,
        )
