"""`hypcheck cases check` finds wrong descriptions of known flags and families, and compares no others."""

from __future__ import annotations

from dataclasses import replace

import pytest

from hypcheck.cli.main import main
from hypcheck.vectors import fixed_sizes, frozen
from hypcheck.vectors.cases import cases_text
from hypcheck.vectors.checking import wrong_description, wrong_meanings
from hypcheck.vectors.families import ALL, FAMILIES
from hypcheck.vectors.format import described, descriptions
from hypcheck.vectors.invalid_rows import INVALID_CONTENTS

FILE = frozen.load("tangent")
TEXT = cases_text(replace(FILE, cases=FILE.cases[:6]))


def checked(tmp_path, capsys, text):
    """How the check ends, and what it says."""
    path = tmp_path / "mine.json"
    path.write_text(text, encoding="utf-8")
    code = main(["cases", "check", str(path)])
    return code, capsys.readouterr().out.replace(f"{path}, ", "").splitlines()


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ('"title":"exactly', '"title":"nearly', 'line 3: family.title is "nearly tangent, in every'),
        ('"extreme":false', '"extreme":true', "line 3: family.extreme is true; of tangent it is false"),
        ('"version":1', '"version":2', "line 3: family.version is 2; of tangent it is 1"),
        ('"the surfaces touch', '"the surfaces cross', 'line 4: the meaning of the flag tangent is "the surfaces cro'),
        ('"equality"', '"luck"', 'line 4: the bug_type of the flag tangent is "luck"; it is "equality"'),
    ],
)
def test_wrong_description_in_the_metadata_of_a_family_is_a_fault(tmp_path, capsys, old, new, sentence):
    assert old in TEXT
    code, (said, closing) = checked(tmp_path, capsys, TEXT.replace(old, new, 1))
    assert code == 1
    assert said.startswith(sentence)
    assert closing == "6 cases checked, none with a wrong label; 1 file with a wrong head"


def test_wrong_description_in_the_metadata_of_invalid_rows_is_a_fault(tmp_path, capsys):
    text = cases_text(frozen.load("invalid"))
    code, lines = checked(tmp_path, capsys, text.replace(frozen.head_of("invalid").drone, "a bad row is answered"))
    assert (code, lines[0][:39]) == (1, 'line 3: family.drone is "a bad row is a')


@pytest.mark.parametrize(
    "changes",
    [
        {'"name":"tangent"': '"name":"mine"', '"id":"tangent-': '"id":"mine-', "exactly tangent": "nearly"},
        {"freeze": "make"},
    ],
    ids=["a family of one's own", "made in another way"],
)
def test_descriptions_of_unknown_families_are_not_compared(tmp_path, capsys, changes):
    text = TEXT
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    assert checked(tmp_path, capsys, text) == (0, ["6 cases checked, none with a wrong label"])


def test_descriptions_of_earlier_versions_are_not_compared():
    head = replace(frozen.load("ring").head, title="another")
    right = frozen.head_of("ring").title
    assert list(wrong_description(head)) == [f'family.title is "another"; of ring it is "{right}"']
    assert list(wrong_description(replace(head, version=0))) == []


def test_messages_quote_the_beginning_of_a_long_value(tmp_path, capsys):
    code, (said, _) = checked(tmp_path, capsys, TEXT.replace("exactly tangent", "nearly" * 10_000, 1))
    assert code == 1
    assert len(said) < 400


def test_every_family_and_file_has_a_description_and_every_description_is_used():
    names = {*ALL, *frozen.ALL_NAMES, *fixed_sizes.TRAPS, *fixed_sizes.TILTED_TRAPS, "found"}
    assert sorted(descriptions()) == sorted(names)
    for name in descriptions():
        assert all(vars(described(name, "a command", FAMILIES["extreme-hair"])).values())


def test_descriptions_in_the_shipped_files_are_right():
    for name in frozen.NAMES:
        file = frozen.load(name)
        assert file.head.name == name
        assert [*wrong_description(file.head), *wrong_meanings(file.flags, file.content.flags)] == []
    for name in frozen.TILTED_NAMES:
        tilted = frozen.load(name)
        assert tilted.head.name == name
        assert [*wrong_description(tilted.head), *wrong_meanings(tilted.flags, tilted.content.flags)] == []
    for name in frozen.SWEEP_NAMES:
        ways = frozen.load(name)
        assert ways.head.name == name
        assert [*wrong_description(ways.head), *wrong_meanings(ways.flags, ways.content.flags)] == []
    for name in (*frozen.ENDED_NAMES, *frozen.ENDED_SWEEP_NAMES, *INVALID_CONTENTS):
        assert list(wrong_description(frozen.load(name).head)) == []
