"""Charts as SVG: curves with markers."""

import math

# Colour, dash and marker of a curve: told apart in grey, too.
CURVES = (
    ("#000000", "none", "circle"),
    ("#0062bd", "8 4", "square"),
    ("#b5470b", "2 3", "diamond"),
    ("#009150", "10 3 2 3", "triangle"),
    ("#8a2be2", "5 5", "ring"),
    ("#7a7a7a", "none", "cross"),
    ("#c2185b", "12 6", "box"),
    ("#005f73", "2 6", "circle"),
    ("#6b4f00", "6 2", "square"),
    ("#3b3b9e", "14 3", "ring"),
)
MARKERS = {
    "circle": '<circle r="4.5" fill="{0}"/>',
    "ring": '<circle r="4.5" fill="white" stroke="{0}" stroke-width="1.5"/>',
    "square": '<rect x="-4" y="-4" width="8" height="8" fill="{0}"/>',
    "box": '<rect x="-4" y="-4" width="8" height="8" fill="white" stroke="{0}" stroke-width="1.5"/>',
    "diamond": '<path d="M0 -5.5 L5.5 0 L0 5.5 L-5.5 0 z" fill="{0}"/>',
    "triangle": '<path d="M0 -5.5 L5 4 L-5 4 z" fill="{0}"/>',
    "cross": '<path d="M-4 -4 L4 4 M-4 4 L4 -4" fill="none" stroke="{0}" stroke-width="2"/>',
}
WIDTH = 460
BOX = (74, 24, WIDTH, 340)  # left, top, width, height of a chart
BELOW, LEGEND = 62, 410  # what axes and legend need


def ticks(low, high, most=8):
    """Round numbers between two ends."""
    rough = (high - low) / most
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(factor * power for factor in (1, 2, 5, 10) if factor * power >= rough * (1.0 - 1e-9))
    first = math.ceil(low / step - 1e-9)
    return [k * step for k in range(first, math.floor(high / step + 1e-9) + 1)]


def decades(values):
    """The powers of ten around values."""
    return 10.0 ** math.floor(math.log10(min(values)) + 1e-9), 10.0 ** math.ceil(math.log10(max(values)) - 1e-9)


def power_text(value):
    return f'10<tspan dy="-6" font-size="11">{str(round(math.log10(value))).replace("-", "−")}</tspan>'


