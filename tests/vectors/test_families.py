"""The table of families: names, streams, case ids, and rows that are the same to the byte on every machine."""

from __future__ import annotations

import hashlib
import json
import os
import re
import subprocess
import sys

import numpy as np
import pytest

from hypcheck.cli.main import main
from hypcheck.errors import InputError
from hypcheck.geometry.pair import ALL_GROUPS, AXIS, COLUMNS, HEIGHTS, SWEEP_COLUMNS
from hypcheck.geometry.rows import PAIRS, SWEEPS, Rows, invalid
from hypcheck.vectors.draw import BLOCK, TOGETHER, Family
from hypcheck.vectors.families import (
    ALL,
    ENDED_FAMILIES,
    ENDED_SWEEP_FAMILIES,
    FAMILIES,
    SWEEP_FAMILIES,
    TILTED_FAMILIES,
    case_id,
    family_of,
    is_extreme,
    parse_case_id,
    select,
)
from hypcheck.vectors.format import described
from tests.vectors.case_rows import first_block

try:
    from numpy._core import _multiarray_umath as numpy_core
except ImportError:  # numpy 1
    from numpy.core import _multiarray_umath as numpy_core  # type: ignore[no-redef]

AXIS_ALONE = frozenset({"axis"})

DIGESTS: dict[str, str] = {
    "forest-type-1": "bc47da5389336338726fa52ea589b1d7bea2ff2814e208b297d818dbfcc37418",
    "forest-type-2": "7cc3b6fcc1f2faeff729e57df7d0005b9b6df0e616ebeea50cc989ae306622ea",
    "tower-body": "c03582ad8d57a872ba7eb30cda9b41e7ef78e6ad7ee2a3b952e1ca5e666c9d56",
    "tower-rotors": "2fc1b67218b68547ce4cc29e192c6ac5b20acc812b1a67fd3b152bb6ff462251",
    "flight": "6bbf81733e58355ff1698d7205d0eccd961211020a52c4f5e1af7a8814fdf216",
    "uniform": "198d8d8650b04e0526891db6026a6ce9274f9ea22e579d1cf71a384a6c70d836",
    "far-centers": "fb0f54205cb2f418922e2e7c95965ca49a0eaa8925eea19f66863d846e2c2c6a",
    "giant-spheroids": "04c5c2f500ebb8c62d25d58d82fa66eea6104900c57f93aff2dbc2ea0eed5846",
    "tiny-spheroids": "b6e0202c50999a2c49b331dcc4c247bab4b20e1d9b990d1c3925c4cc68ab3907",
    "float32-exact": "396caf7e36668f7d1ee2bc7892b9504e26f80b486ae82b37fe20e4f9dc52173d",
    "float16-exact": "ec89ed472099f3788c18dffd5f65d01e69c12f769026f4b0b77f07f3e3468843",
    "small-integers": "0a1ec2543585ab57ed57fd01cd5a133027dda165eac2a3d2ae29d37e5d232d1e",
    "symmetric-images": "2fa43f31c271393d6e7dabaedca470f95f64cc049e1c021c0d9ec90fa488c6a3",
    "one-number-changed": "23791ee2f2d6b9c6dac1e01c1dbfa4b3c11f07dcdb0a417d0f9c38bb968b452a",
    "tangent": "713fa7e2f00c5c74b8343f681d961a6035b2d4f92d91fe1e8c93b30fc82d44a5",
    "near-tangent-outside": "978c6966f71e1fef1ea42f27525626f513afc33c66e4667107bbff5b299b23a2",
    "near-tangent-inside": "8da7fb314bb2b426556cf75dc6f6061dff729641ddc9d199dff364294eba3302",
    "degenerate-crossing": "2a8eb5f8f81df2f51a801894f6c0b2d8d63c3018e555c758e3c4b58ed8baec77",
    "degenerate-neighbourhood": "8f20f5f2fd35cfcd08f0b27d3c1d5c5708f9f3dade149b54e45a04ed5252e45e",
    "on-surface": "99fccb4eb90cdf0b16e2998df33eb526b8966ca06b7890d3c22310608f8b0cd7",
    "tangent-ladder": "e3b8919c1d23ce35216ac6f2ce8ed2a307afd4f9a52426c15fa6d0169a3579be",
    "ring": "a6b06cca15f49ddf56534026ced502713ff12129acd3eb8eb07cd49cbb95f584",
    "ring-neighbourhood": "ad367519a16f811a065a6b0a8752f66c1756f56f2266b334b307bf77a9bf5719",
    "osculation": "eacba7266c9f75c2d6fabe5aed43f5fa180dcc267cdcb6399fa6c3ab5ebec1fc",
    "near-axis": "aad51d60a32db9ebed50125d629ad5b23c095ad7fb98f80a3d41a93e07136901",
    "coefficient-zero": "9f634f06c218d9f4e26d12cea95306c21c7d8364084fc440be5d42997ebd8db0",
    "axis": "eac4c06ce0a1d7967464010d3b638c24416a30c9db50f1a5f8aceb98f0410b88",
    "waist": "753d061147b8f8cac16b2602955d32440d5891a30c99ec1d351b086073f24481",
    "regime-borders": "46629d24659af3175e8fc4519a357b052fa7337d75227b7df55033821b4d4ba9",
    "out-of-regime": "7820c325b4b657b02426ac4b931b36f8d68fda41a907fc03eff2c341231de30b",
    "stiff-radial": "43083e527dda29d65991654c6192ab82071a7b3337ca6ba308ee7eba6d7cbe5a",
    "stiff-axial": "68b5bd7e057df5e3e17166028c9e91bb318ec5fddbfece30267105f8fdc07ea3",
    "stiff-both": "58884ba05c02ce6601068dca80e3c0cc3250eed413494ab9b747ef5f168080b4",
    "whole-domain": "f2b762f6c8a0e7233f6083ad79e9735bf1ca273b1b92f97aeaffca1f05a8e639",
    "coincidences": "0fefec9a27fa51b3d3cb58c420e419e6dd1244762cfdee0c5c0818313e382e20",
    "strata": "9c8651de21e15668bfca1e84cf733fb9bdc4c517a619b10a3026299795115009",
    "nearly-zero": "c7144eedcd9df3656a530f21be9ed86de961903f2ba73cca068e33f938c8ff08",
    "extreme-float16": "95bbe1bc87a7bfbcc0ca8de3a9005f8b9d6707bdc3d9248d1991e4e9533afe1b",
    "extreme-float32": "7376d1b6bc81cec40c8658d417dba8af6b29fadce364a4737d3ce8fbc53a75a6",
    "extreme-float64": "f0c7b03edb78a1fcd256c6296e34ae8b2fcc28c2f92455059af56c26a4c9b7da",
    "extreme-subnormal": "49ebb015bd709b64263fd8c550ce7ea7af1c2507373b62eba753cc186bd39ee8",
    "extreme-magnitude": "70eea8aaf4a7f82833bd46782e3e697a6d654d9f248565deb3b6f2bf30785b05",
    "extreme-hair": "855444c442f26c6ba3b0c122fe7aa41e05b7c050d20583a655f8dbb1445f11ef",
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
    "tilted-coincidences": "2a5bb1206fd89fcf9e722e560f084f25a2be475dc3a66834ce6047493d4d0c58",
    "tilted-strata": "0be8aa7bee15a1d4c8c1e720eed65ece9602fde7c518c4054201a644c7cf7a32",
    "tilted-one-number-changed": "3c0b1db94f147a4c0248ba8b2469f175b17d443f96756358913c7df25137785d",
    "tilted-nearly-zero": "4aed8c5cd25ee64d95a1061e47260a4e4a0e230d4189e6f0053ad3a6f5eff41d",
    "tilted-whole-domain": "1dfb40e324148cdf0247ebd9a312b8e9934ccab87169e1ee11b114c338c02dc8",
    "extreme-tilted": "bc959d4a1487842d8693014352e67868f6befbda3bf414bafd7b6032ac0132aa",
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
    "way-one-number-changed": "f138f12c757c4bec4f82b746854b276c3ea032b49eb527ed9d15f6a9c2fbb57c",
    "way-nearly-zero": "c46a7e884862626e063f2ca2e52097be7d9503d647139565d45fbbe1f41d2b0a",
    "way-whole-domain": "d28f40db05d1e3a12aee62c0a4b648f1340142601f0b663cb143484202542764",
    "way-coincidences": "1f75471e79f45fd492b193fb45db4a2ac0bd7779bb6e38eb43a9181734ef91f6",
    "tilted-way-uniform": "cac4b518e8218760fd229da37ac7d5fa1cdb6c6f706500f9cc16e1f434c01154",
    "tilted-way-end": "e19beb0048e04ebe899d56ace987e73b890a001cb5a84a5c848affe3b5203856",
    "tilted-way-ring": "81f30887b4069aa3d2c7a83b5ca24f2fdbf73e39ce145bb90fcfd21fed004ea8",
    "tilted-way-small-integers": "5d9d80b6c64b6a5e66c5183e7e0aedbef20e004d31036af1ea937b1b9676542f",
    "tilted-way-one-number-changed": "18c3254ab255b71e05caf1391ea273393d77ffb63d39977c85c2afee20347ed0",
    "tilted-way-traps": "dd3cfc1041ce9ebbd56f54b5c975d960ee04023db2a84e6aeaa5ec925095e4df",
    "tilted-way-coincidences": "db65e20df469034ffd1347b465329577d46719dfdb2457a4b2061ff55a84d98f",
    "ended-uniform": "d3faaf39531558aad144eb80561110bcfed48edae0f7815362f3dcce0ecb4587",
    "ended-rim": "4c20a9612af80ba50683c0a29ce2a74bf5c42d036df39d9f44610309518dc2dd",
    "ended-rim-tangent": "8d1640447e7260b2079861ee31d861926442742c98d8e4e812d163297389ef8c",
    "ended-rim-neighbourhood": "6bc3f1931f3e71eb6dc8970cfba6e0825c71bfa9675a8a62db1415556460f368",
    "ended-opening": "de7e955bd2d48f7d0aa4de2e5878f33b5c28cc5bc4dba02bd1b4231a6ab12501",
    "ended-thin": "92b8f09820a94070f892f6f847fcc5fac0719ee2e4ec7016211f0f75ba8a1127",
    "ended-swallowed": "e2a8fb2c7296d44d85cb2f1cac565468faf1550f9907148420a69559101f8032",
    "ended-disc": "06c51e76d2751727a169456074da515a3f67f45c7d1be36a5bd9862768f76f7e",
    "ended-groove": "e5eda8e8f3645f03a93fbce90f31b266242d4b56c1c1f1e94d37a30e3680a2cf",
    "ended-waist": "5faf4269ef1ef0c4dba90f8b54fed6c6cb6d56f998160a486cd14a64349387b7",
    "ended-far": "fa80ee696a3a574ea95ae59731bc697c09f34d71cea2f23c2a0856175c8f2bf8",
    "ended-stiff": "5e692d90f80c753e69cd2cd3489d8b8b3424d5ef503a4a3b9cf308204b933a2b",
    "ended-small-integers": "186eed411b7863734e474cb969bba86172b5c0ed432c6b85458e1808f87ff05b",
    "ended-one-number-changed": "9029c8de1d86d4fe1d1decf24ba3ea0b47c997ffce864469dac01c400e12ac5b",
    "ended-nearly-zero": "1b741b7ff209a0e1b5f16510c18c08d3ae23127f721b2ab077d4d6fb8c9eec81",
    "ended-whole-domain": "55babb793b5252e63866df814b2b0eeb0173b8450c959cdb42256ad67d2f2625",
    "tilted-ended-uniform": "f30f484dc6cb4776120160970ac101b37eee686fb813286b9c7bbb3e7a9b1940",
    "tilted-ended-rim": "76ca80e924a2adba64cc80d7bb0de5e929b4213fb88d907b12aafb6ab5439af3",
    "tilted-ended-thin": "b8fd4206c202a5eb1602ae24a5d38b11c7beacc8cd948f76c4523358be65cdef",
    "tilted-ended-disc": "9f8eaa07c12be313c589ef75fbceaf341d441fd2796bc904fdb4b33427676344",
    "tilted-ended-small-integers": "52bb76ba541210409f13c6d66f7bd6cdafee127995349c54c1cbebb733f78b0e",
    "tilted-ended-nearly-zero": "05aa4e3bb08db4baf43812b5447d6932e90ec66a145842f08cdd1b9d70dede06",
    "tilted-ended-traps": "828d9dd1718996c0bbe790d5776c0fb74be738d85df0bf71e15ce31008184e66",
    "tilted-ended-coincidences": "d13708ff7b3f67b15b38a4a1e8a84bfe5bc98370b24a05cd3c64cfdcc0799a9c",
    "ended-way-uniform": "840310ec7e4068644497b01e6ca03d9234326dbafa443dca581d9eb912b9c1ae",
    "ended-way-over": "facc1968871b2ef669787fd2e832d829108a9a827b6355c21bfeb341242517f3",
    "ended-way-landing": "6baf9482f77f3161b638018b2a3b527df0b27fb0ac1526327c1c5b891e3202ca",
    "ended-way-disc": "39473dd54f5b3b632bdbabc5b0c86b5d62c5a67081f6e866d054d697495883dc",
    "ended-way-opening": "7a4279bf7ed569f308bf0f255cfeea7964076ff4a4efecfc230e3d63bb9ba08a",
    "ended-way-thin": "9c6dde9ff656e63004effcb2935c69ba93c65a50c3fbe4977e324befccdfb0f7",
    "ended-way-touch": "6ae22d271e5abaeb106e324efd9b3e5f147022552a39877476dac506d45bb95f",
    "ended-way-one-number-changed": "804a40828bb0000aeb4ac1d18d81ab57a8b663f2ed502858344fc393a718e3bf",
    "ended-way-lengths": "22717a83cea3a761b7c7ec826697d448fd80f3d39af701df9de39dde03edbd88",
    "ended-way-coincidences": "a65b011bd49827e8f48bed71c7d0fe5f7ada27abf3d9a6bced3c8912c2f80d2b",
    "tilted-ended-way-uniform": "f7f7dce4cad3e10e493ff9e3c60a4883da55be5d77330c7d858afa0a8f4d1cfd",
    "tilted-ended-way-over": "1f16d3c426b51f463685b1a537110d6794c39a5d934053589ba56e73fe3de7d4",
    "tilted-ended-way-traps": "145c05ce2742f98b50a54ba350bb09611f8cbc02b173eb3fcf32671c46385e8d",
    "tilted-ended-way-coincidences": "880f30699b42eacc9170d8dd1d42891cd551cb480434f45bfeb1be45a775e8ca",
}
"""sha256 of the first rows for seed 0, little-endian; a change means a new generator version, or a defect."""

