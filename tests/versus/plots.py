"""Errors over processor seconds as a picture, both in powers of ten."""

import math

WIDTH, HEIGHT, LEFT, BOTTOM, TOP, RIGHT = 420, 300, 56, 40, 28, 12
COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"]


def write_plots(path, plots):
    """`plots` has (title, {program: [(seconds, error)]}) for each scene."""
    columns = min(3, len(plots))
    rows = math.ceil(len(plots) / columns)
    programs = list(dict.fromkeys(name for _, curves in plots for name in curves))
    colours = {name: COLOURS[i % len(COLOURS)] for i, name in enumerate(programs)}
    parts = [plot(title, curves, colours, i % columns * WIDTH, i // columns * HEIGHT) for i, (title, curves) in enumerate(plots)]
    key = "".join(
        f'<text x="{LEFT + 170 * i}" y="{rows * HEIGHT + 18}" fill="{colour}">{name}</text>'
        for i, (name, colour) in enumerate(colours.items())
    )
    width, height = columns * WIDTH, rows * HEIGHT + 30
    path.write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
        f'font-family="sans-serif" font-size="12"><rect width="100%" height="100%" fill="white"/>{"".join(parts)}{key}</svg>\n',
        encoding="utf-8",
    )


def plot(title, curves, colours, left, top):
    """One scene's."""
    points = [point for curve in curves.values() for point in curve]
    x_axis, y_axis = span([x for x, _ in points]), span([y for _, y in points])
    x_of = lambda x: left + LEFT + (math.log10(x) - x_axis[0]) / (x_axis[1] - x_axis[0]) * (WIDTH - LEFT - RIGHT)  # noqa: E731
    y_of = lambda y: top + HEIGHT - BOTTOM - (math.log10(y) - y_axis[0]) / (y_axis[1] - y_axis[0]) * (HEIGHT - BOTTOM - TOP)  # noqa: E731
    parts = [f'<text x="{left + LEFT}" y="{top + 18}" font-weight="bold">{title}</text>']
    for x in ticks(x_axis):
        parts.append(line(x_of(x), y_of(10 ** y_axis[0]), x_of(x), y_of(10 ** y_axis[1])))
        parts.append(f'<text x="{x_of(x):.1f}" y="{top + HEIGHT - BOTTOM + 16}" text-anchor="middle">{x:g} s</text>')
    for y in ticks(y_axis):
        parts.append(line(x_of(10 ** x_axis[0]), y_of(y), x_of(10 ** x_axis[1]), y_of(y)))
        parts.append(f'<text x="{left + LEFT - 6}" y="{y_of(y) + 4:.1f}" text-anchor="end">{100 * y:g} %</text>')
    for name, curve in curves.items():
        path = " ".join(f"{x_of(x):.1f},{y_of(y):.1f}" for x, y in curve)
        parts.append(f'<polyline points="{path}" fill="none" stroke="{colours[name]}" stroke-width="2"/>')
    return "".join(parts)


def line(x1, y1, x2, y2):
    """Of the grid."""
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="#ddd"/>'


def span(values):
    """Logarithms of the least and the largest, with some room."""
    low, high = math.log10(min(values)), math.log10(max(values))
    room = 0.05 * (high - low) + 0.02
    return low - room, high + room


def ticks(axis):
    """Round values: 1, 2 and 5 times powers of ten."""
    powers = range(math.floor(axis[0]), math.ceil(axis[1]) + 1)
    values = [digit * 10.0**power for power in powers for digit in (1, 2, 5)]
    return [value for value in values if axis[0] <= math.log10(value) <= axis[1]]
