"""SciPy's trust-constr, an interior-point method (python3-scipy)."""

import numpy as np
from scipy.optimize import BFGS, NonlinearConstraint, minimize

from pleuel.scaled import Scaled


def optimum(problem):
    """The design that it finds [SI]."""
    scaled = Scaled(problem)
    limits = NonlinearConstraint(scaled.violations, -np.inf, 0.0, jac=scaled.jacobian, hess=BFGS())
    found = minimize(
        scaled.objective, scaled.start, jac=scaled.gradient, hess=BFGS(), bounds=[(0, 1)] * scaled.start.size,
        constraints=[limits], method="trust-constr",
        # gtol alone would end it while the barrier still keeps the design away from its limits
        options={"gtol": 1e-14, "xtol": 1e-9, "barrier_tol": 1e-8, "maxiter": 300},
    )
    return scaled.design(found.x)
