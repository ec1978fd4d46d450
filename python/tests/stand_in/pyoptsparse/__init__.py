"""STAND-IN for pyoptsparse, not pyOptSparse: as much of it as one group of variables, one of constraints and SLSQP take."""

import sys
from types import SimpleNamespace

import numpy as np
from scipy.optimize import minimize

IS_STAND_IN = True
print("STAND-IN for pyOptSparse, which is not installed", file=sys.stderr)


def _numbers(bounds, none):
    if any(one is not None and not np.isfinite(one) for one in bounds):
        raise ValueError("pyOptSparse computes with infinities, to NaN: None is no bound")
    return np.array([none if one is None else one for one in bounds])


class Optimization:
    def __init__(self, name, function):
        self.name, self.function = name, function

    def addVarGroup(self, name, count, kind, value, lower, upper, scale):
        if kind != "c" or len(value) != count:
            raise ValueError((kind, count))
        self.variables = SimpleNamespace(
            name=name, value=value, lower=_numbers(lower, -np.inf), upper=_numbers(upper, np.inf), scale=scale
        )

    def addObj(self, name, scale):
        self.objective = SimpleNamespace(name=name, scale=scale)

    def addConGroup(self, name, count, lower, upper, scale):
        if len(scale) != count:
            raise ValueError(count)
        self.constraints = SimpleNamespace(
            name=name, lower=_numbers(lower, -np.inf), upper=_numbers(upper, np.inf), scale=scale
        )


class SLSQP:
    def __init__(self, options):
        self.options = options

    def __call__(self, described, sens):
        x, f, c = described.variables, described.objective, described.constraints
        rows = [(sign, i, bounds[i]) for sign, bounds in ((1, c.upper), (-1, c.lower)) for i in np.flatnonzero(np.isfinite(bounds))]
        signs, indices, bounds = (np.array(column) for column in zip(*rows))

        def values(y):
            funcs, has_failed = described.function({x.name: y / x.scale})
            if has_failed:
                raise RuntimeError("a design failed")
            return funcs

        def slopes(y, of):
            return sens({x.name: y / x.scale}, values(y))[0][of][x.name] / x.scale

        found = minimize(
            lambda y: values(y)[f.name] * f.scale, x.value * x.scale, jac=lambda y: slopes(y, f.name) * f.scale,
            bounds=list(zip(x.lower * x.scale, x.upper * x.scale)), tol=self.options["ACC"], method="SLSQP",
            constraints={
                "type": "ineq",
                "fun": lambda y: -signs * (values(y)[c.name][indices] - bounds) * c.scale[indices],
                "jac": lambda y: -(signs * c.scale[indices])[:, None] * slopes(y, c.name)[indices],
            },
        )
        return SimpleNamespace(xStar={x.name: found.x / x.scale}, fStar=found.fun / f.scale)