GENERATE = ["cases", "generate", "osculation", "--count", "20"]

every_family = pytest.mark.parametrize("family", ALL.values(), ids=lambda family: family.name)


def digest_of(family: Family, rows: Rows) -> str:
    """Of the first 256 rows, or 64 ways."""
    count = 64 if family.layout is SWEEPS else 256
    return hashlib.sha256(rows[:count].astype("<f8").tobytes()).hexdigest()


def digest(family: Family) -> str:
    """That of seed 0."""
    return digest_of(family, family.rows(0, 256))


def test_every_family_is_in_the_table_of_its_kind() -> None:
    for families, layout, tilted in (
        (FAMILIES, PAIRS, {False}),
        (TILTED_FAMILIES, PAIRS, {True}),
        (SWEEP_FAMILIES, SWEEPS, {False, True}),
        (ENDED_SWEEP_FAMILIES, SWEEPS, {False, True}),
    ):
        assert {family.layout for family in families.values()} == {layout}
        assert {"axis" in family.groups for family in families.values()} == tilted
        assert all(("way" in name) == (layout is SWEEPS) for name in families)
    ended = ENDED_FAMILIES | ENDED_SWEEP_FAMILIES
    assert [name for name, family in ALL.items() if "heights" in family.groups] == [*ended]
    assert [*ALL] == [*FAMILIES, *TILTED_FAMILIES, *SWEEP_FAMILIES, *ended]


