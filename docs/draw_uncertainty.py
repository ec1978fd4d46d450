#!/usr/bin/env python3
"""Draws what uncertain parameters make of the responses: first order beside Monte Carlo.

    ./pleuel uncertainty problems/slider_crank.json --histories -o run
    docs/draw_uncertainty.py run rod_bow crank_tip > docs/uncertainty.svg

Above, every response in units of its first-order deviation; below, the histories that are named, and
their deviations over time.
"""
import csv
import json
import sys

FIRST, SAMPLED = "#4c78a8", "#f58518"
LEFT, WIDTH, ROW = 150, 780, 30  # of the upper part
PLOT_WIDTH, PLOT_HEIGHT, GAP = 440, 120, 90


def text(x, y, content, anchor="start", size=13, colour="#222"):
    return (
        f'<text x="{x:.1f}" y="{y:.1f}" font-family="sans-serif" font-size="{size}" '
        f'text-anchor="{anchor}" fill="{colour}">{content}</text>'
    )


def line(x1, y1, x2, y2, colour="#333", width=1.5):
    return (
        f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}" '
        f'stroke-width="{width}"/>'
    )


def bar(x, y, middle, deviation, low, high, colour):
    """One deviation to either side as a bar, the range as a line; x maps to pixels."""
    left, right = x(middle - deviation), x(middle + deviation)
    return [
        line(x(low), y, x(high), y, colour),
        line(x(low), y - 4, x(low), y + 4, colour),
        line(x(high), y - 4, x(high), y + 4, colour),
        f'<rect x="{left:.1f}" y="{y - 5:.1f}" width="{right - left:.1f}" height="10" '
        f'fill="{colour}" fill-opacity="0.75"/>',
        line(x(middle), y - 6, x(middle), y + 6, "#fff", 2),
    ]


def ranges(responses, top):
    def in_deviations(response, value):
        return (value - response["value"]) / response["deviation"]

    def ends(response):
        values = list(response["bounds"])
        if "sampled" in response:
            values += [response["sampled"]["lowest"], response["sampled"]["highest"]]
        return [in_deviations(response, value) for value in values]

    largest = max(abs(end) for response in responses.values() for end in ends(response))
    half = int(largest) + 1

    def x(value):
        return LEFT + WIDTH * (value + half) / (2 * half)

    bottom = top + ROW * len(responses)
    parts = []
    for tick in range(-half, half + 1):
        parts.append(line(x(tick), top, x(tick), bottom, "#aaa" if tick == 0 else "#e4e4e4", 1))
        if tick % 2 == 0:
            parts.append(text(x(tick), bottom + 16, f"{tick} σ" if tick else "value", "middle", 12))
    for i, (name, response) in enumerate(responses.items()):
        y = top + ROW * (i + 0.5)
        parts.append(text(LEFT - 10, y + 4, name, "end"))
        low, high = (in_deviations(response, end) for end in response["bounds"])
        parts += bar(x, y - 6, 0.0, 1.0, low, high, FIRST)
        if "sampled" in response:
            sampled = response["sampled"]
            parts += bar(
                x, y + 7, in_deviations(response, sampled["mean"]),
                sampled["deviation"] / response["deviation"],
                in_deviations(response, sampled["lowest"]),
                in_deviations(response, sampled["highest"]), SAMPLED,
            )
    return parts


def curve(time, values, x, y, colour, dashes=""):
    points = " ".join(f"{x(t):.1f},{y(v):.2f}" for t, v in zip(time, values))
    return (
        f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.4" '
        f'stroke-dasharray="{dashes}"/>'
    )


def plot(left, top, time, curves, label):
    """curves: (values, colour, dashes); their common range fills the height."""
    low = min(0.0, min(min(values) for values, _, _ in curves))
    high = max(max(values) for values, _, _ in curves)

    def x(t):
        return left + PLOT_WIDTH * t / time[-1]

    def y(v):
        return top + PLOT_HEIGHT * (high - v) / (high - low)

    parts = [
        f'<rect x="{left}" y="{top}" width="{PLOT_WIDTH}" height="{PLOT_HEIGHT}" fill="none" '
        'stroke="#bbb"/>',
        line(left, y(0.0), left + PLOT_WIDTH, y(0.0), "#ddd", 1),
        text(left, top - 7, label),
        text(left + PLOT_WIDTH, top - 7, f"largest {max(high, -low):.3g}", "end", 12),
        text(left + PLOT_WIDTH, top + PLOT_HEIGHT + 16, f"{time[-1] * 1e3:.4g} ms", "end", 12),
    ]
    return parts + [curve(time, values, x, y, colour, dashes) for values, colour, dashes in curves]


def histories(run, names, responses, top):
    with open(f"{run}/uncertainty.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    step = max(1, len(rows) // 300)  # points of a curve
    rows = rows[::step]
    time = [float(row["time"]) for row in rows]

    def column(name):
        return [float(row[name]) for row in rows] if name in rows[0] else None

    parts = []
    for i, name in enumerate(names):
        left, unit = 30 + i * (PLOT_WIDTH + 30), responses[name]["unit"]
        parts += plot(left, top, time, [(column(name), "#333", "")], f"{name} [{unit}]")
        deviations = [(column(f"{name}:deviation"), FIRST, "")]
        sampled = column(f"{name}:sampled_deviation")
        if sampled:
            deviations.append((sampled, SAMPLED, "5 3"))
        below = top + PLOT_HEIGHT + GAP / 2
        parts += plot(left, below, time, deviations, f"its deviation [{unit}]")
    return parts


def main():
    run, names = sys.argv[1], sys.argv[2:]
    with open(f"{run}/result.json", encoding="utf-8") as file:
        result = json.load(file)
    responses = {n: r for n, r in result["responses"].items() if r["deviation"] > 0.0}
    top = 50
    below = top + ROW * len(responses) + 70
    height = below + (2 * PLOT_HEIGHT + GAP if names else -40)
    width = max(LEFT + WIDTH + 40, 30 + len(names) * (PLOT_WIDTH + 30))
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}">',
        f'<rect width="{width:.0f}" height="{height:.0f}" fill="#fff"/>',
        text(LEFT, 28, "first order: deviation (bar), bounds (line)", colour=FIRST),
        text(LEFT + 320, 28, f'{result["samples"]} samples: mean, deviation, range',
             colour=SAMPLED),
    ]
    parts += ranges(responses, top)
    if names:
        parts += histories(run, names, responses, below)
    print("\n".join(parts + ["</svg>"]))


main()
