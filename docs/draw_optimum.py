#!/usr/bin/env python3
"""Draws the slider-crank of problems/slider_crank.json before and after its optimization, turning.

    ./pleuel optimize problems/slider_crank.json -o run
    docs/draw_optimum.py run/result.json > docs/slider_crank.svg

Heights of the members and the picture of the mechanism are to the same scale.
"""
import json
import math
import sys

CRANK, ROD = 0.120, 0.180  # lengths [m]
ANGLE = math.radians(50)  # of the crank where pictures do not move, and at the beginning
SCALE = 1900.0  # pixels per metre
FRAMES = 60  # of a turn
SECONDS = 4  # of a turn in the picture; the machine takes 31 ms


def places(angle):
    """Crank pin and slider [m]."""
    pin_point = (CRANK * math.cos(angle), CRANK * math.sin(angle))
    return pin_point, (pin_point[0] + math.sqrt(ROD**2 - pin_point[1] ** 2), 0.0)


TURN = [places(ANGLE + 2 * math.pi * i / FRAMES) for i in range(FRAMES + 1)]


def moved(kind, values, content):
    """A group that goes through these values of a transform, again and again."""
    return (
        f'<g transform="{kind}({values[0]})"><animateTransform attributeName="transform" type="{kind}" '
        f'dur="{SECONDS}s" repeatCount="indefinite" values="{";".join(values)}"/>{content}</g>'
    )


def at(points, content):
    return moved("translate", [f"{x * SCALE:.1f} {-y * SCALE:.1f}" for x, y in points], content)


def member(starts, ends, height, colour):
    """A beam from starts to ends [m] as a rectangle of that height [m]."""
    length = math.dist(starts[0], ends[0])
    turns = [math.degrees(math.atan2(b[1] - a[1], b[0] - a[0])) for a, b in zip(starts, ends)]
    for i in range(1, len(turns)):  # on without a jump
        turns[i] += 360 * round((turns[i - 1] - turns[i]) / 360)
    rectangle = (
        f'<rect x="0" y="{-height / 2 * SCALE:.1f}" width="{length * SCALE:.1f}" '
        f'height="{height * SCALE:.1f}" rx="3" fill="{colour}" fill-opacity="0.85" stroke="#333"/>'
    )
    return at(starts, moved("rotate", [f"{-turn:.2f}" for turn in turns], rectangle))


def pin(points):
    return at(points, '<circle r="6" fill="#fff" stroke="#333" stroke-width="2"/>')


def mechanism(heights, mass, title, origin):
    bearing = [(0.0, 0.0)] * len(TURN)
    pins = [pin_point for pin_point, _ in TURN]
    sliders = [slider for _, slider in TURN]
    size = 0.030 * SCALE
    first, last = (ROD - CRANK) * SCALE - 45, (ROD + CRANK) * SCALE + 45
    parts = [
        f'<g transform="translate({origin[0]} {origin[1]})">',
        f'<line x1="{first:.0f}" y1="{size / 2 + 2:.0f}" x2="{last:.0f}" y2="{size / 2 + 2:.0f}" '
        f'stroke="#333" stroke-width="2"/>',
        at(sliders, f'<rect x="{-size / 2:.1f}" y="{-size / 2:.1f}" width="{size:.1f}" height="{size:.1f}" fill="#cfd8dc" stroke="#333"/>'),
        member(bearing, pins, heights[0], "#4c78a8"),
        member(pins, sliders, heights[1], "#f58518"),
        pin(bearing), pin(pins), pin(sliders),
        f'<text x="150" y="-215" font-family="sans-serif" font-size="20">{title}: {mass:.3f} kg</text>',
        "</g>",
    ]
    return "\n".join(parts)


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        result = json.load(file)
    variables = result["variables"]

    def heights(key):
        return [variables[f"{name}_height"][key] for name in ("crank", "rod")]

    print('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1810 560">')
    print('<rect width="1810" height="560" fill="#fff"/>')
    objective = result["objective"]
    print(mechanism(heights("start"), objective["start"], "start", (280, 280)))
    print(mechanism(heights("value"), objective["value"], "optimum", (1160, 280)))
    print("</svg>")


main()
