"""summary.json holds the record's counts, under the same keys in the same order for every run."""

from __future__ import annotations

import json

import pytest
from hypothesis import given

from hypcheck.report.summary import render
from tests.report import record_samples


def summary(record):
    return json.loads(render(record))


def test_summary_json_has_its_documented_keys():
    """The fields that other people's programs read."""
    found = summary(record_samples.record())
    assert (found["schema"], found["exit_code"], found["passed"], found["truncated"]) == ("1.5.0", 0, True, False)
    low = next(each for each in found["implementations"] if each["name"] == "table-2-float32")
    families = low.pop("families")
    assert low == {
        "name": "table-2-float32",
        "spec": "builtin:table-2-float32",
        "precision": "float32",
        "question": "position",
        "exact": False,
        "asked": 39,
        "right": 28,
        "tolerated": 5,
        "wrong": 6,
        "excused": 0,
        "mistakes": {"false-clear": 1, "false-contact": 10, "wrong-side": 0},
        "worst_backward_error_u": "inf",
        "worst_case": "ring/1/1/7",
        "statuses": {"right": 28, "tolerated": 5, "wrong": 6, "skipped": 1},
    }
    assert families["tower-body"] == {
        "asked": 20,
        "right": 19,
        "tolerated": 1,
        "wrong": 0,
        "excused": 0,
        "mistakes": {"false-clear": 0, "false-contact": 1, "wrong-side": 0},
        "worst_backward_error_u": 2.5,
        "worst_case": "tower-body/1/1/5",
    }


def test_counts_of_an_implementation_in_the_summary_are_sums_over_its_families():
    for each in summary(record_samples.record())["implementations"]:
        for field in ("asked", "right", "tolerated", "wrong", "excused"):
            assert each[field] == sum(family[field] for family in each["families"].values())
        assert each["asked"] == sum(number for status, number in each["statuses"].items() if status != "skipped")


def test_the_summary_counts_the_answers_of_each_oracle():
    found = summary(record_samples.record())["oracles"]
    assert list(found) == ["exact", "nearest", "roots", "mesh"]
    for each in found.values():
        assert each["asked"] == each["agreed"] + each["undecided"] + each["disagreements"]
    assert found["roots"]["undecided"] == 2
    assert found["mesh"]["asked"] == 0
    assert found["mesh"]["unavailable"] == "python-fcl cannot be imported"
    assert "unavailable" not in found["exact"]


def test_the_summary_counts_equations_proofs_and_findings():
    found = summary(record_samples.record())
    assert found["equations"] == {"holds": ["1"], "misprint": ["12"], "false": []}
    assert found["proofs"] == {"asked": 2, "hold": 2, "fail": 0}
    assert found["findings"] == {
        "inside_stated_regimes": 2,
        "outside_stated_regimes": 1,
        "unlisted": 0,
        "drift": [],
    }
    unknown = record_samples.finding("hessian", "ring", inside=True, reason=None)
    assert summary(record_samples.record([*record_samples.lines(), unknown], 1))["findings"]["unlisted"] == 1


def test_an_interrupted_run_has_no_exit_code_and_has_not_passed():
    found = summary(record_samples.record(exit_code=None))
    assert (found["exit_code"], found["seconds"]) == (None, None)
    assert found["truncated"]
    assert not found["passed"]


def test_order_of_keys_in_the_summary_does_not_depend_on_the_run():
    def keys(value):
        return [(name, keys(part)) for name, part in value.items()] if isinstance(value, dict) else None

    one, other = summary(record_samples.record()), summary(record_samples.record([], 6))
    assert list(one) == list(other)
    assert keys(one["findings"]) == keys(other["findings"])
    assert (
        render(record_samples.record()).partition(b'"oracles"')[2]
        == render(record_samples.record()).partition(b'"oracles"')[2]
    )


@pytest.mark.slow
@given(record_samples.FOREIGN)
def test_a_summary_with_any_foreign_name_is_json_in_utf_8(name):
    changed = record_samples.rewritten(record_samples.lines(), "table-2-float32", name)
    found = json.loads(render(record_samples.record(changed)).decode("utf-8"))
    assert name.encode("utf-8", "replace").decode("utf-8") in [each["name"] for each in found["implementations"]]
