#!/usr/bin/env python3
"""Writes a file of invariants (docs/invariants.md) for a straight planar rod of rectangular section.

An example of how the body of another finite-element code comes to Pleuel: Euler-Bernoulli elements
in the x-y plane, all integrals by quadrature, derivatives with respect to the height of the section
by central differences. It needs the standard library only.

    python3 planar_rod.py rod.json        # the rod of problems/slider_crank.json
"""

import argparse
import json
import math
import sys

GAUSS = [  # places in 0 ... 1 and weights; exact up to degree 7
    (0.5 - math.sqrt(3 / 7 + 2 / 7 * math.sqrt(6 / 5)) / 2, (18 - math.sqrt(30)) / 72),
    (0.5 - math.sqrt(3 / 7 - 2 / 7 * math.sqrt(6 / 5)) / 2, (18 + math.sqrt(30)) / 72),
    (0.5 + math.sqrt(3 / 7 - 2 / 7 * math.sqrt(6 / 5)) / 2, (18 + math.sqrt(30)) / 72),
    (0.5 + math.sqrt(3 / 7 + 2 / 7 * math.sqrt(6 / 5)) / 2, (18 - math.sqrt(30)) / 72),
]
NODAL = 3  # u, v, theta


class Matrix(dict):
    """Entries {(row, column): value} that are not zero."""

    def add(self, row, column, value):
        if value != 0.0:
            self[row, column] = self.get((row, column), 0.0) + value

    def add_product(self, factor, left, right):
        """factor * left^T right of two rows {column: value}."""
        for i, a in left.items():
            for j, b in right.items():
                self.add(i, j, factor * a * b)


class Rod:
    def __init__(self, arguments, height):
        self.length, self.elements = arguments.length, arguments.elements
        self.young, self.density = arguments.young, arguments.density
        self.damping = arguments.damping
        self.width, self.height = arguments.width, height
        self.area = self.width * height
        self.inertia = self.width * height**3 / 12
        self.size = self.length / self.elements
        # Chord: the frame goes through both end nodes, so that u_0 = v_0 = v_N = 0.
        clamped = {0, 1, NODAL * self.elements + 1}
        free = [i for i in range(NODAL * (self.elements + 1)) if i not in clamped]
        self.index = {nodal: i for i, nodal in enumerate(free)}
        self.names = [f"{'uvt'[i % NODAL]} of node {i // NODAL}" for i in free]

    def row(self, element, values):
        """The six values of an element as a row of the free coordinates."""
        first = NODAL * element
        return {self.index[first + i]: value for i, value in enumerate(values)
                if first + i in self.index and value != 0.0}

    def u(self, element, xi):
        return self.row(element, [1 - xi, 0, 0, xi, 0, 0])

    def v(self, element, xi, order=0):
        """Hermite polynomials, differentiated with respect to x."""
        l = self.size
        return self.row(element, [
            [0, 1 - 3 * xi**2 + 2 * xi**3, l * (xi - 2 * xi**2 + xi**3),
             0, 3 * xi**2 - 2 * xi**3, l * (xi**3 - xi**2)],
            [0, (6 * xi**2 - 6 * xi) / l, 1 - 4 * xi + 3 * xi**2,
             0, (6 * xi - 6 * xi**2) / l, 3 * xi**2 - 2 * xi],
            [0, (12 * xi - 6) / l**2, (6 * xi - 4) / l,
             0, (6 - 12 * xi) / l**2, (6 * xi - 2) / l]][order])

    def invariants(self):
        shape, mixed = Matrix(), Matrix()
        xx, yy, xy, stiffness = Matrix(), Matrix(), Matrix(), Matrix()
        line, rotary = self.density * self.area, self.density * self.inertia
        for element in range(self.elements):
            for xi, weight in GAUSS:
                dx = weight * self.size
                x = (element + xi) * self.size
                u, v, slope = self.u(element, xi), self.v(element, xi), self.v(element, xi, 1)
                for column, value in u.items():
                    shape.add(0, column, line * dx * value)
                    mixed.add(0, column, line * dx * x * value)  # x, u
                for column, value in v.items():
                    shape.add(1, column, line * dx * value)
                    mixed.add(1, column, line * dx * x * value)  # x, v
                for column, value in slope.items():
                    mixed.add(3, column, -rotary * dx * value)  # y, u = -y v'
                xx.add_product(line * dx, u, u)
                xx.add_product(rotary * dx, slope, slope)
                yy.add_product(line * dx, v, v)
                xy.add_product(line * dx, u, v)
                bending = self.v(element, xi, 2)
                stiffness.add_product(self.young * self.inertia * dx, bending, bending)
            stretch = self.row(element, [-1, 0, 0, 1, 0, 0])
            stiffness.add_product(self.young * self.area / self.size, stretch, stretch)
        mass_matrix, damping = Matrix(xx), Matrix()
        for place, value in yy.items():
            mass_matrix.add(*place, value)
        for place, value in stiffness.items():
            damping.add(*place, self.damping * value)
        mass = line * self.length
        across = self.density * self.height * self.width**3 / 12
        return {
            "mass": mass,
            "first_moment": [mass * self.length / 2, 0.0, 0.0],
            "second_moment": [[mass * self.length**2 / 3, 0.0, 0.0],
                              [0.0, rotary * self.length, 0.0],
                              [0.0, 0.0, across * self.length]],
            "shape": shape, "mixed": mixed,
            "moment_xx": xx, "moment_yy": yy, "moment_xy": xy,
            "mass_matrix": mass_matrix, "stiffness": stiffness, "damping": damping,
        }

    def places(self):
        places = {}
        for node in range(self.elements + 1):
            displacement, rotation = Matrix(), Matrix()
            for row, matrix in enumerate([displacement, displacement, rotation]):
                nodal = NODAL * node + row
                if nodal in self.index:
                    matrix.add(row, self.index[nodal], 1.0)
            places[f"node {node}"] = {"position": [node * self.size, 0.0, 0.0],
                                      "displacement": displacement, "rotation": rotation}
        return places

    def stress(self):
        """sigma = E (u' -+ h/2 v'') at both ends of every element, above and below."""
        points, rows = [], Matrix()
        for element in range(self.elements):
            for xi in (0, 1):
                for sign in (1, -1):
                    for column, value in self.v(element, xi, 2).items():
                        rows.add(6 * len(points), column,
                                 -sign * self.young * self.height / 2 * value)
                    stretch = self.row(element, [-1, 0, 0, 1, 0, 0])
                    for column, value in stretch.items():
                        rows.add(6 * len(points), column, self.young / self.size * value)
                    points.append(f"node {element + xi} of element {element}, side {sign}")
        return {"points": points, "of_coordinates": rows}

    def stiffening(self):
        """Von Karman's strain, averaged over each element: slopes of v only."""
        elements = []
        for element in range(self.elements):
            slopes = Matrix()
            for xi, weight in GAUSS:
                row = self.v(element, xi, 1)
                slopes.add_product(weight * self.size, row, row)
            stretch = self.row(element, [-1, 0, 0, 1, 0, 0])
            first = NODAL * element
            local = [self.index[i] for i in range(first, first + 2 * NODAL) if i in self.index]
            elements.append({
                "displacements": local,
                "elongation": [stretch.get(i, 0.0) for i in local],
                "axial_stiffness": self.young * self.area / self.size,
                "slopes": [[slopes.get((i, j), 0.0) for j in local] for i in local],
            })
        return {"damping": self.damping, "size": len(self.index),
                "displacements": Matrix({(i, i): 1.0 for i in range(len(self.index))}),
                "elements": elements}

    def blocks(self):
        return {"invariants": self.invariants(), "places": self.places(),
                "stress": self.stress(), "stiffening": self.stiffening()}


