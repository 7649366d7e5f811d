"""results.sarif: the failures of a run in SARIF 2.1.0, which code scanners read and show beside the code."""

from __future__ import annotations

import json
from typing import Any
from urllib.parse import quote

from hypcheck.messages import sentence
from hypcheck.record import Record
from hypcheck.report.places import Place, PlacedFailure, placed_failures
from hypcheck.report.verdict import verdict

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


def render(record: Record) -> bytes:
    """The log of the run as JSON in UTF-8: one result for each failure; none if the run passed."""
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
