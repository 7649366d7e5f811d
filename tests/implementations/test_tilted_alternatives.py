"""Plain numpy versions for spheroids that lean are right away from contact; simpler bodies are what they say."""

from __future__ import annotations

import numpy as np
import pytest

import hypcheck
from hypcheck.implementations import tilted_alternatives
from hypcheck.implementations.tilted_alternatives import (
    bounding_sphere,
    bounding_sphere_scene,
    by_eigenvectors,
    by_eigenvectors_scene,
    by_roots,
    upright,
    upright_scene,
)
from hypcheck.truth.tilted import batch
from hypcheck.vectors.families import TILTED_FAMILIES

FAMILY_NAMES = ("tilted-uniform", "tilted-tower")


@pytest.mark.parametrize("name", FAMILY_NAMES)
@pytest.mark.parametrize("method", [by_eigenvectors, by_roots])
def test_numpy_methods_for_tilted_rows_are_right_away_from_contact(method, name):
    rows = TILTED_FAMILIES[name].rows(3, 300)
    assert (method(rows) == batch.positions(rows)).all()


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


def test_the_bounding_sphere_is_never_clear_where_the_leaning_spheroid_is_not():
    rows = TILTED_FAMILIES["tilted-tower"].rows(3, 1000)
    found, truth = bounding_sphere(rows), hypcheck.classify(rows)
    assert ((found == truth) | (found == 0)).all()
    assert (found != truth).any()


def test_by_eigenvectors_with_few_bisections_has_more_errors():
    rows = TILTED_FAMILIES["tilted-near-contact"].rows(3, 1000)
    truth = hypcheck.classify(rows)
    few, many = (np.count_nonzero(by_eigenvectors(rows, turns) != truth) for turns in (5, tilted_alternatives.TURNS))
    assert 2 * many < few
