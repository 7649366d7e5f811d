"""Gaps of the C header's coverage are named by their function, and each is explained by a proof that is of one."""

from __future__ import annotations

import re

from tests.tools.evidence.c_sites import HEADER
from tests.tools.evidence.coverage import gaps_of
from tests.tools.evidence.gaps import EMITTED, REASONS, reason
from tests.tools.evidence.parts import kept


def test_every_kept_gap_in_coverage_has_a_reason_and_every_reason_a_kept_gap():
    gaps = kept()["coverage"]["gaps"]
    assert [gap for gap in gaps if reason(gap) is None] == []
    for function, text in REASONS:
        assert any(gap.startswith(f"{function}: ") and text in gap for gap in gaps), (function, text)


def test_every_proof_about_emitted_code_is_of_a_kept_gap():
    gaps = [gap.split(": ", 2) for gap in kept()["emitted"]["gaps"]]
    for where, what in EMITTED:
        assert any(re.fullmatch(where, f"{name}: {function}") and what in rest for name, function, rest in gaps), where


def test_branch_taken_only_one_way_is_reported_with_its_function():
    lines = HEADER.read_text(encoding="utf-8").split("\n")
    line = next(number for number, text in enumerate(lines, 1) if "if (delta < 0) return 0;" in text)
    start = lines[line - 1].index("delta") + 1
    found = {
        "filename": str(HEADER),
        "branches": [[line, start, line, start + 9, 1, 0, 0, 0, 4]],
        "mcdc_records": [[line, start, line, start + 9, 0, 0, 5, [True, False]]],
    }
    assert list(gaps_of(found)) == [
        "hc_fixed_position: never false: delta < 0",
        "hc_fixed_position: MC/DC of condition 2: delta < 0",
    ]
