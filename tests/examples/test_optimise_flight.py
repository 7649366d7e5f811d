"""The example with scipy: the straight flight touches a tree, the optimised one is clear by the exact first contact."""

from __future__ import annotations

import runpy
from pathlib import Path

import numpy as np
import pytest

EXAMPLE = Path(__file__).parents[2] / "examples" / "optimise_flight.py"


@pytest.mark.thorough
def test_optimised_flight_keeps_its_distance_at_each_point_and_is_hardly_longer():
    pytest.importorskip("scipy", reason="the optimiser; pip install 'hypcheck[examples]' brings it")
    example = runpy.run_path(str(EXAMPLE))
    scene = example["trees"]()
    path = example["optimised"](scene)
    assert scene.first_contact([example["START"], example["GOAL"]]).hit
    assert not scene.first_contact(path).hit
    assert (scene.nearest(path[1:-1]).distance_upper > example["CLEAR"] - 1e-6).all()
    assert 16 < np.sqrt((np.diff(path, axis=0) ** 2).sum(axis=1)).sum() < 17.5
