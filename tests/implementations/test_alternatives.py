"""Methods that only bench uses keep what they promise; those for spheroids that lean are right away from contact."""

from __future__ import annotations

import numpy as np
import pytest

import hypcheck
from hypcheck.bench.workloads import WORKLOADS
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS, answers
from hypcheck.geometry.pair import COLUMNS
from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.implementations import alternatives
from hypcheck.implementations import method as formula
from hypcheck.implementations.alternatives import (
    bounding_cylinder,
    bounding_sphere,
    bounding_sphere_scene,
    by_eigenvectors,
    by_eigenvectors_scene,
    by_roots,
    dual,
    numpy_roots,
    trigonometric_roots,
    upright,
    upright_scene,
)
from hypcheck.implementations.builtin import builtin, methods, trouble_with
from hypcheck.implementations.method import on_rows, on_scene
from hypcheck.vectors.families import FAMILIES, TILTED_FAMILIES, select
from hypcheck.vectors.frozen import load
from tests.support import inside
from tests.support.inside import numpy_kernel_positions

BY_PAIRS = [name for name, each in FORMULAS.items() if each.classifies_pairs]


@pytest.fixture(scope="module")
def rows():
    return np.concatenate([family.rows(5, 40) for family in select(("*", "extreme"))])


@pytest.fixture(scope="module")
def tower():
    return FAMILIES["tower-body"].rows(2, 3000)


def scene(rows):
    return (tuple(rows[0, :4].tolist()), *np.ascontiguousarray(rows[:, 4:].T))


@pytest.mark.parametrize("name", BY_PAIRS)
def test_a_formula_prepared_for_rows_answers_as_its_program(name, rows):
    for format_name in ("float16", "float32", "float64", "longdouble"):
        right = answers(FORMULAS[name], float_arithmetic(format_name), dict(zip(COLUMNS, rows.T, strict=True)))
        assert (formula.by_rows(FORMULAS[name], format_name)(rows) == right).all(), format_name


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
    "answer", [trigonometric_roots("float64"), trigonometric_roots("float32"), dual("float64"), bounding_cylinder]
)
def test_a_method_on_columns_answers_alike_by_scene_and_by_rows(answer, tower):
    assert (on_scene(answer)(*scene(tower)) == on_rows(answer)(tower)).all()


def test_the_bounding_sphere_answers_alike_by_scene_and_by_rows(tower):
    assert (bounding_sphere_scene(*scene(tower)) == bounding_sphere(tower)).all()


@pytest.mark.parametrize("answer", [on_rows(trigonometric_roots("float64")), numpy_roots])
def test_root_methods_are_right_away_from_contact(answer):
    regimes = [FAMILIES[name].rows(3, 250) for name in ("tower-body", "forest-type-1", "forest-type-2")]
    rows = np.concatenate([*regimes, FAMILIES["out-of-regime"].rows(3, 250)])
    truth = inside.positions(rows)
    wrong = np.flatnonzero(answer(rows) != truth)
    assert set(truth.tolist()) == {-1, 0, 1}
    assert len(wrong) <= 2  # ratios at random may come near
    assert (answer(rows[:750]) == truth[:750]).all()


@pytest.mark.slow
def test_mpmath_roots_with_50_digits_are_right_where_15_digits_are_not():
    rows = WORKLOADS["near-contact"].rows(1, 40)
    truth = inside.positions(rows)
    fewer, more = (alternatives.mpmath_roots(rows, digits) for digits in (15, 50))
    assert np.count_nonzero(fewer != truth) > 0
    assert (more == truth).all()


def test_numpy_roots_answers_cannot_say_if_the_coefficients_overflow():
    huge = np.array([[1e200, 1e200, 1.0, 1.0, 0.0, 0.0, 0.0]])
    assert numpy_roots(huge).tolist() == [CANNOT_SAY]


@pytest.mark.parametrize("answer", [bounding_sphere, on_rows(bounding_cylinder)])
def test_a_bounding_shape_is_clear_only_where_the_spheroid_has_the_same_clear_position(answer, rows):
    found = answer(rows)
    claimed = found != 0
    assert claimed.any()
    assert (found[claimed] == inside.positions(rows)[claimed]).all()


