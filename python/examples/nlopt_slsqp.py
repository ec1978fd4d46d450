"""NLopt (python3-nlopt)."""

import nlopt
import numpy as np

from pleuel.scaled import Scaled


def minimum(functions):
    """The y that it finds of the functions of a pleuel.scaled.Scaled or a pleuel.Search."""

    def objective(y, gradient):
        if gradient.size:
            gradient[:] = functions.gradient(y)
        return functions.objective(y)

    def limits(result, y, jacobian):
        result[:] = functions.violations(y)
        if jacobian.size:
            jacobian[:] = functions.jacobian(y)

    solver = nlopt.opt(nlopt.LD_SLSQP, functions.start.size)
    solver.set_lower_bounds(functions.lower)
    solver.set_upper_bounds(functions.upper)
    solver.set_min_objective(objective)
    solver.add_inequality_mconstraint(limits, np.full(functions.violations(functions.start).size, 1e-9))
    solver.set_ftol_rel(1e-10)
    return solver.optimize(functions.start)


def optimum(problem):
    """The design that it finds [SI]."""
    scaled = Scaled(problem)
    return scaled.design(minimum(scaled))
