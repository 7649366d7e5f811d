"""Families of ways: described in full, valid, the same for ever, and found only where ways are asked about."""

from __future__ import annotations

import hashlib
import re

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.geometry.rows import WAYS, invalid
from hypcheck.truth.passage_error import hits_at_size
from hypcheck.vectors.double_roots import gather
from hypcheck.vectors.draw import Draw
from hypcheck.vectors.families import WAY_FAMILIES, case_id, family_of, parse_case_id, select
from hypcheck.vectors.family import BLOCK
from hypcheck.vectors.ways import more_than_a_radius_away, ring_attempt

DIGESTS = {
    "way-anywhere": "c884c53f71228633130e82191fad30f9ee7dac62c2bd9bc9a7dd0c309a6cfbb5",
    "way-tunnelling": "e80202d1d6bc263ff4f66efc969880cdb88f00fef197835a0a29b51bd3a1dbb4",
    "way-uniform": "3bec30695e2613e9cd0b6138a3aed66ce42135d822bb48e6778a4a28b6603677",
    "way-tower": "28f66479e215d2c5355cf79a5d12bc2c5156747284db72360c11ca99c6e56f8c",
    "way-across": "d0b68be6b2abf98e3bfaea7fdd21a721fa6c79e3fd6b258a8838a242eadae765",
    "way-grazing": "8d70281046dd285067fd6a5f37ce67cc8e835408b95dfbd164e395414ad30b12",
    "way-near-graze": "ce79b11cf3f1455d15dabe06f6bbde2197e4a4347d4e8c96712573e9898b395b",
    "way-ring": "274a0a36193fdcfa096ef27e23e06a689b63e66d7b81d540d17d0a20febaf1ed",
    "way-end": "c09fc4ef6c88ae3c8e9d4ca12643a6d3e10c2a80484a76c19566283ff6231267",
    "way-begun-in-contact": "4a1a8d8f0c60bf7618554140c5e7f075048903a97f1f7e7a038d022ecbe31e6d",
    "way-still": "7945635714050544d10fb482d035d977485093b10955db3f88d884a74909aeee",
    "way-along-a-line": "8300d4d1b575c14b206f617a90a8cea3090dfc2448d1f997d19bfbc83a45f1b6",
    "way-vertical": "6ce301a5e63e91b6d6076d24abb4aabfcc5bddbe145a29613680183c44de14dd",
    "way-horizontal": "dcd36c70cbdf3231acbda2951fc23a3c774d5dba11ab9809a12a34cc899f8272",
    "way-long": "a4b89eb7a7ea6cadd0d3900a30a226fb8c2cea9085238a25c4727f9a843268ca",
    "way-short": "ada4ad5e6e6c8bd7e3592f5f47390d45bc37cb09b61a2e2d2684727d171b687f",
    "way-stiff": "2183dd63f2925e4151282963a3d73740452379aaafef3fd4e61e78262ef5eece",
    "way-small-integers": "f660a4f57cd0a7c97f141df381da67eb1e2948e31efc72b04066f24d666c87e9",
    "tilted-way-uniform": "cac4b518e8218760fd229da37ac7d5fa1cdb6c6f706500f9cc16e1f434c01154",
    "tilted-way-end": "e19beb0048e04ebe899d56ace987e73b890a001cb5a84a5c848affe3b5203856",
    "tilted-way-ring": "81f30887b4069aa3d2c7a83b5ca24f2fdbf73e39ce145bb90fcfd21fed004ea8",
    "tilted-way-small-integers": "5d9d80b6c64b6a5e66c5183e7e0aedbef20e004d31036af1ea937b1b9676542f",
}
"""sha256 of the first 64 rows for seed 0, little-endian; a change means a new generator version, or a defect."""

every_family = pytest.mark.parametrize("family", WAY_FAMILIES.values(), ids=lambda family: family.name)


def digest(family):
    return hashlib.sha256(family.rows(0, 64).astype("<f8").tobytes()).hexdigest()


@every_family
def test_a_family_of_ways_is_described_in_full(family):
    assert re.fullmatch(r"(tilted-)?way-[a-z-]+", family.name)
    assert family.layout is WAYS
    assert family.tilted == family.name.startswith("tilted-")
    assert not family.extreme
    for name, value in vars(family.described("a command")).items():
        if isinstance(value, str):
            assert value.strip().rstrip(".") == value != "", name


@every_family
def test_rows_of_a_family_of_ways_are_valid_and_more_rows_begin_with_fewer(family):
    long = family.rows(3, BLOCK + 40)
    assert long.shape == (BLOCK + 40, 13 if family.tilted else 10)
    assert not invalid(long, WAYS).any()
    assert not np.signbit(long[long == 0]).any()
    assert family.rows(3, 7).tobytes() == long[:7].tobytes()
    assert family.block(3, 1)[:40].tobytes() == long[BLOCK:].tobytes()
    assert family.rows(4, 40).tobytes() != long[:40].tobytes()
    assert len({row.tobytes() for row in long}) > 0.9 * len(long)


def test_rows_of_families_of_ways_equal_those_of_their_generator_version():
    assert {family.name: digest(family) for family in WAY_FAMILIES.values()} == DIGESTS


def test_generated_ways_across_a_ring_are_clear_where_rings_beside_the_surface_were_replaced():
    rows = WAY_FAMILIES["way-ring"].rows(1, BLOCK)
    before = gather(Draw("way-ring", 1, 1, 0), BLOCK, ring_attempt)
    replaced = (rows != before).any(axis=1)
    assert 0 < replaced.sum() < 0.05 * BLOCK
    assert all(hits_at_size(row) for row in before[replaced].tolist())
    assert not any(hits_at_size(row) for row in rows[:64].tolist())
    near = ~more_than_a_radius_away(rows)
    assert near.any()
    assert not any(hits_at_size(row) for row in rows[near].tolist())


def test_select_takes_families_of_ways_only_if_ways_are_requested():
    assert not any(family.layout is WAYS for family in select(["*"], tilted=True))
    assert set(select(["*"], tilted=True, layout=WAYS)) == set(WAY_FAMILIES.values())
    with pytest.raises(InputError, match="'way-ring' names ways"):
        select(["way-ring"])


def test_the_id_of_a_way_names_its_family_and_row():
    text = case_id(WAY_FAMILIES["way-ring"], 9, 3)
    assert parse_case_id(text).family is family_of("way-ring")
    assert parse_case_id(text).family.row(9, 3) == tuple(WAY_FAMILIES["way-ring"].rows(9, 4)[3].tolist())
