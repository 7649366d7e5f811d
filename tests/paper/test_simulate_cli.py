"""`hypcheck simulate`: text, JSON by its schema, files, and one sentence about bad input."""

from __future__ import annotations

import json
import subprocess
import sys
from importlib import resources
from xml.etree import ElementTree

import pytest

from hypcheck.cli.main import main
from hypcheck.scene.reading import shipped_text
from tests.support.records import violations

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
def tower(tmp_path):
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
        ("--ends",),
        ("--ends", "--table", "5", "--runs", "1"),
    ],
)
def test_the_json_of_simulate_tower_fits_its_schema(capsys, tower, more):
    code, out, err = run(capsys, *tower, "--format", "json", *more)
    assert (code, err) == (0, "")
    assert violations(json.loads(out), schema("tower"), closed=True) == []
    assert (json.loads(out)["table_5"] is None) == ("--runs" not in more)
    assert (json.loads(out)["pitch"] is None) == ("--pitch" not in more)


@pytest.mark.parametrize(
    "more", [("--steps", 40), ("--continuous",), ("--steps", 0), ("--steps", 0, "--ends"), ("--ends",)]
)
def test_the_json_of_simulate_forest_fits_its_schema(capsys, more):
    code, out, err = run(capsys, *FOREST, "--format", "json", *more)
    assert (code, err) == (0, "")
    assert violations(json.loads(out), schema("forest"), closed=True) == []


def test_the_text_of_simulate_tower_has_the_statement_and_every_assumption(capsys, tower):
    _, out, _ = run(capsys, *tower, "--table", "5", "--runs", "2", "--continuous")
    assert "The unstated parameters are not identified by the table" in out
    assert "printed            13.9532       13.9029" in out
    assert "  the second row, if its t is a misprint for 0.25:" in out
    assert "ahead or back, half each" in out
    assert "l = 0.135, g1 = heading +45 degrees" in out
    assert "accepted vertical moves" in out
    assert max(map(len, out.splitlines())) <= 120


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


@pytest.mark.parametrize(
    ("command", "scenes", "sections"),
    [("forest", ["forest"], "section 3.1"), ("tower", ["tower", "tower-simplest"], "sections 3.2 and 4")],
)
def test_the_help_and_the_scenes_of_a_simulation_name_the_same_sections_of_the_paper(capsys, command, scenes, sections):
    assert main(["simulate", "--help"]) == main(["simulate", command, "--help"]) == 0
    assert " ".join(capsys.readouterr().out.split()).count(sections) == 2
    for scene in scenes:
        assert f"the paper's {sections}" in shipped_text(scene).partition("name =")[0]


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
