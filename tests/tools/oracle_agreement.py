"""How far the other oracles agree with the exact decision: a tool, run by hand.

    python -m tests.tools.oracle_agreement nearest --rows 1000000 [--seed 1] [--families uniform,grid]
    python -m tests.tools.oracle_agreement mesh --rows 10000 --families ended,rim,disc,slab

Rows of the families below are drawn in turn from the seed, by default of those without ends. The last lines are a
table: rows by family and exact position, how many the oracle could not decide, and time a row. Every disagreement is
printed with its row as it is found, and makes the status 1.
"""

from __future__ import annotations

import argparse
import math
import random
import sys
import time
from collections import Counter

import numpy as np

from hypcheck.geometry.pair import Pair, Position
from hypcheck.runs.oracles import ORACLES
from tests.support import inside

ASKED = ("nearest", "roots", "heights", "mesh")


def uniform(draw):
    """Everything of one order."""
    return [*(draw.uniform(0.3, 4) for _ in range(4)), *(draw.uniform(-6, 6) for _ in range(3)), *direction(draw)]


def near(draw):
    """From 10⁻¹⁶ to 10⁻¹ radii off contact, at a random point of a surface of moderate sizes."""
    return touching(draw, [10 ** draw.uniform(-1, 1) for _ in range(4)], direction(draw))


def stiff(draw):
    """The same with ratios of sizes up to 10⁸."""
    return touching(draw, [10 ** draw.uniform(-4, 4) for _ in range(4)], direction(draw))


def slight(draw):
    """Near contact, the axis almost vertical, or almost horizontal: tilts from 10⁻³⁰⁰ to 10⁻¹."""
    small = 10 ** draw.uniform(-300 if draw.random() < 0.2 else -17, -1)
    axis = [small * draw.uniform(-1, 1), small * draw.uniform(-1, 1), draw.choice((-1, 1)) * draw.uniform(0.1, 9)]
    draw.choice((lambda: None, axis.reverse))()
    return touching(draw, [10 ** draw.uniform(-1, 1) for _ in range(4)], axis)


def symmetric(draw):
    """Near contact, the axis in the meridian plane, horizontal, or through the centre; or the centre at the waist."""
    row = near(draw)
    x, y, z = row[4:7]
    kind = draw.randrange(4)
    if kind == 0:
        t = draw.uniform(-3, 3)
        return [*row[:7], x * t, y * t, draw.gauss(0, 1)]
    if kind == 1:
        return [*row[:9], 0.0]
    if kind == 2:
        return [*row[:7], x, y, z]
    return [*row[:6], 0.0, *row[7:]]


def grid(draw):
    """Small integers, among which are tangencies, rings and centres on the surface."""
    sizes = [draw.randint(1, 6) for _ in range(4)]
    while not any(axis := [draw.randint(-2, 2) for _ in range(3)]):
        pass
    return [*map(float, sizes), *(draw.randint(-12, 12) / draw.choice((1, 2)) for _ in range(3)), *map(float, axis)]


def extreme(draw):
    """Anything that float64 holds, and axes of any length."""
    scale = draw.randint(-1000, 950)
    row = touching(draw, [10 ** draw.uniform(-6, 6) for _ in range(4)], direction(draw))
    factor = math.ldexp(1, draw.randint(-1020, 900))
    row = [*(math.ldexp(each, scale) for each in row[:7]), *(each * factor for each in row[7:])]
    for index in range(10):
        if draw.random() < 0.1:
            row[index] = math.ldexp(draw.uniform(0.5, 1), draw.randint(-1073, 1024)) * (1 if index < 4 else -1)
    return [*(max(each, 5e-324) for each in row[:4]), *row[4:]]


def direction(draw):
    """A vector of any direction, of length about 1."""
    return [draw.gauss(0, 1) for _ in range(3)]


def touching(draw, sizes, axis):
    """A row whose centre is a little more or less than one radius beyond a point of the surface, along M⁻¹ n.

    n is the normal there. Where the surface is more curved than the spheroid, another point may be nearer.
    """
    alpha, gamma, b, d = sizes
    height, angle = draw.gauss(0, 1), draw.uniform(0, 2 * math.pi)
    radius = alpha * math.sqrt(1 + height * height)
    point = (radius * math.cos(angle), radius * math.sin(angle), gamma * height)
    normal = (point[0] / alpha**2, point[1] / alpha**2, -point[2] / gamma**2)
    largest = max(map(abs, axis))
    v = [each / largest for each in axis]
    along = sum(n * a for n, a in zip(normal, v, strict=True)) / sum(a * a for a in v)
    way = [b * b * n + (d * d - b * b) * along * a for n, a in zip(normal, v, strict=True)]
    half = math.sqrt(sum(w * n for w, n in zip(way, normal, strict=True)))
    if not half:
        return [*sizes, *point, *axis]
    steps = draw.choice((-1, 1)) * (1 + draw.choice((-1, 1)) * 10 ** draw.uniform(-16, -1)) / half
    return [*sizes, *(p + steps * w for p, w in zip(point, way, strict=True)), *axis]


def upright_or_not(draw):
    """An axis, half of the time upright."""
    return direction(draw) if draw.random() < 0.5 else [0.0, 0.0, 1.0]


