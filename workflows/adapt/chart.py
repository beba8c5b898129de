#!/usr/bin/env python3
"""Error against elements of adapted, graded and uniform meshes, one chart for each section.

    chart.py MESHES.csv PICTURE.svg SECTION...

MESHES.csv is that of study.py.
"""

import csv
import math
import sys

LEFT, TOP, WIDTH, HEIGHT, BETWEEN, BELOW, LEGEND = 82, 42, 290, 300, 48, 62, 190
KINDS = (  # of the table; words, colour, dash, marker
    ("adapted to 0.001", "adapted", "#0062bd", "none", "circle"),
    ("graded", "graded by hand", "#009150", "2 4", "diamond"),
    ("uniform", "uniform", "#000000", "8 5", "square"),
)


def marker(kind, x, y, color):
    if kind == "circle":
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4.5" fill="{color}"/>'
    if kind == "square":
        return f'<rect x="{x - 4:.1f}" y="{y - 4:.1f}" width="8" height="8" fill="{color}"/>'
    return f'<path d="M{x:.1f} {y - 5.5:.1f} l5.5 5.5 l-5.5 5.5 l-5.5 -5.5 z" fill="{color}"/>'


def decades(values):
    return math.floor(math.log10(min(values)) + 1e-9), math.ceil(math.log10(max(values)) - 1e-9)


def power_text(power):
    return f'10<tspan dy="-6" font-size="11">{str(power).replace("-", "−")}</tspan>'


class Panel:
    """One chart; x and y are powers of ten at its ends."""

    def __init__(self, left, x, y):
        self.left, self.x, self.y = left, x, y

    def at(self, elements, error):
        share_x = (math.log10(elements) - self.x[0]) / (self.x[1] - self.x[0])
        share_y = (math.log10(error) - self.y[0]) / (self.y[1] - self.y[0])
        return self.left + WIDTH * share_x, TOP + HEIGHT * (1.0 - share_y)

    def axes(self, title, first):
        right, bottom = self.left + WIDTH, TOP + HEIGHT
        yield f'<text x="{self.left + WIDTH / 2}" y="{TOP - 16}" text-anchor="middle" font-size="16">{title}</text>'
        for power in range(self.x[0], self.x[1] + 1):
            x, _ = self.at(10.0**power, 10.0 ** self.y[0])
            yield f'<line x1="{x:.1f}" y1="{TOP}" x2="{x:.1f}" y2="{bottom}" stroke="#e4e4e4"/>'
            yield f'<text x="{x:.1f}" y="{bottom + 20}" text-anchor="middle">{power_text(power)}</text>'
        for power in range(self.y[0], self.y[1] + 1):
            _, y = self.at(10.0 ** self.x[0], 10.0**power)
            yield f'<line x1="{self.left}" y1="{y:.1f}" x2="{right}" y2="{y:.1f}" stroke="#e4e4e4"/>'
            if first:
                yield f'<text x="{self.left - 8}" y="{y + 5:.1f}" text-anchor="end">{power_text(power)}</text>'
        yield f'<path d="M{self.left} {TOP} V{bottom} H{right}" fill="none" stroke="#222"/>'
        yield f'<text x="{self.left + WIDTH / 2}" y="{bottom + 46}" text-anchor="middle">elements (-)</text>'
        if first:
            x, y = self.left - 56, TOP + HEIGHT / 2
            yield (f'<text transform="translate({x} {y}) rotate(-90)" text-anchor="middle">'
                   "half of the interval over its middle (-)</text>")

    def curve(self, points, color, dash, kind):
        places = [self.at(*point) for point in points]
        path = " L".join(f"{x:.1f} {y:.1f}" for x, y in places)
        yield f'<path d="M{path}" fill="none" stroke="{color}" stroke-width="1.5" stroke-dasharray="{dash}"/>'
        for x, y in places:
            yield marker(kind, x, y, color)


def chart(rows, sections):
    points = {}
    for row in rows:
        points.setdefault((row["section"], row["kind"]), []).append((float(row["elements"]), float(row["error"])))
    shown = [p for section in sections for kind, *_ in KINDS for p in points[section, kind]]
    x, y = decades([p[0] for p in shown]), decades([p[1] for p in shown])
    width = LEFT + len(sections) * (WIDTH + BETWEEN) + LEGEND
    height = TOP + HEIGHT + BELOW
    yield (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
           'font-family="DejaVu Sans, Arial, sans-serif" font-size="14" role="img" aria-labelledby="title">')
    yield f'<title id="title">Error of the discharge against the number of elements: {", ".join(sections)}</title>'
    yield f'<rect width="{width}" height="{height}" fill="white"/>'
    for number, section in enumerate(sections):
        panel = Panel(LEFT + number * (WIDTH + BETWEEN), x, y)
        yield from panel.axes(section, number == 0)
        for kind, _, color, dash, mark in KINDS:
            yield from panel.curve(points[section, kind], color, dash, mark)
    left = LEFT + len(sections) * (WIDTH + BETWEEN)
    for number, (_, words, color, dash, mark) in enumerate(KINDS):
        line = TOP + 10 + 24 * number
        yield f'<path d="M{left} {line} h40" stroke="{color}" stroke-width="1.5" stroke-dasharray="{dash}"/>'
        yield marker(mark, left + 20, line, color)
        yield f'<text x="{left + 50}" y="{line + 5}">{words}</text>'
    yield "</svg>"


def main():
    if len(sys.argv) < 4:
        sys.exit("usage: chart.py MESHES.csv PICTURE.svg SECTION...")
    with open(sys.argv[1], encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write("\n".join(chart(rows, sys.argv[3:])) + "\n")


if __name__ == "__main__":
    main()
