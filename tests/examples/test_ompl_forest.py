"""The example with OMPL, in a small forest: its checkers plan, and Scene's paths are clear by the exact passage."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).parents[2] / "examples" / "ompl_forest.py"


def test_paths_that_scene_accepts_in_ompl_as_motions_are_clear_by_the_exact_passage(tmp_path):
    pytest.importorskip("ompl", reason="the planner; pip install 'hypcheck[examples]' brings it")
    example = runpy.run_path(str(EXAMPLE))
    example["util"].noOutputHandler()
    scene = example["forest"](36)
    meshes, states, motions = example["compared"](scene, 2, 5.0)
    assert [each.name for each in (meshes, states, motions)] == ["FCL", "Scene, states", "Scene, motions"]
    assert motions.solved > 0
    assert motions.touches == []
    assert motions.worst > 0
    assert motions.motions > 0
    assert meshes.states > 0 < states.states
    pytest.importorskip("matplotlib", reason="it draws; pip install 'hypcheck[report]' brings it")
    example["draw"](scene, [meshes, states, motions], str(tmp_path / "planner.png"))
    assert (tmp_path / "planner.png").read_bytes().startswith(b"\x89PNG")
