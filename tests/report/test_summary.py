"""summary.json holds the record's counts, under the same keys in the same order for every run.

The goldens of recorded runs show it whole.
"""

from __future__ import annotations

import json

import pytest
from hypothesis import given

from hypcheck.report.summary import render
from tests.report import record_samples


def summary(record):
    return json.loads(render(record))


def test_an_interrupted_run_has_no_exit_code_and_has_not_passed():
    found = summary(record_samples.record(exit_code=None))
    assert (found["exit_code"], found["seconds"]) == (None, None)
    assert (found["truncated"], found["passed"]) == (True, False)


def test_order_of_keys_in_the_summary_does_not_depend_on_the_run():
    one, other = summary(record_samples.record()), summary(record_samples.record([], 6))
    assert list(one) == list(other)
    assert list(one["findings"]) == list(other["findings"])


@pytest.mark.slow
@given(record_samples.FOREIGN)
def test_a_summary_with_any_foreign_name_is_json_in_utf_8(name):
    changed = record_samples.rewritten(record_samples.lines(), "table-2-float32", name)
    found = json.loads(render(record_samples.record(changed)).decode("utf-8"))
    assert name.encode("utf-8", "replace").decode("utf-8") in [each["name"] for each in found["implementations"]]