class Panel:
    """A chart with the ends of both axes. `marks`: values of x on the axis, round numbers if there are none. `logarithmic`: both axes,
    whose ends are powers of ten. Without `y_label` the axis of y has no numbers."""

    def __init__(self, x, y, x_label, y_label="", marks=None, box=BOX, logarithmic=False, title=""):
        self.x, self.y, self.x_label, self.y_label, self.title = x, y, x_label, y_label, title
        self.left, self.top, self.width, self.height = box
        self.scale, self.text = (math.log10, power_text) if logarithmic else (float, "{:.10g}".format)
        powers = lambda low, high: [10.0**power for power in range(round(math.log10(low)), round(math.log10(high)) + 1)]
        self.marks = marks or (powers if logarithmic else ticks)(*x), (powers if logarithmic else ticks)(*y)

    def at(self, x, y):
        share_x, share_y = ((self.scale(value) - self.scale(low)) / (self.scale(high) - self.scale(low))
                            for value, (low, high) in ((x, self.x), (y, self.y)))
        return self.left + self.width * share_x, self.top + self.height * (1.0 - share_y)

    def axes(self):
        left, top, right, bottom = self.left, self.top, self.left + self.width, self.top + self.height
        yield f'<clipPath id="inside{left}"><rect x="{left - 6}" y="{top}" width="{self.width + 12}" height="{self.height + 6}"/></clipPath>'
        yield f'<text x="{left + self.width / 2}" y="{top - 16}" text-anchor="middle" font-size="16">{self.title}</text>' if self.title else ""
        for value in self.marks[0]:
            x, _ = self.at(value, self.y[0])
            yield f'<line x1="{x:.1f}" y1="{top}" x2="{x:.1f}" y2="{bottom}" stroke="#e4e4e4"/>'
            yield f'<text x="{x:.1f}" y="{bottom + 20}" text-anchor="middle">{self.text(value)}</text>'
        for value in self.marks[1]:
            _, y = self.at(self.x[0], value)
            yield f'<line x1="{left}" y1="{y:.1f}" x2="{right}" y2="{y:.1f}" stroke="#e4e4e4"/>'
            yield f'<text x="{left - 8}" y="{y + 5:.1f}" text-anchor="end">{self.text(value)}</text>' if self.y_label else ""
        yield f'<path d="M{left} {top} V{bottom} H{right}" fill="none" stroke="#222"/>'
        yield f'<text x="{left + self.width / 2}" y="{bottom + 46}" text-anchor="middle">{self.x_label}</text>'
        yield f'<text transform="translate({left - 50} {top + self.height / 2}) rotate(-90)" text-anchor="middle">{self.y_label}</text>'

    def rule(self, y):
        """A line across at a value."""
        _, place = self.at(self.x[0], y)
        yield f'<line x1="{self.left}" y1="{place:.1f}" x2="{self.left + self.width}" y2="{place:.1f}" stroke="#222" stroke-width="1.5"/>'

    def curve(self, points, style):
        color, dash, kind = style
        places = [self.at(*point) for point in points]
        path = " L".join(f"{x:.1f} {y:.1f}" for x, y in places)
        yield (f'<g clip-path="url(#inside{self.left})"><path d="M{path}" fill="none" stroke="{color}" stroke-width="1.8" '
               f'stroke-dasharray="{dash}"/>')
        for x, y in places:
            yield mark(kind, color, x, y)
        yield "</g>"

    def drop(self, x, y, style):
        """A line from a point down to the axis."""
        left, top = self.at(x, y)
        yield (f'<line x1="{left:.1f}" y1="{top:.1f}" x2="{left:.1f}" y2="{self.top + self.height}" stroke="{style[0]}" '
               'stroke-dasharray="1 3"/>')

    def length(self, pixels):
        """A length on the axis of x."""
        return pixels * (self.x[1] - self.x[0]) / self.width

    def bar(self, x, low, high, style):
        """An interval of y."""
        left, top = self.at(x, high)
        bottom = self.at(x, low)[1]
        yield f'<path d="M{left - 4:.1f} {top:.1f} h8 m-4 0 V{bottom:.1f} m-4 0 h8" fill="none" stroke="{style[0]}" stroke-width="1.2"/>'

    def legend(self, entries, notes=()):
        """Lines of words and style, to the right of the chart, and lines of words below them."""
        left = self.left + self.width + 24
        for number, (words, (color, dash, kind)) in enumerate(entries):
            line = self.top + 14 + 26 * number
            yield f'<path d="M{left} {line} h44" stroke="{color}" stroke-width="1.8" stroke-dasharray="{dash}"/>'
            yield mark(kind, color, left + 22, line)
            yield f'<text x="{left + 54}" y="{line + 5}">{words}</text>'
        for number, words in enumerate(notes):
            yield f'<text x="{left}" y="{self.top + 27 + 26 * len(entries) + 20 * number}">{words}</text>'


def mark(kind, color, x, y):
    return f'<g transform="translate({x:.1f} {y:.1f})">{MARKERS[kind].format(color)}</g>'


def document(title, parts, panel, legend=LEGEND):
    """`panel`: the last one, to the right of which the legend is."""
    width, height = panel.left + panel.width + legend, panel.top + panel.height + BELOW
    return "\n".join([
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
        'font-family="DejaVu Sans, Arial, sans-serif" font-size="14" role="img" aria-labelledby="title">',
        f'<title id="title">{title}</title>', f'<rect width="{width}" height="{height}" fill="white"/>', *filter(None, parts), "</svg>", ""])