def test_bounding_sphere_is_exact_for_spheres_and_contains_other_spheroids(tower):
    spheres = tower.copy()
    spheres[:, 3] = spheres[:, 2]
    assert (bounding_sphere(spheres) == numpy_kernel_positions(spheres)).all()
    tall = tower.copy()
    tall[:, 3] = 8 * tall[:, 2]
    wide = tall.copy()
    wide[:, 2] = wide[:, 3]
    assert (bounding_sphere(tall) == inside.positions(wide)).all()


@pytest.mark.parametrize("name", ["exact-integers", "exact-oracle", "nearest-point"])
def test_the_exact_bench_methods_are_never_wrong(name, rows):
    some = rows[::9]
    assert (builtin(name).answer(some) == inside.positions(some)).all()


def test_built_in_methods_that_only_bench_measures_can_be_opened_by_name():
    measured = [
        name
        for name, method in methods().items()
        if method.measured and not method.tilt and trouble_with(method) is None
    ]
    assert {"table-2-float16", "trigonometric-float64", "mpmath-roots-100", "bounding-sphere"} <= set(measured)
    assert all(builtin(name).name == name for name in measured)


LEANING = ("tilted-uniform", "tilted-tower")


@pytest.mark.parametrize("name", LEANING)
@pytest.mark.parametrize("method", [by_eigenvectors, by_roots])
def test_numpy_methods_for_tilted_rows_are_right_away_from_contact(method, name):
    rows = TILTED_FAMILIES[name].rows(3, 300)
    assert (method(rows) == inside.positions(rows)).all()


@pytest.mark.parametrize("method", [by_eigenvectors, by_roots])
def test_numpy_methods_for_tilted_rows_are_sometimes_wrong_at_exact_tangencies(method):
    rows = TILTED_FAMILIES["tilted-tangent"].rows(3, 200)
    wrong = np.count_nonzero(method(rows) != hypcheck.classify(rows))
    assert 0 < wrong < 150


@pytest.mark.parametrize(
    ("by_rows", "by_scene"),
    [(by_eigenvectors, by_eigenvectors_scene), (upright, upright_scene), (bounding_sphere, bounding_sphere_scene)],
)
def test_a_method_for_tilted_rows_answers_alike_by_scene_and_by_rows(by_rows, by_scene):
    rows = TILTED_FAMILIES["tilted-tower"].rows(4, 400)
    rows[:, 7:] = rows[0, 7:]
    found = by_scene((2.0, 17.8, 0.25, 0.15), *np.ascontiguousarray(rows[:, 4:7].T), tuple(rows[0, 7:].tolist()))
    assert (found == by_rows(rows)).all()
    assert len(set(found.tolist())) == 3


def test_the_method_that_ignores_the_axis_is_right_for_spheres_and_wrong_for_others():
    spheres, tower = (TILTED_FAMILIES[name].rows(3, 300) for name in ("tilted-sphere", "tilted-tower"))
    assert (upright(spheres) == hypcheck.classify(spheres)).all()
    assert (upright(tower) != hypcheck.classify(tower)).sum() > 30
    assert (upright(tower) == hypcheck.classify(tower[:, :7])).all()


def test_the_bounding_sphere_is_never_clear_where_the_tilted_spheroid_is_not():
    rows = TILTED_FAMILIES["tilted-tower"].rows(3, 1000)
    found, truth = bounding_sphere(rows), hypcheck.classify(rows)
    assert ((found == truth) | (found == 0)).all()
    assert (found != truth).any()


def test_by_eigenvectors_with_few_bisections_has_more_errors():
    rows = TILTED_FAMILIES["tilted-near-contact"].rows(3, 1000)
    truth = hypcheck.classify(rows)
    few, many = (np.count_nonzero(by_eigenvectors(rows, turns) != truth) for turns in (5, alternatives.TURNS))
    assert 2 * many < few


def test_two_roots_that_mpmath_finds_equal_are_contact():
    """A tangency of the frozen vectors; of most, the two come out a little apart."""
    row = [17.45037176355254, 2.4914282880490646, 7.94814582914114, 0.3576665623113513, -13.731668396969326]
    row += [-10.298751297726994, -2.6182321517553646]
    assert row in load("tangent").rows.tolist()
    assert alternatives.mpmath_roots(np.array([row]), digits=20).tolist() == [0]
