#!/usr/bin/env python3
"""Makes the connecting rod for a design: gmsh -> CalculiX -> pleuel reduce (see solid.py).

The mesh of the first design is moved to the others, so that its nodes stay the same ones: no noise of re-meshing, and the
same points of stress. Needs gmsh besides (Debian package gmsh).
"""

import os

from solid import HERE, generate, reduced, require, run

SIZE = os.environ.get("CONROD_SIZE", "0.006")  # of elements [m]

LENGTH, BIG, SMALL, HALF = 0.150, 0.024, 0.011, 0.011  # radii of the bores, half the height of the eyes
FIRST = {"width": 0.030, "web": 0.008, "flange": 0.004}  # that conrod.geo draws
TAPER = 22.0 / 30.0  # width at the small end
SHANK = (0.029, 0.037, 0.127, 0.133)  # where the shank begins, is whole, is whole still, and ends


def read_mesh(path):
    """Nodes {number: [x, y, z]} and tetrahedra with ten nodes."""
    nodes, elements, mode = {}, [], ""
    for line in path.read_text().splitlines():
        if line.startswith("*"):
            card = line.upper().replace(" ", "")
            mode = "node" if card.startswith("*NODE") else "element" if "TYPE=C3D10" in card else ""
            continue
        if mode == "node":
            number, *place = line.split(",")
            nodes[int(number)] = [float(x) for x in place]
        elif mode == "element":
            elements.append([int(n) for n in line.split(",")[1:]])
    return nodes, elements


def mirror(nodes, elements):
    """Adds the lower half: an exact mirror image, so that the body has a plane of symmetry."""
    other, last = {}, max(nodes)
    for number, (x, y, z) in list(nodes.items()):
        other[number] = number
        if abs(z) > 1e-9:
            last += 1
            other[number] = last
            nodes[last] = [x, y, -z]
        else:
            nodes[number][2] = 0.0
    turned = [1, 0, 2, 3, 4, 6, 5, 8, 7, 9]  # two corners change places: else it would be inside out
    return elements + [[other[element[i]] for i in turned] for element in elements]


def smooth(t):
    t = min(max(t, 0.0), 1.0)
    return t * t * (3.0 - 2.0 * t)


def stretched(value, old, new, old_end, new_end):
    """0 … old … old_end goes to 0 … new … new_end, linearly in both parts."""
    if value <= old:
        return value * new / old
    return new + (value - old) * (new_end - new) / (old_end - old)


def in_shank(place):
    """Where nodes move with the design: all designs have the same straight edges there."""
    return SHANK[0] < place[0] < SHANK[3]


def move(place, design):
    """A node of the first design in another one."""
    x, y, z = place
    part = smooth((x - SHANK[0]) / (SHANK[1] - SHANK[0])) * smooth((SHANK[3] - x) / (SHANK[3] - SHANK[2]))
    if not in_shank(place):
        return place
    taper = 1.0 + (TAPER - 1.0) * x / LENGTH

    def half_pocket(of):
        return 0.5 * TAPER * of["width"] - of["flange"]

    new_y = stretched(abs(y), half_pocket(FIRST), half_pocket(design), 0.5 * taper * FIRST["width"],
                      0.5 * taper * design["width"])
    new_z = stretched(abs(z), 0.5 * FIRST["web"], 0.5 * design["web"], HALF, HALF)
    sign = lambda value: -1.0 if value < 0.0 else 1.0
    return [x, y + part * (sign(y) * new_y - y), z + part * (sign(z) * new_z - z)]


EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))


def move_mesh(nodes, elements, design):
    """All nodes in another design. Edges of which an end moves are straight: their middle could leave the element."""
    moved = {n: move(place, design) for n, place in nodes.items()}
    for element in elements:
        for (a, b), n in zip(EDGES, element[4:]):
            a, b = element[a], element[b]
            if in_shank(nodes[a]) or in_shank(nodes[b]):
                moved[n] = [0.5 * (moved[a][k] + moved[b][k]) for k in range(3)]
    return moved


def stress_nodes(nodes, elements):
    """Corners on the flanks of the shank, in the middle plane and on the upper edge, by the first design."""
    corners = sorted({n for element in elements for n in element[:4]})
    flank = []
    for n in corners:
        x, y, z = nodes[n]
        half = 0.5 * FIRST["width"] * (1.0 + (TAPER - 1.0) * x / LENGTH)
        if 0.036 < x < 0.130 and abs(abs(y) - half) < 1e-6 and (abs(z) < 1e-6 or abs(z - 0.0088) < 1e-6):
            flank.append(n)
    return flank[:: max(1, len(flank) // 24)]


def model():
    def bore(x, radius):
        return {"nodes": {"cylinder": {"from": [x, 0, -HALF], "to": [x, 0, HALF], "radius": radius}}, "kind": "rigid",
                "at": [x, 0, 0]}

    return {"body": "rod", "description": "connecting rod of steel (problems/conrod)",
            "interfaces": {"big end": bore(0.0, BIG), "small end": bore(LENGTH, SMALL)}, "modes": {"inertia_responses": 2},
            "damping": "2e-6 s", "surface": 2000,
            "stress": {"nodes": {"shank": "POINTS"}, "strength": "400 MPa", "ultimate_strength": "650 MPa",
                       "endurance_limit": "260 MPa"},
            "stiffening": {"from": "big end", "to": "small end", "elements": 8}, "plane": "z = 0"}


def make(design, folder):
    require(("gmsh", "gmsh"), ("ccx", "calculix-ccx"))
    run(["gmsh", "-3", str(HERE / "conrod.geo"), "-setnumber", "h", SIZE, "-format", "inp", "-o", "mesh.inp"], folder)
    nodes, elements = read_mesh(folder / "mesh.inp")
    elements = mirror(nodes, elements)
    sets = {"POINTS": stress_nodes(nodes, elements)}
    return reduced(folder, "C3D10", move_mesh(nodes, elements, design), elements, sets, model())


if __name__ == "__main__":
    generate(make, FIRST)
