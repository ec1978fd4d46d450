#!/usr/bin/env python3
"""Draws the slider-crank of problems/slider_crank.json before and after its optimization.

    ./pleuel optimize problems/slider_crank.json -o run
    docs/draw_optimum.py run/result.json > docs/slider_crank.svg

Heights of the members and the picture of the mechanism are to the same scale.
"""
import json
import math
import sys

CRANK, ROD = 0.120, 0.180  # lengths [m]
ANGLE = math.radians(50)  # of the crank in the picture
SCALE = 1900.0  # pixels per metre


def member(start, end, height, colour):
    """A beam from start to end [m] as a rectangle of that height [m]."""
    length = math.dist(start, end)
    turn = math.degrees(math.atan2(end[1] - start[1], end[0] - start[0]))
    return (
        f'<rect x="0" y="{-height / 2 * SCALE:.1f}" width="{length * SCALE:.1f}" '
        f'height="{height * SCALE:.1f}" rx="3" fill="{colour}" fill-opacity="0.85" stroke="#333" '
        f'transform="translate({start[0] * SCALE:.1f} {-start[1] * SCALE:.1f}) '
        f'rotate({-turn:.2f})"/>'
    )


def pin(point):
    return (
        f'<circle cx="{point[0] * SCALE:.1f}" cy="{-point[1] * SCALE:.1f}" r="6" fill="#fff" '
        f'stroke="#333" stroke-width="2"/>'
    )


def mechanism(heights, mass, title, origin):
    pin_point = (CRANK * math.cos(ANGLE), CRANK * math.sin(ANGLE))
    slider = (pin_point[0] + math.sqrt(ROD**2 - pin_point[1] ** 2), 0.0)
    x, size = slider[0] * SCALE, 0.030 * SCALE
    parts = [
        f'<g transform="translate({origin[0]} {origin[1]})">',
        f'<line x1="{x - 60:.0f}" y1="{size / 2 + 2:.0f}" x2="{x + 60:.0f}" y2="{size / 2 + 2:.0f}" '
        f'stroke="#333" stroke-width="2"/>',
        f'<rect x="{x - size / 2:.1f}" y="{-size / 2:.1f}" width="{size:.1f}" height="{size:.1f}" '
        f'fill="#cfd8dc" stroke="#333"/>',
        member((0, 0), pin_point, heights[0], "#4c78a8"),
        member(pin_point, slider, heights[1], "#f58518"),
        pin((0, 0)), pin(pin_point), pin(slider),
        f'<text x="-20" y="60" font-family="sans-serif" font-size="17">{title}: {mass:.3f} kg</text>',
        "</g>",
    ]
    return "\n".join(parts)


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        result = json.load(file)
    variables = result["variables"]

    def heights(key):
        return [variables[f"{name}_height"][key] for name in ("crank", "rod")]

    print('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1110 310">')
    print('<rect width="1110" height="310" fill="#fff"/>')
    objective = result["objective"]
    print(mechanism(heights("start"), objective["start"], "start", (70, 230)))
    print(mechanism(heights("value"), objective["value"], "optimum", (640, 230)))
    print("</svg>")


main()
