"""A program that knows by heart every row that stays, and answers contact to all others.

What it knows are the frozen vectors of all families of positions, and the first rows of the seed that runs use. It is
a folder of two files: a function, and its table. The function imports numpy alone, so that it can be isolated.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from hypcheck import classify
from hypcheck.runs.cases import first_unfrozen
from hypcheck.vectors import frozen
from hypcheck.vectors.families import ALL, FAMILIES

SEED = 1
SPEC = "python:by_heart.py:classify"

_PROGRAM = """import json
import numpy as np

with open("known.json") as file:
    KNOWN = json.load(file)


def classify(rows):
    return np.array([KNOWN.get(row.tobytes().hex(), 0) for row in rows], dtype=np.int8)
"""


def write(folder: Path, count: int) -> None:
    """Write the program; it knows as many generated rows of each family that is asked as a run of that count asks."""
    known: dict[str, int] = {}
    for name in dict.fromkeys([*frozen.NAMES, *FAMILIES]):
        if name in FAMILIES and name not in ALL:
            continue
        family, rows = FAMILIES.get(name), [frozen.load(name).rows] if name in frozen.NAMES else []
        if family is not None:
            rows.append(family.rows(SEED, first_unfrozen(family, SEED) + count * family.times))
        every = np.vstack(rows)
        known |= {row.tobytes().hex(): int(answer) for row, answer in zip(every, classify(every), strict=True)}
    (folder / "known.json").write_text(json.dumps(known))
    (folder / "by_heart.py").write_text(_PROGRAM)
