"""`hypcheck flight`: what it says, as text and as JSON, where lengths are too large for bounds."""

from __future__ import annotations

import json
import warnings

import pytest

from hypcheck.cli.main import main

SCENE = """
name = "wide"
[[hyperboloid]]
alpha = {}
gamma = 17.8
center = {}
[mover]
b = 0.25
d = 0.15
"""


@pytest.mark.parametrize(("alpha", "center"), [("1e308", "[0, 0, 0]"), ("1.0", "[1e308, 1e308, 0]")])
def test_flight_prints_none_for_a_least_distance_that_is_not_known(alpha, center, tmp_path, capsys):
    scene, path = tmp_path / "wide.toml", tmp_path / "path.csv"
    scene.write_text(SCENE.format(alpha, center), encoding="utf-8")
    path.write_text("x,y,z\n5,0,0\n0,0,3\n", encoding="utf-8")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert main(["flight", str(scene), str(path)]) == 0
        text = capsys.readouterr().out
        assert main(["flight", str(scene), str(path), "--json"]) == 0
    assert text.startswith("clear; the least distance is not known")
    answer = json.loads(capsys.readouterr().out)
    assert (answer["hit"], answer["contact"], answer["least"]) == (False, None, None)
