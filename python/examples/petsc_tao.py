"""TAO of PETSc (python3-petsc4py): bound-constrained quasi-Newton on an augmented Lagrangian of the limits."""

import numpy as np
from petsc4py import PETSc

from pleuel.scaled import Scaled


def minimum(functions, weight=10.0, rounds=40):
    """The y that it finds of the functions of a pleuel.scaled.Scaled."""
    multipliers = np.zeros(functions.violations(functions.start).size)
    y = PETSc.Vec().createWithArray(functions.start.copy(), comm=PETSc.COMM_SELF)
    lower, upper = (PETSc.Vec().createWithArray(at, comm=PETSc.COMM_SELF) for at in (functions.lower, functions.upper))

    def lagrangian(_, at, gradient):
        forces = np.maximum(0.0, multipliers + weight * functions.violations(at.array_r))
        gradient.array = functions.gradient(at.array_r) + functions.jacobian(at.array_r).T @ forces
        return functions.objective(at.array_r) + (forces @ forces - multipliers @ multipliers) / (2.0 * weight)

    tao = PETSc.TAO().create(comm=PETSc.COMM_SELF)
    tao.setType("blmvm")
    tao.setObjectiveGradient(lagrangian, y.duplicate())
    tao.setVariableBounds((lower, upper))
    tao.setTolerances(gatol=1e-8, grtol=0.0)
    for _ in range(rounds):
        tao.solve(y)
        change = np.maximum(0.0, multipliers + weight * functions.violations(y.array_r)) - multipliers
        multipliers += change
        if np.abs(change).max() < 1e-8:
            break
    return y.array_r


def optimum(problem):
    """The design that it finds [SI]."""
    scaled = Scaled(problem)
    return scaled.design(minimum(scaled))