@every_family
def test_every_family_has_a_complete_description(family: Family) -> None:
    assert re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", family.name)
    assert family.version >= 1
    for name, value in vars(described(family.name, "a command", family)).items():
        if isinstance(value, str):
            assert value.strip().rstrip(".") == value != "", name
    assert ALL[family.name] is family_of(family.name) is family
    words = {"end": "way", "axis": "tilted", "heights": "ended"}
    assert family.groups == {group for group, word in words.items() if word in family.name.split("-")}
    axis = AXIS if family.groups & {"axis", "heights"} else ()
    heights = HEIGHTS if "heights" in family.groups else ()
    assert family.columns == ((SWEEP_COLUMNS if "end" in family.groups else COLUMNS) + axis + heights)
    assert family.extreme == is_extreme(family.name) == is_extreme(case_id(family, 1, 0))


@every_family
def test_rows_of_a_family_are_valid_distinct_and_the_same_as_in_earlier_releases(family: Family) -> None:
    """A generator knows its stream alone, so that a block of another seed and number stands for all others."""
    rows, others = first_block(family.name), family.block(1, 1)
    assert digest_of(family, rows) == DIGESTS[family.name]
    ordinary = family.name in FAMILIES
    for block in (rows, others):
        assert block.shape == (BLOCK, len(family.columns))
        assert block.dtype == np.float64
        assert not invalid(block, family.layout).any()
        assert ordinary or not np.signbit(block[block == 0]).any()
        assert len(np.unique(block, axis=0)) > (0.85 if ordinary else 0.9) * BLOCK
    assert rows[:40].tobytes() != others[:40].tobytes()


