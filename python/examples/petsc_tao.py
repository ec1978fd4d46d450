"""TAO of PETSc (python3-petsc4py): bound-constrained quasi-Newton on an augmented Lagrangian of the limits."""

import numpy as np
from petsc4py import PETSc

from pleuel.scaled import Scaled


def optimum(problem, weight=10.0, rounds=40):
    """The design that it finds [SI]."""
    scaled = Scaled(problem)
    multipliers = np.zeros(scaled.violations(scaled.start).size)
    y = PETSc.Vec().createWithArray(scaled.start.copy(), comm=PETSc.COMM_SELF)
    lower, upper = (PETSc.Vec().createWithArray(np.full(y.size, bound), comm=PETSc.COMM_SELF) for bound in (0.0, 1.0))

    def lagrangian(_, at, gradient):
        forces = np.maximum(0.0, multipliers + weight * scaled.violations(at.array_r))
        gradient.array = scaled.gradient(at.array_r) + scaled.jacobian(at.array_r).T @ forces
        return scaled.objective(at.array_r) + (forces @ forces - multipliers @ multipliers) / (2.0 * weight)

    tao = PETSc.TAO().create(comm=PETSc.COMM_SELF)
    tao.setType("blmvm")
    tao.setObjectiveGradient(lagrangian, y.duplicate())
    tao.setVariableBounds((lower, upper))
    tao.setTolerances(gatol=1e-8, grtol=0.0)
    for _ in range(rounds):
        tao.solve(y)
        change = np.maximum(0.0, multipliers + weight * scaled.violations(y.array_r)) - multipliers
        multipliers += change
        if np.abs(change).max() < 1e-8:
            break
    return scaled.design(y.array_r)
