"""One sign wrong: in each term of the coefficients (14), of the discriminant (13) and of the decision."""

from __future__ import annotations

from tests.tools.mutants import exactly
from tests.tools.mutants.exactly import delta_terms, position
from tests.tools.mutants.expectation import wrong


def _negated(*terms):
    """The discriminant with the terms of these numbers negated."""

    def delta(t, k0, k1, k2):
        return sum(-term if number in terms else term for number, term in enumerate(delta_terms(k0, k1, k2)))

    return delta


@wrong()
def c0(rows):
    """c0 = +AB."""
    return position(rows, c0=lambda t: t.A * t.B * t.U)


@wrong()
def c1_product(rows):
    """c1 begins with +AB."""
    return position(rows, c1=lambda t: exactly.c1(t) + 2 * t.A * t.B)


@wrong()
def c1_A(rows):
    """c1 has −A."""
    return position(rows, c1=lambda t: exactly.c1(t) - 2 * t.A * t.U)


@wrong()
def c1_B(rows):
    """c1 has +B."""
    return position(rows, c1=lambda t: exactly.c1(t) + 2 * t.B * t.U)


@wrong()
def c1_BP(rows):
    """c1 has −BP."""
    return position(rows, c1=lambda t: exactly.c1(t) - 2 * t.B * t.P)


@wrong()
def c1_AQ(rows):
    """c1 has +AQ."""
    return position(rows, c1=lambda t: exactly.c1(t) + 2 * t.A * t.Q)


@wrong()
def c2_A(rows):
    """c2 has −A."""
    return position(rows, c2=lambda t: exactly.c2(t) - 2 * t.A)


@wrong()
def c2_B(rows):
    """c2 has +B."""
    return position(rows, c2=lambda t: exactly.c2(t) + 2 * t.B)


@wrong()
def c2_one(rows):
    """c2 has −1."""
    return position(rows, c2=lambda t: exactly.c2(t) - 2 * t.U)


@wrong()
def c2_P(rows):
    """c2 has +P."""
    return position(rows, c2=lambda t: exactly.c2(t) + 2 * t.P)


@wrong()
def c2_Q(rows):
    """c2 has +Q."""
    return position(rows, c2=lambda t: exactly.c2(t) + 2 * t.Q)


@wrong()
def delta_4_c2_c0(rows):
    """Δ has +4 c2³ c0."""
    return position(rows, delta=_negated(0))


@wrong()
def delta_c2_c1(rows):
    """Δ has −c2² c1²."""
    return position(rows, delta=_negated(1))


@wrong()
def delta_18(rows):
    """Δ has −18 c2 c1 c0."""
    return position(rows, delta=_negated(2))


@wrong()
def delta_4_c1(rows):
    """Δ has +4 c1³."""
    return position(rows, delta=_negated(3))


@wrong()
def delta_27(rows):
    """Δ has +27 c0²."""
    return position(rows, delta=_negated(4))


@wrong()
def delta_whole(rows):
    """Δ < 0 is asked for where Δ > 0 should be."""
    return position(rows, delta=_negated(0, 1, 2, 3, 4))


@wrong()
def decision_c1(rows):
    """Exterior asks for c1 < 0 instead of c1 > 0."""
    return position(rows, positive=lambda k1, k2: exactly.all_positive(-k1, k2))


@wrong()
def decision_c2(rows):
    """Exterior asks for c2 > 0 instead of c2 < 0."""
    return position(rows, positive=lambda k1, k2: exactly.all_positive(k1, -k2))
