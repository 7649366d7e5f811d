"""Malformed vector files are refused, and the message names file, line and case."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from functools import partial

import pytest

from hypcheck.errors import InputError
from hypcheck.vectors import frozen
from hypcheck.vectors.cases import case_fields, cases_text, read_cases
from hypcheck.vectors.format import HEAD_FIELDS, MEMBERS, content_with, flag_facts
from tests.support.inside import Kind

WHOLE = frozen.load("tangent-ladder")
COUNT = 12
SOUND = cases_text(replace(WHOLE, cases=WHOLE.cases[:COUNT])).splitlines()
"""The lines of a file of that family's first cases."""

FIRST = SOUND.index('"cases": [') + 1
"""The place of the first case; it stands on line FIRST + 1."""

FIFTH = FIRST + 4
ID = "tangent-ladder-0004"


READ = replace(WHOLE, cases=WHOLE.cases[:COUNT], lines=tuple(range(FIRST + 1, FIRST + 1 + COUNT)))
"""What such a file holds."""


def refused(tmp_path, content, read=read_cases):
    """The message about a file of these lines, or of this text or these bytes."""
    path = tmp_path / "mine.json"
    if isinstance(content, list):
        content = "\n".join(content) + "\n"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(InputError) as caught:
        read(str(path))
    message = str(caught.value)
    assert message.startswith(str(path))
    assert "\n" not in message
    return message[len(str(path)) :]


def with_case(change, place=FIFTH):
    """The lines with one case changed."""
    lines = list(SOUND)
    comma = "," if lines[place].endswith(",") else ""
    case = json.loads(lines[place].removesuffix(","))
    changed = change(case)
    lines[place] = json.dumps(case if changed is None else changed) + comma
    return lines


def with_head(name, change):
    """The lines with one member of the document changed."""
    lines = list(SOUND)
    document = json.loads("\n".join(lines))
    text = json.dumps(change(document[name]))
    start = next(place for place, line in enumerate(lines) if line.lstrip("{").startswith(f'"{name}"'))
    end = next(
        place
        for place in range(start + 1, len(lines))
        if any(lines[place].startswith(f'"{other}"') for other in (*MEMBERS, "cases"))
    )
    begin = "{" if start == 0 else ""
    return [*lines[:start], f'{begin}"{name}": {text},', *lines[end:]]


def test_valid_vector_file_is_read_and_written_back_to_the_same_bytes(tmp_path):
    path = tmp_path / "mine.json"
    path.write_text("\n".join(SOUND) + "\n", encoding="utf-8")
    file = read_cases(str(path))
    assert len(file.cases) == COUNT
    assert file.cases[4].id == ID
    assert file.lines[4] == FIFTH + 1
    assert cases_text(file) == "\n".join(SOUND) + "\n"
    assert file == READ


def test_vector_file_may_have_any_layout_and_notation_but_no_other_digits(tmp_path):
    document = json.loads("\n".join(SOUND))
    path = tmp_path / "mine.json"
    path.write_text("\ufeff" + json.dumps(document, indent=3), encoding="utf-8")
    assert read_cases(str(path)).cases == READ.cases


def test_numbers_of_a_vector_file_may_be_written_as_javascript_writes_them(tmp_path):
    """2 for 2.0, and 1e-5 for 1e-05."""
    text = frozen.path_of("ring").read_text(encoding="utf-8")
    shorter = re.sub(r"(\de-)0(\d)", r"\1\2", re.sub(r"(\d)\.0(?=[,\]])", r"\1", text))
    assert len(text) - len(shorter) > 500
    path = tmp_path / "mine.json"
    path.write_text(shorter, encoding="utf-8")
    assert read_cases(str(path)).cases == frozen.load("ring").cases


def test_a_case_is_named_by_line_and_id_in_any_layout(tmp_path):
    document = json.loads("\n".join(SOUND))
    document["cases"][4]["position"] = 2
    text = json.dumps(document, indent=1)
    line = text[: text.index(f'"{ID}"')].count("\n")  # of the brace before the id
    assert refused(tmp_path, text) == f", line {line}, case {ID}: position is 2; it must be 1, 0 or -1"


