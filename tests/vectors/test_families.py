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

from hypcheck.errors import InputError
from hypcheck.geometry.rows import invalid
from hypcheck.vectors.families import FAMILIES, case_id, is_extreme, parse_case_id, select
from hypcheck.vectors.family import BLOCK, TOGETHER, Family

try:
    from numpy._core import _multiarray_umath as numpy_core
except ImportError:  # numpy 1
    from numpy.core import _multiarray_umath as numpy_core  # type: ignore[no-redef]

DIGESTED = 256
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
    "extreme-float16": "95bbe1bc87a7bfbcc0ca8de3a9005f8b9d6707bdc3d9248d1991e4e9533afe1b",
    "extreme-float32": "7376d1b6bc81cec40c8658d417dba8af6b29fadce364a4737d3ce8fbc53a75a6",
    "extreme-float64": "f0c7b03edb78a1fcd256c6296e34ae8b2fcc28c2f92455059af56c26a4c9b7da",
    "extreme-subnormal": "49ebb015bd709b64263fd8c550ce7ea7af1c2507373b62eba753cc186bd39ee8",
    "extreme-magnitude": "70eea8aaf4a7f82833bd46782e3e697a6d654d9f248565deb3b6f2bf30785b05",
    "extreme-hair": "855444c442f26c6ba3b0c122fe7aa41e05b7c050d20583a655f8dbb1445f11ef",
}
"""sha256 of the first 256 rows for seed 0, little-endian; a change means a new generator version, or a defect."""

every_family = pytest.mark.parametrize("family", FAMILIES.values(), ids=lambda family: family.name)


def digest(family: Family) -> str:
    return hashlib.sha256(family.rows(0, DIGESTED).astype("<f8").tobytes()).hexdigest()


@every_family
def test_every_family_has_a_complete_description(family: Family) -> None:
    assert re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", family.name)
    assert family.version >= 1
    for name, value in vars(family.described("a command")).items():
        if isinstance(value, str):
            assert value.strip() == value, name
            assert value, name
            assert not value.endswith("."), name
    assert FAMILIES[family.name] is family
    assert family.extreme == is_extreme(family.name) == is_extreme(case_id(family, 1, 0))


@pytest.mark.slow
@every_family
def test_rows_of_a_family_are_valid_and_more_rows_begin_with_fewer(family: Family) -> None:
    long = family.rows(3, BLOCK + 40)
    assert long.shape == (BLOCK + 40, 7)
    assert long.dtype == np.float64
    assert not invalid(long).any()
    for count in (0, 1, 7, BLOCK, BLOCK + 1):
        assert family.rows(3, count).tobytes() == long[:count].tobytes()
    assert family.block(3, 1)[:40].tobytes() == long[BLOCK:].tobytes()
    others = [family.rows(seed, 40).tobytes() for seed in (3, 4)] + [long[BLOCK:].tobytes()]
    assert len(set(others)) == 3, "another seed or block repeats the rows"


@pytest.mark.parametrize(
    "family", [each for each in FAMILIES.values() if each.by_place], ids=lambda family: family.name
)
def test_blocks_of_a_family_generated_together_equal_blocks_generated_alone(family: Family) -> None:
    blocks = [family.block(5, number) for number in range(TOGETHER + 3)]
    rows = family.rows(5, len(blocks) * BLOCK)
    assert rows.tobytes() == np.concatenate(blocks).tobytes()
    start, stop = BLOCK + 7, TOGETHER * BLOCK + 500
    assert family.columns_between(5, start, stop).T.tobytes() == rows[start:stop].tobytes()


@every_family
def test_rows_of_a_family_are_almost_all_distinct(family: Family) -> None:
    rows = family.rows(1, BLOCK)
    assert len(np.unique(rows, axis=0)) > 0.85 * BLOCK


@every_family
def test_rows_of_a_family_equal_those_of_earlier_releases(family: Family) -> None:
    assert digest(family) == DIGESTS[family.name]


def test_every_kept_digest_belongs_to_a_family() -> None:
    assert set(DIGESTS) == set(FAMILIES)


@pytest.mark.slow
def test_rows_of_families_do_not_depend_on_the_instruction_set() -> None:
    """The same digests with every instruction set beyond numpy's baseline turned off."""
    optional = [name for name in numpy_core.__cpu_dispatch__ if numpy_core.__cpu_features__[name]]
    if not optional:
        pytest.skip("this processor has nothing beyond numpy's baseline to turn off")
    program = f"""
import json
from {numpy_core.__name__} import __cpu_features__ as features
from {__name__} import digest
from hypcheck.vectors.families import FAMILIES
assert not any(features[name] for name in {optional!r}), "numpy ignored the request"
print(json.dumps({{name: digest(family) for name, family in FAMILIES.items()}}))
"""
    environment = os.environ | {
        "NPY_DISABLE_CPU_FEATURES": " ".join(optional),
        "PYTHONPATH": os.pathsep.join(path for path in sys.path if path),
    }
    ran = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    assert json.loads(ran.stdout) == DIGESTS


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


@pytest.mark.parametrize(
    ("pattern", "hint"),
    [("tower-bodi", "tower-body"), ("tangant", "tangent"), ("Ring", "ring"), ("qqq*", "forest-type-1")],
)
def test_unknown_name_of_a_family_is_refused_with_a_suggestion(pattern: str, hint: str) -> None:
    with pytest.raises(InputError, match=re.escape(pattern)) as caught:
        select(["uniform", pattern])
    assert hint in str(caught.value)


@pytest.mark.parametrize("index", [0, 1, BLOCK - 1, BLOCK, 5 * BLOCK + 3])
def test_a_case_id_names_its_row(index: int) -> None:
    family = FAMILIES["symmetric-images"]
    text = case_id(family, 9, index)
    assert text == f"symmetric-images/{family.version}/9/{index}"
    case = parse_case_id(text)
    assert (case.family, case.seed, case.index) == (family, 9, index)
    assert family.row(9, index) == tuple(family.rows(9, index + 1)[index].tolist())


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("uniform", "no case id"),
        ("uniform/1/0", "no case id"),
        ("uniform/1/0/-1", "no case id"),
        ("uniform/1/0/01", "no case id"),
        ("uniform/1/0/1 ", "no case id"),
        ("uniform/1/0/٣", "no case id"),
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
