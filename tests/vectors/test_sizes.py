"""Sizes, ratios, formats and images are spread as each family says."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np
import pytest

from hypcheck.geometry.rows import ORDINARY_MAGNITUDE, ORDINARY_RATIO, within
from hypcheck.vectors import ended
from hypcheck.vectors.families import ALL, FAMILIES
from tests.support import inside
from tests.support.inside import passage_of
from tests.vectors.case_rows import COUNT, ratios


def test_uniform_family_has_each_of_the_four_regimes_in_at_least_a_fifth_of_its_rows() -> None:
    regimes = Counter((a >= 1, c * c >= a) for a, c in ratios(FAMILIES["uniform"].rows(0, COUNT)))
    assert len(regimes) == 4
    assert min(regimes.values()) > 0.2 * COUNT


@pytest.mark.parametrize(
    ("name", "stiff_columns", "plain_columns"),
    [("stiff-radial", [(0, 2)], [(1, 3)]), ("stiff-axial", [(1, 3)], [(0, 2)]), ("stiff-both", [(0, 2), (1, 3)], [])],
)
def test_stiff_ratios_are_spread_over_both_sides_of_1e8(
    name: str, stiff_columns: list[tuple[int, int]], plain_columns: list[tuple[int, int]]
) -> None:
    rows = FAMILIES[name].rows(0, COUNT)
    for top, bottom in stiff_columns:
        decades = Counter(np.floor(np.log10(rows[:, top] / rows[:, bottom])).astype(int).tolist())
        assert set(decades) == set(range(3, 13))
        assert min(decades[decade] for decade in range(3, 12)) > 0.07 * COUNT
    for top, bottom in plain_columns:
        ratio = rows[:, top] / rows[:, bottom]
        assert 0.24 < ratio.min() <= ratio.max() < 65
    within = np.abs(rows[:, :4])
    assert 4e-7 < within.min() <= within.max() < 4e6


def test_giant_tiny_and_far_families_have_the_sizes_that_their_names_say() -> None:
    for name, low, high in (("giant-spheroids", 2.0**-17, 0.26), ("tiny-spheroids", 1000, 2.0**21)):
        rows = FAMILIES[name].rows(0, COUNT)
        for top, bottom in ((0, 2), (1, 3)):
            ratio = rows[:, top] / rows[:, bottom]
            assert low < ratio.min() <= ratio.max() < high
    _, _, b, d, x, y, z = FAMILIES["far-centers"].rows(0, COUNT).T
    far = np.sqrt(((x * x + y * y) / (b * b)) + (z / d) ** 2)
    assert far.min() > 8
    assert np.median(far) > 1e3
    assert far.max() > 1e7


def test_rows_of_float32_and_float16_families_are_exact_in_these_formats() -> None:
    for name, dtype in (("float32-exact", np.float32), ("float16-exact", np.float16)):
        rows = FAMILIES[name].rows(0, COUNT)
        assert np.array_equal(rows.astype(dtype).astype(np.float64), rows)
        nonzero = np.abs(rows[rows != 0])
        assert nonzero.min() >= np.finfo(dtype).tiny
    wide = FAMILIES["float32-exact"].rows(0, COUNT)
    assert np.mean(wide.astype(np.float16) != wide) > 0.5, "24 bits are used"


def test_symmetric_images_of_a_pair_have_the_same_position() -> None:
    rows = FAMILIES["symmetric-images"].rows(0, 960)
    answers = inside.positions(rows).reshape(-1, 16)
    assert (answers == answers[:, :1]).all()
    assert len(np.unique(rows[:16].view(np.uint64), axis=0)) == 16
    assert (np.signbit(rows[:, 4:]) & (rows[:, 4:] == 0)).any(), "−0.0 is among them"


def test_whole_domain_family_covers_the_domain_to_its_ends_and_not_beyond() -> None:
    rows = FAMILIES["whole-domain"].rows(0, 4000)
    assert within(rows).all()
    ratio = rows[:, :2] / rows[:, 2:4]
    for values, (least, most) in ((ratio, ORDINARY_RATIO), (rows[:, :4], ORDINARY_MAGNITUDE)):
        for column in values.T:
            decades = np.floor(np.log10(column / least * (1 + 1e-12))).astype(int)
            ends = round(np.log10(most / least))
            assert set(range(ends)) <= set(decades.tolist())
            assert np.bincount(decades)[:ends].min() > 0.02 * len(rows)
            assert min((column == least).sum(), (column == most).sum()) >= 10


def test_whole_domain_family_has_every_position_in_each_regime_and_near_its_ends() -> None:
    rows = FAMILIES["whole-domain"].rows(0, 4000)
    a, c = (rows[:, :2] / rows[:, 2:4]).T
    found = inside.positions(rows)
    for wide in (True, False):
        for bent in (True, False):
            chosen = ((a >= 1) == wide) & ((c * c >= a) == bent)
            assert min(Counter(found[chosen].tolist()).values()) > 40
    far = (np.maximum(ratio := rows[:, :2] / rows[:, 2:4], 1 / ratio) > 1e6).any(axis=1)
    assert min(Counter(found[far].tolist()).values()) > 100


@pytest.mark.parametrize(
    ("name", "changing", "least"),
    [
        ("one-number-changed", range(7), 6),
        ("tilted-one-number-changed", range(10), 6),
        ("ended-one-number-changed", ended.CHANGED, 6),
        ("way-one-number-changed", range(10), 3),
        ("tilted-way-one-number-changed", range(13), 1),
        ("ended-way-one-number-changed", ended.SWEEP_CHANGED, 0),
    ],
)
def test_one_number_changed_families_change_one_number_from_row_to_row(
    name: str, changing: Sequence[int], least: int
) -> None:
    turn = 2 * len(changing)
    pairs = 1024 // turn if least else 20
    rows = ALL[name].rows(0, pairs * turn)
    turns = rows.reshape(pairs, turn, -1)
    changed = turns[:, 1:] != turns[:, :-1]
    assert (changed.sum(axis=2) <= 1).all()
    for place, column in enumerate(changing):
        assert (changed[:, 2 * place, column] | (turns[:, 0, column] == 0)).all()
    if least:
        answers = [passage_of(tuple(row)).hit for row in rows.tolist()] if "way" in name else inside.positions(rows)
        before, after = np.asarray(answers).reshape(pairs, -1, 2).T
        assert ((before != after).sum(axis=1) >= least).all()


def test_small_integers_come_in_groups_of_four_rows_made_of_the_same_numbers() -> None:
    rows = FAMILIES["small-integers"].rows(2, 2000)
    first, turned, swapped, doubled = (rows[place::4] for place in range(4))
    assert (turned[:, :4] == first[:, :4]).all()
    assert (turned[:, 4:] == first[:, [6, 4, 5]]).all()
    assert (swapped == first[:, [1, 0, 3, 2, 4, 5, 6]]).all()
    assert (doubled == first * [2, 1, 2, 1, 1, 1, 1]).all()
    positions = inside.positions(rows)
    for alike in (
        (rows[:, :4] == 1).all(axis=1),
        (rows[:, :4] == rows[:, :1]).all(axis=1),
        (rows[:, 0] == rows[:, 2]) & (rows[:, 1] == rows[:, 3]),
        (np.abs(rows[:, 4:]) == np.abs(rows[:, 4:5])).all(axis=1),
        *((rows[:, column] == 0) & np.signbit(rows[:, column]) for column in (4, 5, 6)),
    ):
        assert set(positions[alike]) == {1, 0, -1}
