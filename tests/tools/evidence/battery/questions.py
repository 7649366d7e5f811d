"""The questions: frozen vectors, and rows and scenes at the borders of the bounds, each under some rounding modes.

The right answers are those of the files, and of the oracles for what is drawn (tests/tools/attack).
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tests.tools.attack import places, tilted_places
from tests.tools.attack.strike import truth_of
from tests.tools.evidence.battery import ended, timed
from tests.tools.evidence.battery.constructed import constructed, rows_of
from tests.tools.evidence.parts import ROOT
from tests.tools.evidence.seeds import CLEARANCES, LEANING, LEANING_SCENE, ROWS, SCENE, SWEEPS, numbers

ALL_MODES, NEAREST = 0b1111, 0b0001
ENDED = 7
"""A kind besides those of fuzzing/fuzzer.c: rows of 13. Here SWEEPS are all sweeps, two times behind each row."""

SIZE = 17 * 64
"""Centres of a scene: enough for half planes, and whole blocks."""

LEANING_PLACES = (
    tilted_places.near_contact,
    tilted_places.at_a_pole,
    tilted_places.grid,
    tilted_places.at_the_limits,
    tilted_places.far,
)


@dataclass(frozen=True)
class Questions:
    """Rows (n, k) of one kind, their answers int8 (n,), and the rounding modes as bits, to nearest first."""

    kind: int
    rows: np.ndarray
    right: np.ndarray
    modes: int = ALL_MODES

    @property
    def data(self) -> bytes:
        """What driver.c reads."""
        head = np.array([self.kind, self.modes, *self.rows.shape], "<i4")
        return head.tobytes() + self.rows.astype("<f8").tobytes() + self.right.astype(np.int8).tobytes()


def _cases(path: Path) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads(path.read_text(encoding="utf-8"))["cases"]
    return found


def frozen(every: int = 1) -> Iterator[Questions]:
    """Each `every`-th row of every file of frozen vectors; no scenes."""
    for path in sorted((ROOT / "cases").glob("*.json")):
        cases = _cases(path)[::every]
        rows = np.array([numbers(case) for case in cases])
        if "way-" in path.stem:
            yield Questions(SWEEPS, *timed.frozen(rows, cases), NEAREST | 4)
        elif rows.shape[1] > 7:
            kind = LEANING if rows.shape[1] == 10 else ENDED
            yield Questions(kind, rows, np.array([case.get("position", timed.INVALID) for case in cases]))
        else:
            right = np.array([case.get("position", timed.INVALID) for case in cases])
            yield Questions(ROWS, rows, right)
            clearances = [float.fromhex(case.get("clearance_hex", "nan")) for case in cases]
            yield Questions(CLEARANCES, np.column_stack([rows, clearances]), right, NEAREST | 4)


SCENES = ("forest-type-1", "forest-type-2", "flight", "small-integers", "tilted-tower", "tilted-symmetric")
"""Families whose first sizes, and axis, make a scene of all their centres."""


def frozen_scenes() -> Iterator[Questions]:
    """A scene from each of these families; the same on every machine, as no function of libm is asked."""
    for number, name in enumerate(SCENES):
        cases = _cases(ROOT / "cases" / f"{name}.json")
        rows = np.resize(np.array([numbers(case) for case in cases]), (SIZE, len(numbers(cases[0]))))
        rows[:, :4], rows[:, 7:] = rows[0, :4], rows[0, 7:]
        kind = SCENE if rows.shape[1] == 7 else LEANING_SCENE
        some = truth_of(rows[: len(cases)])
        yield Questions(kind, rows, np.resize(some, SIZE), NEAREST | 2 << number % 3)


def drawn(seed: int = 5) -> Iterator[Questions]:
    """Rows and scenes of the attack at the borders of positions and bounds, under two rounding modes or more."""
    random = np.random.default_rng(seed)
    rows = [make(random, 1500) for make in (places.near_contact, places.on_the_ring, places.grid, places.far)]
    rows += [make(random, 300) for make in LEANING_PLACES]
    for number, some in enumerate(rows):
        far = number in (3, len(rows) - 1)
        kind = ROWS if some.shape[1] == 7 else LEANING
        yield Questions(kind, some, truth_of(some), ALL_MODES if far else NEAREST | 2 << number % 3)
    scenes = [*places.scenes(random, 10, SIZE), *places.wild_scenes(random, 4, SIZE)]
    scenes += [*places.on_the_lines(random, 5, SIZE), *places.far_scenes(random, 3, SIZE)]
    scenes += [*tilted_places.scenes(random, 3, SIZE), *tilted_places.on_the_planes(random, 3, SIZE)]
    for number, scene in enumerate(scenes):
        kind = SCENE if scene.axis is None else LEANING_SCENE
        yield Questions(kind, scene.rows, truth_of(scene.rows), NEAREST | 2 << number % 3)


def constructed_about_ends() -> Iterator[Questions]:
    """Rows and sweeps for one branch each, under two rounding modes."""
    rows = rows_of(ended.FAR_FROM_THE_MULTIPLIER)
    yield Questions(ENDED, rows, ended.positions_of(rows), NEAREST | 4)
    for rows in ended.constructed_sweeps():
        yield Questions(SWEEPS, *timed.timed(rows), NEAREST | 4)


def drawn_about_ends(seed: int, every: int) -> Iterator[Questions]:
    """Rows and sweeps beside hyperboloids that end, under two rounding modes each."""
    for number, rows in enumerate(ended.drawn_rows(seed, every)):
        yield Questions(ENDED, rows, ended.positions_of(rows), NEAREST | 2 << number % 3)
    for number, rows in enumerate(ended.drawn_sweeps(seed, every)):
        yield Questions(SWEEPS, *timed.timed(rows), NEAREST | 2 << number % 3)


def write(path: Path, every: int = 6, seeds: tuple[int, ...] = (5,)) -> Path:
    """Writes the file of questions that driver.c reads; what takes longest, scenes, comes last."""
    made = [Questions(kind, rows, right, NEAREST | 4) for kind, rows, right in constructed()]
    of_seeds = (each for seed in seeds for each in (*drawn(seed), *drawn_about_ends(seed, every)))
    asked = [*frozen(every), *made, *constructed_about_ends(), *frozen_scenes(), *of_seeds]
    with path.open("wb") as file:
        for questions in sorted(asked, key=lambda each: each.kind in (SCENE, LEANING_SCENE)):
            file.write(questions.data)
    return path
