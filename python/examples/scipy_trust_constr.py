"""SciPy's trust-constr, an interior-point method (python3-scipy)."""

import numpy as np
from scipy.optimize import BFGS, Bounds, NonlinearConstraint, minimize

from pleuel.scaled import Scaled


def minimum(functions):
    """The y that it finds of the functions of a pleuel.scaled.Scaled or a pleuel.Search."""
    limits = NonlinearConstraint(functions.violations, -np.inf, 0.0, jac=functions.jacobian, hess=BFGS())
    found = minimize(
        functions.objective, functions.start, jac=functions.gradient, hess=BFGS(),
        bounds=Bounds(functions.lower, functions.upper), constraints=[limits], method="trust-constr",
        # gtol alone would end it while the barrier still keeps the design away from its limits
        options={"gtol": 1e-14, "xtol": 1e-9, "barrier_tol": 1e-8, "maxiter": 300},
    )
    return found.x


def optimum(problem):
    """The design that it finds [SI]."""
    scaled = Scaled(problem)
    return scaled.design(minimum(scaled))
