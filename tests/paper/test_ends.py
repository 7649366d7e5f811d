"""`hypcheck simulate --ends`: what the centre's height misses where a tower or a tree ends."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from hypcheck.cli.main import main
from hypcheck.geometry.pair import Pair
from hypcheck.paper.ends import EndVerdicts
from hypcheck.paper.flights import Moves
from hypcheck.paper.quadcopter import craft_of
from hypcheck.scene.reading import read_scene, shipped_text
from tests.support import inside

TREES = Path(__file__).parents[2] / "docs" / "simulate" / "two-trees.toml"
FOREST = ("simulate", "forest", "--scene", str(TREES))


def result_of(capsys, *arguments):
    assert main([*arguments, "--format", "json"]) == 0
    return json.loads(capsys.readouterr().out)


@pytest.fixture
def tower(tmp_path):
    """A tower that ends below its waist, where it narrows towards the top, and a flight of 20 m in it."""
    path = tmp_path / "lower.toml"
    text = shipped_text("tower").replace("gamma = 17.8", "gamma = 2.0").replace("distance = 500.0", "distance = 20.0")
    path.write_text(text.replace("[-17.8, 17.8]", "[-17.8, -2.0]"))
    return ("simulate", "tower", "--scene", str(path), "--workers", "1", "--time", "0.05")


@pytest.mark.parametrize("command", [("simulate", "forest", "--steps", "50"), ("simulate", "tower", "--time", "0.05")])
def test_the_option_ends_adds_one_key_to_the_output_of_a_simulation_and_changes_no_other(capsys, command):
    ended, without = (result_of(capsys, *command, *more) for more in (("--ends",), ()))
    assert ended.pop("ends")
    assert ended == without
    assert list(ended) == list(without)


def test_a_drone_above_the_top_of_a_tree_is_counted_as_dangerous_where_it_touches_the_top(capsys):
    """The top is a disc of radius 0.2 √5 at z = 2, and the drone's circle there, 0.01 below its centre, is known."""
    result = result_of(capsys, *FOREST, "--ends", "--steps", "1000")
    reach = 0.2 * math.sqrt(5) + 0.3 * math.sqrt(1 - (0.01 / 0.2) ** 2)
    low = [(x, y) for x, y, _ in result["path"][1:] if math.hypot(x, y) <= reach]
    assert len(low) > 5
    assert result["ends"]["steps"]["dangerous"] == result["ends"]["questions"]["dangerous"] == len(low)
    assert result["ends"]["steps"]["needless"] == 0
    places = [(tuple(place["at"][:2]), place["tree"], place["dangerous"]) for place in result["ends"]["places"]]
    assert places == [(at, "low tree", True) for at in low[:12]]


def test_counts_about_a_tower_that_ends_are_those_of_exact_decisions_at_each_position(tower):
    """Moves to random places near the upper end and the wall, where the tower narrows; half of them ask nothing."""
    craft, draw, count = craft_of(read_scene(tower[3])), np.random.default_rng(5), 500
    z = draw.uniform(-2.02, -1.98, count) - draw.integers(0, 2, count) * draw.uniform(0, 0.3, count)
    radius = 2 * np.hypot(1, z / 2) - draw.uniform(0.2, 0.26, count)
    angle, none = draw.uniform(-0.1, 0.1, count), np.zeros(count, dtype=np.bool_)
    end, heading = (radius * np.cos(angle), radius * np.sin(angle), z), (np.ones(count), np.zeros(count))
    asked = z <= -2
    moves = Moves(np.arange(count), end, end, heading, np.zeros(count), asked, none, ~none, none, asked, none)
    verdicts = EndVerdicts()
    verdicts.watch(craft, moves)
    by_center, by_ends, touching = [], [], 0
    places = zip(*(column.tolist() for column in end), strict=True)
    for at, below in zip(places, asked.tolist(), strict=True):
        touching += not below and position(craft.sizes, at, ENDED) == 0
        if below:
            by_center.append(is_valid(craft, at, ()))
            by_ends.append(is_valid(craft, at, ENDED))
    needless = sum(ended and not whole for whole, ended in zip(by_center, by_ends, strict=True))
    assert needless > 2
    assert touching > 10
    assert not any(whole and not ended for whole, ended in zip(by_center, by_ends, strict=True))
    assert (verdicts.asked, verdicts.needless, verdicts.dangerous) == (len(by_ends), needless, 0)
    assert (verdicts.beyond, verdicts.touching) == (count - len(by_ends), touching)
    assert verdicts.asked > verdicts.reaching >= needless


ENDED = (0.0, 0.0, 1.0, -17.8, -2.0, 0.0)


def position(sizes, at, heights):
    return inside.position(Pair(*sizes, *at, *heights).lengths)


def is_valid(craft, at, heights):
    """Whether the body is interior, or all four rotors, for a heading along x."""
    rotors = craft.rotors(tuple(np.array([number]) for number in at), (np.ones(1), np.zeros(1)))
    four = zip(*(column.tolist() for column in rotors), strict=True)
    return position(craft.sizes, at, heights) == -1 or all(position(craft.rotor, one, heights) == -1 for one in four)


def test_text_of_a_simulation_with_ends_states_the_errors_of_a_test_of_the_centres_height(capsys, tower):
    assert main([*FOREST, "--ends", "--steps", "400"]) == 0
    out = capsys.readouterr().out
    assert "Trees as they end, where the walk asks for the height of the centre alone:" in out
    assert "the walker touches low tree" in out
    assert main([*tower, "--ends", "--table", "5", "--runs", "1"]) == 0
    out = capsys.readouterr().out
    assert "The tower as it ends, where the flights ask for the height of the centre alone:" in out
    assert "needlessly refused" in out
    assert max(map(len, out.splitlines())) <= 120


@pytest.mark.parametrize("more", [("tower", "--scene", "tower-simplest"), ("forest", "--scene", "bare.toml")])
def test_the_option_ends_is_refused_in_one_sentence_if_no_hyperboloid_of_the_scene_ends(
    capsys, tmp_path, monkeypatch, more
):
    monkeypatch.chdir(tmp_path)
    Path("bare.toml").write_text(
        "".join(
            line for line in TREES.read_text().splitlines(keepends=True) if not line.startswith(("height", "solid"))
        )
    )
    assert main(["simulate", *more, "--ends"]) == 2
    error = capsys.readouterr().err
    assert error.startswith("hypcheck: error: --ends: nothing in the scene")
    assert error.count("\n") == 1
