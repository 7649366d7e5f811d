"""badge.json: how a run ended, as shields.io draws it from an address (its endpoint schema, version 1)."""

from __future__ import annotations

import json

from hypcheck.messages import counted
from hypcheck.record import Record
from hypcheck.report.model import implementations
from hypcheck.report.verdict import EXIT_INCONCLUSIVE, EXITS_UNFINISHED, failures, verdict


def render(record: Record) -> bytes:
    """The badge as JSON in UTF-8."""
    message, color = _shown(record)
    badge = {"schemaVersion": 1, "label": "hypcheck", "message": message, "color": color}
    return (json.dumps(badge, ensure_ascii=False) + "\n").encode("utf-8")


def _shown(record: Record) -> tuple[str, str]:
    """The right half of the badge, and its colour."""
    if record.footer is None or record.footer.exit_code in EXITS_UNFINISHED:
        return "unfinished", "lightgrey"
    if verdict(record).passed:
        asked = sum(each.asked for each in implementations(record) if each.gated)
        return (f"held on {counted(asked, 'case')}" if asked else "held"), "brightgreen"
    if record.footer.exit_code == EXIT_INCONCLUSIVE:
        return "inconclusive", "yellow"
    number = sum(each.count for each in failures(record))
    return (counted(number, "failure") if number else "failed"), "red"
