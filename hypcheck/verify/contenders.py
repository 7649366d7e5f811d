"""What verify times: the fast path beside the plain formula, general-purpose roots and FCL, on the cooling tower."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hypcheck.bench.rounds import Entry, Samples, clocked
from hypcheck.casebook.families import FAMILIES
from hypcheck.methods.builtin import fast_scene
from hypcheck.methods.fcl_naive import point_mesh
from hypcheck.methods.method import Answers
from hypcheck.methods.roots import by_numpy
from hypcheck.record.lines import Timing
from hypcheck.rows import CANNOT_SAY, Rows
from hypcheck.verify.opinions import ORACLES

WORKLOAD = "tower-body"
ROWS = 100_000
FAST, PLAIN = "fast path", "plain numpy formula"


@dataclass(frozen=True)
class Contender:
    """Something to be timed: `run` answers the first `count` rows of the workload it is given."""

    name: str
    title: str
    run: Callable[[Rows], Answers]
    count: int

    def entry(self, rows: Rows) -> Entry:
        """It, ready to be timed on those rows."""
        part = rows[: self.count]
        return Entry(self.name, len(part), clocked(lambda: self.run(part)))


def workload(seed: int) -> Rows:
    """Uniform positions in the box around the cooling tower; all rows have its sizes."""
    return FAMILIES[WORKLOAD].rows(seed, ROWS)


def contenders(*, meshes: bool) -> list[Contender]:
    """The methods to be timed; the slow ones on fewer rows. FCL is loaded only where `meshes` are asked for."""
    found = [
        Contender(FAST, "certified floats, integers where they cannot tell; exact", _fast, ROWS),
        Contender(PLAIN, "Table 2 as one writes it in numpy; not certified", _plain, ROWS),
        Contender("numpy.roots", "eigenvalues of the companion matrix, one call a row; not certified", by_numpy, 200),
    ]
    if meshes and ORACLES["mesh"].available() is None:
        found += [
            Contender("FCL point-mesh", "distance to a mesh of 2,000 triangles built for each row", point_mesh, 60),
            Contender("FCL certified", "two one-sided meshes built for each row; contact or clear only", _mesh, 60),
        ]
    return found


def line(contender: Contender, timing: Samples) -> Timing:
    """The record's line about one contender."""
    return Timing(
        workload=WORKLOAD,
        median_ns=timing.median_ns,
        name=timing.name,
        title=contender.title,
        rows=timing.rows,
        loops=timing.loops,
        samples_ns=timing.samples_ns,
        checksum=timing.checksum,
    )


def _fast(rows: Rows) -> Answers:
    sizes = tuple(rows[0, :4].tolist())
    return fast_scene((sizes[0], sizes[1], sizes[2], sizes[3]), rows[:, 4], rows[:, 5], rows[:, 6])


def _plain(rows: Rows) -> Answers:
    """Procedure 1 and the repaired interior condition, as the paper's Table 2 reads in numpy."""
    alpha, gamma, b, d = rows[0, :4].tolist()
    x, y, z = rows[:, 4], rows[:, 5], rows[:, 6]
    A, B = (alpha / b) ** 2, (gamma / d) ** 2
    c0 = -A * B
    P, Q = (x**2 + y**2) / b**2, (z / d) ** 2
    c1 = c0 + A - B + B * P - A * Q
    c2 = A - B + 1 - P - Q
    delta = -4 * c2**3 * c0 + (c2 * c1) ** 2 + 18 * c2 * c1 * c0 - 4 * c1**3 - 27 * c0**2
    clear, outside = delta > 0, (c2 < 0) & (c1 > 0)
    return np.where(clear, np.where(outside, 1, -1), 0).astype(np.int8)


def _mesh(rows: Rows) -> Answers:
    opinions = ORACLES["mesh"].ask(rows)
    return np.array([CANNOT_SAY if each.position is None else each.position for each in opinions], dtype=np.int8)