@pytest.mark.parametrize("name", ["ring", "symmetric-images", "tilted-uniform", "ended-way-thin"])
def test_few_rows_of_a_family_are_the_beginning_of_more_and_other_seeds_and_blocks_give_other_rows(name: str) -> None:
    family = ALL[name]
    long = family.rows(3, BLOCK + 40)
    for count in (0, 1, 7, BLOCK, BLOCK + 1):
        assert family.rows(3, count).tobytes() == long[:count].tobytes()
    assert family.block(3, 1)[:40].tobytes() == long[BLOCK:].tobytes()
    others = [family.rows(seed, 40).tobytes() for seed in (3, 4)] + [long[BLOCK:].tobytes()]
    assert len(set(others)) == 3


@pytest.mark.parametrize(
    "family", [each for each in FAMILIES.values() if each.by_place], ids=lambda family: family.name
)
def test_blocks_of_a_family_generated_together_equal_blocks_generated_separately(family: Family) -> None:
    blocks = [family.block(5, number) for number in range(TOGETHER + 3)]
    rows = family.rows(5, len(blocks) * BLOCK)
    assert rows.tobytes() == np.concatenate(blocks).tobytes()
    start, stop = BLOCK + 7, TOGETHER * BLOCK + 500
    assert family.columns_between(5, start, stop).T.tobytes() == rows[start:stop].tobytes()


