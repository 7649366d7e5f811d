"""What threads may share, and what lets other threads run: docs/api.md, Threads."""

from __future__ import annotations

import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import hypcheck
from tests.support.inside import choice

SIZES = (2.0, 17.8, 0.25, 0.15)
THREADS = 8


def points_of(seed, count=3000):
    return np.random.default_rng(seed).uniform((-4, -4, -18), (4, 4, 18), (count, 3))


def questions():
    """Questions about shared objects, made anew so that nothing is prepared yet."""
    prepared = hypcheck.Prepared(SIZES)
    centers = [(x, y, 0.0) for x in (0.0, 6.0, 12.0) for y in (0.0, 6.0, 12.0)]
    scene = hypcheck.Scene.from_arrays(2, 17.8, centers, mover=hypcheck.Mover(0.25, 0.15), z_min=-17, z_max=17)
    rows = np.hstack([np.tile(SIZES, (3000, 1)), points_of(1)])
    near, sweeps = hypcheck.clearance(rows[:200]), hypcheck.passage(SIZES, points_of(2, 50), points_of(3, 50))
    return {
        "rows": lambda seed: hypcheck.classify(rows[seed:]),
        "prepared": lambda seed: hypcheck.classify(prepared, points_of(seed)),
        "strided": lambda seed: hypcheck.classify(SIZES, *points_of(seed).T),
        "scene": lambda seed: scene.classify(points_of(seed)),
        "one step": lambda seed: np.array([scene.position(point) for point in points_of(seed, 50).tolist()]),
        "ways of a scene": lambda seed: scene.passage(points_of(seed, 100), points_of(seed + 1, 100)).hit,
        "changed": lambda seed: scene.moved(seed, (3.0, 3.0, 0.0)).classify(points_of(seed)),
        "normals": lambda _seed: np.nan_to_num(near.normal),
        "times": lambda _seed: np.nan_to_num(sweeps.first_lower),
    }


def test_eight_threads_that_share_all_objects_get_the_answers_of_a_single_thread():
    alone = {name: [ask(seed).tolist() for seed in range(THREADS)] for name, ask in questions().items()}
    shared, start = questions(), threading.Barrier(THREADS)

    def all_of(seed):
        start.wait()
        return {name: ask(seed).tolist() for name, ask in shared.items()}

    with ThreadPoolExecutor(THREADS) as pool:
        found = list(pool.map(all_of, range(THREADS)))
    for name, expected in alone.items():
        assert [answers[name] for answers in found] == expected


TANGENT = (1.0, 2.0, 1.0, 1.0, 2.0, 0.0, 0.0)
"""A row that integers decide, so that a call about many lasts."""

CALLS = {
    "classify": lambda rows: hypcheck.classify(rows, threads=1),
    "classify, strided": lambda rows: hypcheck.classify(rows[::2], threads=1),
    "classify_scene": lambda rows: hypcheck.classify_scene(rows[0, :4], rows[:, 4:], threads=1),
    "clearance": lambda rows: hypcheck.clearance(rows[: len(rows) // 8], threads=1),
}


@pytest.mark.skipif(choice().kernel != "compiled", reason="the numpy kernel holds the interpreter")
@pytest.mark.parametrize("ask", CALLS.values(), ids=CALLS)
def test_a_long_call_lets_other_threads_of_python_run(ask):
    rows, ticks, stop = np.tile(TANGENT, (500_000, 1)), [], threading.Event()

    def tick():
        while not stop.wait(0.002):
            ticks.append(time.perf_counter())

    other = threading.Thread(target=tick)
    other.start()
    started = time.perf_counter()
    ask(rows)
    ended = time.perf_counter()
    stop.set()
    other.join()
    middle = [at for at in ticks if started + 0.2 * (ended - started) < at < started + 0.8 * (ended - started)]
    assert len(middle) > 2
