"""The families of tilted spheroids: valid rows of ten numbers, the same on every machine, in every position."""

from __future__ import annotations

import hashlib
import re
from collections import Counter

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.geometry.pair import TILTED_COLUMNS, Position
from hypcheck.geometry.rows import invalid
from hypcheck.truth.float_filter import positions
from hypcheck.vectors.families import FAMILIES, TILTED_FAMILIES, case_id, family_of, is_extreme, parse_case_id, select
from hypcheck.vectors.family import BLOCK

DIGESTS = {
    "tilted-uniform": "ad03ae03fe45e5532fda60696617017f8e85ddf7dff98a30f83b6520cd7480ac",
    "tilted-tower": "8ee90f53daed574d8461d389c1e88ae50146fde887a2a2f2da37c18fb753e66d",
    "tilted-near-contact": "cfbbab116c34356bbf49f97578482cd3a4527a06e7f4b0f606566ab828aca85c",
    "tilted-tangent": "2532b507fc4b8fb4f17f19ebab57d395ed0ea6a0bd90079f595db4227501917f",
    "tilted-near-tangent": "879e17cf37f3c74d384828e7f33b7d26ca6c4ba4e62f239f8d75020b68955a64",
    "tilted-crossing": "89b87a1ec7a4a6c9c8bec70ac17516e40774050281707746881f588cc0165460",
    "tilted-symmetric": "f2bca3436d65f4e1e174eea5eeea9fb8906a6560447b51a5a204606239b92d6d",
    "tilted-sphere": "1f9ce5484f45f55974241714f6e425e8e8e20ac75db963e7d8a6877daae43362",
    "tilted-upright": "c3ba9690210eb4136558f3e4371e41b294870fd2c1a7e6f49cb1583152080de0",
    "tilted-slight": "7bcb7a48cc82a4b3305c8f95809415711dbbc051e8857316d495f96f3f4ed3bd",
    "tilted-twins": "58a03bd8378338e72ea7964b289981128dd3110b1c70e82e52b629b90d4692c5",
    "tilted-ring": "f3265a03a5de570347d84d52685fc2fbcfc6f6ca6884ae8381bd09c9d83e0827",
    "tilted-stiff": "10a004188a66deffa4d47835e11cdd2ac09520e1b8fece4a31cc1b1574c816aa",
    "tilted-axis-length": "0deda10c1a450a9168862370f19b291ef4cdb5e760ea6407d60180317baaeb83",
    "tilted-small-integers": "35aafc30e04460aaf6b871e7e6d54b45d9ab41689cb54d6b1bbdd5ee8ad025ad",
    "extreme-tilted": "bc959d4a1487842d8693014352e67868f6befbda3bf414bafd7b6032ac0132aa",
}
"""sha256 of the first 256 rows for seed 0, little-endian; a change means a new generator version, or a defect."""

every_family = pytest.mark.parametrize("family", TILTED_FAMILIES.values(), ids=lambda family: family.name)


def digest(family):
    return hashlib.sha256(family.rows(0, 256).astype("<f8").tobytes()).hexdigest()


@every_family
def test_a_tilted_family_is_described_in_full_and_says_that_it_is_tilted(family):
    assert re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", family.name)
    assert family.tilted
    assert "tilted" in family.name
    assert family.columns == TILTED_COLUMNS
    assert family.extreme == is_extreme(family.name) == is_extreme(case_id(family, 1, 0))
    for name, value in vars(family.described("a command")).items():
        if isinstance(value, str):
            assert value.strip().rstrip(".") == value != "", name


@every_family
def test_rows_of_a_tilted_family_are_valid_and_more_rows_begin_with_fewer(family):
    long = family.rows(3, BLOCK + 40)
    assert long.shape == (BLOCK + 40, 10)
    assert not invalid(long).any()
    assert not np.signbit(long[long == 0]).any()
    for count in (0, 1, 7, BLOCK + 1):
        assert family.rows(3, count).tobytes() == long[:count].tobytes()
    assert family.block(3, 1)[:40].tobytes() == long[BLOCK:].tobytes()
    assert family.rows(4, 40).tobytes() != long[:40].tobytes()
    assert len({row.tobytes() for row in long}) > 0.9 * len(long)


def test_rows_of_tilted_families_equal_those_of_their_generator_version():
    assert {family.name: digest(family) for family in TILTED_FAMILIES.values()} == DIGESTS


def test_upright_families_are_not_tilted():
    assert not any(family.tilted for family in FAMILIES.values())
    assert not set(FAMILIES) & set(TILTED_FAMILIES)


def test_select_takes_tilted_families_only_if_tilt_is_requested():
    assert not any(family.tilted for family in (*select(), *select(["*", "extreme"])))
    assert select(tilted=True) == (*select(), *(each for each in TILTED_FAMILIES.values() if not each.extreme))
    assert select(["*"], tilted=True) == (*FAMILIES.values(), *TILTED_FAMILIES.values())
    assert select(["tilted-uniform", "ring"], tilted=True) == (FAMILIES["ring"], TILTED_FAMILIES["tilted-uniform"])
    with pytest.raises(InputError, match="'tilted-\\*' names tilted spheroids, which only an implementation with tilt"):
        select(["ring", "tilted-*"])


def test_the_id_of_a_tilted_case_names_its_row():
    family = TILTED_FAMILIES["tilted-uniform"]
    text = case_id(family, 9, BLOCK + 3)
    case = parse_case_id(text)
    assert case.family is family_of("tilted-uniform") is family
    assert family.row(case.seed, case.index) == tuple(family.rows(9, BLOCK + 4)[-1].tolist())


@every_family
def test_a_tilted_family_meets_every_position_that_it_promises(family):
    found = Counter(positions(family.rows(5, 300)).tolist())
    wanted = PROMISED.get(family.name, set(Position))
    assert set(found) == wanted
    assert min(found.values()) >= 10, found


PROMISED = {
    "tilted-tangent": {Position.CONTACT},
    "tilted-crossing": {Position.CONTACT},
    "tilted-ring": {Position.EXTERIOR, Position.INTERIOR},
}
"""Families in which not every position occurs."""
