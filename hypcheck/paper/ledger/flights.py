"""The ledger's entries about section 4's flights: where Δ is small, and what Table 5 says of its own figures."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from itertools import pairwise

from hypcheck.paper.ledger import entry
from hypcheck.paper.ledger.entry import (
    FALSE,
    NOT_CHECKABLE,
    PROVED,
    Evidence,
    LedgerEntry,
    harmless_where,
    with_counterexample,
)
from hypcheck.paper.ledger.points import SquaredRatios, Statement, discriminant
from hypcheck.paper.tower_flights import PRINTED, SPEEDS, TIMES

TOWER = ("64", "126736/9")
"""A = (2/0.25)² and B = (17.8/0.15)² of the paper's body in its tower."""

ON_THE_AXIS = SquaredRatios(*TOWER, "0", "0")
NEAR_THE_WALL = SquaredRatios(*TOWER, "33884041/390625", "126736/9")
"""z = 17.8 m, where the wall is 2.8284 m from the axis, and 2.3284 m from it: P = (2.3284/0.25)²."""


def flights() -> tuple[LedgerEntry, ...]:
    """In the order of the text."""
    return (_near_the_wall(), _clear_by_discriminant(), _look_ahead(), *_shares(), *_order(), _equal_steps())


def _near_the_wall() -> LedgerEntry:
    axis, near = discriminant(ON_THE_AXIS), discriminant(NEAR_THE_WALL)
    return LedgerEntry(
        "Section 4, near the wall",
        "4",
        "the values of Δ closest to zero are those where the UAV is near the wall",
        FALSE,
        f"in the paper's tower Δ is {round(axis / 10**18)}·10¹⁸ on the axis at the waist, 2 m from the wall, and "
        f"{round(near / 10**18)}·10¹⁸ at z = 17.8 m, half a metre from it",
        "do not read a distance off Δ; `hypcheck classify` prints the clearance, which is a distance",
        lambda: (
            Evidence("count", "the greater Δ is the one nearer to the wall", 0 < axis < near),
            Evidence(
                "count",
                "at each of 7 heights from 0 to 17.8 m Δ falls at each of the steps of 6 cm from the axis to Δ ≤ 0",
                all(_falls(height) for height in range(7)),
            ),
        ),
        "at one height Δ falls towards the wall; across heights it does not tell how near the wall is",
        harmless="at one height of the paper's tower: there Δ falls from the axis to the wall",
    )


def _falls(height: int) -> bool:
    """Whether Δ falls along a radius at height/6 of γ until it is not above 0, in steps of b/4."""
    Q = str(Fraction(126736 * height**2, 9 * 36))
    values = [discriminant(SquaredRatios(*TOWER, str(Fraction(step**2, 16)), Q)) for step in range(48)]
    end = next(place for place, value in enumerate(values) if value <= 0)
    return end > 20 and _falling(values[: end + 1])


def _falling(values: Iterable[Fraction | float]) -> bool:
    return all(one > two for one, two in pairwise(values))


CLEAR_IS_POSITIVE = Statement(
    "interior or exterior ⟺ Δ > 0", entry.wide, lambda facts: entry.contact(facts) == (facts.delta <= 0)
)


def _clear_by_discriminant() -> LedgerEntry:
    return LedgerEntry(
        "Section 4, discriminant",
        "4",
        "interior or exterior positions correspond to Δ > 0",
        FALSE,
        "the ring is exterior with Δ = 0; for (γ/d)² < α/b there is contact with Δ > 0",
        "inside the paper's tower the sentence holds, so the share of Δ ≤ 0 is the share of contact there",
        lambda: (
            with_counterexample(CLEAR_IS_POSITIVE),
            harmless_where(CLEAR_IS_POSITIVE, lambda facts: entry.tall(facts) and not entry.exterior(facts)),
        ),
        "for α/b ≥ 1 and (γ/d)² ≥ α/b: interior, or exterior off the ring ⟺ Δ > 0",
        harmless="inside a hyperboloid with (γ/d)² ≥ α/b, as in the paper's tower",
    )


def _look_ahead() -> LedgerEntry:
    return LedgerEntry(
        "Section 4, look-ahead",
        "4",
        "the prediction is made for the position in t seconds",
        NOT_CHECKABLE,
        "whether the UAV also moves by v·t, and how far up, down and after a turn, is not said",
        "`hypcheck simulate tower` takes v·t for both, and says so",
    )


