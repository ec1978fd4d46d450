"""SciPy's SLSQP (python3-scipy)."""

from scipy.optimize import minimize

from pleuel.scaled import Scaled


def optimum(problem):
    """The design that it finds [SI]."""
    scaled = Scaled(problem)
    limits = {"type": "ineq", "fun": lambda y: -scaled.violations(y), "jac": lambda y: -scaled.jacobian(y)}
    found = minimize(
        scaled.objective, scaled.start, jac=scaled.gradient, bounds=[(0, 1)] * scaled.start.size,
        constraints=[limits], method="SLSQP", options={"ftol": 1e-10},
    )
    if not found.success:
        raise RuntimeError(found.message)
    return scaled.design(found.x)
