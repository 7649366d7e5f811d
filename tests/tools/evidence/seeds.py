"""The frozen vectors as inputs of the fuzzer: a kind, a choice and doubles (fuzzing/fuzzer.c)."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from tests.tools.evidence.parts import ROOT

ROWS, LEANING, SCENE, LEANING_SCENE, SWEEPS, LEANING_WAYS, CLEARANCES = range(7)
WIDTHS = {ROWS: 7, LEANING: 10, SCENE: 7, LEANING_SCENE: 10, SWEEPS: 10, LEANING_WAYS: 13, CLEARANCES: 7}
TOGETHER = {ROWS: 8, LEANING: 4, SCENE: 8, LEANING_SCENE: 4, SWEEPS: 2, LEANING_WAYS: 2, CLEARANCES: 2}
"""Numbers of a row, and rows of an input."""


def frozen_rows() -> Iterator[tuple[str, np.ndarray]]:
    """The name and the rows of each file of frozen vectors, (n, 7), (n, 10) or (n, 13)."""
    for path in sorted((ROOT / "cases").glob("*.json")):
        cases = json.loads(path.read_text(encoding="utf-8"))["cases"]
        yield path.stem, np.array([numbers(case) for case in cases])


def numbers(case: dict[str, list[str]]) -> list[float]:
    """A row; that of an invalid one is given by its bits."""
    if "bits" in case:
        return [struct.unpack(">d", bytes.fromhex(each))[0] for each in case["bits"]]
    return [float.fromhex(each) for each in case["hex"]]


def seeds(every: int = 1) -> Iterator[bytes]:
    """Inputs made of each `every`-th frozen row: all kinds that its file allows, levels and rounding modes in turn."""
    turn = 0
    for name, rows in frozen_rows():
        for kind in _kinds(name, rows.shape[1]):
            some = rows[::every]
            for start in range(0, len(some), TOGETHER[kind]):
                choice = turn % 64
                turn += 5  # prime to 64: every level meets every mode and question
                yield bytes((kind, choice)) + some[start : start + TOGETHER[kind]].astype("<f8").tobytes()


def _kinds(name: str, width: int) -> tuple[int, ...]:
    if name.startswith(("way-", "tilted-way-")):
        return (SWEEPS,) if width == WIDTHS[SWEEPS] else (LEANING_WAYS,)
    return (ROWS, SCENE, CLEARANCES) if width == WIDTHS[ROWS] else (LEANING, LEANING_SCENE)


def write_seeds(folder: Path, every: int = 1) -> int:
    """Writes the seeds as files of a corpus; returns how many."""
    made = list(seeds(every))
    for number, seed in enumerate(made):
        (folder / f"seed-{number:05}").write_bytes(seed)
    return len(made)