def test_every_kept_digest_belongs_to_a_family() -> None:
    assert set(DIGESTS) == set(ALL)


@pytest.mark.slow
def test_rows_of_families_and_generated_files_do_not_depend_on_the_instruction_set(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The same digests of every third family, labels and flags with all beyond numpy's baseline turned off."""
    optional = [name for name in numpy_core.__cpu_dispatch__ if numpy_core.__cpu_features__[name]]
    if not optional:
        pytest.skip("this processor has nothing beyond numpy's baseline to turn off")
    program = f"""
import json
from hypcheck.cli.main import main
from {numpy_core.__name__} import __cpu_features__ as features
from {__name__} import digest
from hypcheck.vectors.families import ALL
assert not any(features[name] for name in {optional!r}), "numpy ignored the request"
print(json.dumps({{name: digest(ALL[name]) for name in [*ALL][::3]}}))
assert main({GENERATE!r}) == 0
"""
    environment = os.environ | {
        "NPY_DISABLE_CPU_FEATURES": " ".join(optional),
        "PYTHONPATH": os.pathsep.join(path for path in sys.path if path),
    }
    ran = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    digests, _, file = ran.stdout.partition("\n")
    assert json.loads(digests) == {name: DIGESTS[name] for name in [*ALL][::3]}
    assert main(GENERATE) == 0
    assert file == capsys.readouterr().out
    assert json.loads(file)["count"] == 20


def test_select_takes_names_and_globs_and_keeps_the_order_of_the_table() -> None:
    assert [family.name for family in select(["stiff-*", "ring"])] == [
        "ring",
        "stiff-radial",
        "stiff-axial",
        "stiff-both",
    ]
    assert select(["ring", "r?ng"]) == (FAMILIES["ring"],)


def test_select_without_a_pattern_takes_no_extreme_family() -> None:
    assert {family.name for family in select()} == {each.name for each in FAMILIES.values() if not each.extreme}


def test_select_with_a_glob_takes_every_matching_family_and_with_a_star_all() -> None:
    extremes = tuple(family for family in FAMILIES.values() if family.extreme)
    assert len(extremes) >= 5
    assert select(["extreme"]) == select(["extreme-*"]) == select(["?xtreme-*"]) == extremes
    assert select(["extreme-float16"]) == (FAMILIES["extreme-float16"],)
    assert select(["*"]) == tuple(FAMILIES.values())


def test_select_takes_tilted_families_only_if_tilt_is_requested():
    assert not any(family.groups for family in (*select(), *select(["*", "extreme"])))
    assert select(taken=AXIS_ALONE) == (*select(), *(each for each in TILTED_FAMILIES.values() if not each.extreme))
    assert select(["*"], AXIS_ALONE) == (*FAMILIES.values(), *TILTED_FAMILIES.values())
    assert select(["tilted-uniform", "ring"], AXIS_ALONE) == (FAMILIES["ring"], TILTED_FAMILIES["tilted-uniform"])
    with pytest.raises(InputError, match="'tilted-\\*' names tilted spheroids; only implementations with tilt"):
        select(["ring", "tilted-*"])


def test_select_takes_families_of_sweeps_only_if_sweeps_are_requested():
    assert not any(family.layout is SWEEPS for family in select(["*"], AXIS_ALONE))
    assert set(select(["*"], frozenset({"end", "axis"}))) == set(SWEEP_FAMILIES.values())
    assert set(select(["*-way-*"], ALL_GROUPS)) >= set(ENDED_SWEEP_FAMILIES.values())
    with pytest.raises(InputError, match="'ended-way-thin' names hyperboloids that end"):
        select(["ended-way-thin"])
    with pytest.raises(InputError, match="'way-ring' names sweeps"):
        select(["way-ring"])
    with pytest.raises(InputError, match="'ring' names pairs; the question passage is about sweeps alone"):
        select(["ring"], frozenset({"end"}))


@pytest.mark.parametrize(
    ("pattern", "hint"),
    [("tower-bodi", "tower-body"), ("tangant", "tangent"), ("Ring", "ring"), ("qqq*", "forest-type-1")],
)
def test_unknown_name_of_a_family_is_refused_with_a_suggestion(pattern: str, hint: str) -> None:
    with pytest.raises(InputError, match=re.escape(pattern)) as caught:
        select(["uniform", pattern])
    assert hint in str(caught.value)


@pytest.mark.parametrize("index", [0, 1, BLOCK - 1, BLOCK, 5 * BLOCK + 3])
@pytest.mark.parametrize("name", ["symmetric-images", "tilted-uniform", "way-ring"])
def test_a_case_id_names_its_row(name: str, index: int) -> None:
    family = ALL[name]
    text = case_id(family, 9, index)
    assert text == f"{name}/{family.version}/9/{index}"
    case = parse_case_id(text)
    assert (case.family, case.seed, case.index) == (family, 9, index)
    assert family.row(9, index) == tuple(family.rows(9, index + 1)[index].tolist())


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("uniform", "not a case id"),
        ("uniform/1/0", "not a case id"),
        ("uniform/1/0/-1", "not a case id"),
        ("uniform/1/0/01", "not a case id"),
        ("uniform/1/0/1 ", "not a case id"),
        ("uniform/1/0/٣", "not a case id"),
        ("unifrom/1/0/1", "did you mean uniform"),
        ("uniform/999/0/1", "generator"),
    ],
)
def test_a_wrong_case_id_is_refused(text: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        parse_case_id(text)


@pytest.mark.parametrize(("seed", "count"), [(-1, 3), (0, -3)])
def test_negative_seeds_and_counts_are_refused(seed: int, count: int) -> None:
    with pytest.raises(InputError, match="negative"):
        FAMILIES["ring"].rows(seed, count)
