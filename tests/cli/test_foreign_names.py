"""Names in scenes, records and files of vectors are text on a terminal, whatever characters they have."""

from __future__ import annotations

import json

import pytest

from hypcheck.cli.main import main
from hypcheck.scene.reading import shipped_text
from hypcheck.vectors import frozen
from tests.report.test_hostile import UNSEEN
from tests.support.records import resealed
from tests.support.without_drawing import draw_nothing

ACTS = "\x1b]0;title\x07\x1b[2J\x9b31m\u202e\r"
"""Sets a terminal's title, clears it, changes colours and directions, and overwrites the line."""


def said(capsys, *words, codes=(0,)):
    """What a command says, of which nothing acts on a terminal."""
    assert main([str(word) for word in words]) in codes
    out, err = capsys.readouterr()
    assert not UNSEEN.search(out.replace("\n", "")), words
    assert not UNSEEN.search(err.replace("\n", "")), words
    return out


@pytest.fixture(scope="module")
def record(tmp_path_factory):
    """A record in which every case has a name that acts."""
    out = tmp_path_factory.mktemp("run")
    words = ["verify", "builtin:table-2-float64", "--families", "ring", "--count", "50", "--out", str(out)]
    with pytest.MonkeyPatch.context() as patch:
        draw_nothing(patch)
        assert main(words) == 1
    lines = [json.loads(line) for line in (out / "record.jsonl").read_text().splitlines()]
    for line in lines:
        worst = line.get("worst", ())
        for case in [worst] if isinstance(worst, dict) else [*worst, *line.get("faults", ())]:
            case["case"] += ACTS
    (out / "record.jsonl").write_bytes(resealed(lines))
    return out


@pytest.mark.parametrize("form", [(), ("--json",)])
def test_replay_escapes_the_names_of_cases_in_a_record(form, record, capsys):
    found = said(capsys, "replay", f"{record}:1", "builtin:table-2-float64", *form, codes=(1,))
    assert ("\\u001b]0;title\\u0007" if form else r"\x1b]0;title\x07\x1b[2J\x9b31m\u202e\r") in found


@pytest.mark.parametrize("form", ["terminal", "markdown", "json"])
def test_report_escapes_the_names_of_cases_in_a_record(form, record, capsys):
    if form == "json":  # for programs, whose strings have escapes of their own
        assert main(["report", str(record), "--format", form]) == 0
        assert "\x1b" not in capsys.readouterr().out
    else:
        said(capsys, "report", record, "--format", form)


@pytest.mark.slow
@pytest.mark.parametrize(
    "words",
    [
        ("simulate", "forest", "--steps", "300", "--scene"),
        ("simulate", "forest", "--steps", "300", "--format", "json", "--continuous", "--scene"),
        ("simulate", "tower", "--scene"),
        ("plan",),
        ("plan", "--json"),
    ],
    ids=" ".join,
)
def test_commands_that_take_a_scene_escape_the_names_in_its_file(words, tmp_path, capsys):
    acts = json.dumps(ACTS)[1:-1]
    name = "tower" if "tower" in words else "forest"
    text = shipped_text(name).replace('name = "', f'name = "{acts}')
    (tmp_path / "scene.toml").write_text(text)
    found = said(capsys, *words, tmp_path / "scene.toml")
    assert ("\\u001b]0;title" if "json" in " ".join(words) else r"\x1b]0;title") in found


@pytest.mark.slow
def test_cases_check_escapes_the_names_of_files_and_cases(tmp_path, capsys):
    path = tmp_path / f"{ACTS}.json"
    text = frozen.path_of("ring").read_text(encoding="utf-8")
    path.write_text(text.replace('"tangent":false', '"tangent":true', 1), encoding="utf-8")
    assert r"\x1b]0;title" in said(capsys, "cases", "check", path, codes=(1,))
