"""The gate asks implementations that take an end and heights about ways beside hyperboloids that end."""

from __future__ import annotations

import json
import math
from functools import cache

import numpy as np
import pytest

from hypcheck import passage
from hypcheck.cli.main import main
from hypcheck.vectors import frozen
from tests.support.inside import TARGET
from tests.tools.miniatures import compiled_text

pytestmark = pytest.mark.usefixtures("text_reports")

FEW = "ended-way-disc,ended-way-opening,ended-way-uniform"

HEADER = """
#define HYPCHECK_IMPLEMENTATION
#define HYPCHECK_SELF "PATH"
#include HYPCHECK_SELF
const char *hypcheck_describe(void) {
    return "{\\"protocol\\":1,\\"name\\":\\"header\\",\\"question\\":\\"passage\\","
           "\\"takes\\":[\\"end\\",\\"axis\\",\\"heights\\"]}";
}
"""


@cache
def _passage(row):
    """What the exact passage says of a row, which runs ask again and again."""
    return passage(row[:4], row[4:7], row[7:10], row[10:13], z_min=row[13], z_max=row[14], solid=bool(row[15]))


def _hits(rows, *, low=None, high=None, solid=None, ends=(4, 7)):
    answers = []
    for row in rows.tolist():
        begin, end = (row[k : k + 3] for k in ends)
        changed = (value if other is None else other for value, other in zip(row[13:], (low, high, solid), strict=True))
        answers.append(_passage((*row[:4], *begin, *end, *row[10:13], *changed)).hit)
    return np.array(answers, dtype=np.int8)


def right(rows):
    return _hits(rows)


def backwards(rows):
    return _hits(rows, ends=(7, 4))


def ends_ignored(rows):
    return _hits(rows, low=-math.inf, high=math.inf)


def discs_ignored(rows):
    return _hits(rows, solid=0)


def closed_for_open(rows):
    return _hits(rows, solid=1)


def both_ends_of_the_way_alone(rows):
    return np.maximum(_hits(rows, ends=(4, 4)), _hits(rows, ends=(7, 7)))


def leaving_is_contact(rows):
    """The side differs at both ends of the way, and so there must be contact."""
    found = [_passage(tuple(row)) for row in rows.tolist()]
    return np.array([each.hit or each.start != each.end for each in found], dtype=np.int8)


def verified(folder, spec, families, *words):
    """The exit code, and how many cases ended how."""
    code = main(["verify", spec, "--families", families, "--count", "0", *words, "--out", str(folder / "out")])
    (used,) = json.loads((folder / "out" / "summary.json").read_text())["implementations"]
    return code, used["statuses"]


def test_header_answers_frozen_sweeps_beside_ends(tmp_path):
    library = compiled_text(HEADER.replace("PATH", str(TARGET)), tmp_path / "header.so", "-O0")
    code, statuses = verified(tmp_path, f"library:{library}", FEW, "--isolate", "off")
    asked = sum(frozen.count_of(name) for name in FEW.split(","))
    assert code == 0
    assert statuses["right"] + statuses.get("skipped", 0) == asked
    assert statuses["right"] > 0.8 * asked


TAKES_ENDS = {"question": "passage", "tilt": True, "heights": True}


@pytest.mark.parametrize("function", [right, pytest.param(backwards, marks=pytest.mark.thorough)])
def test_right_functions_about_sweeps_beside_ends_pass(function, built_in, tmp_path):
    code, statuses = verified(tmp_path, built_in(function, **TAKES_ENDS), FEW, "--tolerance", "0")
    assert (code, statuses.get("wrong", 0)) == (0, 0)


ALSO_WRONG = (ends_ignored, closed_for_open, both_ends_of_the_way_alone)


@pytest.mark.parametrize(
    "function",
    [discs_ignored, leaving_is_contact, *(pytest.param(each, marks=pytest.mark.thorough) for each in ALSO_WRONG)],
)
def test_wrong_functions_about_sweeps_beside_ends_are_rejected(function, built_in, tmp_path):
    code, statuses = verified(tmp_path, built_in(function, **TAKES_ENDS), FEW)
    assert code == 1
    assert statuses["wrong"] > 2
