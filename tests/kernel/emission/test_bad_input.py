"""`emit` refuses scenes that no kernel is made for: one sentence that says what and where, exit 2, nothing written."""

from __future__ import annotations

import pytest

from hypcheck.cli.main import main

SCENE = """name = "t"
question = "interior"
[[hyperboloid]]
alpha = 2.0
gamma = 17.8
[mover]
b = 0.25
d = 0.15
"""
MANY = 'name = "m"\nquestion = "exterior"\n' + "".join(
    f"[[hyperboloid]]\nalpha = {n}.5\ngamma = 9.0\n" for n in range(65)
)
BAD = {
    "a negative size": ("alpha = 2.0", "alpha = -2.0", "line 4: hyperboloid 1: alpha is -2.0"),
    "sizes beyond the format": ("alpha = 2.0", "alpha = 1e-300", "no kernel is made for alpha 1e-300, gamma 17.8, b 0"),
    "nothing to ask": (
        "[mover]",
        "height = [-1, 3]\n[region]\nz = [4, 5]\n[mover]",
        "the region contains no height of a hyperboloid",
    ),
    "a flat end": ("[mover]", "height = [-1, 3]\nsolid = true\n[mover]", "the hyperboloid 'hyperboloid 1' is solid"),
    "too many sizes": (SCENE, MANY + "[mover]\nb = 0.3\nd = 0.9\n", "the scene has 65 different pairs of sizes"),
}


def refused(arguments, capsys):
    """The one line of a command that refuses."""
    assert main(arguments) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert len(said.err.splitlines()) == 1
    return said.err


@pytest.mark.parametrize(("old", "new", "sentence"), BAD.values(), ids=BAD)
def test_emit_refuses_a_bad_scene_and_leaves_the_output_file_unchanged(old, new, sentence, tmp_path, capsys):
    path, output = tmp_path / "scene.toml", tmp_path / "kernel.c"
    assert old in SCENE
    path.write_text(SCENE.replace(old, new), encoding="utf-8")
    output.write_text("kept", encoding="utf-8")
    assert sentence in refused(["plan", str(path)], capsys)
    assert sentence in refused(["emit", "--scene", str(path), "--language", "c", "--output", str(output)], capsys)
    assert output.read_text(encoding="utf-8") == "kept"
    assert sorted(each.name for each in tmp_path.iterdir()) == ["kernel.c", "scene.toml"]


def test_emit_refuses_to_write_to_a_folder(tmp_path, capsys):
    emit = ["emit", "--scene", "tower", "--language", "c", "--output", str(tmp_path)]
    assert "it is a folder" in refused(emit, capsys)


@pytest.mark.parametrize("prefix", ["", "2nd", "_own", "own_", "a__b", "höhe", "a-b", "a b", "x" * 41, "a;\n"])
def test_emit_refuses_a_prefix_that_is_no_identifier(prefix, tmp_path, capsys):
    output = tmp_path / "kernel.c"
    emit = ["emit", "--scene", "tower", "--language", "c", "--output", str(output), "--prefix", prefix]
    assert "the prefix is " in refused(emit, capsys)
    assert not output.exists()


@pytest.mark.parametrize("language", ["javascript", "python"])
def test_emit_refuses_a_prefix_for_a_language_with_modules(language, capsys):
    emit = ["emit", "--scene", "tower", "--language", language, "--prefix", "tower"]
    assert f"a {language} kernel is a module with names of its own" in refused(emit, capsys)


def test_plan_accepts_a_scene_whose_trees_overlap(tmp_path, capsys):
    """Every pair is asked for itself; trees of the same sizes share a function."""
    path = tmp_path / "scene.toml"
    trees = "".join(
        f'[[hyperboloid]]\nname = "{name}"\nalpha = 0.5\ngamma = 6\ncenter = [{x}, 0, 0]\n'
        for name, x in (("a", 0), ("b", 0.25))
    )
    path.write_text(f'name = "t"\nquestion = "exterior"\n{trees}[mover]\nb = 0.3\nd = 0.9\n', encoding="utf-8")
    assert main(["plan", str(path)]) == 0
    assert "1. alpha 0.5, gamma 6.0, b 0.3, d 0.9: the mover and a; the mover and b" in capsys.readouterr().out
