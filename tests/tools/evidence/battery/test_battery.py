"""The header answers the battery's questions right in every rounding mode, and no stage decides less than it did."""

from __future__ import annotations

import shutil

import pytest

from tests.tools.evidence.battery import asked, built
from tests.tools.evidence.battery.questions import write

pytestmark = pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler")

DECIDED = (
    "single: 1512, certified: 4185, fixed point: 1281, tangencies: 74, roots in 128 bits: 28, roots in 256 bits: 54, "
    "in the plane: 180, one line: 79108, two lines: 79612, tilted: 1456, one plane: 13700, two planes: 14088, "
    "ways: 1842, times: 572, clearances: 2686, touches: 2588, distances: 2218, gaps: 1458, "
    "rows beside ends: 668, ways beside ends: 184, times beside ends: 41, near times: 602"
)
"""Rows that each stage of the plain level decides, of the frozen questions under their rounding modes."""


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    return built(tmp_path_factory.mktemp("battery"), None, "-O1")


@pytest.mark.slow
def test_battery_answers_frozen_questions_rightly_and_each_stage_decides_the_kept_number(program, tmp_path):
    """More is better: put the new numbers here. Fewer means that a bound or a guard has become weaker."""
    found = asked(program, write(tmp_path / "questions", 6, ()))
    assert (found.what, found.says) == ("right", DECIDED)


@pytest.mark.thorough
def test_battery_answers_generated_questions_rightly(program, tmp_path):
    assert asked(program, write(tmp_path / "questions")).what == "right"
