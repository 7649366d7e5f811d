"""Foreign records are validated against the schema; an error is one sentence that names the fault."""

from __future__ import annotations

import json

import pytest

from hypcheck.errors import InputError
from hypcheck.record import plain
from hypcheck.record.reader import notes, read
from hypcheck.report.write import render
from tests.report import bench_lines, record_samples
from tests.support.records import resealed
from tests.tools.published_schemas import record_schema

REQUIRED = {name: part.get("required", ()) for name, part in record_schema()["$defs"].items()}
"""The fields that each type of line must have."""


def written(tmp_path, body=None, **header):
    first, *_, last = map(json.loads, record_samples.text_and_record()[0].splitlines())
    lines = plain(record_samples.lines() if body is None else body)
    path = tmp_path / "record.jsonl"
    path.write_bytes(resealed([{**first, **header}, *lines, {**last, "lines": len(lines) + 2}]))
    return path


@pytest.mark.parametrize("body", [record_samples.lines(), bench_lines.lines()])
def test_record_is_read_from_its_file_or_its_folder(tmp_path, body):
    path = written(tmp_path, body)
    assert read(path) == read(tmp_path)
    assert notes(read(path)) == []


@pytest.mark.parametrize(
    ("kind", "spoilt", "said"),
    [
        ("group", {"counts": None}, "counts is null; it must be an object"),
        ("group", {"worst": [{}]}, "worst[0] lacks case"),
        ("oracle", {"asked": -4}, "asked is -4; it must be a whole number >= 0"),
        ("timing", {"samples_ns": ["\x1b[31m"]}, r'samples_ns[0] is "\u001b[31m"; it must be a number'),
        ("group", {"octaves": {"-in\u202e": {}}}, "octaves has '-in\\u202e', which is neither a small whole number"),
        ("group", {"octaves": {"12345": {}}}, "octaves has '12345', which is neither a small whole number"),
        ("group", {"size_bins": [[0, 0, 3, 4]]}, "size_bins[0] has 4 wrong answers of 3"),
        ("group", {"place_bins": [[0, 0, 3, 2], [0, 10**5, 1, 1]]}, "place_bins[1] is at 100000"),
        ("group", {"place_bins": [[0, 0, -3, -4]]}, "place_bins[0] has -4 wrong answers of -3"),
        ("map", {"lines": ["x" * 10**6]}, 'lines[0] is "xxxxxxxxxxxxxxxxx'),
        ("map", {"r": [1, 2, 3]}, "r is [1, 2, 3]; it must be a list of length 2"),
        ("equation", {"verdict": "odd"}, 'verdict is "odd"; it must be a text out of holds, misprint, false'),
        (
            "group",
            {"worst": [record_samples.worst("x", "wrong", "inf") | {"backward_error": "nan"}]},
            "worst[0].backward_error",
        ),
    ],
)
def test_invalid_record_line_is_refused_naming_its_number_and_type(tmp_path, kind, spoilt, said):
    body = [{**line, **spoilt} if line["type"] == kind else line for line in record_samples.lines()]
    number = 2 + next(place for place, line in enumerate(body) if line["type"] == kind)
    with pytest.raises(InputError) as caught:
        read(written(tmp_path, body))
    assert f"record.jsonl: line {number}, {kind}: {said}" in str(caught.value)
    assert len(str(caught.value)) < 1000


@pytest.mark.parametrize(
    ("octaves", "said"),
    [
        ([[-3, 2, 3]], "octaves[0] has 3 wrong answers of 2"),
        ([["-inf", 2, 1], [10**5, 1, 1]], "octaves[1] is at 100000; it must be between"),
        ([[-3, "-inf", 3]], 'octaves[0][1] is "-inf"; it must be a whole number'),
    ],
)
def test_record_line_with_impossible_counts_is_refused_naming_the_field(tmp_path, octaves, said):
    body = [{**line, "octaves": octaves} if line["type"] == "accuracy" else line for line in bench_lines.lines()]
    with pytest.raises(InputError) as caught:
        read(written(tmp_path, body))
    assert f", accuracy: {said}" in str(caught.value)


@pytest.mark.parametrize("constant", ["NaN", "Infinity"])
def test_record_with_a_constant_that_json_does_not_have_is_refused(tmp_path, constant):
    path = tmp_path / "record.jsonl"
    path.write_text(f'{{"type": "header", "schema": "1.1.0"}}\n{{"type": "proof", "seconds": {constant}}}\n')
    with pytest.raises(InputError, match=f"in line 2, at byte 38: {constant} is not a number of JSON"):
        read(path)


def test_record_line_that_lacks_a_field_is_refused_naming_the_field(tmp_path):
    """Whatever is left out, there is a sentence or a report."""
    every = [*record_samples.lines(), *bench_lines.lines()]
    first = {line["type"]: line for line in reversed(every)}
    header, *lines = map(json.loads, record_samples.text_and_record(list(first.values()))[0].splitlines())
    path = tmp_path / "record.jsonl"
    path.write_bytes(resealed([header, *lines]))
    read(path)
    for place, whole in enumerate(lines):
        for field in set(REQUIRED[whole["type"]]) - {"type"}:
            less = [dict(line) for line in lines]
            del less[place][field]
            path.write_bytes(resealed([header, *less]))
            with pytest.raises(InputError, match=rf"{field}|footer counts"):
                read(path)


def test_later_minor_versions_are_read_and_other_major_versions_refused(tmp_path):
    later = read(written(tmp_path, [*record_samples.lines(), {"type": "dream", "of": "sheep"}], schema="1.11.0"))
    assert notes(later) == [
        "the record has schema 1.11.0, later than this program's 1.10.0; what it adds is not shown",
    ]
    for name in ("terminal", "json", "markdown", "junit"):
        assert render(name, later)
    assert notes(read(written(tmp_path, schema="1.0.0"))) == []
    for version in ("0.9.0", "2.0.0"):
        with pytest.raises(InputError, match=r"reads 1\.x"):
            read(written(tmp_path, schema=version))
    with pytest.raises(InputError, match=r"not a header with a schema such as 1\.0\.0"):
        read(written(tmp_path, schema="1"))


def test_reading_a_truncated_record_gives_a_note_that_the_run_was_interrupted(tmp_path):
    text, _ = record_samples.text_and_record(exit_code=None)
    path = tmp_path / "record.jsonl"
    path.write_text(text, encoding="utf-8")
    assert "interrupted" in notes(read(path))[0]