FIXED = {"points", "size", "elongation"}  # what a derivative does not repeat


def difference(a, b, step):
    """(a - b) / step of numbers inside objects, lists and matrices."""
    if isinstance(a, Matrix):
        return Matrix({key: (a.get(key, 0.0) - b.get(key, 0.0)) / step for key in {*a, *b}})
    if isinstance(a, dict):
        return {key: difference(a[key], b[key], step) for key in a
                if key not in FIXED and not (key == "displacements" and isinstance(a[key], list))}
    if isinstance(a, list):
        return [difference(x, y, step) for x, y in zip(a, b)]
    return (a - b) / step


def as_json(value):
    """Matrices as [row, column, value]."""
    if isinstance(value, Matrix):
        return [[i, j, entry] for (i, j), entry in sorted(value.items()) if entry != 0.0]
    if isinstance(value, dict):
        return {key: as_json(member) for key, member in value.items()}
    return value


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("output", help="a file; or -: reads {\"variables\": {NAME: height}} from standard input and "
                                       "writes to standard output, as the generator of a body does")
    parser.add_argument("--length", type=float, default=0.18, help="[m]")
    parser.add_argument("--width", type=float, default=0.02, help="across the plane [m]")
    parser.add_argument("--height", type=float, default=0.03, help="in the plane [m]")
    parser.add_argument("--young", type=float, default=210e9, help="[Pa]")
    parser.add_argument("--density", type=float, default=7850.0, help="[kg/m^3]")
    parser.add_argument("--damping", type=float, default=1e-5, help="of D = damping K [s]")
    parser.add_argument("--elements", type=int, default=6)
    parser.add_argument("--variable", default="rod_height", help="the design variable of the height")
    arguments = parser.parse_args()
    is_generator = arguments.output == "-"
    if is_generator:
        arguments.height = json.load(sys.stdin)["variables"][arguments.variable]
    rod = Rod(arguments, arguments.height)
    step = 1e-4 * arguments.height
    above, below = Rod(arguments, arguments.height + step), Rod(arguments, arguments.height - step)
    document = {"format": "pleuel-invariants", "version": 1, "body": "rod", "units": "SI",
                "reference_condition": "chord", "coordinates": rod.names, **rod.blocks(),
                "design": {arguments.variable: {"value": arguments.height, "unit": "m"}},
                "derivatives": {arguments.variable:
                                difference(above.blocks(), below.blocks(), 2 * step)}}
    with sys.stdout if is_generator else open(arguments.output, "w", encoding="utf-8") as stream:
        json.dump(as_json(document), stream, indent=1)


if __name__ == "__main__":
    main()
