#!/usr/bin/env python3
"""Draws what bench/drift measures: how constraints and their sensitivities drift.

    build/bench/bench/drift > drift.csv
    docs/draw_drift.py drift.csv > docs/drift.svg
"""
import csv
import math
import sys

WIDTH, HEIGHT = 420, 300  # of a panel [pixels]
LOWEST, HIGHEST = -19, 1  # powers of ten
COLOURS = ["#4c78a8", "#54a24b", "#e45756", "#f58518", "#7b5ea7"]
DASHES = ["", "6 3", "", "6 3", "2 2"]


def read(path):
    """{formulation: [(time, position, sensitivity)]} in the order of the file"""
    curves = {}
    with open(path, encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            numbers = tuple(float(row[key]) for key in ("time", "position", "sensitivity"))
            curves.setdefault(row["formulation"], []).append(numbers)
    return curves


def height_of(value):
    power = math.log10(value) if value > 0 else LOWEST
    return HEIGHT * (HIGHEST - max(power, LOWEST)) / (HIGHEST - LOWEST)


def text(x, y, words, anchor="middle", more=""):
    return f'<text x="{x:.0f}" y="{y:.0f}" text-anchor="{anchor}" {more}>{words}</text>'


def axes(title, unit, end):
    parts = [text(WIDTH / 2, -32, title, more='font-size="16"'),
             text(WIDTH / 2, -13, unit, more='fill="#555"')]
    for power in range(LOWEST, HIGHEST + 1, 2):
        y = height_of(10.0**power)
        parts.append(f'<path d="M0 {y:.0f}H{WIDTH}" stroke="#ddd"/>')
        parts.append(text(-8, y + 4, f'10<tspan dy="-5" font-size="10">{power}</tspan>', "end"))
    for tenth in range(0, 11, 2):
        x = WIDTH * tenth / 10
        parts.append(f'<path d="M{x:.0f} {HEIGHT}v5" stroke="#333"/>')
        parts.append(text(x, HEIGHT + 20, f"{end * tenth / 10:g}"))
    parts.append(text(WIDTH / 2, HEIGHT + 38, "time [s]"))
    parts.append(f'<path d="M0 0V{HEIGHT}H{WIDTH}" fill="none" stroke="#333"/>')
    return parts


def curve(points, column, end, style):
    places = [f"{WIDTH * p[0] / end:.1f} {height_of(p[column]):.1f}" for p in points]
    colour, dash = style
    return (f'<polyline points="{" ".join(places)}" fill="none" stroke="{colour}" '
            f'stroke-width="1.8" stroke-dasharray="{dash}"/>')


def legend(names, styles):
    parts = []
    x = 0
    for name, (colour, dash) in zip(names, styles):
        parts.append(f'<path d="M{x} 0h36" stroke="{colour}" stroke-width="2.5" '
                     f'stroke-dasharray="{dash}"/>')
        parts.append(text(x + 44, 5, name, "start"))
        x += 78 + 7 * len(name)
    return parts


def main():
    curves = read(sys.argv[1])
    end = max(points[-1][0] for points in curves.values())
    styles = list(zip(COLOURS, DASHES))
    print('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1020 450" '
          'font-family="sans-serif" font-size="13">')
    print('<rect width="1020" height="450" fill="#fff"/>')
    panels = [("constraints", "|Φ| [m or rad]"),
              ("their sensitivities", "|dΦ/dx| x [m or rad], per relative change of the variable")]
    for i, (title, unit) in enumerate(panels):
        print(f'<g transform="translate({70 + i * 510} 55)">')
        print("\n".join(axes(title, unit, end)))
        for points, style in zip(curves.values(), styles):
            print(curve(points, i + 1, end, style))
        print("</g>")
    print('<g transform="translate(20 425)">')
    print("\n".join(legend(curves, styles)))
    print("</g>\n</svg>")


main()
