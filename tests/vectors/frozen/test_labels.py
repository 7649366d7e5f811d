"""Making cases: short proofs, flags of rows worked out by hand, ids that are kept, searches that repeat."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hypcheck.answer import DisagreementError
from hypcheck.errors import InputError
from hypcheck.geometry.pair import Pair, Position
from hypcheck.implementations.domain import Domain, representable
from hypcheck.tables.numbers import Literal, decimal_of, exact_text, hex_of, is_shortest, rational_of
from hypcheck.vectors import freezing
from hypcheck.vectors import frozen as vectors
from hypcheck.vectors.cancellation import BEGINNINGS, STRATA, CancellationSearch, searches, worst_row
from hypcheck.vectors.cases import cases_text, read_cases
from hypcheck.vectors.families import ALL, FAMILIES
from hypcheck.vectors.format import content_with, flag_facts
from hypcheck.vectors.freezing import extended, frozen, frozen_invalid_rows
from hypcheck.vectors.invalid_rows import invalid_rows
from hypcheck.vectors.labels import DEFEATED, flags_of, in_range, labelled, shows_crossing, stored_certificate
from tests.support import inside
from tests.support.examples import examples
from tests.support.inside import Certificate, prove
from tests.support.pairs import pairs

# flag → rows that have it and rows that have it not, by hand. A row is α, γ, b, d, x, y, z.
BY_HAND = {
    "tangent": (
        [(1, 2, 1, 1, 2, 0, 0), (4, 4, 1, 1, 3, 0, 0)],
        [(1, 2, 1, 1, 2.0000001, 0, 0), (1, 2, 1, 1, 2.5, 0, 0)],
    ),
    "ring": ([(1, 2, 1, 1, 2.5, 0, 0), (7, 7, 1, 1, 10, 0, 0)], [(1, 2, 1, 1, 2, 0, 0), (1, 2, 1, 1, 2.5, 0, 0.5)]),
    "delta=0": ([(1, 2, 1, 1, 2.5, 0, 0), (1, 2, 1, 1, 2, 0, 0)], [(1, 2, 1, 1, 2.4, 0, 0)]),
    "c2=0": ([(3, 3, 1, 1, 1, 0, 0)], [(3, 3, 1, 1, 1.5, 0, 0)]),
    "c1=0": ([(4, 1, 1, 1, 1, 0, 0)], [(4, 1, 1, 1, 1.5, 0, 0)]),
    "a<1": ([(1, 2, 1.5, 1, 9, 0, 0)], [(1, 2, 1, 1, 9, 0, 0), (2, 2, 1, 1, 9, 0, 0)]),
    "a=1": ([(1, 2, 1, 1, 9, 0, 0)], [(1, 2, 1 + 2.0**-52, 1, 9, 0, 0)]),
    "c^2<a": ([(5, 2, 1, 1, 9, 0, 0)], [(4, 2, 1, 1, 9, 0, 0), (3, 2, 1, 1, 9, 0, 0)]),
    "c^2=a": ([(4, 2, 1, 1, 9, 0, 0)], [(4, 2, 1, 1 + 2.0**-52, 9, 0, 0)]),
    "axis": ([(4, 2, 1, 1, 0, -0.0, 3)], [(4, 2, 1, 1, 0, 5e-324, 3)]),
    "waist": ([(4, 2, 1, 1, 1, 1, -0.0)], [(4, 2, 1, 1, 1, 1, 5e-324)]),
    "on-surface": ([(3, 4, 1, 1, 5, 0, 16 / 3 + 1), (3, 4, 1, 1, 3, 0, 0)], []),
    "negative-zero": ([(4, 2, 1, 1, -0.0, 1, 1)], [(4, 2, 1, 1, 0.0, -1, 1)]),
    "extreme": (
        [(4e8, 2, 1, 1, 1, 1, 1), (4, 2, 1e-7, 1, 1, 1, 1), (4, 2, 1, 1, 1e7, 1, 1), (1e-5, 1, 1e4, 1, 0, 0, 0)],
        [(1e6, 1e-6, 1, 1, 1e-7, 1e6, 0)],
    ),
    "float32-exact": (
        [(4, 2, 1, 1, 0.5, 16777215, 2.0**-126)],
        [(4, 2, 1, 1, 0.5, 16777217, 1), (4, 2, 1, 1, 0.1, 1, 1), (4, 2, 1, 1, 2.0**-127, 1, 1)],
    ),
    "float16-exact": ([(4, 2, 1, 1, 65504, 2.0**-14, 0)], [(4, 2, 1, 1, 65505, 0, 0), (4, 2, 1, 1, 2.0**-15, 0, 0)]),
    "subnormal-float16": ([(4, 2, 1, 1, 2.0**-15, 0, 0)], [(4, 2, 1, 1, 2.0**-14, 0, 0), (4, 2, 1, 1, 2.0**-25, 0, 0)]),
    "subnormal-float32": (
        [(4, 2, 1, 1, 2.0**-149, 0, 0)],
        [(4, 2, 1, 1, 2.0**-126, 0, 0), (4, 2, 1, 1, 2.0**-150, 0, 0)],
    ),
    "subnormal-float64": ([(4, 2, 1, 1, 5e-324, 0, 0)], [(4, 2, 1, 1, 2.0**-1022, 0, 0)]),
    # (α/b)² is 2¹⁸, 2¹²⁸, 2¹⁰²⁴; 27 c0² and c2³ of smaller ratios overflow too.
    "overflow-float16": (
        [(512, 1, 1, 1, 1, 1, 1), (1, 1, 1, 1, 32, 1, 1)],
        [(1, 1, 1, 1, 1, 1, 1), (70000, 1, 1, 1, 1, 1, 1)],
    ),
    "overflow-float32": ([(2.0**64, 1, 1, 1, 1, 1, 1)], [(2.0**10, 1, 1, 1, 1, 1, 1), (2.0**200, 1, 1, 1, 1, 1, 1)]),
    "overflow-float64": ([(2.0**512, 1, 1, 1, 1, 1, 1)], [(2.0**64, 1, 1, 1, 1, 1, 1)]),
    "underflow-float16": ([(1, 1, 1, 1, 2.0**-8, 1, 1)], [(1, 1, 1, 1, 1, 1, 1), (1, 1, 1, 1, 2.0**-16, 1, 1)]),
    "underflow-float32": ([(1, 1, 1, 1, 2.0**-64, 1, 1)], [(1, 1, 1, 1, 2.0**-8, 1, 1)]),
    "underflow-float64": ([(1, 1, 1, 1, 2.0**-512, 1, 1)], [(1, 1, 1, 1, 2.0**-64, 1, 1)]),
    # The witnesses of docs/mathematics.md, "Where the paper is wrong".
    "proposition-3-false": ([(1, 2, 1, 1, 2.5, 0, 0), (2, 0.5, 1, 1, 4, 0, 0)], [(1, 2, 1, 1, 2.4, 0, 0)]),
    "proposition-5-false": ([(3, 3, 1, 1, 1, 0, 0), (4, 1, 1, 1, 1, 0, 0)], [(3, 3, 1, 1, 1.5, 0, 0)]),
}


def flags_at(*rows):
    return flags_of(content_with(), rows, [inside.decide(Pair.from_row(row).lengths) for row in rows])


@pytest.mark.parametrize("flag", BY_HAND)
def test_flags_of_rows_worked_out_by_hand_are_right(flag):
    with_it, without = ([tuple(map(float, row)) for row in rows] for rows in BY_HAND[flag])
    if flag == "on-surface":
        with_it = with_it[1:]  # 5² / 3² − (16/3 + 1)²/4² − 1 is not 0 in floats
    assert [flag in flags for flags in flags_at(*with_it)] == [True] * len(with_it)
    if without:
        assert [flag in flags for flags in flags_at(*without)] == [False] * len(without)


def test_rounding_flags_of_cases_agree_with_the_wrong_answers_of_built_in_methods():
    """What judge.py calls wrong at 8 u of a built-in method, where exact arithmetic has it right."""
    from hypcheck.derivation.evaluation import EXACT
    from hypcheck.derivation.formulas import FORMULAS, answers
    from hypcheck.geometry.pair import COLUMNS
    from hypcheck.implementations.builtin import methods
    from hypcheck.runs.judge import Criterion, Status, expected
    from tests.support.judging import wrong_cases

    names = ("osculation", "near-axis", "ring-neighbourhood", "extreme-float32", "worst-cancellation")
    rows = np.concatenate([vectors.load(name).rows[:60] for name in names])
    flags = flags_at(*map(tuple, rows.tolist()))
    positions = np.asarray([inside.decide(Pair.from_row(row).lengths).position for row in rows.tolist()], dtype=np.int8)
    for formula, precision in DEFEATED:
        method = methods()[f"{formula}-{precision}"]
        asked = np.flatnonzero(representable(rows, precision))
        criterion = Criterion(method.question, precision)
        wrong = wrong_cases(rows[asked], positions[asked], method.answer(rows[asked]), criterion)
        right = expected(positions, method.question)
        wanted = {
            place
            for place in (int(asked[case.index]) for case in wrong if case.status is Status.WRONG)
            if int(answers(FORMULAS[formula], EXACT, dict(zip(COLUMNS, rows[place].tolist(), strict=True))))
            == right[place]
        }
        assert wanted
        assert {place for place, found in enumerate(flags) if f"{formula}-{precision}" in found} == wanted


def test_the_flags_extreme_and_the_ranges_of_formats_agree_with_domain_and_representable():
    rows = np.concatenate([vectors.load(name).rows for name in vectors.NAMES])
    flagged = ["extreme" in case.flags for name in vectors.NAMES for case in vectors.load(name).cases]
    assert flagged == (~Domain().holds(rows)).tolist()
    for precision in ("float16", "float32", "float64"):
        assert (in_range(rows, precision) == representable(rows, precision)).all()


def test_flags_of_a_case_come_in_the_order_of_the_table():
    for flags in flags_at(*[case.row for case in vectors.load("ring").cases[:20]]):
        assert list(flags) == [name for name in flag_facts("upright") if name in flags]


@given(pairs)
@settings(max_examples=25)
def test_shortened_certificates_still_prove_a_crossing(pair):
    decision = inside.decide(pair.lengths)
    found = stored_certificate(pair.row, prove(pair, decision))
    crosses = decision.position is Position.CONTACT and not decision.tangent
    assert bool(found.offsets) == crosses
    if crosses:
        assert shows_crossing(pair.row, found.offsets)


def test_points_in_certificates_of_ordinary_crossings_have_at_most_40_characters():
    for name in ("uniform", "tower-rotors", "on-surface", "out-of-regime"):
        lengths = sorted(
            max(len(exact_text(part)) for point in case.witness.offsets for part in point)
            for case in vectors.load(name).cases
            if case.witness.offsets
        )
        assert lengths[len(lengths) // 2] <= 8
        assert lengths[-1] <= 40


@pytest.mark.parametrize("outward", [True, False])
def test_a_proof_point_on_the_spheroid_is_moved_inside(outward):
    """The point 3/5 up, 4/5 out (or in) of a unit sphere lies on the hyperboloid, and the two cross there."""
    # (3/5, 4/5) from the centre, on x² − z² = 1 where x = 5/4, z = 3/4: the normal (5/4, −3/4) is not (4/5, 3/5).
    side = Fraction(1 if outward else -1)
    reach = (side * Fraction(4, 5), Fraction(0), Fraction(3, 5))
    center = (Fraction(5, 4) - reach[0], Fraction(0), Fraction(3, 4) - reach[2])
    scaled = [float(20 * value) for value in center]
    pair = Pair(20.0, 20.0, 20.0, 20.0, *scaled)
    assert [Fraction(value) for value in scaled] == [20 * value for value in center]
    touched = tuple(20 * (value + step) for value, step in zip(center, reach, strict=True))
    plain = Certificate(Position.CONTACT, points=(tuple(20 * value for value in center), touched))
    assert not shows_crossing(pair.row, ((Fraction(0),) * 3, reach))
    found = stored_certificate(pair.row, plain)
    assert shows_crossing(pair.row, found.offsets)
    assert max(len(exact_text(part)) for part in found.offsets[1]) < 20


def test_points_outside_the_spheroid_do_not_prove_a_crossing():
    """x = 4 is beyond the waist of x² + y² − z² = 1 and x = 0 inside it; a unit sphere at (3, 0, 0) has neither."""
    pair = Pair(1.0, 1.0, 1.0, 1.0, 3.0, 0.0, 0.0)
    inside, outside = (Fraction(-3), Fraction(0), Fraction(0)), (Fraction(1), Fraction(0), Fraction(0))
    assert not shows_crossing(pair.row, (inside, outside))
    wider = Pair(1.0, 1.0, 3.0, 1.0, 3.0, 0.0, 0.0)
    assert shows_crossing(wider.row, ((Fraction(-1), Fraction(0), Fraction(0)), outside))


@given(st.floats(allow_nan=False))
@examples(300)
def test_decimal_and_hexadecimal_texts_of_a_number_are_read_back_as_that_number(value):
    assert float.fromhex(hex_of(value)) == value
    assert math.copysign(1, float.fromhex(hex_of(value))) == math.copysign(1, value)
    if math.isfinite(value):
        assert float(decimal_of(value)) == value
        assert is_shortest(Literal(decimal_of(value)))
        assert is_shortest(Literal(f"{value:.25e}")) == (Fraction(f"{value:.25e}") == Fraction(repr(value)))
    else:
        assert decimal_of(value) == f'"{value}"'


def test_hexadecimal_text_of_a_number_equals_that_of_c_printf():
    assert [hex_of(value) for value in (0.0, -0.0, 1.5, -1e-300, 5e-324, 0.1, math.inf)] == [
        *("0x0p+0", "-0x0p+0", "0x1.8p+0", "-0x1.56e1fc2f8f359p-997", "0x0.0000000000001p-1022"),
        *("0x1.999999999999ap-4", "inf"),
    ]


@given(st.fractions())
@examples(100)
def test_rational_text_is_read_back_as_that_rational(value):
    assert rational_of(exact_text(value)) == value


def test_rationals_may_be_longer_than_python_reads_integers_but_not_without_end():
    value = Fraction(-(7**20_000), 2**30_001)
    assert rational_of(exact_text(value)) == value
    with pytest.raises(ValueError, match="a text of at most 100000 digits"):
        rational_of("7" * 100_001)


ROWS = [(1.0, 2.0, 1.0, 1.0, 2.5, 0.0, 0.0), (1.0, 2.0, 1.0, 1.0, 2.5, -0.0, 0.0), (1.0, 2.0, 1.0, 1.0, 2.0, 0.0, 0.0)]


def test_freezing_keeps_ids_of_old_rows_and_appends_new_ones():
    first = extended("mine", [], [ROWS[0], ROWS[0], ROWS[1]])
    assert first == [("mine-0000", ROWS[0]), ("mine-0001", ROWS[1])]
    assert extended("mine", first, [ROWS[2], ROWS[1]]) == [*first, ("mine-0002", ROWS[2])]
    gaps = [("mine-0007", ROWS[1]), ("mine/1/0/9", ROWS[0])]
    assert extended("mine", gaps, ROWS) == [*gaps, ("mine-0008", ROWS[2])]


def test_freezing_keeps_rows_of_an_older_generator_and_numbers_new_rows_after_them(monkeypatch):
    """Half of the frozen cases, in another order, and a row that no generator makes now."""
    monkeypatch.setitem(ALL, "ring", replace(ALL["ring"], frozen=12))
    now = frozen("ring")
    alien = replace(labelled(content_with(), [("ring-0500", ROWS[2])])[0])
    before = replace(now, cases=(now.cases[9], alien, now.cases[2]))
    after = frozen("ring", before)
    assert after.cases[:3] == before.cases
    assert [case.id for case in after.cases[3:]] == [f"ring-{number:04d}" for number in range(501, 511)]
    assert {case.row for case in after.cases} == {case.row for case in (*now.cases, alien)}
    assert frozen("ring", after) == after


def test_freezing_writes_files_that_are_read_back(tmp_path, monkeypatch):
    monkeypatch.setitem(ALL, "ring", replace(ALL["ring"], frozen=5))
    told = []
    freezing.freeze(["ring", "invalid", "ring"], tmp_path, told.append)
    assert told == ["ring", "invalid"]
    before = (tmp_path / "ring.json").read_bytes()
    assert len(read_cases(str(tmp_path / "ring.json")).cases) == 5
    assert read_cases(str(tmp_path / "invalid.json")) == vectors.load("invalid")
    freezing.freeze(["ring"], tmp_path)
    assert (tmp_path / "ring.json").read_bytes() == before


def test_freezing_does_not_overwrite_a_file_of_another_family(tmp_path):
    (tmp_path / "ring.json").write_text("precious", encoding="utf-8")
    with pytest.raises(InputError, match="line 1"):
        freezing.freeze(["ring"], tmp_path)
    assert (tmp_path / "ring.json").read_text(encoding="utf-8") == "precious"
    (tmp_path / "ring.json").write_text(cases_text(vectors.load("axis")), encoding="utf-8")
    with pytest.raises(InputError, match="of the family 'axis'"):
        freezing.freeze(["ring"], tmp_path)
    with pytest.raises(InputError, match="no frozen vectors 'rnig'"):
        freezing.freeze(["rnig"], tmp_path)
    with pytest.raises(InputError, match="is not a folder"):
        freezing.freeze(["ring"], tmp_path / "nowhere")


def test_freezing_refuses_a_label_that_fails_its_check(tmp_path, monkeypatch):
    """A maker of labels that lies about the clearance is found out before anything is written."""
    monkeypatch.setitem(ALL, "ring", replace(ALL["ring"], frozen=3))

    def wrong(content, cases):
        return [replace(case, clearance=1.0) for case in labelled(content, cases)]

    monkeypatch.setattr(freezing, "labelled", wrong)
    with pytest.raises(DisagreementError, match="ring-0000"):
        freezing.freeze(["ring"], tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_freezing_keeps_ids_of_old_invalid_rows_and_appends_new_ones():
    now = invalid_rows("invalid")
    before = replace(now, cases=(replace(now.cases[4], id="invalid-0700"), now.cases[0]))
    after = frozen_invalid_rows("invalid", before)
    assert after.cases[:2] == before.cases
    assert after.cases[2].id == "invalid-0701"
    assert {case.bits for case in after.cases} == {case.bits for case in now.cases}
    assert cases_text(frozen_invalid_rows("invalid", after)) == cases_text(after)


def test_every_family_is_frozen_except_the_known_ones_and_every_stratum_has_its_searches():
    kinds = ("tilted", "way", "tilted-way", "ended", "ended-way")
    domains = {f"{kind}-whole-domain" for kind in ("tilted", "way", "ended")}
    little = {f"{kind}nearly-zero" for kind in ("", "tilted-", "way-", "ended-", "tilted-ended-")}
    together = {"tilted-way-traps", "ended-way-lengths", "ended-way-coincidences"}
    together |= {f"tilted-ended-{kind}" for kind in ("traps", "coincidences", "way-traps", "way-coincidences")}
    assert {name for name, family in ALL.items() if not family.frozen} == {
        f"{kind}-one-number-changed" for kind in kinds
    } | domains | together | little
    assert set(STRATA) <= set(FAMILIES)
    assert len(searches()) == len(DEFEATED) * 2 * len(STRATA) * BEGINNINGS


def test_cancellation_search_that_finds_nothing_returns_none():
    assert worst_row(CancellationSearch("local-maximum", "float64", False, "uniform", 0)) is None


@pytest.mark.parametrize("row", [(1.0, 1.0, 0.25, 1.0, 1.0, 0.0, 1.0), (1.0, 1.0, 0.25, 1.0, 0.6, 0.8, 1.0)])
def test_a_crossing_through_the_tip_of_a_spheroid_is_shown_by_two_points_within_it(row):
    """The lower tip lies on the waist, and the points that are 1/4 across at the height 1 inside the wall, √2 out."""
    (case,) = labelled(content_with(), [("x-0000", row)])
    assert (case.position, case.tangent) == (Position.CONTACT, False)
    alpha, gamma, b, d, x, y, z = map(Fraction, row)
    levels = []
    for s, t, w in case.witness.offsets:
        assert s * s + t * t + w * w <= 1
        u, v, height = x + b * s, y + b * t, z + d * w
        levels.append((u * u + v * v) / alpha**2 - (height / gamma) ** 2 - 1)
    assert min(levels) < 0 < max(levels)
