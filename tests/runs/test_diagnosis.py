"""Causes of wrong answers: each is named where its rule gives those very answers, and nowhere else."""

from importlib import resources

import numpy as np
import pytest

from hypcheck import classify, toml
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS, answers
from hypcheck.geometry.pair import COLUMNS
from hypcheck.implementations.domain import EVERYWHERE
from hypcheck.implementations.session import Answered
from hypcheck.record.fields import row_of
from hypcheck.runs.causes import SILENT, AnsweredRows, Scope
from hypcheck.runs.diagnosis import CAUSES, PLACE_CAUSES, causes_of, with_diagnosis
from hypcheck.runs.judge import Criterion, Mistake, Status, WrongCase
from hypcheck.runs.score import score
from hypcheck.runs.tally import EMPTY, merged_tally
from hypcheck.vectors.frozen import load

FAMILIES = ("ring", "ring-neighbourhood", "out-of-regime", "coefficient-zero", "near-axis", "uniform")
ORDINARY = Criterion()


def diagnosed(implementation, families=FAMILIES, criterion=ORDINARY, step=1):
    """The causes, None of what is unexplained, with the number of wrong answers; and how many are wrong in all."""
    tallies, clean, wrong = {}, [], 0
    for family in families:
        found = load(family)
        rows, positions, ids = found.rows[::step], found.positions[::step], found.ids[::step]
        given = np.asarray(implementation(rows), dtype=np.int8)
        scored = score(rows, positions, Answered.of(given), criterion)
        cases = [case for case in scored.judged() if case.status == "wrong"]
        right = np.flatnonzero(given == positions).tolist()
        named = [((0, case.index), ids[case.index]) for case in cases]
        tallies[family] = with_diagnosis(EMPTY, AnsweredRows(rows, positions, given, criterion), cases, right, named)
        wrong += len(cases)
        if not cases:
            clean.append(family)
    causes = causes_of(tallies, clean, criterion, EVERYWHERE)
    return {each.cause and each.cause.name: each.cases for each in causes}, wrong


def plain(rows):
    """The paper's two rules in float64, wherever they are asked."""
    delta, c1, c2 = _coefficients(rows)
    positive = (c2 < 0) & (c1 > 0)
    return np.where(delta > 0, np.where(positive, 1, -1), 0)


