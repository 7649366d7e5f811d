"""What ends cost: rows and steps beside hyperboloids that end, timed in turns with the same without ends; run by hand.

    python -m tests.tools.ended_pace [--rows 20000] [--trees 100000] [--rounds 15]

Each line has the median of the ratios of the rounds, and what is wanted. A ratio that is missed makes the status 1.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from dataclasses import replace
from statistics import median

import numpy as np

from hypcheck import Scene
from hypcheck.kernel import _compiled
from hypcheck.scene.model import Hyperboloid, Mover, Region, SceneModel, Span

TOWER = (2.0, 17.8, 0.25, 0.15)
RIM = 2 * math.sqrt(2)
"""The radius of the tower at 17.8."""


def rows_of(centres, heights, axis):
    """Rows (n, 13) of the paper's tower and drone."""
    n = len(centres)
    return np.ascontiguousarray(np.column_stack([np.tile(TOWER, (n, 1)), centres, axis, np.tile(heights, (n, 1))]))


def about_the_tower(random, n):
    """Centres in a box around the tower."""
    return random.uniform((-4, -4, -20), (4, 4, 20), (n, 3))


def about_the_rim(random, n):
    """Centres within two spheroids of the rim."""
    turn, radius = random.uniform(0, 2 * math.pi, n), RIM + random.uniform(-0.4, 0.4, n)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), 17.8 + random.uniform(-0.3, 0.3, n)], axis=1)


def row_calls(random, n):
    """Names, calls with ends and without, and the ratio that is wanted."""
    upright, tilted = np.tile([0.0, 0.0, 1.0], (n, 1)), random.normal(size=(n, 3))
    answers = np.empty(n, np.int8)

    def ended(rows):
        return lambda: _compiled.classify_ended(rows, answers)

    def whole(rows, width):
        some = np.ascontiguousarray(rows[:, :width])
        return lambda: _compiled.ask(0, some, answers)

    for kind, axis, width in (("upright", upright, 7), ("upright of ten", upright, 10), ("tilted", tilted, 10)):
        far = rows_of(about_the_tower(random, n), (-1e4, 1e4, 0.0), axis)
        near = rows_of(about_the_rim(random, n), (-17.8, 17.8, 0.0), axis)
        yield f"rows, {kind}, ends far away", ended(far), whole(far, width), 1.3
        yield f"rows, {kind}, near the rim, beside ordinary ones", ended(near), whole(far, width), 6.0


def step_calls(random, trees):
    """The same of steps of a mover in a forest."""
    side = math.sqrt(trees) * 2
    places = random.uniform(-side, side, (trees, 2))
    bodies = tuple(
        Hyperboloid(f"tree {k}", 0.2, 1.0, (x, y, 0.0), Span(-1.0, 2.0)) for k, (x, y) in enumerate(places.tolist())
    )
    mover = Mover(0.3, 0.2)
    with_tops = SceneModel("forest", "position", bodies, mover, Region(z=Span(-1.0, 3.0)))
    without = replace(with_tops, hyperboloids=tuple(replace(body, height=None) for body in bodies))
    scenes = [Scene(with_tops), Scene(without)]
    start = random.uniform(-side / 2, side / 2, 2)
    steps = start + 0.1 * np.arange(1000)[:, None] * np.array([0.6, 0.8])
    walk = [(x, y, 1.0) for x, y in steps.tolist()]
    columns = random.uniform((-side, -side, -1), (side, side, 3), (20_000, 3)).T

    def walked(scene):
        return lambda: [scene.position(*place) for place in walk]

    def classified(scene):
        return lambda: scene.classify(*columns)

    yield f"Scene.position, {trees} trees with tops", *map(walked, scenes), 1.3
    yield f"Scene.classify, {trees} trees with tops", *map(classified, scenes), 1.3


def seconds(call):
    """How long a call takes, of this process: others may use the machine."""
    start = time.process_time()
    call()
    return time.process_time() - start


def main(arguments):
    """Measure and print; returns the status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rows", type=int, default=20_000)
    parser.add_argument("--trees", type=int, default=100_000)
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args(arguments)
    random = np.random.default_rng(given.seed)
    missed = 0
    for name, ended, whole, wanted in (*row_calls(random, given.rows), *step_calls(random, given.trees)):
        seconds(ended), seconds(whole)
        ratio = median(seconds(ended) / seconds(whole) for _ in range(given.rounds))
        missed += ratio > wanted
        sys.stdout.write(f"{name:60} {ratio:6.2f}  (at most {wanted}){'  missed' if ratio > wanted else ''}\n")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
