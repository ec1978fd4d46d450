"""What goes wrong, with the place in the problem where it does."""

from __future__ import annotations


class Error(Exception):
    """A call failed.

    file:    of the problem, or empty
    pointer: JSON pointer to the place in it, "/scene/bodies/rod/length", or empty
    rule:    what must hold there, and the value that does not
    """

    def __init__(self, text: str, file: str = "", pointer: str = "", rule: str = "") -> None:
        super().__init__(text)
        self.file, self.pointer, self.rule = file, pointer, rule

    def __reduce__(self):
        return type(self), (str(self), self.file, self.pointer, self.rule)


class InputError(Error, ValueError):
    """The problem, an override or an option cannot be used."""


class SimulationError(Error, ArithmeticError):
    """This design cannot be simulated. The text says when and where, and what to try."""


class CallError(Error, ValueError):
    """An argument is none: a wrong size, a number that is not finite, a closed problem."""


class Stopped(Error):
    """stop() ended the call."""


class Fault(Error, RuntimeError):
    """A fault of Pleuel itself."""


class Interrupted(KeyboardInterrupt):
    """Ctrl-C ended an optimization; `optimum` has the best design until then."""

    def __init__(self, optimum: object) -> None:
        super().__init__("interrupted; .optimum has the best design until then")
        self.optimum = optimum
