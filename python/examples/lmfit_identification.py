"""lmfit (python3-lmfit): finds the numbers of a mechanism from a measured history."""

import lmfit


def identified(problem, response, names, measured):
    """The variables of these names with which the history of a response is the measured one [SI], as lmfit reports them."""
    unknown = lmfit.Parameters()
    for name in names:
        i = problem.variables.index(name)
        unknown.add(name, value=problem.start[i], min=problem.lower[i], max=problem.upper[i])
    unit = abs(measured).max()

    def misfit(values):
        return (problem.histories(response, x=values.valuesdict()).values - measured) / unit

    return lmfit.minimize(misfit, unknown, xtol=1e-12, ftol=1e-12)
