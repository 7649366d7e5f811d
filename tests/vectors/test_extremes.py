"""Families at the ends of the float formats: overflow, underflow, subnormal lengths, tiny coordinates."""

from __future__ import annotations

import numpy as np
import pytest

from hypcheck.derivation.float_arithmetic import FLOAT_FORMATS
from hypcheck.geometry.pair import Pair
from hypcheck.geometry.rows import Rows
from hypcheck.vectors.families import FAMILIES
from tests.support import inside

TABLE_2 = (
    "A",
    "B",
    "c0",
    "P",
    "Q",
    "c1",
    "c2",
    "b²",
    "x²",
    "z²",
    "c2³",
    "c2³ c0",
    "(c2 c1)²",
    "c2 c1 c0",
    "c1³",
    "c0²",
)


def table_2(rows: Rows) -> dict[str, np.ndarray[tuple[int], np.dtype[np.floating]]]:
    """Every intermediate of the paper's Table 2 in the rows' own precision."""
    alpha, gamma, b, d, x, y, z = rows.T
    A, B = (alpha / b) * (alpha / b), (gamma / d) * (gamma / d)
    P, Q = (x * x + y * y) / (b * b), (z / d) * (z / d)
    c0 = -(A * B)
    c1, c2 = c0 + A - B + B * P - A * Q, A - B + 1 - P - Q
    cube = c2 * c2 * c2
    values = (A, B, c0, P, Q, c1, c2, b * b, x * x, z * z, cube, cube * c0, c2 * c1 * (c2 * c1), c2 * c1 * c0)
    return dict(zip(TABLE_2, (*values, c1 * c1 * c1, c0 * c0), strict=True))


@pytest.mark.parametrize(("name", "dtype"), [("float16", np.float16), ("float32", np.float32), ("float64", np.float64)])
def test_each_intermediate_of_table_2_overflows_and_underflows(name: str, dtype: type[np.floating]) -> None:
    rows = FAMILIES[f"extreme-{name}"].rows(0, 4000)
    limits = np.finfo(dtype)
    own = rows.astype(dtype)
    assert np.array_equal(own.astype(np.float64), rows)
    nonzero = np.abs(rows[rows != 0])
    assert nonzero.min() >= limits.tiny
    with np.errstate(all="ignore"):
        found = table_2(own)
        finite = {key: np.isfinite(own).all(axis=1) & ~np.isnan(value) for key, value in found.items()}
    for key, value in found.items():
        assert np.isinf(value[finite[key]]).sum() >= 20, key
        if key not in ("c2", "c2³"):  # c2 is small by cancellation alone, for it contains 1 − P − Q
            zero = {"P": own[:, 4:6], "x²": own[:, 4:5], "Q": own[:, 6:], "z²": own[:, 6:]}.get(key, own[:, :1])
            assert (np.abs(value[(zero != 0).any(axis=1)]) < limits.tiny).sum() >= 20, key


@pytest.mark.parametrize("dtype", [np.float16, np.float32, np.float64])
def test_extreme_subnormal_family_has_subnormal_lengths_in_each_format(dtype: type[np.floating]) -> None:
    form = list(FLOAT_FORMATS).index(np.dtype(dtype).name)
    rows = FAMILIES["extreme-subnormal"].rows(0, 900)[form::3]
    b, d = rows[:, 2], rows[:, 3]
    limits = np.finfo(dtype)
    low = {
        name: (values >= float(limits.smallest_subnormal)) & (values < float(limits.tiny))
        for name, values in (("b", b), ("d", d))
    }
    assert (low["b"] | low["d"]).all()
    assert min(low["b"].mean(), low["d"].mean()) > 0.5
    assert (low["b"] & low["d"]).any()


def test_extreme_magnitude_family_has_all_combinations_of_sizes_above_1e149_and_below_1e_149() -> None:
    sizes = FAMILIES["extreme-magnitude"].rows(0, 400)[:, [2, 3]]
    assert ((sizes > 1e149) | (sizes < 1e-149)).all()
    assert len(np.unique(sizes > 1, axis=0)) == 4


def test_rows_of_extreme_hair_differ_from_a_tangency_by_one_tiny_coordinate() -> None:
    for row in FAMILIES["extreme-hair"].rows(0, 200).tolist():
        assert not inside.decide(Pair.from_row(row).lengths).tangent
        without = [0.0 if 0 < abs(value) < 1e-59 else value for value in row]
        assert inside.decide(Pair.from_row(without).lengths).tangent
