#!/usr/bin/env python3
"""Makes the rod of a slider-crank, a block of hexahedra that tapers in its height, for a design (see solid.py)."""

from solid import generate, reduced, require

LENGTH = 0.18
FIRST = {"height": 0.030, "end_height": None, "width": 0.020}  # at the crank pin, at the slider (else the same); across
ALONG, UP, ACROSS = 18, 4, 2  # elements

# Nodes of C3D20 in a cell of 2 x 2 x 2 steps: corners, then the middles of edges.
CELL = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2),
        (1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2),
        (0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)]


def mesh(design):
    """Nodes {number: place}, elements, and sets of nodes: both ends, and points of stress on the flanks."""
    numbers, nodes, elements, points = {}, {}, [], []
    end_height = design["end_height"] or design["height"]

    def number(i, j, k):
        if (i, j, k) not in numbers:
            n = numbers[i, j, k] = len(numbers) + 1
            share = i / (2 * ALONG)
            height = design["height"] + share * (end_height - design["height"])
            nodes[n] = (LENGTH * share, height * (j / (2 * UP) - 0.5), design["width"] * (k / (2 * ACROSS) - 0.5))
            if 4 <= i <= 2 * ALONG - 4 and i % 2 == 0 and j in (0, 2 * UP) and k == ACROSS:
                points.append(n)
        return numbers[i, j, k]

    for i in range(ALONG):
        for j in range(UP):
            for k in range(ACROSS):
                elements.append([number(2 * i + a, 2 * j + b, 2 * k + c) for a, b, c in CELL])
    ends = {name: [n for (i, _, _), n in numbers.items() if i == at] for name, at in (("BIG", 0), ("SMALL", 2 * ALONG))}
    return nodes, elements, {**ends, "POINTS": points}


def make(design, folder):
    require(("ccx", "calculix-ccx"))
    model = {"body": "rod", "description": "block of steel (problems/conrod)",
             "interfaces": {"big end": {"nodes": "BIG", "kind": "rigid", "at": [0, 0, 0]},
                            "small end": {"nodes": "SMALL", "kind": "rigid", "at": [LENGTH, 0, 0]}},
             "places": {"middle": {"nodes": {"box": [[0.45 * LENGTH, -1, -1], [0.55 * LENGTH, 1, 1]]}}},
             "modes": {"inertia_responses": 2}, "damping": "1e-5 s", "stress": {"nodes": "POINTS", "strength": "400 MPa"},
             "stiffening": {"from": "big end", "to": "small end", "elements": 12}, "plane": "z = 0"}
    return reduced(folder, "C3D20", *mesh(design), model)


if __name__ == "__main__":
    generate(make, FIRST)
