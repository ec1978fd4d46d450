"""STAND-IN for openmdao.api, not OpenMDAO: as much of ExplicitComponent as PleuelComponent uses."""

import numpy as np

IS_STAND_IN = True


class _Options(dict):
    def declare(self, name, default=None, **_):
        self.setdefault(name, default)


class ExplicitComponent:
    def __init__(self, **options):
        self.options = _Options()
        self.initialize()
        unknown = set(options) - set(self.options)
        if unknown:
            raise KeyError(f"options that were not declared: {unknown}")
        self.options.update(options)
        self._inputs, self._outputs, self._pairs = {}, {}, []
        self.setup()

    def add_input(self, name, val):
        self._inputs[name] = np.array(val, dtype=float)

    def add_output(self, name, val=0.0, shape=1):
        self._outputs[name] = np.full(shape, float(val))

    def declare_partials(self, of, wrt):
        if of not in self._outputs or wrt not in self._inputs:
            raise KeyError((of, wrt))
        self._pairs.append((of, wrt))


def run(component, x):
    """Outputs, and partial derivatives as a model of OpenMDAO would take them."""
    inputs = {"x": np.asarray(x, dtype=float)}
    outputs = {name: np.array(value) for name, value in component._outputs.items()}
    partials = {}
    component.compute(inputs, outputs)
    component.compute_partials(inputs, partials)
    if set(partials) != set(component._pairs):
        raise KeyError("not the partial derivatives that were declared")
    return outputs, partials
