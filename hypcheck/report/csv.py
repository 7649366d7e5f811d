"""measurements.csv: every measurement of a record, one on each line, for spreadsheets and statistics.

A line is [kind, method, workload, detail, quantity, value, low, high]: the type of the record's line, the method, the
workload or family, a detail that distinguishes it from similar measurements, and the value, with an interval if there
is one.
"""

from __future__ import annotations

import csv
import io

from hypcheck.messages import escaped
from hypcheck.record import Record
from hypcheck.report.benchmark_facts import facts_of

HEAD = ("kind", "method", "workload", "detail", "quantity", "value", "low", "high")


def render(record: Record) -> bytes:
    """Render the measurements as CSV (RFC 4180) in UTF-8, in the order of the record."""
    stream = io.StringIO()
    writer = csv.writer(stream)
    writer.writerow(HEAD)
    for facts in facts_of(record):
        for method, workload, detail, quantity, *figures in facts.measurements():
            value, low, high = figures if len(figures) > 1 else (*figures, None, None)
            names = map(_harmless, (method, workload, detail, quantity))
            writer.writerow([facts.line.type, *names, *map(_number, (value, low, high))])
    return stream.getvalue().encode("utf-8", "replace")


def _harmless(text: str) -> str:
    """Escape foreign text, so that no spreadsheet reads it as a formula."""
    shown = escaped(text)
    return f"'{shown}" if shown[:1] in ("=", "+", "-", "@") else shown


def _number(value: object) -> str:
    """Return a number as text; "" if there is none."""
    return "" if value is None else str(value)
