"""`hypcheck simulate`: text, JSON by its schema, files, and one sentence about bad input."""

from __future__ import annotations

import json
import subprocess
import sys
from importlib import resources
from xml.etree import ElementTree

import pytest

from hypcheck.cli.main import main
from hypcheck.paper import motion
from hypcheck.scene.reading import shipped_text
from tests.support.records import violations
from tests.support.without_drawing import draw_nothing

SHORT = shipped_text("tower").replace("distance = 500.0", "distance = 3.0")
FOREST = ("simulate", "forest", "--seed", "3")


VERSIONS = {"forest": "1.1.0", "tower": "1.2.0"}


def schema(name):
    file = resources.files("hypcheck.paper").joinpath("schemas", f"simulate-{name}-{VERSIONS[name]}.json")
    return json.loads(file.read_text(encoding="utf-8"))


def run(capsys, *arguments):
    code = main([str(argument) for argument in arguments])
    out, err = capsys.readouterr()
    return code, out, err


@pytest.fixture
def tower(tmp_path, monkeypatch):
    monkeypatch.setattr(motion, "CENTRES", 50)
    path = tmp_path / "short.toml"
    path.write_text(SHORT)
    return ("simulate", "tower", "--scene", str(path), "--workers", "1")


@pytest.mark.parametrize(
    "more",
    [
        (),
        ("--continuous",),
        ("--table", "5", "--runs", "3"),
        ("--table", "5", "--runs", "1", "--continuous"),
        ("--pitch", "20", "--runs", "1"),
    ],
)
def test_the_json_of_simulate_tower_fits_its_schema(capsys, tower, more):
    code, out, err = run(capsys, *tower, "--format", "json", *more)
    assert (code, err) == (0, "")
    assert violations(json.loads(out), schema("tower"), closed=True) == []
    assert (json.loads(out)["table_5"] is None) == ("--runs" not in more)
    assert (json.loads(out)["pitch"] is None) == ("--pitch" not in more)


@pytest.mark.parametrize("more", [("--steps", 40), ("--continuous",), ("--steps", 0)])
def test_the_json_of_simulate_forest_fits_its_schema(capsys, more):
    code, out, err = run(capsys, *FOREST, "--format", "json", *more)
    assert (code, err) == (0, "")
    assert violations(json.loads(out), schema("forest"), closed=True) == []


def test_a_flights_moves_and_refused_attempts_are_counted_apart_from_its_positions(capsys, tower):
    """Δ ≤ 0 in 3 executions beside a least Δ above 0 would read as a contradiction."""
    _, out, _ = run(capsys, *tower)
    assert out.count("executions, of which 24 moves made and ") == 3
    assert out.count("Δ at its positions from ") == out.count("(refused attempts lead to none)") == 3


def test_the_text_of_simulate_tower_has_the_statement_and_every_assumption(capsys, tower):
    _, out, _ = run(capsys, *tower, "--table", "5", "--runs", "2", "--continuous")
    assert "The unstated parameters are not identified by the table" in out
    assert "printed            13.9532       13.9029" in out
    assert "  the second row, if its t is a misprint for 0.25:" in out
    assert "ahead or back, half each" in out
    assert "l = 0.135, g1 = heading +45 degrees" in out
    assert "accepted vertical moves" in out
    assert max(map(len, out.splitlines())) <= 120


def test_simulate_tower_shows_its_statement_even_without_the_table(capsys, tower):
    assert "not identified by the table" in run(capsys, *tower)[1]


def test_simulate_tower_takes_the_scene_tower_simplest(capsys):
    code, out, _ = run(capsys, "simulate", "tower", "--scene", "tower-simplest")
    assert code == 0
    assert "no end of its height is modelled" in out
    assert "a turn asks nothing" in out
    assert "straight 0.25 (ahead)" in out


def test_the_text_of_simulate_forest_counts_phantoms_and_lines(capsys):
    _, out, _ = run(capsys, *FOREST, "--continuous")
    assert "64 trees (40 of type 1, 24 of type 2)" in out
    assert "without Δ" in out
    assert "phantoms, contact with nothing: 5 in float32, 0 in float64, 0 in float32 where the line is asked" in out
    assert "from touching: birch 18" in out
    assert "made steps: 3 touch a tree on the way" in out


def test_the_text_names_trees_outside_the_regime_and_questions_outside_heights(capsys, tmp_path):
    path = tmp_path / "odd.toml"
    text = shipped_text("forest").replace("alpha = 0.61, gamma = 28.0", "alpha = 0.61, gamma = 0.9", 1)
    path.write_text(text.replace("height = [-0.9, 5.0]", "height = [-0.9, -0.5]", 2))
    code, out, _ = run(capsys, "simulate", "forest", "--scene", path, "--steps", 20)
    assert code == 0
    assert "claims nothing about trees with (gamma/d)^2 < alpha/b: 1, oak 1" in out
    assert "40 more are outside the modelled height and have no answer" in out


