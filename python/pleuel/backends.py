"""Optimizers of other packages as backends of Pleuel, which judges what they find."""

from __future__ import annotations

from typing import Any, Callable, Optional

import numpy as np
import numpy.typing as npt

from . import _border as border
from .errors import SimulationError, Stopped
from .results import Array, Evaluation
from .scaled import Functions


class Search(Functions):
    """What a backend has to minimize: the functions of Functions, and equalities(y) = 0 where there are any.

    Designs that cannot be simulated look worse than all others, as walls. Whatever asks for more when the search is to
    end gets Stopped, which may pass through.
    """

    def __init__(self, search: border.Search) -> None:
        super().__init__()
        self.start, self.lower, self.upper = (
            np.ctypeslib.as_array(array, (search.variables,)).copy() for array in (search.start, search.lower, search.upper)
        )
        self.tolerance: float = search.tolerance  #: relative, at which it should end
        self._number, self._inequalities = search.number, search.inequalities
        self._rows = search.inequalities + search.equalities
        self._worst = 0.0

    def violations(self, y: Array) -> Array:
        return super().violations(y)[: self._inequalities]

    def jacobian(self, y: Array) -> Array:
        return super().jacobian(y)[: self._inequalities]

    def equalities(self, y: Array) -> Array:
        """0: they are kept."""
        return self._at(y).limits[self._inequalities :]

    def equality_jacobian(self, y: Array) -> Array:
        """equalities × variables"""
        return self._at(y).jacobian[self._inequalities :]

    def _evaluated(self, y: Array) -> Evaluation:
        objective, rows = np.empty(1), np.empty(self._rows)
        gradient, jacobian = np.empty(y.size), np.empty((rows.size, y.size))
        status = border.library.pleuel_search_evaluate(
            self._number, y.ctypes.data, y.size, objective.ctypes.data, rows.ctypes.data, rows.size,
            gradient.ctypes.data, jacobian.ctypes.data,
        )
        if status == border.STOPPED:  # also where no more evaluations are allowed
            raise Stopped("the search is to end: the backend should return")
        try:
            border.checked(status)
        except SimulationError:
            wall = self._worst + 10.0  # the penalty of Pleuel's own backends of NLopt
            return Evaluation(wall, np.full(self._rows, wall), np.zeros(y.size), np.zeros((rows.size, y.size)))
        self._worst = max(self._worst, objective[0], *rows)
        return Evaluation(float(objective[0]), rows, gradient, jacobian)


Backend = Callable[[Search], npt.ArrayLike]
_registered: list[Any] = []  #: functions for the library, which may call them until the process ends


def register_backend(name: str, backend: Optional[Backend], *, equalities: bool = False) -> None:
    """Makes an optimizer known, under a name that `backend` of options, problem files and commands may have.

    backend:    takes a Search, returns the y that it comes to; None: forgets the one of this name
    equalities: whether it keeps equalities(y) = 0; else problems with such limits are refused

    The best design counts wherever it ends, and Pleuel's own audit says whether that is an optimum. What it raises is
    the cause of the CallError of the call that needed it.
    """
    if backend is None:
        border.checked(border.library.pleuel_register_backend(name.encode(), 0, border.BACKEND(), None))
        return

    def called(search: Any, end: Any, reason: Any, _: Any) -> int:
        try:
            size = search.contents.variables
            y = np.asarray(backend(Search(search.contents)), dtype=np.float64)
            if y.shape != (size,):
                raise ValueError(f"it returned an array of the shape {y.shape} for {size} variables")
            np.ctypeslib.as_array(end, (size,))[:] = y
            return 0
        except Stopped:
            return 0
        except BaseException as failure:  # also KeyboardInterrupt
            border.keep_failure(failure)
            text = f"{type(failure).__name__}: {failure}".encode()[: border.REASON_SIZE - 1]
            for i, byte in enumerate(text):
                reason[i] = byte
            return 1

    _registered.append(border.BACKEND(called))
    border.checked(border.library.pleuel_register_backend(name.encode(), int(equalities), _registered[-1], None))
