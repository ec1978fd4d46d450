#!/usr/bin/env python3
"""A rod whose thickness is a field: a finite-element program of its own, with as many variables as elements.

The rod of the slider-crank is a sheet of plane-stress elements between two pins, each with a thickness of its own. Its bow
is to be small, with no more mass than 10 mm everywhere. Pleuel knows nothing of the elements: it takes the body by its
invariants, and gives the derivatives of the bow by each of them. The chain rule to the thicknesses is a sum over elements
here. The basis of the reduction is renewed for each design; how it changes is left out of the derivatives (--check).

    python3 sheet_thickness.py [--elements 36 6] [--evaluations 60] [--check]

It needs NumPy, SciPy and NLopt (python3-numpy, python3-scipy, python3-nlopt).
"""

import argparse
import json
import pathlib
import tempfile

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

import pleuel

ROOT = pathlib.Path(__file__).resolve().parents[2]
LENGTH, HEIGHT = 0.18, 0.03  # [m]
YOUNG, POISSON, DENSITY = 210e9, 0.3, 7850.0
LEAST, MOST = 4e-3, 20e-3  # of the thickness [m]
PAIRS = {"moment_xx": (0, 0), "moment_yy": (1, 1), "moment_xy": (0, 1)}


class Sheet:
    """nx × ny bilinear elements of plane stress. The frame is clamped to the left pin; both pins are rigid edges."""

    def __init__(self, nx, ny, modes=6):
        self.nx, self.ny, self.modes = nx, ny, modes
        self.size = np.array([LENGTH / nx, HEIGHT / ny])
        x, y = np.meshgrid(np.linspace(0, LENGTH, nx + 1), np.linspace(-HEIGHT / 2, HEIGHT / 2, ny + 1), indexing="ij")
        self.points = np.column_stack([x.ravel(), y.ravel()])
        corner = (np.arange(nx)[:, None] * (ny + 1) + np.arange(ny)).ravel()
        self.nodes = np.column_stack([corner, corner + ny + 1, corner + ny + 2, corner + 1])
        self.freedoms = np.stack([2 * self.nodes, 2 * self.nodes + 1], axis=2).reshape(-1, 8)
        self.middle = (nx // 2) * (ny + 1) + ny // 2
        self.stiffness, self.scalar_mass = self._unit_element()

    def _unit_element(self):
        """Stiffness (8 × 8) and mass of one direction (4 × 4) of an element that is 1 m thick."""
        law = YOUNG / (1 - POISSON**2) * np.array([[1, POISSON, 0], [POISSON, 1, 0], [0, 0, (1 - POISSON) / 2]])
        corners, area = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]), self.size.prod() / 4
        k, m = np.zeros((8, 8)), np.zeros((4, 4))
        for place in corners / np.sqrt(3):
            shape = np.prod(1 + corners * place, axis=1) / 4
            slope = corners * (1 + corners * place)[:, ::-1] / 4 * (2 / self.size)
            b = np.zeros((3, 8))
            b[0, ::2], b[1, 1::2], b[2, ::2], b[2, 1::2] = slope[:, 0], slope[:, 1], slope[:, 1], slope[:, 0]
            k += area * b.T @ law @ b
            m += DENSITY * area * np.outer(shape, shape)
        return k, m

    def _assembled(self, element, freedoms, thickness):
        rows, columns = np.repeat(freedoms, freedoms.shape[1], axis=1), np.tile(freedoms, freedoms.shape[1])
        return coo_matrix(((thickness[:, None] * element.ravel()).ravel(), (rows.ravel(), columns.ravel()))).tocsc()

    def basis(self, thickness):
        """Nodal displacements by the elastic coordinates: the rigid right pin (u, v, θ), what a force at the place that is
        looked at does (else derivatives of its displacement would miss what modes do not span), fixed-interface modes."""
        k = self._assembled(self.stiffness, self.freedoms, thickness)
        m = self._assembled(np.kron(self.scalar_mass, np.eye(2)), self.freedoms, thickness)
        edge = self.ny + 1
        right = np.arange(2 * edge * self.nx, 2 * edge * (self.nx + 1))
        free = np.arange(2 * edge, 2 * edge * self.nx)
        rigid = np.zeros((right.size, 3))
        rigid[::2, 0] = rigid[1::2, 1] = 1.0
        rigid[::2, 2] = -self.points[right[::2] // 2, 1]
        inner = splu(k[free][:, free])
        static = -inner.solve(k[free][:, right] @ rigid)
        lowest = min(self.modes + 10, free.size)
        vectors = np.random.default_rng(1).standard_normal((free.size, lowest))
        for _ in range(12):  # subspace iteration
            vectors = inner.solve(m[free][:, free] @ vectors)
            values, turn = eigh(vectors.T @ k[free][:, free] @ vectors, vectors.T @ m[free][:, free] @ vectors)
            vectors = vectors @ turn
        force = np.zeros(free.size)
        force[2 * self.middle + 1 - free[0]] = 1.0
        pushed = inner.solve(force)
        basis = np.zeros((2 * len(self.points), 4 + self.modes))
        basis[right, :3], basis[free, :3] = rigid, static
        basis[free, 3], basis[free, 4:] = pushed / np.abs(pushed).max(), vectors[:, : self.modes]
        return basis

    def invariants(self, thickness, basis):
        """The numbers of the body, a dictionary of arrays: linear in the thicknesses while the basis stays."""
        return {name: np.einsum("e,e...->...", thickness, each) for name, each in self.of_elements(basis).items()}

    def of_elements(self, basis):
        """Those of each element for a thickness of 1 m: their derivatives. Coordinates are interpolated as displacements."""
        m, points = self.scalar_mass, self.points[self.nodes]  # elements × 4 × 2
        shape = basis.reshape(-1, 2, basis.shape[1])[self.nodes]  # elements × 4 × 2 × n
        weight = m.sum(axis=0)
        zero = np.zeros(len(points))
        moved = np.einsum("a,eakn->ekn", weight, shape)
        mixed = np.einsum("eak,ab,ebln->ekln", points, m, shape)
        n = basis.shape[1]
        full = np.zeros((len(points), 3, 3, n))
        full[:, :2, :2] = mixed
        second = np.zeros((len(points), 3, 3))
        second[:, :2, :2] = np.einsum("eak,ab,ebl->ekl", points, m, points)
        of_freedoms = basis[self.freedoms]
        found = {
            "mass": np.full(len(points), m.sum()),
            "first_moment": np.column_stack([np.einsum("a,eak->ek", weight, points), zero]),
            "second_moment": second,
            "shape": np.concatenate([moved, np.zeros((len(points), 1, n))], axis=1),
            "mixed": full.reshape(len(points), 9, n),
            "stiffness": np.einsum("ein,ij,ejm->enm", of_freedoms, self.stiffness, of_freedoms),
        }
        for name, (k, l) in PAIRS.items():
            found[name] = np.einsum("ean,ab,ebm->enm", shape[:, :, k], m, shape[:, :, l])
        found["mass_matrix"] = found["moment_xx"] + found["moment_yy"]
        found["damping"] = 1e-5 * found["stiffness"]
        return found

    def body(self, thickness, basis=None):
        """A file of invariants, and the derivatives of its numbers by each thickness."""
        basis = self.basis(thickness) if basis is None else basis
        numbers = self.invariants(thickness, basis)
        n = basis.shape[1]

        def place(node, rotation):
            moves = np.zeros((3, n))
            moves[:2] = basis[2 * node : 2 * node + 2]
            turns = np.zeros((3, n))
            turns[2] = rotation
            return {"position": [*self.points[node], 0.0], "displacement": entries(moves), "rotation": entries(turns)}

        right = self.nx * (self.ny + 1) + self.ny // 2
        document = {
            "format": "pleuel-invariants", "version": 1, "body": "rod", "units": "SI",
            "reference_condition": "tangent", "coordinates": [f"q{i}" for i in range(n)],
            "invariants": {name: entries(a) if a.ndim == 2 and name != "second_moment" else a.tolist() for name, a in numbers.items()},
            "places": {
                "left": place(self.ny // 2, np.zeros(n)),
                "middle": place(self.middle, np.zeros(n)),
                "right": place(right, np.eye(n)[2]),
            },
        }  # fmt: skip
        return document, self.of_elements(basis)


def entries(matrix):
    """All of them, zeros too: there are derivatives by what is listed."""
    return [[i, j, float(matrix[i, j])] for i, j in np.ndindex(matrix.shape)]


def dense(value, like):
    """A block of derivatives as an array of the shape of the numbers."""
    if like.ndim != 2 or like.shape == (3, 3):
        return np.asarray(value, dtype=float)
    array = np.zeros(like.shape)
    for i, j, number in value:
        array[i, j] = number
    return array


def chain(gradient, of_elements):
    """Σ dJ/dI · dI/dt of every element."""
    slopes = 0.0
    for name, each in of_elements.items():
        block = dense(gradient["invariants"][name], each[0])
        slopes = slopes + (each * block).reshape(len(each), -1).sum(axis=1)
    return slopes


class Rod:
    """Mass and bow of the rod in the slider-crank, with derivatives by all thicknesses."""

    def __init__(self, sheet):
        self.sheet, self.evaluations = sheet, 0
        document = json.loads((ROOT / "docs" / "invariants" / "slider_crank.json").read_text())
        del document["scene"]["bodies"]["rod"]["other_designs"]
        del document["effects"]
        document["simulation"].update(step="0.2 ms", end_time="80 ms")
        document["variables"] = {name: document["variables"][name] for name in ("crank_width", "crank_height")}
        document["responses"] = {
            "mass": {"type": "mass", "bodies": ["rod"]},
            "bow": {"type": "deflection", "body": "rod", "at": "middle", "against": "chord",
                    "chord": ["left", "right"], "over_time": "rms"},
        }  # fmt: skip
        self.document = document

    def __call__(self, thickness, derivatives=True, basis=None):
        """{response: value}, {response: derivatives}; the basis is that of the design if none is given."""
        self.evaluations += 1
        body, of_elements = self.sheet.body(thickness, basis)
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "rod.json").write_text(json.dumps(body))
            with pleuel.load(self.document, folder=folder) as problem:
                values = problem.response_values()
                gradients = problem.by_invariants("rod") if derivatives else {}
        return values, {name: chain(gradient, of_elements) for name, gradient in gradients.items()}


def check(rod, thickness, basis=None):
    """The largest error of a derivative of the bow by ten thicknesses against differences, relative to the largest. With a
    basis that stays the derivatives are exact."""
    slopes = rod(thickness, True, basis)[1]["bow"]
    chosen = np.linspace(0, thickness.size - 1, 10).astype(int)
    found = []
    for i in chosen:
        change = 1e-3 * thickness[i] * np.eye(thickness.size)[i]
        sides = [rod(thickness + side * change, False, basis)[0]["bow"] for side in (1, -1)]
        found.append((sides[0] - sides[1]) / (2e-3 * thickness[i]))
    return np.abs(np.array(found) - slopes[chosen]).max() / np.abs(slopes).max()


def stiffest(rod, start, evaluations):
    """The least bow for the mass of the start, by the method of moving asymptotes; thicknesses in millimetres, bow and mass
    relative to those of the start."""
    import nlopt

    values = rod(start, False)[0]
    known = {}

    def at(t):
        key = t.tobytes()
        if key not in known:
            known.clear()
            known[key] = rod(1e-3 * t)
        return known[key]

    def relative(name, limit):
        def function(t, gradient):
            found, slopes = at(t)
            if gradient.size:
                gradient[:] = 1e-3 * slopes[name] / values[name]
            return found[name] / values[name] - limit

        return function

    solver = nlopt.opt(nlopt.LD_MMA, start.size)
    solver.set_lower_bounds(1e3 * LEAST)
    solver.set_upper_bounds(1e3 * MOST)
    solver.set_min_objective(relative("bow", 0.0))
    solver.add_inequality_constraint(relative("mass", 1.0), 1e-6)
    solver.set_maxeval(evaluations)
    solver.set_ftol_rel(1e-5)
    return 1e-3 * solver.optimize(1e3 * start), values


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elements", type=int, nargs=2, default=[36, 6])
    parser.add_argument("--evaluations", type=int, default=60)
    parser.add_argument("--check", action="store_true", help="derivatives against differences, and nothing else")
    options = parser.parse_args()
    rod = Rod(Sheet(*options.elements))
    start = np.full(np.prod(options.elements), MOST / 2)
    if options.check:
        print(f"derivatives of the bow: {check(rod, start):.1e} off, relative to the largest")
        return
    found, before = stiffest(rod, start, options.evaluations)
    after = rod(found, False)[0]
    print(f"{start.size} thicknesses, {rod.evaluations} simulations")
    for name in before:
        print(f"{name}: {before[name]:.6g} -> {after[name]:.6g} ({100 * (after[name] / before[name] - 1):+.1f} %)")
    for row in found.reshape(options.elements).T[::-1]:
        print("".join("·-+*#@"[int(5.99 * (t - LEAST) / (MOST - LEAST + 1e-12))] for t in row))


if __name__ == "__main__":
    main()
