"""Rows at certified distances from contact: the certificates hold, and one that is too good is refused."""

import numpy as np
import pytest

from hypcheck import classify
from hypcheck.engines.placing import FAMILIES, drawn, placed


@pytest.mark.parametrize("name", FAMILIES)
def test_every_engine_family_has_as_many_clear_rows_as_contacts_near_contact(name):
    found = placed(FAMILIES[name], 3)
    gaps = np.abs(found.gap) * FAMILIES[name].unit
    for low in (1e-8, 1e-5):
        near = (gaps >= low) & (gaps < 10 * low)
        assert (near & found.contact).sum() == (near & ~found.contact).sum() == 3


@pytest.mark.parametrize("name", FAMILIES)
def test_placed_rows_have_the_positions_that_the_signs_of_their_gaps_say(name):
    found = placed(FAMILIES[name], 3)
    clear = -1 if FAMILIES[name].inside else 1
    assert (classify(found.rows) == np.where(found.contact, 0, clear)).all()


@pytest.mark.parametrize(("family", "here", "beyond"), [("leaning", 1, 0), ("inside", 0, -1)])
def test_a_placed_row_changes_its_position_only_if_it_moves_farther_than_its_gap_or_its_depth(family, here, beyond):
    spot, gap = drawn(FAMILIES[family], 3)
    keep = spot.certifies(gap) & (gap > 1e-6 if here else gap < -1e-6)
    rows, normals, gap = spot.rows(gap)[keep], spot.normal[keep], gap[keep]
    rng = np.random.default_rng(1)
    for _ in range(50):
        way = rng.normal(size=(len(rows), 3))
        moved = rows.copy()
        moved[:, 4:7] += way / np.linalg.norm(way, axis=1, keepdims=True) * (0.999 * gap)[:, np.newaxis]
        assert (classify(moved) == here).all()
    rows[:, 4:7] -= normals * (1.001 * gap)[:, np.newaxis]
    assert (classify(rows) == beyond).all()


def test_a_placed_row_is_not_certified_with_a_wrong_gap():
    spot, gap = drawn(FAMILIES["small"], 3)
    assert spot.certifies(gap).mean() > 0.7
    assert not spot.certifies(np.full(len(gap), -0.1)).any()  # deeper than the body is thick