def test_simulate_writes_files_and_names_them_on_standard_error(capsys, tower, tmp_path):
    out = tmp_path / "new" / "folder"
    code, said, told = run(capsys, *tower, "--pitch", "20", "--runs", "2", "--out", out, "--format", "json")
    assert code == 0
    names = ["simulate-tower.json", "tower-flights.svg", "tower-table-5.svg", "tower-pitch.svg"]
    assert told.splitlines() == [f"wrote {out / name}" for name in names]
    assert json.loads((out / names[0]).read_text()) == json.loads(said)
    for name in names[1:]:
        root = ElementTree.fromstring((out / name).read_bytes())  # noqa: S314 - just written
        assert root.tag.endswith("svg")
    run(capsys, *tower, "--out", out)
    assert not (out / "tower-table-5.svg").exists()  # it would show another run
    assert not (out / "tower-pitch.svg").exists()


def test_without_matplotlib_simulate_writes_all_but_the_pictures(capsys, tmp_path, monkeypatch):
    (tmp_path / "forest-walk.svg").write_text("of another run")
    draw_nothing(monkeypatch)
    code, out, err = run(capsys, *FOREST, "--steps", 10, "--out", tmp_path)
    assert code == 0
    assert "64 trees" in out
    assert err.splitlines()[0] == f"wrote {tmp_path / 'simulate-forest.json'}"
    assert "no pictures: matplotlib cannot be imported" in err
    assert "hypcheck[report]" in err
    assert [path.name for path in tmp_path.iterdir()] == ["simulate-forest.json"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("tower", "--runs", 5), "--runs is for the table; it needs --table 5 or --pitch"),
        (("tower", "--table", "4"), "'4'"),
        (("tower", "--pitch", "91"), "'--pitch': '91' must be a number, at least 0 and at most 90"),
        (("tower", "--table", "5", "--runs", 0), "'0' must be a whole number, at least 1"),
        (("tower", "--speed", "nan"), "'--speed': 'nan' must be a number, at least 1e-06 and at most 1e+06"),
        (("tower", "--time", "-1"), "'--time': '-1' must be a number, at least 1e-06"),
        (("tower", "--scene", "forest"), "has 64 hyperboloids; it must have one, the tower"),
        (("forest", "--scene", "tower"), "has no [walk]"),
        (("forest", "--scene", "nowhere.toml"), "there is no such file"),
        (("forest", "--steps", -1), "'-1' must be a whole number, at least 0"),
        (("forest", "--show-scene", "--scene", "x.toml"), "'x.toml' is no shipped scene; there are forest, tower"),
        (
            ("forest", "--steps", 1, "--out", "/dev/null/x"),
            "--out /dev/null/x: files cannot be written to it: not a directory",
        ),
    ],
)
def test_simulate_refuses_bad_input_in_one_sentence(capsys, arguments, message):
    code, _, err = run(capsys, "simulate", *arguments)
    assert code == 2
    assert message in err
    assert "Traceback" not in err


@pytest.mark.parametrize(
    ("command", "scenes", "sections"),
    [("forest", ["forest"], "section 3.1"), ("tower", ["tower", "tower-simplest"], "sections 3.2 and 4")],
)
def test_the_help_and_the_scenes_of_a_simulation_name_the_same_sections_of_the_paper(capsys, command, scenes, sections):
    assert main(["simulate", "--help"]) == main(["simulate", command, "--help"]) == 0
    assert " ".join(capsys.readouterr().out.split()).count(sections) == 2
    for scene in scenes:
        assert f"the paper's {sections}" in shipped_text(scene).partition("name =")[0]


def test_simulate_accepts_the_scene_that_show_scene_prints(capsys, tmp_path):
    _, out, _ = run(capsys, "simulate", "tower", "--show-scene")
    assert out == shipped_text("tower")
    (tmp_path / "mine.toml").write_text(out)
    assert run(capsys, "simulate", "tower", "--scene", tmp_path / "mine.toml")[0] == 0


@pytest.mark.parametrize(
    ("arguments", "heavy"),
    [(["--help"], {"numpy", "matplotlib", "sympy"}), (["--steps", "5"], {"matplotlib", "sympy", "fcl"})],
)
def test_simulate_loads_no_library_that_it_does_not_use(arguments, heavy):
    code = (
        f"import sys; from hypcheck.cli.main import main; main(['simulate', 'forest', *{arguments!r}]);"
        f"sys.exit(bool({heavy!r} & set(sys.modules)))"
    )
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
