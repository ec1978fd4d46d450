#!/usr/bin/env python3
"""Table and plot of effort and accuracy of the gradient methods.

    build/bench/bench/sensitivity_bench > sensitivity.csv
    docs/plot_sensitivity.py sensitivity.csv > docs/sensitivity.svg
    docs/plot_sensitivity.py sensitivity.csv --table
"""
import csv
import math
import sys

COLOURS = {
    "direct": "#4c78a8",
    "adjoint": "#f58518",
    "direct-coupled": "#e45756",
    "forward-difference": "#72b7b2",
}
WIDTH, HEIGHT, LEFT, TOP, GAP = 300, 260, 70, 50, 60


def read(path):
    with open(path, encoding="utf-8") as file:
        return [
            {
                "elements": int(row["elements"]),
                "variables": int(row["variables"]),
                "method": row["method"],
                "ratio": float(row["ratio"]),
                "error": float(row["error"]),
            }
            for row in csv.DictReader(file)
        ]


def table(rows):
    methods = list(COLOURS)
    print("| elements a member | variables | " + " | ".join(methods) + " |")
    print("|---|---|" + "---|" * len(methods))
    cases = sorted({(row["elements"], row["variables"]) for row in rows})
    for elements, variables in cases:
        cells = []
        for method in methods:
            found = [
                row
                for row in rows
                if (row["elements"], row["variables"], row["method"])
                == (elements, variables, method)
            ]
            cells.append(f'{found[0]["ratio"]:.1f} ({found[0]["error"]:.0e})' if found else "")
        print(f"| {elements} | {variables} | " + " | ".join(cells) + " |")


def log_scale(low, high, start, length):
    return lambda value: start + length * (math.log10(value) - math.log10(low)) / (
        math.log10(high) - math.log10(low)
    )


def text(x, y, content, anchor="middle", size=13, more=""):
    return (
        f'<text x="{x:.0f}" y="{y:.0f}" font-family="sans-serif" font-size="{size}" '
        f'text-anchor="{anchor}" {more}>{content}</text>'
    )


def panel(rows, elements, left):
    """Effort against the number of variables, both logarithmic."""
    x = log_scale(3, 320, left, WIDTH)
    y = log_scale(1, 300, TOP + HEIGHT, -HEIGHT)
    parts = [
        f'<rect x="{left}" y="{TOP}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="#888"/>',
        text(left + WIDTH / 2, TOP - 12, f"{elements} elements a member", size=14),
        text(left + WIDTH / 2, TOP + HEIGHT + 40, "design variables"),
    ]
    for variables in (4, 16, 64, 256):
        parts.append(text(x(variables), TOP + HEIGHT + 18, str(variables)))
    for ratio in (1, 3, 10, 30, 100, 300):
        parts.append(
            f'<line x1="{left}" y1="{y(ratio):.1f}" x2="{left + WIDTH}" y2="{y(ratio):.1f}" '
            f'stroke="#ddd"/>'
        )
        parts.append(text(left - 8, y(ratio) + 4, str(ratio), "end"))
    for method, colour in COLOURS.items():
        points = sorted(
            (row["variables"], row["ratio"])
            for row in rows
            if row["method"] == method and row["elements"] == elements
        )
        path = " ".join(f"{x(n):.1f},{y(ratio):.1f}" for n, ratio in points)
        parts.append(
            f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2.5"/>'
        )
        parts += [
            f'<circle cx="{x(n):.1f}" cy="{y(ratio):.1f}" r="4" fill="{colour}"/>'
            for n, ratio in points
        ]
    return "\n".join(parts)


def plot(rows):
    elements = sorted({row["elements"] for row in rows})
    width = LEFT + len(elements) * (WIDTH + GAP)
    height = TOP + HEIGHT + 90
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
        f'width="{width}" height="{height}">',
        f'<rect width="{width}" height="{height}" fill="#fff"/>',
        text(20, TOP + HEIGHT / 2, "time, the simulation alone = 1",
             more=f'transform="rotate(-90 20 {TOP + HEIGHT / 2})"'),
    ]
    for i, count in enumerate(elements):
        parts.append(panel(rows, count, LEFT + i * (WIDTH + GAP)))
    x = LEFT
    for method, colour in COLOURS.items():
        parts.append(f'<circle cx="{x + 6}" cy="{height - 20}" r="5" fill="{colour}"/>')
        parts.append(text(x + 18, height - 15, method, "start"))
        x += 50 + 8 * len(method)
    parts.append("</svg>")
    print("\n".join(parts))


def main():
    rows = read(sys.argv[1])
    if "--table" in sys.argv:
        table(rows)
    else:
        plot(rows)


if __name__ == "__main__":
    main()
