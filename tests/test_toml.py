"""TOML that people write: read as it is, or refused in one sentence, whatever its size and depth."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from hypcheck import toml
from hypcheck.cli.main import main
from hypcheck.errors import InputError


def test_a_byte_order_mark_in_a_toml_file_is_ignored(tmp_path):
    path = tmp_path / "a.toml"
    path.write_bytes(b"\xef\xbb\xbfa = 1\r\n")
    assert toml.parsed(toml.text_of(str(path)), "a.toml") == {"a": 1}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a = ", "a.toml: is not valid TOML: Invalid value"),
        ("a = " + "[" * 5000, "a.toml: cannot be read as TOML: it is nested too deeply"),
        ("a = " + "9" * 5000, "a.toml: has an integer with too many digits"),
        ("a = 0x" + "f" * 5000, "a.toml: has an integer with too many digits"),
        ("\n\na" + ".a" * 5000 + " = 1", "a.toml, line 3: has more than 100 dots"),
        ('"=\\"".1.1 .1 . 1' * 30 + " = 1", "a.toml, line 1: has more than 100 dots"),
        ("a = '\x1b'", r"a.toml: is not valid TOML: .* character '\\x1b'"),
    ],
)
def test_invalid_toml_is_refused_in_one_sentence(text, message):
    with pytest.raises(InputError, match=message):
        toml.parsed(text, "a.toml")


@pytest.mark.parametrize(
    ("words", "name", "key"),
    [(["verify"], "hypcheck.toml", "out"), (["plan", "a.toml"], "a.toml", "name")],
)
def test_a_file_nested_to_any_depth_is_refused_in_one_sentence(words, name, key, tmp_path, monkeypatch, capsys):
    """Between the depth that has a line and the depth that cannot be read is one that is read but not scanned."""
    monkeypatch.chdir(tmp_path)
    messages = []
    for depth in range(sys.getrecursionlimit() // 2 - 120, sys.getrecursionlimit() // 2 + 1, 2):
        Path(name).write_text(f"{key} = {'[' * depth}{']' * depth}", encoding="utf-8")
        assert main(words) == 2
        messages.append(capsys.readouterr().err.splitlines()[-1])
    assert messages[0].startswith(f"hypcheck: error: {name}, line 1: {key} is [[[")
    assert messages[-1] == f"hypcheck: error: {name}: cannot be read as TOML: it is nested too deeply"


def test_a_toml_file_that_cannot_be_read_is_refused_in_one_sentence(tmp_path):
    large, other = tmp_path / "large.toml", tmp_path / "other.toml"
    with large.open("wb") as file:
        file.truncate(toml.LARGEST + 1)
    other.write_bytes(b"a = 1\nb = '\xff'\n")
    for path, message in (
        (large, "has more than 1 MiB"),
        (other, r"line 2: is not UTF-8 text: invalid start byte at byte 11"),
        (tmp_path, "cannot read .*: is a directory"),
        (os.devnull, "cannot read .*: it is a pipe or a device; it must be a regular file"),
        (tmp_path / "a\0b", "cannot read .*: embedded null byte"),
        (tmp_path / ("a" * 5000), "cannot read .*: file name too long"),
    ):
        with pytest.raises(InputError, match=message):
            toml.text_of(str(path))
    with pytest.raises(FileNotFoundError):
        toml.text_of(str(tmp_path / "none.toml"))


def test_dots_in_numbers_and_comments_do_not_count_towards_the_depth_of_toml_keys():
    """A forest on one line, and a comment that rules it off."""
    text = "trees = [" + "{ x = -0.5, y = 1.25e-3 }, " * 500 + "] #" + "." * 200
    assert len(toml.parsed(text, "a.toml")["trees"]) == 500


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no named pipes")
@pytest.mark.parametrize(
    "words",
    [["verify"], ["plan", "pipe.toml"], ["verify", "--families", "ring", "--known-failures", "pipe.toml"]],
)
def test_a_named_pipe_as_settings_scene_or_known_failures_file_is_refused(words, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    name = "pipe.toml" if "pipe.toml" in words else "hypcheck.toml"
    os.mkfifo(name)
    spec = ["builtin:fast"] if words[0] == "verify" else []
    assert main([words[0], *spec, *words[1:]]) == 2
    said = capsys.readouterr().err.splitlines()[-1]
    assert said == f"hypcheck: error: cannot read {name}: it is a pipe or a device; it must be a regular file"
