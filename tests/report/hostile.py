"""Records in which every name and sentence is text that an attacker or a broken program could write."""

from __future__ import annotations

import json

from tests.report import bench_lines, record_samples
from tests.report.test_worst_way import THROUGH, case, ways_group

SCRIPT = "</script><script>alert(1)</script><img src=x onerror=alert(1)>"
MARKS = "\"'><b>&amp;{{7*7}}{% raw %}\u202e\u200f\x00\x1b[31m\r\n\u2028\ud800"
ENDLESS = "e" * 10**6

FIELDS = (
    "method",
    "title",
    "family",
    "case",
    "statement",
    "finding",
    "correction",
    "reason",
    "claim",
    "says",
    "note",
    "name",
)


def spoilt(line, number):
    """The line with hostile names and sentences; fields that must be one of a few words stay."""
    copy = json.loads(json.dumps(line))
    _spoil(copy, number)
    return copy


def _spoil(value, number):
    for field, inner in list(value.items()) if isinstance(value, dict) else list(enumerate(value)):
        if isinstance(inner, (dict, list)):
            _spoil(inner, number)
        elif isinstance(inner, str) and field in FIELDS:
            value[field] = f"{inner}{SCRIPT}{MARKS}"


def hostile_record(methods=4, workloads=None):
    """A verification, a run about ways and a benchmark at once, with one name of a megabyte."""
    measured = bench_lines.lines()
    kept = {
        "method": [None, *[line["method"] for line in measured if line["type"] == "method"][:methods]],
        "workload": [None, *[line["workload"] for line in measured if line["type"] == "workload"][:workloads]],
    }
    few = [
        line
        for line in measured
        if line["type"] == "places" or all(line.get(field) in names for field, names in kept.items())
    ]
    about_ways = ways_group(case("way-long/1/1/3", *THROUGH, 2.0))
    lines = [spoilt(line, number) for number, line in enumerate([*record_samples.lines(), about_ways, *few])]
    lines.append({**record_samples.group(ENDLESS, "float64", "ring", {"wrong": 3}), "title": ENDLESS})
    return record_samples.record(lines, exit_code=1)
