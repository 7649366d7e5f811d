"""Each family meets the positions that its geometry allows."""

from __future__ import annotations

from collections import Counter

import pytest

from hypcheck.geometry.pair import Position
from hypcheck.vectors.draw import BLOCK
from hypcheck.vectors.families import FAMILIES, TILTED_FAMILIES
from tests.support import inside
from tests.vectors.case_rows import first_block

EXTERIOR, CONTACT, INTERIOR = Position
LIMITED = {
    # in contact by construction
    "tangent": {CONTACT},
    "degenerate-crossing": {CONTACT},
    "degenerate-neighbourhood": {CONTACT},
    "on-surface": {CONTACT},
    # clear by construction
    "ring": {EXTERIOR},
    "ring-neighbourhood": {EXTERIOR},
    # one side of the surface alone
    "near-tangent-outside": {EXTERIOR, CONTACT},
    "near-tangent-inside": {CONTACT, INTERIOR},
    "osculation": {EXTERIOR, CONTACT},
    "near-axis": {CONTACT, INTERIOR},
    "axis": {CONTACT, INTERIOR},
    "coefficient-zero": {CONTACT, INTERIOR},
    # tilted
    "tilted-tangent": {CONTACT},
    "tilted-crossing": {CONTACT},
    "tilted-ring": {EXTERIOR, INTERIOR},
}
"""Families that the geometry keeps from some position; all others show all three."""


@pytest.mark.parametrize("name", FAMILIES)
def test_each_family_has_at_least_10_percent_of_every_position_that_it_allows(name: str) -> None:
    found = Counter(inside.positions(first_block(name)).tolist())
    expected = LIMITED.get(name, set(Position))
    assert set(found) == {int(position) for position in expected}
    assert all(count >= 0.1 * BLOCK for count in found.values()), found


@pytest.mark.parametrize("name", TILTED_FAMILIES)
def test_a_tilted_family_has_at_least_10_rows_of_each_position_that_it_can_have(name: str) -> None:
    found = Counter(inside.positions(first_block(name)[:300]).tolist())
    assert set(found) == set(map(int, LIMITED.get(name, set(Position))))
    assert min(found.values()) >= 10, found
