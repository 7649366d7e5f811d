"""The gate asks implementations that take an end and heights about ways beside hyperboloids that end."""

from __future__ import annotations

import json

import pytest

from hypcheck.cli.main import main
from hypcheck.vectors import frozen
from tests.support.inside import TARGET
from tests.tools.miniatures import compiled_text

FEW = "ended-way-disc,ended-way-opening,ended-way-uniform"
BY_HYPCHECK = ("--isolate", "off")

HEADER = """
#define HYPCHECK_IMPLEMENTATION
#define HYPCHECK_SELF "PATH"
#include HYPCHECK_SELF
const char *hypcheck_describe(void) {
    return "{\\"protocol\\":1,\\"name\\":\\"header\\",\\"question\\":\\"passage\\","
           "\\"takes\\":[\\"end\\",\\"axis\\",\\"heights\\"]}";
}
"""

FUNCTIONS = """
import math
import numpy as np
from hypcheck import passage

hypcheck = {"question": "passage", "takes": ["heights", "axis"]}

def _hits(rows, *, low=None, high=None, solid=None, ends=(4, 7)):
    answers = []
    for row in rows.tolist():
        begin, end = (row[k : k + 3] for k in ends)
        found = passage(row[:4], begin, end, row[10:13],
            z_min=row[13] if low is None else low, z_max=row[14] if high is None else high,
            solid=bool(row[15] if solid is None else solid))
        answers.append(found.hit)
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
    # The side differs at both ends of the way, and so there must be contact.
    answers = []
    for row in rows.tolist():
        found = passage(row[:4], row[4:7], row[7:10], row[10:13], z_min=row[13], z_max=row[14], solid=bool(row[15]))
        answers.append(found.hit or found.start != found.end)
    return np.array(answers, dtype=np.int8)
"""


def verified(folder, spec, families, *words):
    """The exit code, and how many cases ended how."""
    asked = ("--families", families, "--count", "0")
    code = main(["verify", spec, *asked, *BY_HYPCHECK, *words, "--out", str(folder / "out")])
    (used,) = json.loads((folder / "out" / "summary.json").read_text())["implementations"]
    return code, used["statuses"]


def test_header_answers_all_frozen_ways_beside_ends(tmp_path):
    library = compiled_text(HEADER.replace("PATH", str(TARGET)), tmp_path / "header.so")
    code, statuses = verified(tmp_path, f"library:{library}", "*ended-way*")
    asked = sum(frozen.count_of(name) for name in frozen.ENDED_SWEEP_NAMES)
    assert code == 0
    assert statuses["right"] + statuses.get("skipped", 0) == asked
    assert statuses["right"] > 0.8 * asked


@pytest.mark.parametrize("name", ["right", pytest.param("backwards", marks=pytest.mark.thorough)])
def test_right_functions_about_ways_beside_ends_pass(name, tmp_path):
    (tmp_path / "ways.py").write_text(FUNCTIONS)
    code, statuses = verified(tmp_path, f"python:{tmp_path}/ways.py:{name}", FEW, "--tolerance", "0")
    assert (code, statuses.get("wrong", 0)) == (0, 0)


ALSO_WRONG = ("ends_ignored", "closed_for_open", "both_ends_of_the_way_alone")


@pytest.mark.parametrize(
    "name",
    ["discs_ignored", "leaving_is_contact", *(pytest.param(name, marks=pytest.mark.thorough) for name in ALSO_WRONG)],
)
def test_wrong_functions_about_ways_beside_ends_are_rejected(name, tmp_path):
    (tmp_path / "ways.py").write_text(FUNCTIONS)
    code, statuses = verified(tmp_path, f"python:{tmp_path}/ways.py:{name}", FEW)
    assert code == 1
    assert statuses["wrong"] > 2
