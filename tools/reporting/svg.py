"""Log-log plots as SVG: panels side by side, a line per series, bars for confidence."""
import math
from html import escape

COLOURS = {'instantiation': '#0b7a3b', 'clustering': '#1f5fbf', 'flat': '#b8860b', 'direct': '#8a8a8a', 'lattice': '#7a4bb5', 'occlusion': '#c06a1a', 'reference': '#c0392b'}
MARKS = {'instantiation': 'square', 'clustering': 'circle', 'flat': 'triangle', 'direct': 'diamond', 'lattice': 'diamond', 'occlusion': 'square', 'reference': 'cross'}
WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 430, 330, 58, 14, 34, 46


def mark(kind, x, y, colour):
    if kind == 'circle':
        return '<circle cx="%.1f" cy="%.1f" r="4" fill="%s"/>' % (x, y, colour)
    corners = {'square': [(-4, -4), (4, -4), (4, 4), (-4, 4)], 'triangle': [(0, -5), (5, 4), (-5, 4)], 'diamond': [(0, -5), (5, 0), (0, 5), (-5, 0)]}
    if kind in corners:
        return '<polygon points="%s" fill="%s"/>' % (' '.join('%.1f,%.1f' % (x + a, y + b) for a, b in corners[kind]), colour)
    return '<path d="M%.1f %.1fl8 8m0 -8l-8 8" stroke="%s" stroke-width="2"/>' % (x - 4, y - 4, colour)


class Axis:
    """Logarithmic, over whole fractions of decades around the values."""

    def __init__(self, values, low, high):
        a, b = math.log10(min(values)), math.log10(max(values))
        room = max(0.08 * (b - a), 0.08)
        self.a, self.b, self.low, self.high = a - room, b + room, low, high

    def at(self, value):
        return self.low + (self.high - self.low) * (math.log10(max(value, 10**self.a)) - self.a) / (self.b - self.a)

    def ticks(self):
        """(value, labelled)"""
        wide = self.b - self.a > 2.2
        for decade in range(math.floor(self.a), math.ceil(self.b) + 1):
            for k in range(1, 10):
                value = k * 10.0**decade
                if self.a <= math.log10(value) <= self.b:
                    yield value, k == 1 or (k in (2, 5) and not wide)


def number(value):
    return '%g' % value


def panel(x0, y0, title, x_label, series, x_format=number):
    """series: {name: [(x, y, low, high, label)]}"""
    points = [p for ps in series.values() for p in ps]
    xs, ys = [p[0] for p in points], [v for p in points for v in (p[1], p[2] or p[1], p[3] or p[1]) if v > 0]
    x, y = Axis(xs, x0 + LEFT, x0 + WIDTH - RIGHT), Axis(ys, y0 + HEIGHT - BOTTOM, y0 + TOP)
    out = ['<text x="%.0f" y="%.0f" font-weight="bold">%s</text>' % (x0 + LEFT, y0 + 20, escape(title))]
    for value, labelled in x.ticks():
        out.append('<path d="M%.1f %.1fV%.1f" stroke="%s"/>' % (x.at(value), y0 + TOP, y0 + HEIGHT - BOTTOM, '#d5d5d5' if labelled else '#eeeeee'))
        if labelled:
            out.append('<text x="%.1f" y="%.1f" text-anchor="middle">%s</text>' % (x.at(value), y0 + HEIGHT - BOTTOM + 16, escape(x_format(value))))
    for value, labelled in y.ticks():
        out.append('<path d="M%.1f %.1fH%.1f" stroke="%s"/>' % (x0 + LEFT, y.at(value), x0 + WIDTH - RIGHT, '#d5d5d5' if labelled else '#eeeeee'))
        if labelled:
            out.append('<text x="%.1f" y="%.1f" text-anchor="end">%s</text>' % (x0 + LEFT - 6, y.at(value) + 4, number(value)))
    out.append('<text x="%.1f" y="%.1f" text-anchor="middle">%s</text>' % (x0 + (LEFT + WIDTH - RIGHT) / 2, y0 + HEIGHT - 10, escape(x_label)))
    out.append('<text transform="translate(%.1f %.1f) rotate(-90)" text-anchor="middle">error of an organ, %%</text>' %
               (x0 + 14, y0 + (TOP + HEIGHT - BOTTOM) / 2))
    for name, ps in series.items():
        colour = COLOURS[name]
        ps = sorted(ps)
        if len(ps) > 1:
            dash = ' stroke-dasharray="5 4"' if name == 'reference' else ''
            out.append('<path d="M%s" fill="none" stroke="%s" stroke-width="1.8"%s/>' %
                       ('L'.join('%.1f %.1f' % (x.at(p[0]), y.at(p[1])) for p in ps), colour, dash))
        for px, py, low, high, label in ps:
            if low is not None:
                out.append('<path d="M%.1f %.1fV%.1fm-3 0h6M%.1f %.1fh6" stroke="%s" stroke-width="1.4"/>' %
                           (x.at(px), y.at(low), y.at(high), x.at(px) - 3, y.at(low), colour))
            out.append('<g><title>%s</title>%s</g>' % (escape('%s %s: %.3g %%' % (name, label, py)), mark(MARKS[name], x.at(px), y.at(py), colour)))
    return out


def plot(panels):
    """panels: rows of (title, x label, series, x format). All series that occur are named above."""
    names = []
    for row in panels:
        for p in row:
            names += [n for n in p[2] if n not in names]
    width, height = WIDTH * max(len(r) for r in panels), HEIGHT * len(panels) + 30
    out = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 %d %d" width="%d" height="%d" font-family="sans-serif" font-size="12">' %
           (width, height, width, height), '<rect width="100%" height="100%" fill="white"/>']
    at = LEFT
    for name in names:
        out.append(mark(MARKS[name], at, 16, COLOURS[name]))
        out.append('<text x="%d" y="20">%s</text>' % (at + 10, escape({'reference': 'path tracing'}.get(name, name))))
        at += 110
    for r, row in enumerate(panels):
        for c, p in enumerate(row):
            out += panel(c * WIDTH, 30 + r * HEIGHT, *p)
    return '\n'.join(out + ['</svg>', ''])
