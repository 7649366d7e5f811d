"""Families of the paper's scenes have the paper's sizes and coherent movements."""

from __future__ import annotations

import numpy as np

from hypcheck.vectors.families import FAMILIES
from hypcheck.vectors.random_pairs import ARM, FLIGHT_STEPS
from tests.vectors.case_rows import COUNT, ratios


def test_generated_forests_satisfy_the_conditions_of_the_paper() -> None:
    for name, wide in (("forest-type-1", True), ("forest-type-2", False)):
        rows = FAMILIES[name].rows(0, COUNT)
        for a, c in ratios(rows):
            assert c * c >= a
            assert (a >= 1) == wide
        alpha, gamma, b, d, x, y, z = np.abs(rows).T
        assert 0.2 <= b.min() <= b.max() <= 0.5, "a person is 40 cm to 1 m across"
        assert 0.6 <= d.min() <= d.max() <= 1.1, "and 1.2 m to 2.2 m tall"
        assert 0.04 <= alpha.min() <= alpha.max() <= 3, "a trunk is 10 cm to 6 m across"
        assert gamma.max() <= 15
        assert max(x.max(), y.max(), z.max()) < 50


def test_generated_tower_has_the_sizes_of_the_paper() -> None:
    for name, sizes in (
        ("tower-body", (2, 17.8, 0.25, 0.15)),
        ("flight", (2, 17.8, 0.25, 0.15)),
        ("tower-rotors", (2, 17.8, 0.1, 0.05)),
    ):
        assert np.array_equal(np.unique(FAMILIES[name].rows(0, 100)[:, :4], axis=0), [sizes])
    box = np.abs(FAMILIES["tower-body"].rows(0, 4000)[:, 4:])
    assert (box <= [4, 4, 17.8]).all()
    assert (box.max(axis=0) > [3.98, 3.98, 17.7]).all()


def test_tower_rotors_form_a_level_square_around_their_body() -> None:
    quads = FAMILIES["tower-rotors"].rows(0, 400)[:, 4:].reshape(100, 4, 3)
    body = (quads[:, 0] + quads[:, 2]) / 2
    assert np.allclose((quads[:, 1] + quads[:, 3]) / 2, body, atol=1e-12)
    arms = quads - body[:, None]
    assert np.allclose(np.sqrt((arms**2).sum(axis=2)), ARM, atol=1e-12)
    assert np.allclose((arms[:, 0] * arms[:, 1]).sum(axis=1), 0, atol=1e-12)
    assert (quads[:, :, 2] == quads[:, :1, 2]).all()


def test_generated_flights_are_continuous_and_end_within_the_height_of_the_tower() -> None:
    rows = FAMILIES["flight"].rows(0, 64 * FLIGHT_STEPS)
    flights = rows[:, 4:].reshape(64, FLIGHT_STEPS, 3)
    assert np.abs(flights[:, :, 2]).max() <= 17.8
    strides = np.sqrt((np.diff(flights, axis=1) ** 2).sum(axis=2))
    assert strides.max() <= 6 + 1e-9, "a refused move of 3 m and the one after it"
    vertical = (np.diff(flights[:, :, :2], axis=1) == 0).all(axis=2).mean()
    assert 0.1 < vertical < 0.4
