"""The workloads have the rows that their descriptions promise."""

from __future__ import annotations

import numpy as np
import pytest

from hypcheck.bench.workloads import NEAR_SCENES, WORKLOADS, scene_of
from hypcheck.geometry.rows import first_trouble
from tests.support import inside
from tests.support.inside import clearances, flip_exponents


@pytest.mark.parametrize("name", WORKLOADS)
def test_workload_rows_are_valid_and_a_short_workload_is_the_beginning_of_a_longer_one(name):
    rows = WORKLOADS[name].rows(3, 1500)
    assert rows.shape == (1500, 7)
    assert first_trouble(rows) is None
    assert (WORKLOADS[name].rows(3, 90) == rows[:90]).all()
    assert (WORKLOADS[name].rows(4, 90) != rows[:90]).any()
    assert WORKLOADS[name].rows(3, 0).shape == (0, 7)


@pytest.mark.parametrize("name", ["uniform", "flight"])
def test_uniform_and_flight_workloads_have_one_scene_and_near_contact_several(name):
    assert scene_of(WORKLOADS[name].rows(1, 200)) == (2.0, 17.8, 0.25, 0.15)
    assert scene_of(WORKLOADS["near-contact"].rows(1, 200)) is None


def test_near_contact_workload_alternates_its_scenes_and_has_every_position():
    rows = WORKLOADS["near-contact"].rows(1, 1200)
    positions = inside.positions(rows)
    for place, scene in enumerate(NEAR_SCENES):
        assert (rows[place :: len(NEAR_SCENES), :4] == scene).all()
        assert {0, 1} <= set(positions[place :: len(NEAR_SCENES)].tolist())
    assert np.count_nonzero(positions == -1) > 150


def test_near_contact_workload_has_distances_of_every_decade_down_to_1e_15():
    rows = WORKLOADS["near-contact"].rows(1, 1200)
    gaps = np.abs(clearances(rows).clearance)
    decades = np.floor(np.log10(gaps[gaps > 0])).astype(int)
    assert {*range(-15, 0)} <= set(decades.tolist())
    octaves = flip_exponents(rows)
    assert np.count_nonzero(octaves < -53) > 50


def test_every_second_row_of_the_ring_workload_is_clear_with_a_zero_discriminant():
    rows = WORKLOADS["ring"].rows(1, 400)
    assert (inside.positions(rows[::2]) == 1).all()
