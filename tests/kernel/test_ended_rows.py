"""Positions beside hyperboloids that end, by the compiled kernel: against frozen rows, in every mode, and by hairs."""

from __future__ import annotations

import math
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction

import numpy as np
import pytest

from hypcheck import clearance
from hypcheck.geometry.pair import Lengths, Pair
from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.vectors.frozen import ENDED_NAMES, load
from tests.support.inside import choice, classify, decide, ended_enclosure, position
from tests.tools import ended_agreement
from tests.tools.attack.rounding import DIRECTED, TO_NEAREST, rounded

compiled = pytest.importorskip("hypcheck.kernel._compiled")


def answered(rows, mode=TO_NEAREST):
    positions = np.empty(len(rows), np.int8)
    with rounded(mode):
        compiled.classify_ended(np.ascontiguousarray(rows), positions)
    return positions


@pytest.mark.parametrize("mode", [TO_NEAREST, *DIRECTED])
def test_the_compiled_kernel_answers_no_frozen_row_with_ends_wrongly_and_leaves_at_most_two_undecided(mode):
    left_open = 0
    for name in ENDED_NAMES:
        cases = load(name)
        positions = answered(cases.rows, mode)
        decided = positions != CANNOT_SAY
        assert (positions[decided] == cases.positions[decided]).all(), name
        left_open += int((~decided).sum())
    assert left_open <= 2


def test_classify_answers_rows_that_the_numpy_kernel_leaves_undecided_by_their_frozen_labels(monkeypatch):
    cases = load("ended-rim")
    monkeypatch.setenv("HYPCHECK_KERNEL", "numpy")
    choice.cache_clear()
    found = classify(cases.rows[::9])
    choice.cache_clear()
    assert found.tolist() == cases.positions[::9].tolist()


def test_the_compiled_kernel_decides_touches_of_a_rim_and_rows_one_ulp_from_them():
    for name in ("ended-rim-tangent", "ended-rim-neighbourhood"):
        cases = load(name)
        positions = answered(cases.rows)
        assert (positions == cases.positions).all()


@pytest.mark.parametrize("tilted", [False, True])
def test_rows_very_near_contact_are_right_in_every_rounding_mode_and_at_most_1_percent_is_undecided(tilted):
    """Half of the hairs are shorter than the rounding of a centre; they part it from a rim, a flat end or the wall."""
    random = np.random.default_rng(1)
    rows = ended_agreement.hairs(random, 200 if tilted else 600, tilted=tilted, nearest=-75)
    truth = np.array([position(Pair.from_row(row).lengths) for row in rows.tolist()])
    for mode in (TO_NEAREST, *DIRECTED):
        positions = answered(rows, mode)
        decided = positions != CANNOT_SAY
        assert (positions[decided] == truth[decided]).all(), mode
        assert (~decided).mean() <= 0.01, mode
    assert {-1, 0, 1} == set(truth.tolist())


@pytest.mark.parametrize("unit", [2.0**-200, 2.0**-60, 2.0**60, 2.0**200])
@pytest.mark.parametrize("axial", [1.0, 2.0**-70, 2.0**90])
def test_touches_of_a_rim_in_other_units_are_undecided_or_answered_rightly(unit, axial):
    rows = load("ended-rim-neighbourhood").rows.copy()
    rows[:, [0, 2, 4, 5]] *= unit
    rows[:, [1, 3, 6, 10, 11]] *= unit * axial
    positions = answered(rows)
    expected = load("ended-rim-neighbourhood").positions
    assert ((positions == CANNOT_SAY) | (positions == expected)).all()
    assert (positions == expected).any()


def test_the_answer_to_a_row_does_not_depend_on_the_other_rows():
    rows = np.concatenate([load(name).rows for name in ENDED_NAMES])
    together = answered(rows)
    order = np.random.default_rng(1).permutation(len(rows))
    assert (answered(rows[order]) == together[order]).all()
    assert [answered(row[None])[0] for row in rows[:300]] == together[:300].tolist()


def test_the_agreement_check_reports_a_wrong_answer_of_the_kernel_with_its_row(monkeypatch):
    """The row stands in a sentence, and rows and meshes asked are counted."""
    rows = ended_agreement.random_rows(np.random.default_rng(1), 6, tilted=True)
    right = answered(rows)
    wrong = np.where(np.arange(6) == 4, -right + (right == 0), right).astype(np.int8)
    monkeypatch.setattr(ended_agreement.compiled_kernel, "answer_ended", lambda _: wrong)
    counts = Counter()
    (sentence,) = ended_agreement.compare_positions(rows, ended_agreement.RANDOM, counts, 3)
    assert str(rows[4].tolist()) in sentence
    assert counts["random", "rows"] == 6
    assert counts["random", "asked of meshes"] == 2


