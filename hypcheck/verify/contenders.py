"""What verify times: the fast path beside the plain formula, general-purpose roots and FCL, on the cooling tower."""

from __future__ import annotations

import numpy as np

from hypcheck.bench.timing import Contender
from hypcheck.casebook.families import FAMILIES
from hypcheck.kernel import numpy_path
from hypcheck.methods.fcl_naive import point_mesh
from hypcheck.methods.method import Answers
from hypcheck.rows import CANNOT_SAY, Rows
from hypcheck.verify.opinions import ORACLES

WORKLOAD = "tower-body"
ROWS = 100_000
FAST, PLAIN = "fast path", "plain numpy formula"


def workload(seed: int) -> Rows:
    """Uniform positions in the box around the cooling tower; all rows have its sizes."""
    return FAMILIES[WORKLOAD].rows(seed, ROWS)


def contenders() -> list[Contender]:
    """The methods to be timed; the slow ones on fewer rows. FCL is left out where it cannot be imported."""
    found = [
        Contender(FAST, "certified floats, integers where they cannot tell; exact", _fast, ROWS),
        Contender(PLAIN, "Table 2 as one writes it in numpy; not certified", _plain, ROWS),
        Contender("numpy.roots", "eigenvalues of the companion matrix, one call a row; not certified", _roots, 200),
    ]
    if ORACLES["mesh"].available() is None:
        found += [
            Contender("FCL point-mesh", "distance to a mesh of 2,000 triangles built for each row", point_mesh, 60),
            Contender("FCL certified", "two one-sided meshes built for each row; contact or clear only", _mesh, 60),
        ]
    return found


def _fast(rows: Rows) -> Answers:
    sizes = tuple(rows[0, :4].tolist())
    return numpy_path.positions_of_scene((sizes[0], sizes[1], sizes[2], sizes[3]), rows[:, 4], rows[:, 5], rows[:, 6])


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


def _roots(rows: Rows) -> Answers:
    """The roots of g by numpy.roots: three real ones and their signs, as [10] is read in floats."""
    A, B = (rows[:, 0] / rows[:, 2]) ** 2, (rows[:, 1] / rows[:, 3]) ** 2
    P, Q = (rows[:, 4] ** 2 + rows[:, 5] ** 2) / rows[:, 2] ** 2, (rows[:, 6] / rows[:, 3]) ** 2
    c0, c1, c2 = -A * B, B * (P - A - 1) + A * (1 - Q), A - B + 1 - P - Q
    found = np.empty(len(rows), dtype=np.int8)
    for index, coefficients in enumerate(np.column_stack([np.ones(len(rows)), c2, c1, c0])):
        values = np.roots(coefficients)
        real = not np.iscomplexobj(values) or bool((values.imag == 0).all())
        found[index] = 0 if not real else (1 if (values.real > 0).all() else -1)
    return found


def _mesh(rows: Rows) -> Answers:
    opinions = ORACLES["mesh"].ask(rows)
    return np.array([CANNOT_SAY if each.position is None else each.position for each in opinions], dtype=np.int8)
