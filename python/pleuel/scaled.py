"""A problem as optimizers of other packages want it: numbers of order one, limits on one side."""

from __future__ import annotations

import numpy as np

from .problem import Problem
from .results import Array, Evaluation


class Scaled:
    """minimize objective(y)   subject to   violations(y) <= 0,   0 <= y <= 1

    y is the design between its bounds, x = lower + y (upper - lower), which must be finite. The objective is divided
    by its magnitude at the start, each limit by its own or, if that is 0, by the value at the start. The
    last design is kept, so that functions and derivatives of one design cost one evaluation.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.span = problem.upper - problem.lower
        self.start: Array = (problem.start - problem.lower) / self.span
        first = problem.evaluate()
        self._unit = abs(first.objective) or 1.0
        sides = [(1.0, problem.limit_upper), (-1.0, problem.limit_lower)]
        self._rows = [(sign, i, limits[i]) for sign, limits in sides for i in np.flatnonzero(np.isfinite(limits))]
        self._magnitudes = np.array([abs(limit) or abs(first.limits[i]) or 1.0 for _, i, limit in self._rows])
        self._signs = np.array([sign for sign, _, _ in self._rows]) / self._magnitudes
        self._indices = np.array([i for _, i, _ in self._rows], dtype=int)
        self._bounds = np.array([limit for _, _, limit in self._rows])
        self._last: tuple[bytes, Evaluation] = (b"", first)

    def design(self, y: Array) -> Array:
        """x [SI]"""
        return self.problem.lower + np.asarray(y, dtype=float) * self.span

    def objective(self, y: Array) -> float:
        return self._at(y).objective / self._unit

    def gradient(self, y: Array) -> Array:
        return self._at(y).gradient * self.span / self._unit

    def violations(self, y: Array) -> Array:
        """One for each finite side of a limit; 0 or less: it is kept."""
        return self._signs * (self._at(y).limits[self._indices] - self._bounds)

    def jacobian(self, y: Array) -> Array:
        """violations × variables"""
        return self._signs[:, None] * self._at(y).jacobian[self._indices] * self.span

    def _at(self, y: Array) -> Evaluation:
        x = self.design(y)
        key, evaluation = self._last
        if key != x.tobytes():
            evaluation = self.problem.evaluate(x, derivatives=True)
            self._last = (x.tobytes(), evaluation)
        return evaluation