CASES_AT_FAULT = {
    "position": [(2, "must be 1, 0 or -1"), (True, "must be"), ("0", "must be"), (0.0, "must be"), (None, "must be")],
    "tangent": [(1, "true or false"), ("false", "true or false")],
    "kind": [("touching", "one of interior, interior-tangent-point"), (3, "must be one of")],
    "clearance": [("0.5", "must be a number"), ("-inf", "must be a number"), (None, "must be a number")],
    "clearance_hex": [("0x1p+9", "which follows from the field clearance"), (1, "it must be")],
    "row": [([1.0] * 6, "a list of 7"), ("row", "a list of 7"), ({}, "a list of 7")],
    "hex": [(["0x1p+0"] * 7, "the hex of alpha"), (["0x1p+0"], "a list of 7"), (None, "a list of 7")],
    "flips": [
        ({"contact": 0.5}, "flips has no interior; it must be a number"),
        ({"contact": 0.5, "interior": 0.5, "exterior": 0.5}, 'has the key "exterior"'),
        ({"contact": -0.5, "interior": 0.5}, "from 0 to 1"),
        ({"contact": 0.5, "interior": 1.5}, "from 0 to 1"),
        ({"contact": "0.5", "interior": 0.5}, 'must be a number, or "inf"'),
        (0.5, "must be an object"),
    ],
    "certificate": [
        ({}, "one of"),
        ({"multiplier": "1", "double_root": "1"}, "one of"),
        ({"lambda": "1"}, "it may have multiplier, points, double_root"),
        ({"multiplier": 0.5}, "must be a text"),
        ({"multiplier": "0.5"}, "an integer or p/q"),
        ({"multiplier": "2/4"}, "lowest terms"),
        ({"multiplier": "3/1"}, "lowest terms"),
        ({"multiplier": "-0"}, "lowest terms"),
        ({"multiplier": "1/0"}, "an integer or p/q"),
        ({"multiplier": "1/-2"}, "an integer or p/q"),
        ({"multiplier": " 1"}, "an integer or p/q"),
        ({"multiplier": "٣"}, "an integer or p/q"),
        ({"points": []}, "one or two"),
        ({"points": [["0", "0"]]}, "a list of 3"),
        ({"points": [["0", "1", "2/4"]]}, r'points\[0\]\[2\] is "2/4"; it must be in lowest terms'),
        ({"points": "0"}, "must be a list"),
        ("1/2", "must be an object"),
    ],
    "flags": [
        (["not-a-flag"], "is not among those"),
        (["tangent"], "is not among those"),  # a flag that there is, but the file does not describe it
        (["a<1", "a<1"], "duplicate flag"),
        ("a<1", "must be a list"),
        ([1], "is not among those"),
    ],
    "id": [
        ("waist-0001", "it must be tangent-ladder-NNNN"),
        ("tangent-ladder-4", "it must be"),
        ("tangent-ladder/1/1", "it must be"),
        ("tangent-ladder-٠٠٠٤", "it must be"),
        (4, "it must be"),
        ("tangent-ladder-0003", "first on line"),
    ],
}


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [(field, value, message) for field, faults in CASES_AT_FAULT.items() for value, message in faults],
)
def test_case_with_a_wrong_field_is_refused(tmp_path, field, value, message):
    found = refused(tmp_path, with_case(lambda case: case.update({field: value})))
    assert found.startswith(f", line {FIFTH + 1}")
    if field != "id":
        assert f", case {ID}: " in found
    assert re.search(message, found)


@pytest.mark.parametrize("field", case_fields(content_with()))
def test_case_with_a_missing_or_unknown_field_is_refused(tmp_path, field):
    without = with_case(lambda case: {name: value for name, value in case.items() if name != field})
    assert f"the case has no {field}; it must be" in refused(tmp_path, without)
    found = refused(tmp_path, with_case(lambda case: case.update({field + "s": 1})))
    assert f'has the key "{field}s"' in found
    assert f", line {FIFTH + 1}, case {ID}" in found