def ending(draw, row, end):
    """The row with a wall that ends above at a height, below at another or nowhere, or upside down; open or solid."""
    other = end - (math.inf if draw.random() < 0.3 else 10 ** draw.uniform(-2, 1))
    heights = [other, end] if draw.random() < 0.5 else [-end, -other]
    if heights[0] == -end:
        row = [*row[:6], -row[6], *row[7:9], -row[9]]
    return [*row, *heights, float(draw.randrange(2))]


def half_height(row):
    """The spheroid's, of a row of ten."""
    b, d, axis = row[2], row[3], row[7:10]
    lean = axis[2] ** 2 / sum(part * part for part in axis)
    return math.sqrt(b * b + (d * d - b * b) * lean)


def ended(draw):
    """Anywhere or near contact, an end within a spheroid's reach."""
    row = draw.choice((uniform, near))(draw)
    row = [*row[:7], *upright_or_not(draw)]
    return ending(draw, row, row[6] + draw.uniform(-1.5, 1.5) * half_height(row))


def on_plane(draw, sizes, point, normal, axis):
    """The row whose spheroid is from 10⁻¹⁶ to 10⁻¹ radii off the plane through a point across a normal."""
    _, _, b, d = sizes
    along = sum(n * a for n, a in zip(normal, axis, strict=True)) / sum(a * a for a in axis)
    way = [b * b * n + (d * d - b * b) * along * a for n, a in zip(normal, axis, strict=True)]
    half = math.sqrt(sum(w * n for w, n in zip(way, normal, strict=True)))
    steps = (1 + draw.choice((-1, 1)) * 10 ** draw.uniform(-16, -1)) / half
    return [*sizes, *(p + steps * w for p, w in zip(point, way, strict=True)), *axis]


def rim(draw):
    """Near a touch of the rim from above, beside it or through the mouth."""
    sizes, end, angle = [10 ** draw.uniform(-1, 1) for _ in range(4)], draw.gauss(0, 2), draw.uniform(0, 2 * math.pi)
    radius = sizes[0] * math.hypot(1, end / sizes[1])
    point = (radius * math.cos(angle), radius * math.sin(angle), end)
    across, up = draw.uniform(-1, 1), draw.uniform(0, 1)
    normal = (across * math.cos(angle), across * math.sin(angle), up)
    return ending(draw, on_plane(draw, sizes, point, normal, upright_or_not(draw)), end)


def disc(draw):
    """Near a touch of an end disc from above or below, within the rim or about it."""
    sizes, end, angle = [10 ** draw.uniform(-1, 1) for _ in range(4)], draw.gauss(0, 2), draw.uniform(0, 2 * math.pi)
    radius = sizes[0] * math.hypot(1, end / sizes[1]) * draw.uniform(0, 1.1)
    point = (radius * math.cos(angle), radius * math.sin(angle), end)
    return ending(draw, on_plane(draw, sizes, point, (0, 0, draw.choice((-1, 1))), upright_or_not(draw)), end)


def slab(draw):
    """A thin slab somewhere in the heights of a spheroid near contact with the whole wall."""
    row = [*near(draw)[:7], *upright_or_not(draw)]
    low = row[6] + draw.uniform(-1.1, 1.1) * half_height(row)
    return [*row, low, low + 10 ** draw.uniform(-6, 0), float(draw.randrange(2))]


WHOLE = {family.__name__: family for family in (uniform, near, stiff, slight, symmetric, grid, extreme)}
ENDED = {family.__name__: family for family in (ended, rim, disc, slab)}
FAMILIES = WHOLE | ENDED


def rows(families, count, seed):
    """`count` valid rows and their families, one family after the other and over again."""
    draw = random.Random(seed)  # noqa: S311 - nothing is secret
    made = 0
    while made < count:
        family = families[made % len(families)]
        row = FAMILIES[family](draw)
        if all(map(math.isfinite, row[:10])) and min(row[:4]) > 0 and any(row[7:10]):
            made += 1
            yield family, row


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("oracle", choices=ASKED)
    parser.add_argument("--rows", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--families", default=",".join(WHOLE))
    options = parser.parse_args(arguments)
    ask = ORACLES[options.oracle].ask
    seen, undecided, disagreed, spent = Counter(), Counter(), 0, Counter()
    for family, row in rows(options.families.split(","), options.rows, options.seed):
        pair = Pair.from_row(row)
        start = time.process_time()
        expected = inside.position(pair.lengths)
        middle = time.process_time()
        (opinion,) = ask(np.array([row]))
        found = opinion.position
        spent["exact"] += middle - start
        spent[options.oracle] += time.process_time() - middle
        seen[family, expected] += 1
        if found is None:
            undecided[family] += 1
        elif found is not expected:
            disagreed += 1
            tell(f"DISAGREE {family} exact {expected.label} {options.oracle} {found.label} {row!r}")
    report(options, seen, undecided, disagreed, spent)
    return 1 if disagreed else 0


def report(options, seen, undecided, disagreed, spent):
    """The table."""
    tell(f"{'family':12}{'exterior':>10}{'contact':>10}{'interior':>10}{'undecided':>11}")
    for family in options.families.split(","):
        counts = (seen[family, each] for each in Position)
        tell(f"{family:12}" + "".join(f"{each:>10}" for each in counts) + f"{undecided[family]:>11}")
    total = sum(seen.values())
    times = ", ".join(f"{name} {1e6 * value / total:.0f} µs" for name, value in spent.items())
    tell(f"{total} rows, {sum(undecided.values())} undecided, {disagreed} disagreements; {times} a row (CPU)")


def tell(line):
    """Print a line at once."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())
