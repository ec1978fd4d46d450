"""A problem as a component of OpenMDAO; needs the package openmdao."""

from __future__ import annotations

import openmdao.api as om

from .problem import Problem
from .scaled import limit_magnitudes, variable_magnitudes


class PleuelComponent(om.ExplicitComponent):
    """Inputs: "x", the design [SI]. Outputs: "objective", and "limits", one a limit [SI].

    Option "problem": what pleuel.load() returned. Derivatives are those of the discrete motion, exact to round-off. A
    design that cannot be simulated is an AnalysisError, from which drivers that know it step back.
    """

    def initialize(self):
        self.options.declare("problem", recordable=False)

    def setup(self):
        problem = self.options["problem"]
        self.add_input("x", val=problem.start)
        self.add_output("objective", val=0.0)
        self.declare_partials("objective", "x")
        if problem.limits:
            self.add_output("limits", shape=len(problem.limits))
            self.declare_partials("limits", "x")

    def compute(self, inputs, outputs):
        found = self._evaluated(inputs, False)
        outputs["objective"] = found.objective
        if self.options["problem"].limits:
            outputs["limits"] = found.limits

    def compute_partials(self, inputs, partials):
        found = self._evaluated(inputs, True)
        partials["objective", "x"] = found.gradient
        if self.options["problem"].limits:
            partials["limits", "x"] = found.jacobian

    def _evaluated(self, inputs, derivatives):
        try:
            return self.options["problem"].evaluate(inputs["x"], derivatives=derivatives)
        except ArithmeticError as failure:  # pleuel.SimulationError
            raise om.AnalysisError(str(failure)) from failure


def add_optimization(model: om.Group, problem: Problem) -> None:
    """Declares what a problem asks for, of a model that has its component promoted: bounds, objective, limits, all by
    their magnitudes.
    """
    model.add_design_var("x", lower=problem.lower, upper=problem.upper, ref=variable_magnitudes(problem))
    first = problem.evaluate()
    model.add_objective("objective", ref=abs(first.objective) or 1.0)
    if problem.limits:
        model.add_constraint(
            "limits", lower=problem.limit_lower, upper=problem.limit_upper, ref=limit_magnitudes(problem, first.limits)
        )