@pytest.mark.parametrize("case", [3, None, [], "x"])
def test_case_that_is_no_json_object_is_refused(tmp_path, case):
    assert f", line {FIFTH + 1}: the case is" in refused(tmp_path, with_case(lambda _: case if case is not None else 0))


@pytest.mark.parametrize(
    ("number", "message"),
    [
        ("0.10000000000000001", "it must be the shortest decimal"),  # a digit too many
        ("0.1000000000000000055511151231257827", "it must be the shortest decimal"),  # exact, but not the shortest
        ("9007199254740993", "it must be the shortest decimal"),
        ("1e-400", "it must be the shortest decimal"),
        ("1e999", "too large"),
        ("NaN", "not JSON"),
        ("Infinity", "not JSON"),
        ("1" * 500, "too large"),
        ("1_0", "not a JSON document"),
        ("0x1", "not a JSON document"),
        ('"1.0"', "must be a number"),
        ("true", "must be a number"),
        ("-1.0", "greater than 0"),
        ("0.0", "greater than 0"),
    ],
)
def test_case_with_a_number_that_does_not_round_trip_is_refused(tmp_path, number, message):
    lines = list(SOUND)
    lines[FIFTH] = re.sub(r'"row":\[[^,]*', f'"row":[{number}', lines[FIFTH])
    found = refused(tmp_path, lines)
    assert f", line {FIFTH + 1}" in found
    assert message in found


@pytest.mark.parametrize("place", range(7))
def test_case_whose_decimal_and_hexadecimal_numbers_differ_is_refused(tmp_path, place):
    """Another digit in either, though it round-trips by itself."""

    def change(case):
        case["row"][place] = case["row"][place] * 2 + 1

    assert "the hex of" in refused(tmp_path, with_case(change))


def test_vector_file_with_a_duplicate_key_is_refused_wherever_it_stands(tmp_path):
    lines = list(SOUND)
    lines[FIFTH] = lines[FIFTH].replace('"position":', '"position":1,"position":', 1)
    assert f", line {FIFTH + 1}: duplicate key 'position'" in refused(tmp_path, lines)
    place = next(place for place, line in enumerate(SOUND) if line.startswith('"count"'))
    assert f", line {place + 2}: duplicate key 'count'" in refused(
        tmp_path, [*SOUND[: place + 1], SOUND[place], *SOUND[place + 1 :]]
    )


def test_vector_file_with_a_case_removed_or_added_is_refused_by_its_count(tmp_path):
    assert "count is 12; it must be 11, the number of cases" in refused(tmp_path, SOUND[:FIFTH] + SOUND[FIFTH + 1 :])
    more = SOUND[FIFTH].replace(ID, "tangent-ladder-9999")
    assert "count is 12; it must be 13, the number of cases" in refused(
        tmp_path, [*SOUND[:FIFTH], more, *SOUND[FIFTH:]]
    )
    twice = [*SOUND[:FIFTH], SOUND[FIFTH], *SOUND[FIFTH:]]
    assert "count" in refused(tmp_path, twice)


@pytest.mark.parametrize("value", [11, 12.0, "12", True, None])
def test_vector_file_with_a_wrong_count_is_refused(tmp_path, value):
    assert "count is" in refused(tmp_path, with_head("count", lambda _: value))