def test_an_interrupted_agreement_check_continues_from_its_log(tmp_path, monkeypatch, capsys):
    """Chunks of the log are not asked again, and count."""
    asked = []

    def found(_, number):
        asked.append(number)
        return [["random", "rows", 1000]], []

    monkeypatch.setattr(ended_agreement, "chunk_found", found)
    monkeypatch.setattr(ended_agreement, "ProcessPoolExecutor", ThreadPoolExecutor)
    log = str(tmp_path / "found.jsonl")
    assert ended_agreement.main(["--rows", "2000", "--log", log]) == 0
    assert ended_agreement.main(["--rows", "5000", "--log", log]) == 0
    assert sorted(asked) == [0, 1, 2, 3, 4]
    assert capsys.readouterr().out.splitlines()[-1].startswith("5,000 rows, 0 disagreements")


@pytest.mark.parametrize("tilted", [False, True])
def test_distance_bounds_very_near_contact_do_not_cross_and_the_upper_one_is_0_only_in_contact(tilted):
    """The spheroid grown by the upper bound in its shorter radius has contact, by the exact decision."""
    rows = ended_agreement.hairs(np.random.default_rng(4), 3 if tilted else 8, tilted=tilted, nearest=-75)
    found = clearance(rows)
    truth = np.array([position(Pair.from_row(row).lengths) for row in rows.tolist()])
    assert (found.distance_lower <= found.distance_upper).all()
    assert ((found.distance_upper == 0) == (truth == 0)).all()
    assert (found.contact == (truth == 0)).all()
    for row, upper in zip(rows.tolist(), found.distance_upper.tolist(), strict=True):
        grown = 1 + Fraction(upper) / Fraction(min(row[2:4]))
        sizes = (*row[:2], Fraction(row[2]) * grown, Fraction(row[3]) * grown)
        assert position(Lengths.of((*sizes, *row[4:]))) == 0


def test_clearance_bounds_beside_ends_are_tight_and_distance_bounds_agree_with_them():
    rows = np.concatenate([load(name).rows[:3] for name in ("ended-uniform", "ended-rim", "ended-small-integers")])
    found = clearance(rows)
    for place, row in enumerate(rows.tolist()):
        pair = Pair.from_row(row)
        low, high = ended_enclosure(pair, decide(pair.lengths))
        assert math.nextafter(found.lower[place], math.inf) >= low >= found.lower[place]
        assert math.nextafter(found.upper[place], -math.inf) <= high <= found.upper[place]
    clear = found.position != 0
    assert clear.sum() > 3
    shorter, longer = rows[clear, 2:4].min(axis=1), rows[clear, 2:4].max(axis=1)
    assert (found.distance_lower[clear] <= found.upper[clear] * longer).all()
    assert (found.distance_upper[clear] >= found.lower[clear] * shorter).all()


@pytest.mark.parametrize(
    ("row", "distance", "nearest"),
    [
        ((3, 4, 1, 1, 3.75, 0, 6, 0, 0, 1, -1, 3, 0), 2, (3.75, 0, 3)),  # over the rim, whose radius is 15/4
        ((3, 4, 1, 1, 1, 0, 6, 0, 0, 1, -1, 3, 1), 2, (1, 0, 3)),  # over the disc
        ((3, 4, 0.5, 1, 6.75, 0, 7, 3, 0, 4, -1, 3, 0), 4, (3.75, 0, 3)),  # its axis points at the rim, 5 away
        ((3, 4, 2, 1, 6.75, 0, 7, 3, 0, 4, -1, 3, 1), 4, (3.75, 0, 3)),
        ((3, 4, 1, 1, 0, 0, 0, 0, 0, 1, -1, 3, 0), 2, None),  # within the waist
    ],
)
def test_distances_beside_ends_are_those_worked_out_by_hand(row, distance, nearest):
    found = clearance(np.array([row], float))
    assert found.distance_lower[0] <= distance <= found.distance_upper[0]
    assert found.distance_upper[0] - found.distance_lower[0] < 1e-7
    assert nearest is None or found.nearest[0] == pytest.approx(nearest, abs=1e-3)


def test_distance_bounds_from_an_end_at_the_least_number_below_0_contain_the_tiny_distance():
    """The spheroid lies on the plane z = 0, and the solid body ends a least number below it."""
    row = (1.0, 1.0, 0.5, 1.25, -0.75, 0.0, 0.5, 0.0, 1.0, 0.0, -9.0, -5e-324, 1.0)
    found = clearance(np.array([row]))
    assert not found.contact[0]
    assert 0 <= found.distance_lower[0] <= 5e-324 <= found.distance_upper[0]
