"""hypcheck.clearance beside the nearest-point oracle, which shares nothing with it: a tool, run by hand.

    python -m tests.tools.clearance_agreement --rows 1000000 [--seed 1] [--points 100]

Rows are drawn in turn from the families of upright spheroids and from boxes of sizes and centres. Each clearance of the
oracle must lie between the bounds, each position be the same; of one row in so many, `--points`, the exact place of
touch must be within its error. Every fault is printed with its row, and makes the status 1. The last lines count what
was compared.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from collections.abc import Iterator

import numpy as np

from hypcheck import clearance
from hypcheck.geometry.pair import Pair
from hypcheck.vectors.families import FAMILIES
from tests.support.inside import clearances
from tests.support.nearest_points import is_circle, nearest_points

CHUNK = 20_000


def drawn(seed: int, count: int) -> Iterator[np.ndarray]:
    """Chunks of rows, (n, 7), `count` in all: a third of the families, two thirds of boxes."""
    rng = np.random.default_rng(seed)
    names, turn = sorted(FAMILIES), 0
    while count > 0:
        size = min(CHUNK, count)
        if turn % 3 == 0:
            each = -(-size // len(names))
            rows = np.concatenate([FAMILIES[name].rows(seed + turn, each) for name in names])[:size]
        else:
            spread = 0.3 if turn % 3 == 1 else 2.0
            sizes = np.exp(rng.normal(0, spread, (size, 4)))
            rows = np.concatenate([sizes, rng.normal(0, 2 * sizes.max(axis=1)[:, None], (size, 3))], axis=1)
        yield rows
        count, turn = count - len(rows), turn + 1


def faults(rows: np.ndarray, said, points: int) -> Iterator[str]:
    """What `said` gets wrong, in sentences; of each `points`-th row the place of touch too."""
    true = clearances(rows)
    wrong = ~((said.lower <= true.clearance) & (true.clearance <= said.upper)) | (said.position != true.position)
    for k in np.flatnonzero(wrong).tolist():
        yield f"{rows[k].tolist()}: {true.clearance[k]!r} is not from {said.lower[k]!r} to {said.upper[k]!r}"
    for k in range(0, len(rows), points):
        pair = Pair.from_row(rows[k].tolist())
        if is_circle(pair) or not np.isfinite(said.touch_error[k]):
            continue
        off = min(math.dist(point, said.touch[k]) for point in nearest_points(pair))
        if not off <= said.touch_error[k]:
            yield f"{rows[k].tolist()}: the touch is {off!r} away, not {said.touch_error[k]!r} at most"


def main(arguments: list[str]) -> int:
    """Compare, and print; returns the status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rows", type=int, default=1_000_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--points", type=int, default=100)
    given = parser.parse_args(arguments)
    compared, asked, found, widths, spent = 0, 0, 0, [], 0.0
    for rows in drawn(given.seed, given.rows):
        start = time.process_time()
        said = clearance(rows, threads=1)
        spent += time.process_time() - start
        for sentence in faults(rows, said, given.points):
            found += 1
            sys.stdout.write(f"{sentence}\n")
        compared, asked = compared + len(rows), asked + len(range(0, len(rows), given.points))
        widths.append(((said.upper - said.lower) / np.maximum(1, 1 + said.lower)).max())
    counts = f"{compared} clearances and {asked} places of touch compared, {found} wrong"
    sys.stdout.write(f"{counts}; widest interval {max(widths):.3g}\n")
    sys.stdout.write(f"{spent / compared * 1e6:.2f} µs of a processor a row\n")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
