"""What calls return."""

from __future__ import annotations

import html
from typing import NamedTuple, Optional

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


class Evaluation(NamedTuple):
    """One design, as an optimizer sees it [SI]."""

    objective: float  #: what is minimized: the negative of a response that is maximized
    limits: Array  #: values of what is limited, one a limit
    gradient: Optional[Array] = None  #: of the objective, one a variable
    jacobian: Optional[Array] = None  #: limits × variables


class History(NamedTuple):
    """A response over time."""

    time: Array  #: [s]
    values: Array  #: one an instant [SI]
    derivatives: Optional[Array] = None  #: instants × variables [SI]


class Progress(NamedTuple):
    """One evaluation of an optimization."""

    evaluation: int  #: 1, 2, 3, …
    iteration: int  #: designs with gradients so far
    x: Array
    objective: float
    limits: Array  #: empty after a failure
    max_violation: float  #: relative; 0 or less: all limits are kept
    failure: str  #: why the design could not be simulated; empty: it could


def table(titles, rows) -> str:
    """HTML."""
    head = "".join(f"<th>{html.escape(str(title))}</th>" for title in titles)
    body = "".join(
        "<tr>" + "".join(f"<td>{html.escape(str(cell))}</td>" for cell in row) + "</tr>" for row in rows
    )
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def shown(value) -> str:
    """A number as people read it."""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


class Document(dict):
    """What a command prints with --json (docs/reference/commands.md), and its exit code."""

    exit_code: int = 0


class Optimum(Document):
    """The answer of an optimization: the document of `pleuel optimize`."""

    @property
    def is_verified(self) -> bool:
        """Whether it is proven to be a local optimum."""
        return self["status"] == "verified"

    @property
    def x(self) -> Array:
        """The design, one a variable [SI]."""
        return np.array([one["value"] for one in self["variables"].values()])

    @property
    def objective(self) -> float:
        """The value of the response that is minimized or maximized [SI]."""
        return self["objective"].get("value", float("nan"))

    def _repr_html_(self) -> str:
        variables = [(name, shown(one["value"]), one.get("unit", "")) for name, one in self["variables"].items()]
        limits = [
            (name, shown(one["value"]), one["side"], shown(one["limit"]), one.get("unit", ""))
            for name, one in self.get("constraints", {}).items()
        ]
        objective = self["objective"]
        return (
            f"<p><b>{html.escape(self['status'])}</b>: {html.escape(self['message'])}</p>"
            f"<p>{html.escape(objective['name'])} = {shown(self.objective)} {html.escape(objective['unit'])}</p>"
            + table(("variable", "value", "unit"), variables)
            + table(("limit", "value", "side", "bound", "unit"), limits)
        )