def _coefficients(rows):
    alpha, gamma, b, d, x, y, z = rows.T
    A, B, P, Q = (alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / b**2, (z / d) ** 2
    c2, c1, c0 = A - B + 1 - P - Q, -A * B + A - B + B * P - A * Q, -A * B
    return c2**2 * c1**2 - 4 * c1**3 - 4 * c2**3 * c0 - 27 * c0**2 + 18 * c2 * c1 * c0, c1, c2


def changed(change):
    """The exact answers to other rows."""

    def implementation(rows):
        other = rows.copy()
        change(other)
        return classify(other)

    return implementation


def with_mistakes_by_chance(rows):
    """Every seventh answer is another one, whatever the row."""
    exact = classify(rows).astype(int)
    exact[::7] = (exact[::7] + 2) % 3 - 1
    return exact


def test_each_wrong_answer_of_the_plain_formula_in_float64_has_a_cause():
    causes, wrong = diagnosed(plain)
    assert {"ring", "throat", "groove", "lost-beside-the-ring"} <= causes.keys()
    assert None not in causes
    assert sum(causes.values()) == wrong


def test_table_2_in_its_regime_errs_only_on_the_ring_and_by_rounding():
    table_2 = FORMULAS["table-2"]

    def implementation(rows):
        exterior = answers(table_2, float_arithmetic("float64"), dict(zip(COLUMNS, rows.T, strict=True)))
        return np.where(exterior == 1, 1, np.minimum(classify(rows), 0))

    causes, _ = diagnosed(implementation, ("ring", "ring-neighbourhood"))
    assert set(causes) == {"ring", "lost-beside-the-ring"}
    causes, _ = diagnosed(implementation, ("ring",))  # no other family denies a wrong sign in the discriminant
    assert set(causes) == {"ring"}


@pytest.mark.parametrize(
    ("implementation", "cause"),
    [
        (lambda rows: np.zeros(len(rows)), "always-0"),
        (lambda rows: -classify(rows).astype(int), "sides-exchanged"),
        (changed(lambda rows: rows.__setitem__((slice(None), 5), 0)), "y-ignored"),
        (changed(lambda rows: rows.__setitem__((slice(None), 3), rows[:, 2])), "ball-of-b"),
        (changed(lambda rows: rows.__setitem__((slice(None), [2, 3]), rows[:, [3, 2]])), "b-d"),
    ],
)
def test_diagnosis_names_a_rule_that_gives_all_answers(implementation, cause):
    causes, wrong = diagnosed(implementation, ("ring", "uniform"))
    assert causes == {cause: wrong}


def test_diagnosis_of_random_mistakes_names_no_rule_about_every_row():
    causes, wrong = diagnosed(with_mistakes_by_chance)
    everywhere = {cause.name for cause in CAUSES if cause.scope is Scope.EVERYWHERE}
    assert not everywhere & causes.keys()
    assert causes[None] > wrong / 2


def test_diagnosis_names_an_ignored_axis():
    causes, wrong = diagnosed(
        changed(lambda rows: rows.__setitem__((slice(None), slice(7, None)), (0.0, 0.0, 1.0))),
        ("tilted-small-integers",),
    )
    assert causes == {"axis-ignored": wrong}


def test_rounding_causes_agree_with_every_right_clear_answer():
    found = load("uniform")
    sure = found.positions != 0
    answered = AnsweredRows(found.rows[sure], found.positions[sure], found.positions[sure], ORDINARY)
    for cause in PLACE_CAUSES:
        said = cause.rule(answered)
        assert ((said == SILENT) | (said == answered.given)).all(), cause.name


def test_diagnoses_can_be_merged_in_any_order():
    found = load("ring")
    given = np.zeros(len(found.rows), dtype=np.int8)
    scored = score(found.rows, found.positions, Answered.of(given), ORDINARY)
    cases = list(scored.judged())
    answered = AnsweredRows(found.rows, found.positions, given, ORDINARY)
    parts = [
        with_diagnosis(EMPTY, answered, some, [], [((0, case.index), found.ids[case.index]) for case in some])
        for some in (cases[:50], cases[50:90], cases[90:])
    ]
    assert merged_tally(parts) == merged_tally(parts[::-1]) == merged_tally([merged_tally(parts[:2]), parts[2]])
    assert sum(each.cases for each in merged_tally(parts).explained) == len(cases)
    assert merged_tally([]) == EMPTY


def test_wrong_answers_that_no_rule_gives_at_all_are_counted_as_unexplained():
    found = load("uniform")
    clear = np.flatnonzero(found.positions == 1)[:1]
    answered = AnsweredRows(found.rows[clear], found.positions[clear], np.array([7], dtype=np.int8), ORDINARY)
    case = WrongCase(0, tuple(answered.rows[0].tolist()), 1, 7, Mistake.FALSE_CONTACT, Status.WRONG, -1.0)
    tallies = {"uniform": with_diagnosis(EMPTY, answered, [case], [], [((0, 0), "uniform-0000")])}
    (counted,) = causes_of(tallies, [], ORDINARY, EVERYWHERE)
    assert (counted.cause, counted.families) == (None, {"uniform": 1})
    kept = counted.worst.worst
    assert (row_of(kept), kept.answer, kept.mistake, counted.worst.exponent) == (case.row, 7, case.mistake, -1.0)


def test_causes_toml_has_no_unused_entry():
    text = resources.files("hypcheck.runs").joinpath("causes.toml").read_text(encoding="utf-8")
    assert toml.parsed(text, "causes.toml").keys() <= {cause.name for cause in CAUSES}


def by_roots(*, poles, ignoring_pairs=False, tolerance=0.0):
    """Code that computes roots: those that count as real are counted by sign, or between the poles."""

    def one(A, B, c2, c1, c0):
        roots = np.roots([1, c2, c1, c0])
        real = roots[np.abs(roots.imag) <= tolerance].real
        outside, inside = (real > 0) & ((real < B) | (not poles)), (real < 0) & ((real > -A) | (not poles))
        if outside.all() if ignoring_pairs else outside.sum() == (2 if poles else 3):
            return 1
        return -1 if inside.sum() == 2 else 0

    def implementation(rows):
        alpha, gamma, b, d, x, y, z = rows.T
        A, B, P, Q = (alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / b**2, (z / d) ** 2
        c2, c1, c0 = A - B + 1 - P - Q, -A * B + A - B + B * P - A * Q, -A * B
        return [one(*row) for row in np.column_stack([A, B, c2, c1, c0]).tolist()]

    return implementation


MIXED = (*FAMILIES, "waist", "axis", "small-integers", "tangent", "degenerate-crossing", "tangent-ladder")


@pytest.mark.parametrize(
    ("implementation", "expected"),
    [
        (by_roots(poles=False, ignoring_pairs=True), {"complex-pair-ignored", "throat", "groove"}),
        (by_roots(poles=True), {"root-at-lower-pole", "root-at-upper-pole", "ring"}),
        pytest.param(
            *(by_roots(poles=True, tolerance=1e-6), {"root-at-lower-pole", "root-at-upper-pole", "ring"}),
            marks=pytest.mark.thorough,
        ),
        (by_roots(poles=False, tolerance=1e-3), {"imaginary-part-tolerance", "repeated-root-beyond-a-pole", "throat"}),
    ],
    ids=["all real roots positive", "between the poles", "between the poles, 1e-6", "three real ones, 1e-3"],
)
def test_mixed_faults_of_code_that_computes_roots_are_explained_in_parts(implementation, expected):
    causes, wrong = diagnosed(implementation, MIXED, step=3)
    assert expected <= causes.keys()
    assert causes.get(None, 0) <= 0.02 * wrong
    assert sum(causes.values()) == wrong
    assert "zero-coefficient" not in causes  # no code without c1 and c2 is blamed for Proposition 5
