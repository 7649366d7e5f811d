"""What code hosts show of a run: failures beside the code, in SARIF and in GitLab's format, and a badge."""

from __future__ import annotations

import json
from typing import Any
from urllib.parse import quote

from hypcheck.messages import counted, sentence
from hypcheck.record import Record
from hypcheck.report.model import implementations
from hypcheck.report.places import Place, PlacedFailure, placed_failures
from hypcheck.report.verdict import EXIT_INCONCLUSIVE, EXITS_UNFINISHED, failures, verdict

VERSION = "2.1.0"

SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"

_SUBJECTS = {
    "run": "The run did not end well",
    "implementation": "The implementation under test failed",
    "oracle": "An oracle disagrees with the exact decision",
    "proof": "A proof does not hold",
    "findings": "Something differs from what is known",
    "measurement": "A measured method failed",
}
"""What each subject of a failure means, as the beginning of a rule's description."""


def render_sarif(record: Record) -> bytes:
    """results.sarif, in SARIF 2.1.0, as JSON in UTF-8: a result for each failure, none if the run passed."""
    found = placed_failures(record)
    rules = list(dict.fromkeys(each.rule for each in found))
    ended, footer = verdict(record), record.footer
    invocation = {
        "executionSuccessful": footer is not None and not any(each.failure.subject == "run" for each in found),
        **({} if footer is None else {"exitCode": footer.exit_code}),
        "exitCodeDescription": sentence(ended.sentence),
    }
    run = {
        "tool": {
            "driver": {
                "name": "hypcheck",
                "version": sentence(record.header.hypcheck),
                "rules": [_rule(rule) for rule in rules],
            }
        },
        "invocations": [invocation],
        "columnKind": "unicodeCodePoints",
        "results": [_result(each, rules.index(each.rule)) for each in found],
    }
    log = {"$schema": SCHEMA, "version": VERSION, "runs": [run]}
    return (json.dumps(log, ensure_ascii=False, indent=2) + "\n").encode("utf-8", "replace")


def _rule(rule: str) -> dict[str, Any]:
    subject, _, kind = rule.partition("/")
    return {"id": rule, "shortDescription": {"text": f"{_SUBJECTS[subject]}: {kind}."}}


def _result(each: PlacedFailure, rule: int) -> dict[str, Any]:
    return {
        "ruleId": each.rule,
        "ruleIndex": rule,
        "level": "error" if each.certain else "warning",
        "message": {"text": each.message},
        "locations": [{"physicalLocation": _location(each.place)}],
        "partialFingerprints": {"hypcheck/v1": each.fingerprint},
    }


def _location(place: Place) -> dict[str, Any]:
    """The place as a URI reference; readers take a file without a line as its first one."""
    uri = quote(place.file.encode("utf-8", "replace"))
    absolute = {"uri": f"file://{uri}"} if uri.startswith("/") else {"uri": uri, "uriBaseId": "%SRCROOT%"}
    return {"artifactLocation": absolute, "region": {"startLine": place.line or 1}}


def render_gitlab(record: Record) -> bytes:
    """gl-code-quality-report.json as JSON in UTF-8: an issue for each failure; an empty list if the run passed.

    The format is GitLab's subset of the Code Climate report: a list of issues, each with a description, the name of its
    check, a fingerprint, a severity and a place.
    """
    issues = [
        {
            "description": each.message,
            "check_name": f"hypcheck/{each.rule}",
            "fingerprint": each.fingerprint,
            "severity": "critical" if each.certain else "minor",
            "location": {"path": sentence(each.place.file), "lines": {"begin": each.place.line or 1}},
        }
        for each in placed_failures(record)
    ]
    return (json.dumps(issues, ensure_ascii=False, indent=2) + "\n").encode("utf-8", "replace")


def render_badge(record: Record) -> bytes:
    """badge.json: how the run ended, as shields.io draws it from an address (its endpoint schema, version 1)."""
    message, color = _badge_text(record)
    badge = {"schemaVersion": 1, "label": "hypcheck", "message": message, "color": color}
    return (json.dumps(badge, ensure_ascii=False) + "\n").encode("utf-8")


def _badge_text(record: Record) -> tuple[str, str]:
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
