"""The records that are shown as report.html, and their pages: one takes seconds to draw, so a process draws it once."""

from __future__ import annotations

from functools import cache

from hypcheck.report import html
from tests.report import record_samples
from tests.report.bench_lines import bench_record
from tests.report.hostile import hostile_record


def small_record():
    """Failures, one method and one map: every kind of thing that a check looks at, and little of each."""
    proof = {"type": "proof", "formula": "table-2", "holds": False, "statement": "c2 is not c2"}
    failing = [{**proof, "quantity": f"c{place}"} for place in range(9)]
    kept = [line for line in record_samples.lines() if line.get("method") == "table-2-float32"]
    return record_samples.record([*kept, *failing], exit_code=1)


RECORDS = {"small": small_record, "verify": record_samples.record, "bench": bench_record, "hostile": hostile_record}


@cache
def page_of(name):
    """The bytes of the page of a record."""
    return html.render(RECORDS[name]())
