"""The attack: batches of rows and scenes, the truth of each once, and what the subjects say."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator

import numpy as np

from hypcheck.truth import batch
from tests.attack import places
from tests.attack.places import Scene
from tests.attack.subjects import Subject

Batch = tuple[str, np.ndarray | Scene]


def batches(seed: int, rows: int) -> Iterator[Batch]:
    """About `rows` rows, half of them in scenes; the same for the same arguments."""
    random = np.random.default_rng(seed)
    share = rows // 8
    yield from places.families(seed, share // len(places.FAMILIES))
    for name, make in (("near", places.near_contact), ("ring", places.on_the_ring), ("grid", places.grid)):
        for _ in range(0, share, 1 << 16):
            yield name, make(random, min(share, 1 << 16))
    size = min(1 << 15, max(2048, share // 64))  # scenes large enough that every kernel makes lines for them
    for scene in places.scenes(random, 2 * share // size, size):
        yield "scenes", scene
    for scene in places.wild_scenes(random, share // 10_000 + 1, 1100):
        yield "wild scenes", scene
    for scene in places.on_the_lines(random, 2 * share // size, size):
        yield "lines", scene


def strike(subjects: Iterable[Subject], all_batches: Iterable[Batch]) -> Iterator[tuple[str, str, int, np.ndarray]]:
    """For each batch and subject: stratum, subject, number of rows asked and the rows answered wrong."""
    everyone = list(subjects)
    for stratum, each in all_batches:
        rows = each.rows if isinstance(each, Scene) else each
        truth = batch.positions(rows)
        for subject in everyone:
            some = slice(None, None, subject.every)
            found = _asked(subject, each, some)
            yield stratum, subject.name, len(found), rows[some][found != truth[some]]


def _asked(subject: Subject, each: np.ndarray | Scene, some: slice) -> np.ndarray:
    if isinstance(each, Scene):
        return subject.scene(each.sizes, *(column[some] for column in (each.x, each.y, each.z)))
    return subject.rows(each[some])


def tally(struck: Iterable[tuple[str, str, int, np.ndarray]]) -> tuple[Counter, Counter, list[np.ndarray]]:
    """Rows asked and rows wrong by (stratum, subject), and the wrong rows."""
    asked: Counter = Counter()
    wrong: Counter = Counter()
    rows = []
    for stratum, subject, count, bad in struck:
        asked[stratum, subject] += count
        wrong[stratum, subject] += len(bad)
        if len(bad):
            rows.append(bad)
    return asked, wrong, rows
