"""The attack: batches of rows and scenes, the truth of each, and the answers of the subjects in every rounding mode."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from hypcheck.vectors.families import TILTED_FAMILIES
from tests.support import inside
from tests.tools.attack import places, tilted_places
from tests.tools.attack.places import Scene
from tests.tools.attack.rounding import DIRECTED, TO_NEAREST, rounded
from tests.tools.attack.subjects import Subject


@dataclass(frozen=True)
class Batch:
    """Rows (n, 7) or (n, 10), or a scene, their exact positions, and the rounding modes under which they are asked."""

    stratum: str
    asked: np.ndarray | Scene
    truth: np.ndarray
    modes: tuple[str, ...]

    @property
    def rows(self) -> np.ndarray:
        """What is asked, as rows."""
        return self.asked.rows if isinstance(self.asked, Scene) else self.asked


def batches(seed: int, rows: int) -> Iterator[Batch]:
    """About `rows` rows, half of them in scenes; the same for the same arguments.

    Far centres, where intermediate values overflow, are asked under every rounding mode; of the others each fourth
    batch under one directed mode beside the usual one.
    """
    for number, (stratum, asked) in enumerate(drawn(seed, rows)):
        truth = truth_of(asked.rows if isinstance(asked, Scene) else asked)
        turn = DIRECTED[number // 4 % 3 : number // 4 % 3 + 1] if number % 4 == 0 else ()
        yield Batch(stratum, asked, truth, (TO_NEAREST, *(DIRECTED if stratum.startswith("far") else turn)))


def truth_of(rows: np.ndarray) -> np.ndarray:
    """The exact positions of rows of seven or ten."""
    return inside.positions(rows)


def drawn(seed: int, rows: int) -> Iterator[tuple[str, np.ndarray | Scene]]:
    """What `batches` asks, by stratum, without its truth."""
    random = np.random.default_rng(seed)
    share = rows // 8
    yield from places.families(seed, share // len(places.FAMILIES))
    for name, make in (("near", places.near_contact), ("ring", places.on_the_ring), ("grid", places.grid)):
        for _ in range(0, share, 1 << 16):
            yield name, make(random, min(share, 1 << 16))
    size = min(1 << 15, max(2048, share // 64))  # scenes large enough that every kernel makes lines for them
    many = max(5, 2 * share // size)  # of each style of scenes one at least
    for scene in places.scenes(random, many, size):
        yield "scenes", scene
    for scene in places.wild_scenes(random, share // 10_000 + 1, 1100):
        yield "wild scenes", scene
    for scene in places.on_the_lines(random, many, size):
        yield "lines", scene
    for _ in range(0, share, 1 << 16):
        yield "far", places.far(random, min(share // 2, 1 << 15))
    for scene in places.far_scenes(random, share // 4096 + 3, 1024):
        yield "far scenes", scene
    yield from _tilted_places(random, max(2000, share // 12))


def _tilted_places(random: np.random.Generator, share: int) -> Iterator[tuple[str, np.ndarray | Scene]]:
    """Fewer rows with an axis: each is decided alone, in some 0.1 ms."""
    for family in TILTED_FAMILIES.values():
        yield "tilted families", family.rows(1, share // (200 if family.extreme else 20))
    for name, make in (
        ("tilted near", tilted_places.near_contact),
        ("tilted pole", tilted_places.at_a_pole),
        ("tilted grid", tilted_places.grid),
        ("tilted limits", tilted_places.at_the_limits),
        ("far tilted", tilted_places.far),
    ):
        for _ in range(0, share, 1 << 14):
            yield name, make(random, min(share, 1 << 14))
    for scene in tilted_places.scenes(random, share // 1000, 2048):
        yield "tilted scenes", scene
    for scene in tilted_places.on_the_planes(random, share // 500, 2048):
        yield "tilted planes", scene


def strike(subjects: Iterable[Subject], all_batches: Iterable[Batch]) -> Iterator[tuple[str, str, int, np.ndarray]]:
    """For each batch, rounding mode and subject: stratum, subject, number of rows asked and the rows answered wrong."""
    everyone = list(subjects)
    for each in all_batches:
        for mode in each.modes:
            for subject in everyone:
                some = slice(None, None, subject.every)
                with rounded(mode):
                    found = _asked(subject, each.asked, some)
                stratum = each.stratum if mode == TO_NEAREST else f"{each.stratum}, directed"
                yield stratum, subject.name, len(found), each.rows[some][found != each.truth[some]]


def _asked(subject: Subject, asked: np.ndarray | Scene, some: slice) -> np.ndarray:
    if isinstance(asked, Scene):
        return subject.scene(asked.sizes, *(column[some] for column in (asked.x, asked.y, asked.z)), axis=asked.axis)
    return subject.rows(asked[some])


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