@pytest.mark.parametrize(
    ("name", "change", "message"),
    [
        ("schema", lambda _: "1.0.1", "this program reads: '1.0.0'"),
        ("schema", lambda _: 1, "this program reads: '1.0.0'"),
        ("content", lambda _: "questions", "must be one of positions, refusals"),
        ("content", lambda _: "refusals", "here it must be"),
        ("family", lambda head: head["name"], "must be an object"),
        ("family", lambda head: head | {"name": "Ladder"}, "lower case"),
        ("family", lambda head: head | {"version": 0}, "whole number"),
        ("family", lambda head: head | {"version": True}, "whole number"),
        ("family", lambda head: head | {"extreme": 0}, "true or false"),
        ("family", lambda head: head | {"author": "me"}, 'has the key "author"'),
        ("flags", list, "must be an object"),
        ("flags", lambda flags: flags | {"fast": {"meaning": "x", "bug_type": "y"}}, 'has the key "fast"'),
        ("flags", lambda flags: flags | {"ring": {"meaning": "x"}}, "flags.ring has no bug_type"),
        ("flags", lambda flags: flags | {"ring": {"meaning": "", "bug_type": "y"}}, "must be a text"),
        ("flags", lambda flags: {}, "is not among those"),
    ],
)
def test_vector_file_with_wrong_metadata_is_refused(tmp_path, name, change, message):
    assert message in refused(tmp_path, with_head(name, change), partial(read_cases, content=content_with()))


@pytest.mark.parametrize("field", HEAD_FIELDS)
def test_vector_file_whose_family_lacks_a_field_is_refused(tmp_path, field):
    def without(head):
        return {name: value for name, value in head.items() if name != field}

    assert f"family has no {field}" in refused(tmp_path, with_head("family", without))


@pytest.mark.parametrize("name", [*MEMBERS, "cases"])
def test_vector_file_with_a_missing_or_unknown_member_is_refused(tmp_path, name):
    document = json.loads("\n".join(SOUND))
    value = document.pop(name)
    assert name in refused(tmp_path, json.dumps(document))
    assert f'has the key "{name}s"' in refused(tmp_path, json.dumps(document | {name: value, name + "s": 1}))


@pytest.mark.parametrize("share", [0, 0.0001, 0.01, 0.3, 0.9, 0.9999])
def test_vector_file_that_was_cut_off_is_refused(tmp_path, share):
    text = "\n".join(SOUND)
    found = refused(tmp_path, text[: int(share * len(text))])
    assert "not a JSON document of cases" in found


@pytest.mark.parametrize(
    "content",
    [
        b"\x00\x01\x02",
        b"\xff\xfe{\x00",
        b"\x93NUMPY",
        b"[]",
        b"{}",
        b"null",
        b'"cases"',
        b'{"cases": {}}',
        b'{"cases": [1 2]}',
        b"{1: 2}",
        b"{'cases': []}",
        b'{"cases": []} x',
        b"alpha,gamma\n1,2\n",
        b'{"schema": ' + b"[" * 100_000,
        "\n".join(SOUND).replace("{", "[", 1).encode(),
        "\n".join([*SOUND, "{}"]).encode(),
        "\n".join([*SOUND, "]"]).encode(),
    ],
)
def test_reading_a_file_that_is_no_vector_file_raises_an_error(tmp_path, content):
    refused(tmp_path, content)


def test_vector_file_with_a_binary_byte_is_refused_naming_its_line(tmp_path):
    text = "\n".join(SOUND).encode()
    place = text.index(ID.encode()) + 2
    assert f", line {FIFTH + 1}: byte 0xff" in refused(tmp_path, text[:place] + b"\xff" + text[place + 1 :])
    assert f", line {FIFTH + 1}: a NUL byte" in refused(tmp_path, text[:place] + b"\0" + text[place + 1 :])


def test_vector_file_that_cannot_be_opened_raises_an_error(tmp_path):
    for path in (tmp_path, tmp_path / "nowhere.json"):
        with pytest.raises(InputError, match=re.escape(str(path))):
            read_cases(str(path))


def test_every_kind_and_every_flag_occurs_in_the_frozen_files():
    cases = [case for name in frozen.NAMES for case in frozen.load(name).cases]
    assert {case.kind for case in cases} == set(Kind)
    assert {flag for case in cases for flag in case.flags} == set(flag_facts("upright"))


@pytest.mark.parametrize(
    ("name", "near"), [("rnig", "ring"), ("worst-cancelation", "worst-cancellation"), ("zzz", "there are")]
)
def test_unknown_name_of_a_frozen_file_is_refused_with_a_suggestion(name, near):
    with pytest.raises(InputError, match=near):
        frozen.load(name)
