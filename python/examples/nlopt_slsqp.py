"""NLopt (python3-nlopt)."""

import nlopt
import numpy as np

from pleuel.scaled import Scaled


def optimum(problem):
    """The design that it finds [SI]."""
    scaled = Scaled(problem)

    def objective(y, gradient):
        if gradient.size:
            gradient[:] = scaled.gradient(y)
        return scaled.objective(y)

    def limits(result, y, jacobian):
        result[:] = scaled.violations(y)
        if jacobian.size:
            jacobian[:] = scaled.jacobian(y)

    solver = nlopt.opt(nlopt.LD_SLSQP, scaled.start.size)
    solver.set_lower_bounds(np.zeros(scaled.start.size))
    solver.set_upper_bounds(np.ones(scaled.start.size))
    solver.set_min_objective(objective)
    solver.add_inequality_mconstraint(limits, np.full(scaled.violations(scaled.start).size, 1e-9))
    solver.set_ftol_rel(1e-10)
    return scaled.design(solver.optimize(scaled.start))
