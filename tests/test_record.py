"""A record is read back as it was written; a damaged one is refused with the line that is wrong."""

from __future__ import annotations

import io
import json
import math

import pytest

from hypcheck.errors import InputError
from hypcheck.record import Recorder, read


def written(path, close=True):
    stream = io.StringIO()
    recorder = Recorder(stream, {"seed": 3})
    recorder.add("group", method="m", worst=[math.inf, -math.inf, 0.1], counts={1: (2, 3)})
    record = recorder.close(0) if close else None
    path.write_text(stream.getvalue(), encoding="utf-8")
    return record


def test_what_is_read_is_what_was_written(tmp_path):
    path = tmp_path / "record.jsonl"
    record = written(path)
    assert read(path) == record
    assert read(path).of("group")[0]["worst"] == ["inf", "-inf", 0.1]


def test_without_a_footer_a_record_is_truncated(tmp_path):
    path = tmp_path / "record.jsonl"
    written(path, close=False)
    assert read(path).footer is None
    assert len(read(path).lines) == 1


def test_a_line_cut_off_while_it_was_written_is_left_out(tmp_path):
    path = tmp_path / "record.jsonl"
    written(path)
    path.write_text(path.read_text(encoding="utf-8")[:-9], encoding="utf-8")
    assert read(path).footer is None
    assert len(read(path).lines) == 1


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (lambda text: text.replace('"lines": 3', '"lines": 4'), "has 3 lines, but its footer counts 4"),
        (lambda text: text.replace('"method"', "method", 1), "line 2 is no JSON"),
        (lambda text: text.partition("\n")[2], "line 1 is no header"),
        (lambda text: "", "line 1 is no header"),
        (lambda text: "[1]\n" + text, "line 1 is no object with a type"),
        (lambda text: text.replace('"schema": "1.', '"schema": "9.'), "has schema 9"),
    ],
)
def test_a_damaged_record_is_refused(tmp_path, damage, message):
    path = tmp_path / "record.jsonl"
    written(path)
    path.write_text(damage(path.read_text(encoding="utf-8")), encoding="utf-8")
    with pytest.raises(InputError, match=message):
        read(path)


def test_a_file_that_is_no_text_or_is_not_there_is_refused(tmp_path):
    path = tmp_path / "record.jsonl"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="is not UTF-8 text"):
        read(path)
    with pytest.raises(InputError, match="cannot be read"):
        read(tmp_path / "none.jsonl")


def test_every_line_is_strict_json(tmp_path):
    path = tmp_path / "record.jsonl"
    written(path)

    def refuse(constant):
        raise AssertionError(constant)

    for line in path.read_text(encoding="utf-8").splitlines():
        json.loads(line, parse_constant=refuse)
