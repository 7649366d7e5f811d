"""gl-code-quality-report.json: the failures of a run as GitLab shows them beside the code of a merge request.

The format is GitLab's subset of the Code Climate report: a list of issues, each with a description, the name of its
check, a fingerprint, a severity and a place.
"""

from __future__ import annotations

import json

from hypcheck.messages import sentence
from hypcheck.record import Record
from hypcheck.report.places import placed_failures


def render(record: Record) -> bytes:
    """The issues as JSON in UTF-8, one for each failure; an empty list if the run passed."""
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
