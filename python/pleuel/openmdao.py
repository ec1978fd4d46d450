"""A problem as a component of OpenMDAO; needs the package openmdao."""

from __future__ import annotations

import openmdao.api as om


class PleuelComponent(om.ExplicitComponent):
    """Inputs: "x", the design [SI]. Outputs: "objective", and "limits", one a limit.

    Option "problem": what pleuel.load() returned. Derivatives are those of the discrete motion, exact to round-off.
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
        found = self.options["problem"].evaluate(inputs["x"])
        outputs["objective"] = found.objective
        if self.options["problem"].limits:
            outputs["limits"] = found.limits

    def compute_partials(self, inputs, partials):
        found = self.options["problem"].evaluate(inputs["x"], derivatives=True)
        partials["objective", "x"] = found.gradient
        if self.options["problem"].limits:
            partials["limits", "x"] = found.jacobian
