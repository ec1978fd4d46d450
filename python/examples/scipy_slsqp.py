"""SciPy's SLSQP (python3-scipy)."""

from scipy.optimize import minimize

from pleuel.scaled import Scaled


def minimum(functions):
    """The y that it finds of the functions of a pleuel.scaled.Scaled or a pleuel.Search."""
    limits = {"type": "ineq", "fun": lambda y: -functions.violations(y), "jac": lambda y: -functions.jacobian(y)}
    found = minimize(
        functions.objective, functions.start, jac=functions.gradient, bounds=list(zip(functions.lower, functions.upper)),
        constraints=[limits], method="SLSQP", options={"ftol": 1e-10},
    )
    if not found.success:
        raise RuntimeError(found.message)
    return found.x


def optimum(problem):
    """The design that it finds [SI]."""
    scaled = Scaled(problem)
    return scaled.design(minimum(scaled))
