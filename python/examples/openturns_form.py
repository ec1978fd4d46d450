"""FORM of OpenTURNS (python3-openturns): how probable it is that a response is beyond a threshold."""

import openturns as ot


def reliability_index(problem, response, threshold, deviations):
    """Hasofer and Lind's index β of response > threshold, with variables that scatter normally.

    deviations: {variable: standard deviation} [SI]
    """
    names, row = list(deviations), problem.responses.index(response)
    columns = [problem.variables.index(name) for name in names]

    def value(x):
        return [problem.response_values(dict(zip(names, x)))[response]]

    def gradient(x):
        return [[slope] for slope in problem.jacobian(dict(zip(names, x)))[row, columns]]

    means = [problem.start[column] for column in columns]
    scatter = ot.ComposedDistribution([ot.Normal(mean, deviations[name]) for mean, name in zip(means, names)])
    function = ot.PythonFunction(len(names), 1, value, gradient=gradient)
    event = ot.ThresholdEvent(ot.CompositeRandomVector(function, ot.RandomVector(scatter)), ot.Greater(), threshold)
    search = ot.FORM(ot.AbdoRackwitz(), event, means)
    search.run()
    return search.getResult().getHasoferReliabilityIndex()
