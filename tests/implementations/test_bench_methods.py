"""The methods that only bench uses keep what they promise."""

from __future__ import annotations

import numpy as np
import pytest

from hypcheck.bench.workloads import WORKLOADS
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS, answers
from hypcheck.geometry.pair import COLUMNS
from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.implementations import alternatives
from hypcheck.implementations import method as formula
from hypcheck.implementations.alternatives import dual_by_scene, dual_positions
from hypcheck.implementations.builtin import builtin, builtin_methods
from hypcheck.kernel import numpy_kernel
from hypcheck.truth import float_filter
from hypcheck.vectors.families import FAMILIES, select

BY_PAIRS = [name for name, each in FORMULAS.items() if each.classifies_pairs]


@pytest.fixture(scope="module")
def rows():
    return np.concatenate([family.rows(5, 40) for family in select(("*", "extreme"))])


@pytest.fixture(scope="module")
def tower():
    return FAMILIES["tower-body"].rows(2, 3000)


def scene(rows):
    return (tuple(rows[0, :4].tolist()), *np.ascontiguousarray(rows[:, 4:].T))


@pytest.mark.parametrize("format_name", ["float16", "float32", "float64", "longdouble"])
@pytest.mark.parametrize("name", BY_PAIRS)
def test_a_formula_prepared_for_rows_answers_as_its_program(name, format_name, rows):
    right = answers(FORMULAS[name], float_arithmetic(format_name), dict(zip(COLUMNS, rows.T, strict=True)))
    assert (formula.by_rows(FORMULAS[name], format_name)(rows) == right).all()


@pytest.mark.parametrize("name", BY_PAIRS)
def test_a_formula_answers_alike_by_scene_and_by_rows(name, tower):
    found = formula.by_scene(FORMULAS[name], "float32")(*scene(tower))
    assert (found == formula.by_rows(FORMULAS[name], "float32")(tower)).all()


def test_a_formula_answers_rows_of_several_chunks_as_those_of_one(tower):
    many = np.tile(tower, (6, 1))
    assert len(many) > 2 * formula.CHUNK
    table_2 = formula.by_rows(FORMULAS["table-2"], "float64")
    assert (table_2(many) == np.tile(table_2(tower), 6)).all()
    assert table_2(many[:0]).shape == (0,)


@pytest.mark.parametrize(
    ("by_rows", "by_scene"),
    [
        (alternatives.trigonometric_roots("float64"), alternatives.trigonometric_roots_by_scene("float64")),
        (alternatives.trigonometric_roots("float32"), alternatives.trigonometric_roots_by_scene("float32")),
        (alternatives.bounding_sphere, alternatives.bounding_sphere_scene),
        (alternatives.bounding_cylinder, alternatives.bounding_cylinder_scene),
        (lambda rows: dual_positions(rows, "float64"), lambda *each: dual_by_scene("float64", *each)),
    ],
)
def test_a_bench_method_answers_alike_by_scene_and_by_rows(by_rows, by_scene, tower):
    assert (by_scene(*scene(tower)) == by_rows(tower)).all()


@pytest.mark.parametrize("answer", [alternatives.trigonometric_roots("float64"), alternatives.numpy_roots])
def test_root_methods_are_right_away_from_contact(answer):
    regimes = [FAMILIES[name].rows(3, 250) for name in ("tower-body", "forest-type-1", "forest-type-2")]
    rows = np.concatenate([*regimes, FAMILIES["out-of-regime"].rows(3, 250)])
    truth = float_filter.positions(rows)
    wrong = np.flatnonzero(answer(rows) != truth)
    assert set(truth.tolist()) == {-1, 0, 1}
    assert len(wrong) <= 2  # ratios at random may come near
    assert (answer(rows[:750]) == truth[:750]).all()


@pytest.mark.slow
def test_mpmath_roots_with_50_digits_are_right_where_15_digits_are_not():
    rows = WORKLOADS["near-contact"].rows(1, 150)
    truth = float_filter.positions(rows)
    fewer, more = (alternatives.mpmath_roots(rows, digits) for digits in (15, 50))
    assert np.count_nonzero(fewer != truth) > 0
    assert (more == truth).all()


def test_numpy_roots_answers_cannot_say_if_the_coefficients_overflow():
    huge = np.array([[1e200, 1e200, 1.0, 1.0, 0.0, 0.0, 0.0]])
    assert alternatives.numpy_roots(huge).tolist() == [CANNOT_SAY]


@pytest.mark.parametrize("answer", [alternatives.bounding_sphere, alternatives.bounding_cylinder])
def test_a_bounding_shape_is_never_clear_where_the_spheroid_is_not(answer, rows):
    found = answer(rows)
    claimed = found != 0
    assert claimed.any()
    assert (found[claimed] == float_filter.positions(rows)[claimed]).all()


def test_bounding_sphere_is_exact_for_spheres_and_contains_other_spheroids(tower):
    spheres = tower.copy()
    spheres[:, 3] = spheres[:, 2]
    assert (alternatives.bounding_sphere(spheres) == numpy_kernel.positions(spheres)).all()
    tall = tower.copy()
    tall[:, 3] = 8 * tall[:, 2]
    wide = tall.copy()
    wide[:, 2] = wide[:, 3]
    assert (alternatives.bounding_sphere(tall) == float_filter.positions(wide)).all()


@pytest.mark.parametrize("name", ["exact-integers", "exact-oracle", "nearest-point"])
def test_the_exact_bench_methods_are_never_wrong(name, rows):
    some = rows[::9]
    assert (builtin(name).answer(some) == float_filter.positions(some)).all()


def test_methods_only_for_bench_can_be_opened_by_name():
    measured = [name for name, method in builtin_methods().items() if method.measured]
    assert {"table-2-float16", "trigonometric-float64", "mpmath-roots-100", "bounding-sphere"} <= set(measured)
    assert all(builtin(name).name == name for name in measured)
