"""STAND-IN for openmdao.api, not OpenMDAO: as much of it as one promoted ExplicitComponent and a search by SLSQP take."""

import sys

import numpy as np
from scipy.optimize import minimize

IS_STAND_IN = True
print("STAND-IN for OpenMDAO, which is not installed", file=sys.stderr)


class AnalysisError(Exception):
    pass


class _Options(dict):
    def declare(self, name, default=None, **_):
        self.setdefault(name, default)


class ExplicitComponent:
    def __init__(self, **options):
        self.options = _Options()
        self.initialize()
        unknown = set(options) - set(self.options)
        if unknown:
            raise KeyError(f"options that were not declared: {unknown}")
        self.options.update(options)
        self.values, self.outputs, self.pairs = {}, [], []

    def add_input(self, name, val):
        self.values[name] = np.atleast_1d(np.array(val, dtype=float))

    def add_output(self, name, val=0.0, shape=1):
        self.values[name] = np.full(shape, float(val))
        self.outputs.append(name)

    def declare_partials(self, of, wrt):
        if of not in self.outputs or wrt not in self.values:
            raise KeyError((of, wrt))
        self.pairs.append((of, wrt))


class Group:
    def __init__(self):
        self.name, self.component, self.declared = None, None, {}

    def add_subsystem(self, name, component, promotes=()):
        if self.component is not None or list(promotes) != ["*"]:
            raise NotImplementedError("the stand-in takes one component, all promoted")
        self.name, self.component = name, component
        return component

    def add_design_var(self, name, lower, upper, ref):
        self.declared["design"] = (name, lower, upper, ref)

    def add_objective(self, name, ref):
        self.declared["objective"] = (name, None, None, ref)

    def add_constraint(self, name, lower, upper, ref):
        self.declared["constraint"] = (name, lower, upper, ref)


class ScipyOptimizeDriver:
    def __init__(self, optimizer, tol):
        if optimizer != "SLSQP":
            raise NotImplementedError(optimizer)
        self.options = {"optimizer": optimizer, "tol": tol, "disp": True}


class Problem:
    def __init__(self, reports=None):
        self.model, self.driver = Group(), None

    def setup(self):
        self.model.component.setup()

    def __getitem__(self, name):
        return self.model.component.values[name]

    def set_val(self, name, value):
        self.model.component.values[name][:] = value

    def run_model(self):
        component = self.model.component
        outputs = {name: component.values[name] for name in component.outputs}
        component.compute(component.values, outputs)
        for name, value in outputs.items():
            self.set_val(name, value)

    def partials(self):
        """As a model of OpenMDAO would take them."""
        partials = {}
        self.model.component.compute_partials(self.model.component.values, partials)
        if set(partials) != set(self.model.component.pairs):
            raise KeyError("not the partial derivatives that were declared")
        shapes = {pair: tuple(self[name].size for name in pair) for pair in partials}
        return {pair: np.asarray(one).reshape(shapes[pair]) for pair, one in partials.items()}

    def check_partials(self, out_stream, method, form, step, step_calc):
        """By central differences of this step."""
        if (method, form, step_calc) != ("fd", "central", "abs"):
            raise NotImplementedError((method, form, step_calc))
        data = {pair: {"J_fwd": one, "J_fd": np.empty(one.shape)} for pair, one in self.partials().items()}
        for (of, wrt), one in data.items():
            start = self[wrt].copy()
            for j in range(start.size):
                ends = []
                for sign in (1.0, -1.0):
                    self.set_val(wrt, start + sign * step * np.eye(start.size)[j])
                    self.run_model()
                    ends.append(self[of].copy())
                one["J_fd"][:, j] = (ends[0] - ends[1]) / (2.0 * step)
            self.set_val(wrt, start)
        return {self.model.name: data}

    def run_driver(self):
        x, lower, upper, size = self.model.declared["design"]
        objective, _, _, unit = self.model.declared["objective"]
        limits, least, most, sizes = self.model.declared["constraint"]
        rows = [(sign, i, bounds[i]) for sign, bounds in ((1, most), (-1, least)) for i in np.flatnonzero(np.isfinite(bounds))]
        signs, indices, bounds = (np.array(column) for column in zip(*rows))

        def at(y, value):
            self.set_val(x, y * size)
            self.run_model()
            return value()

        found = minimize(
            lambda y: at(y, lambda: float(self[objective][0]) / unit), self[x] / size,
            jac=lambda y: at(y, lambda: self.partials()[objective, x][0] * size / unit),
            bounds=list(zip(lower / size, upper / size)), tol=self.driver.options["tol"], method="SLSQP",
            constraints={
                "type": "ineq",
                "fun": lambda y: at(y, lambda: -signs * (self[limits][indices] - bounds) / sizes[indices]),
                "jac": lambda y: at(y, lambda: -(signs / sizes[indices])[:, None] * self.partials()[limits, x][indices] * size),
            },
        )
        at(found.x, lambda: None)
