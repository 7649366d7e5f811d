"""Files of invalid rows are read as strictly as the others, and neither kind is taken for the other."""

from __future__ import annotations

import json
from functools import partial

import pytest

from hypcheck.geometry.pair import REFUSED
from hypcheck.vectors import frozen
from hypcheck.vectors.cases import read_cases
from hypcheck.vectors.format import content_with
from tests.vectors.frozen.test_reading import SOUND, refused

BAD_ROWS = frozen.path_of("invalid").read_text(encoding="utf-8").splitlines()
BAD_FIRST = BAD_ROWS.index('"cases": [') + 1


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda case: case.update(expected="answered"), "it must be refused"),
        (lambda case: case.update(columns=[]), "one or more"),
        (lambda case: case.update(columns=["y", "x"]), "one or more"),
        (lambda case: case.update(columns=["w"]), "one or more"),
        (lambda case: case.update(columns="x"), "must be a list"),
        (lambda case: case["bits"].__setitem__(1, "4000000000000001"), "the bits of gamma"),
        (lambda case: case["bits"].__setitem__(0, "7ff8000000000000"), "the bits of alpha"),
        (lambda case: case["bits"].__setitem__(1, "0x40"), "16 hexadecimal digits"),
        (lambda case: case["row"].__setitem__(0, "infinity"), "must be a number"),
        (lambda case: case["row"].__setitem__(0, "nan"), "the bits of alpha"),
        (lambda case: case.pop("bits") and None, "the case has no bits"),
        (lambda case: case.update(position=0), 'has the key "position"'),
    ],
)
def test_malformed_case_in_a_file_of_invalid_rows_is_refused(tmp_path, change, message):
    lines = list(BAD_ROWS)
    case = json.loads(lines[BAD_FIRST].removesuffix(","))
    assert case["row"][0] == "inf"
    change(case)
    lines[BAD_FIRST] = json.dumps(case) + ","
    found = refused(tmp_path, lines, read_cases)
    assert f", line {BAD_FIRST + 1}, case invalid-0000" in found
    assert message in found


def test_readers_of_answers_and_of_invalid_rows_refuse_each_others_files(tmp_path):
    for lines, wanted in ((BAD_ROWS, content_with()), (SOUND, content_with(refused=True))):
        found = refused(tmp_path, lines, partial(read_cases, content=wanted))
        assert f"here it must be {wanted.name!r}" in found


def test_right_answers_to_invalid_rows_are_refusals():
    assert set(frozen.load("invalid").positions.tolist()) == {REFUSED}
