"""A run whose disk fails ends as it must; `make evidence` lets every call fail, this one call in each way."""

from __future__ import annotations

import pytest

from tests.tools.evidence import faults, faulty_runs
from tests.tools.evidence.faulty_runs import Case, Performed
from tests.tools.evidence.parts import Unavailable


def test_run_whose_record_cannot_be_renewed_ends_with_the_expected_error_and_can_be_repeated():
    try:
        found = faults.measure(23)
    except Unavailable as missing:
        pytest.skip(str(missing))
    assert found["calls"]["write"] > 9
    assert found["cases"] >= 4
    assert found["findings"] == []


@pytest.mark.parametrize(
    ("code", "said", "why"),
    [
        (70, "hypcheck: internal error: no space left on device", "it ended with 70"),
        (2, "Traceback\nhypcheck: error: cannot write run: no space left on device", "it ended with 2"),
        (2, "hypcheck: error: cannot write run", "its sentence gives no reason"),
        (2, "hypcheck: error: cannot write: no space left on device", "its sentence names no place"),
        (2, "hypcheck: error: cannot write {out}: no space left on device", ""),
    ],
)
def test_unexpected_ending_of_a_faulty_run_is_reported_with_the_reason(tmp_path, code, said, why):
    out = tmp_path / "out"
    done = Performed(code, said.format(out=out), "")
    found = faulty_runs.wrong_ending(Case("full", 1, after=False), done, out, [])
    assert found.startswith(why)
    assert bool(found) is bool(why)
