"""The paper's rules, exactly, where its hypotheses hold and where they do not; and parts of the full rule left out."""

from __future__ import annotations

import numpy as np

from tests.tools.mutants import exactly
from tests.tools.mutants.exactly import position
from tests.tools.mutants.expectation import NO_TOLERANCE, wrong

BENT = ("--domain", '{"regimes": ["c2>=a"]}')
WIDE = ("--domain", '{"regimes": ["a>=1"]}')
EXTERIOR, INTERIOR = ("--question", "exterior"), ("--question", "interior")


def _never(t, k1, k2):
    return np.zeros(len(t.A), dtype=bool)


def _always(t, k1, k2):
    return np.ones(len(t.A), dtype=bool)


def _double_at_B(t, k1, k2):
    return (t.Q == 0) & (3 * t.B * t.B + 2 * k2 * t.B + k1 == 0)


def _procedure_1(t, k1, k2, delta):
    return (delta > 0) & exactly.all_positive(k1, k2)


def _printed_inside(t, k1, k2, delta):
    """Table 3: Δ > 0, and c2 > 0 and c1 ≠ 0 or c2 < 0 and c1 < 0."""
    return (delta > 0) & (((k2 > 0) & (k1 != 0)) | ((k2 < 0) & (k1 < 0)))


@wrong(claim=(*EXTERIOR, *BENT))
def procedure_1_as_printed(rows):
    """Procedure 1 where its hypothesis holds: the ring of clear positions with Δ = 0 is refused."""
    return position(rows, decide=_procedure_1)


@wrong(claim=EXTERIOR)
def procedure_1_everywhere(rows):
    """Procedure 1, mended on the ring, claimed for every regime."""
    return position(rows, decide=lambda t, k1, k2, d: _procedure_1(t, k1, k2, d) | exactly.ring(t, k1, k2))


@wrong(claim=(*INTERIOR, *WIDE))
def procedure_2a_as_printed(rows):
    """Procedure 2.a's test of a spheroid where its hypothesis holds: c1 = 0 and c2 = 0 are refused."""
    return position(rows, decide=_printed_inside)


@wrong(claim=INTERIOR)
def procedure_2a_everywhere(rows):
    """Procedure 2.a's test, mended where c1 or c2 vanishes, claimed for every regime."""
    return position(rows, decide=lambda t, k1, k2, d: (d > 0) & ~exactly.all_positive(k1, k2))


@wrong()
def both_procedures_everywhere(rows):
    """Three distinct roots are clear, whatever the regime; +1 where all are positive, else −1."""
    return position(rows, beyond=_never, above=_always)


@wrong()
def without_the_ring(rows):
    """The ring is called contact, everything else is right."""
    return position(rows, ring=_never)


@wrong(asked=NO_TOLERANCE)
def two_points_are_ring(rows):
    """On the waist every double root at B is called clear, tangencies at two points among them."""
    return position(rows, ring=_double_at_B)


@wrong(asked=NO_TOLERANCE)
def osculation_is_ring(rows):
    """The ring is said to have c² ≥ a, so that a triple root at B is called clear."""
    return position(rows, ring=lambda t, k1, k2: _double_at_B(t, k1, k2) & (t.A * t.U <= t.B * t.B))


@wrong()
def flanks_forgotten(rows):
    """Three roots beyond B, a sphere on both flanks of the groove, are called exterior."""
    return position(rows, beyond=_never)


@wrong()
def throat_forgotten(rows):
    """Two roots below −A, a sphere stuck in the throat, are called interior."""
    return position(rows, above=_always)


@wrong()
def flanks_by_the_slope_alone(rows):
    """g'(B) > 0 is asked for, c2 < −3B is not."""
    return position(rows, beyond=lambda t, k1, k2: 3 * t.B * t.B + 2 * k2 * t.B + k1 > 0)


@wrong()
def flanks_by_the_sum_alone(rows):
    """c2 < −3B is asked for, g'(B) > 0 is not."""
    return position(rows, beyond=lambda t, k1, k2: k2 < -3 * t.B)


@wrong()
def throat_by_the_slope_alone(rows):
    """g'(−A) > 0 is asked for, c2 < 3A is not."""
    return position(rows, above=lambda t, k1, k2: 3 * t.A * t.A - 2 * k2 * t.A + k1 > 0)


@wrong()
def throat_by_the_sum_alone(rows):
    """c2 < 3A is asked for, g'(−A) > 0 is not."""
    return position(rows, above=lambda t, k1, k2: k2 < 3 * t.A)


@wrong()
def never_interior_in_a_narrow_throat(rows):
    """Where α < b nothing is called interior, for the spheroid does not fit through the waist."""
    answers = position(rows)
    return np.where(rows[:, 0] < rows[:, 2], np.maximum(answers, 0), answers).astype(np.int8)