def _shares() -> tuple[LedgerEntry, ...]:
    most = max(max(row) for row in PRINTED)
    first = PRINTED[0]
    fall = 100 * (1 - first[-1] / first[0])
    return (
        LedgerEntry(
            "Table 5",
            "4",
            "the percentages of executions with Δ ≤ 0",
            NOT_CHECKABLE,
            "the rules of flight, l, g1, the heights and the start are not stated; about 40,000 combinations "
            "of rules were "
            "tried, and many fit about as well",
            "`hypcheck simulate tower --table 5` sets its own figures beside the printed ones, every assumption named",
        ),
        LedgerEntry(
            "Table 5, below 14 %",
            "4",
            "less than 14 % of executions in all cases",
            PROVED,
            f"true of the printed figures, the greatest of which is {most}; the greatest of our own is 14.06 ± 0.05 "
            "(v = 6) with l = 0.135, where rotors overlap, and with rotors apart, 0.1414 ≤ l ≤ 0.15, 13.66 to 13.09",
            "“extremely low” has no measure; for Procedure 2.b it means about one question in seven that "
            "asks the rotors",
            lambda: (Evidence("count", f"{most} < 14", most < 14),),
        ),
        LedgerEntry(
            "Table 5, t = 0.1",
            "4",
            "for t = 0.1 the values are similar, independently of the speed",
            FALSE,
            f"they fall at every step, from {first[0]} to {first[-1]}, by {fall:.1f} % of the first; a "
            "standard error is "
            "0.04 to 0.08",
            "the share depends on v·t in this row as in the others; its steps are shorter",
            lambda: (
                Evidence("count", f"falls at each of 5 steps, by {fall:.1f} % in all", _falling(first) and fall > 10),
            ),
            "for t = 0.1 the values fall with the speed too, by less",
            harmless="for the other rows' statement, which is true of this one as well",
        ),
    )


def _order() -> tuple[LedgerEntry, ...]:
    columns = list(zip(*PRINTED, strict=True))
    return (
        LedgerEntry(
            "Table 5, speed",
            "4",
            "the percentage falls as the speed rises",
            PROVED,
            "true of the printed figures, in all three rows",
            "longer steps leave the wall's neighbourhood faster",
            lambda: (Evidence("count", "15 falls of 15", all(map(_falling, PRINTED))),),
        ),
        LedgerEntry(
            "Table 5, response time",
            "4",
            "the percentage falls as t rises",
            PROVED,
            "true of the printed figures, in all six columns",
            "as for the speed",
            lambda: (Evidence("count", "12 falls of 12", all(map(_falling, columns))),),
        ),
        LedgerEntry(
            "Table 5, reason",
            "4",
            "higher speeds and times lead to higher probabilities of interior or exterior positions",
            NOT_CHECKABLE,
            "inside the paper's tower this is the same share, counted from the other side, and no reason for it",
            "see Section 4, discriminant",
        ),
    )


def _equal_steps() -> LedgerEntry:
    (first, second, third), speeds = PRINTED, list(SPEEDS)
    pairs = (
        (first[speeds.index(10)], second[speeds.index(5)], 10 * TIMES[0], 5 * TIMES[1]),
        (third[speeds.index(6)], second[speeds.index(9)], 6 * TIMES[2], 9 * TIMES[1]),
    )
    read_anew = third[speeds.index(5)], second[speeds.index(6)]
    text = ", ".join(f"{one:.2f} against {other:.2f} at v·t = {step:g}" for one, other, step, _ in pairs)
    return LedgerEntry(
        "Table 5, equal steps",
        "4",
        "the rows are of t = 0.1, 0.2 and 0.3, and a flight depends on v and t by the way v·t alone",
        FALSE,
        f"equal v·t must give equal figures, and do not: {text}. With t = 0.25 in the second row they do: "
        f"{read_anew[1]:.4f} against {read_anew[0]:.4f} at v·t = 1.5",
        "the best single argument that t = 0.2 is a misprint for 0.25, if the look-ahead and the step are both v·t",
        lambda: (
            Evidence(
                "count",
                f"{text}: more than 7 standard errors of a difference",
                all(abs(one - other) > 0.6 and abs(here - there) < 1e-9 for one, other, here, there in pairs),
            ),
            Evidence(
                "count",
                "t = 0.25 brings the two figures of v·t = 1.5 to within 0.02",
                abs(read_anew[0] - read_anew[1]) < 0.02,
            ),
        ),
        "t = 0.25 in the second row (an inference; the printed page or the authors must confirm it)",
        harmless="for the other two rows, and for the order of the figures",
    )
