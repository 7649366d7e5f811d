"""Outputs for code hosts: failures at lines of code, in SARIF and in GitLab's format, a badge, GitHub's outputs.

A step of GitHub Actions has annotations on standard output, and a summary. Workflow commands are lines that begin with
"::", also after blanks; the older form is "##[" anywhere in a line. Foreign text is printed between a pair of commands
that suspends both forms.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import secrets
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import quote

from hypcheck.errors import InputError, system_reason
from hypcheck.implementations.spec import Spec, is_file, parse_spec
from hypcheck.messages import counted, escaped, sentence
from hypcheck.record import Record
from hypcheck.record.reader import FILE
from hypcheck.report import markdown
from hypcheck.report.benchmark_facts import INCONCLUSIVE
from hypcheck.report.facts import CauseFacts, Failure, cause_facts
from hypcheck.report.model import implementations, under_test
from hypcheck.report.verdict import EXIT_INCONCLUSIVE, EXITS_UNFINISHED, ended_badly, failures, verdict
from hypcheck.runs.fingerprint import sha256


@dataclass(frozen=True, slots=True)
class CodePlace:
    """A file, relative to the working directory if it is inside, and a line number from 1; None if not known."""

    file: str
    line: int | None = None


@dataclass(frozen=True, slots=True)
class PlacedFailure:
    """A failure, its place, and a fingerprint that a later run of the same code repeats and no other failure has."""

    failure: Failure
    place: CodePlace
    fingerprint: str

    @property
    def rule(self) -> str:
        """The id of the broken rule, for programs: implementation/wrong."""
        return sentence(f"{self.failure.subject}/{self.failure.kind}")

    @property
    def message(self) -> str:
        """The failure's message, and the command that shows it."""
        replay = f"; replay: {self.failure.replay}" if self.failure.replay else ""
        return sentence(f"{self.failure.message}{replay}")

    @property
    def certain(self) -> bool:
        """Whether it is certainly a failure; False if noise prevents a decision."""
        return self.failure.kind != INCONCLUSIVE


UNKNOWN = CodePlace(FILE)
"""The place of a failure if its file is not known: the record, since readers require a place."""


def placed_failures(record: Record) -> list[PlacedFailure]:
    """Return every failure of a run, the worst first; if the run ended badly, that is the first failure."""
    failed = failures(record)
    ended = ended_badly(record, failed)
    known = dict(_places(record))
    placed, seen = [], dict[str, int]()
    for failure in [*([ended] if ended else []), *failed]:
        name = "\0".join((failure.subject, failure.name, failure.group, failure.kind))
        seen[name] = seen.get(name, 0) + 1
        digest = hashlib.sha256(f"{name}\0{seen[name]}".encode("utf-8", "replace")).hexdigest()
        place = known.get(failure.name, UNKNOWN) if failure.subject == "implementation" else UNKNOWN
        placed.append(PlacedFailure(failure, place, digest))
    return placed


def _places(record: Record) -> Iterator[tuple[str, CodePlace]]:
    """Yield the implementations under test whose place in the code is known: the name in reports, and the place."""
    hashes = record.header.files or {}
    for tested in under_test(record):
        try:
            spec = parse_spec(tested.line.spec)
        except InputError:  # a record may hold any text
            continue
        file = _file(spec, hashes)
        if file is not None:
            yield tested.name, CodePlace(_relative(file), _line(spec, file, hashes.get(file)))


def _file(spec: Spec, hashes: Mapping[str, str]) -> str | None:
    """Return an implementation's file, None if it is not known.

    Of a command it is the first argument that names a file of the record, else the program's own path.
    """
    first, *arguments = spec.words
    match spec.kind:
        case "library":
            return str(Path(first))
        case "python" if is_file(first):
            return str(Path(first))
        case "python":
            module = first.replace(".", "/")
            ends = (f"/{module}.py", f"/{module}/__init__.py")
            return next((path for path in hashes if Path(path).as_posix().endswith(ends)), None)
        case "command":
            files = [str(Path(word)) for word in arguments] + ([str(Path(first))] if os.sep in first else [])
            return next((path for path in files if path in hashes), None)
        case _:
            return None


def _relative(file: str) -> str:
    """Return the path with forward slashes, relative to the working directory if it is inside."""
    here = Path.cwd()
    path = Path(file)
    return (path.relative_to(here) if path.is_relative_to(here) else path).as_posix()


def _line(spec: Spec, file: str, recorded: str | None) -> int | None:
    """Find the line of a Python function in its file; None if the file has changed, or does not define it by name."""
    if spec.kind != "python" or recorded is None or sha256(Path(file)) != recorded:
        return None
    name = re.escape(spec.words[1])
    text = Path(file).read_text(encoding="utf-8", errors="replace")
    definition = re.search(
        rf"^[ \t]*(?:async[ \t]+def|def|class)[ \t]+{name}\b|^{name}[ \t]*(?::[^=\n]*)?=", text, re.MULTILINE
    )
    return None if definition is None else text.count("\n", 0, definition.start()) + 1


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
    """Render results.sarif, in SARIF 2.1.0, as JSON in UTF-8: a result for each failure, none if the run passed.

    A note for each cause of wrong answers follows; its rule has the id that `hypcheck explain` takes.
    """
    failures = placed_failures(record)
    causes = cause_facts(record) if failures else []
    known = dict.fromkeys(failure.rule for failure in failures)
    rules = [_rule(rule) for rule in known]
    rules += {sentence(facts.name): _cause_rule(facts) for facts in causes}.values()
    number = {rule["id"]: place for place, rule in enumerate(rules)}
    places, names = dict(_places(record)), {tested.line.spec: tested.name for tested in under_test(record)}
    ended, footer = verdict(record), record.footer
    invocation = {
        "executionSuccessful": footer is not None and not any(failure.failure.subject == "run" for failure in failures),
        **({} if footer is None else {"exitCode": footer.exit_code}),
        "exitCodeDescription": sentence(ended.sentence),
    }
    run = {
        "tool": {
            "driver": {
                "name": "hypcheck",
                "version": sentence(record.header.hypcheck),
                "rules": rules,
            }
        },
        "invocations": [invocation],
        "columnKind": "unicodeCodePoints",
        "results": [
            *(_result(failure, number[failure.rule]) for failure in failures),
            *(
                _cause_result(facts, number[sentence(facts.name)], places.get(names.get(facts.line.spec, ""), UNKNOWN))
                for facts in causes
            ),
        ],
    }
    log = {"$schema": SCHEMA, "version": VERSION, "runs": [run]}
    return (json.dumps(log, ensure_ascii=False, indent=2) + "\n").encode("utf-8", "replace")


def _rule(rule: str) -> dict[str, Any]:
    """Make the SARIF rule of a failure; its id is the subject and the kind."""
    subject, _, kind = rule.partition("/")
    return {"id": rule, "shortDescription": {"text": f"{_SUBJECTS[subject]}: {kind}."}}


def _result(placed: PlacedFailure, rule: int) -> dict[str, Any]:
    """Make the SARIF result of a failure; `rule` is the number of its rule in the list of rules."""
    return {
        "ruleId": placed.rule,
        "ruleIndex": rule,
        "level": "error" if placed.certain else "warning",
        "message": {"text": placed.message},
        "locations": [{"physicalLocation": _location(placed.place)}],
        "partialFingerprints": {"hypcheck/v1": placed.fingerprint},
    }


def _cause_rule(facts: CauseFacts) -> dict[str, Any]:
    """Make the SARIF rule of a cause, with its remedy as help."""
    about = f"; {facts.command}" if facts.command else ""
    return {
        "id": sentence(facts.name),
        "shortDescription": {"text": sentence(facts.line.sentence)},
        "help": {"text": sentence(f"{facts.line.remedy}{about}")},
    }


def _cause_result(facts: CauseFacts, rule: int, place: CodePlace) -> dict[str, Any]:
    """Make a note about a cause; the failures that it explains are separate results."""
    digest = hashlib.sha256(f"cause\0{facts.line.spec}\0{facts.name}".encode("utf-8", "replace")).hexdigest()
    return {
        "ruleId": sentence(facts.name),
        "ruleIndex": rule,
        "level": "note",
        "message": {"text": sentence("; ".join([facts.headline(), *facts.sentences()]))},
        "locations": [{"physicalLocation": _location(place)}],
        "partialFingerprints": {"hypcheck/v1": digest},
    }


def _location(place: CodePlace) -> dict[str, Any]:
    """Make the SARIF location of a place; a place without a line is at the file's first line."""
    uri = quote(place.file.encode("utf-8", "replace"))
    absolute = {"uri": f"file://{uri}"} if uri.startswith("/") else {"uri": uri, "uriBaseId": "%SRCROOT%"}
    return {"artifactLocation": absolute, "region": {"startLine": place.line or 1}}


def render_gitlab(record: Record) -> bytes:
    """Render gl-code-quality-report.json as JSON in UTF-8: an issue for each failure, an empty list if the run passed.

    The format is GitLab's subset of the Code Climate report: a list of issues, each with a description, the name of its
    check, a fingerprint, a severity and a place.
    """
    issues = [
        {
            "description": placed.message,
            "check_name": f"hypcheck/{placed.rule}",
            "fingerprint": placed.fingerprint,
            "severity": "critical" if placed.certain else "minor",
            "location": {"path": sentence(placed.place.file), "lines": {"begin": placed.place.line or 1}},
        }
        for placed in placed_failures(record)
    ]
    return (json.dumps(issues, ensure_ascii=False, indent=2) + "\n").encode("utf-8", "replace")


def render_badge(record: Record) -> bytes:
    """Render badge.json: the result of the run, in the schema of shields.io's endpoint badge, version 1."""
    message, color = _badge_text(record)
    badge = {"schemaVersion": 1, "label": "hypcheck", "message": message, "color": color}
    return (json.dumps(badge, ensure_ascii=False) + "\n").encode("utf-8")


def _badge_text(record: Record) -> tuple[str, str]:
    """Return the text of the badge's right half, and its colour."""
    if record.footer is None or record.footer.exit_code in EXITS_UNFINISHED:
        return "unfinished", "lightgrey"
    if verdict(record).passed:
        cases = sum(total.asked for total in implementations(record) if total.gated)
        return (f"held on {counted(cases, 'case')}" if cases else "held"), "brightgreen"
    if record.footer.exit_code == EXIT_INCONCLUSIVE:
        return "inconclusive", "yellow"
    number = sum(failure.count for failure in failures(record))
    return (counted(number, "failure") if number else "failed"), "red"


MOST_ANNOTATIONS = 10
"""Errors of one step that GitHub shows; the last one counts those that are left out."""

LARGEST_SUMMARY = (1 << 20) - 1
"""Bytes of a step's summary, at most: GitHub drops a larger one."""

_CUT = b"\n*Cut here: a step summary is less than 1 MiB. report.md has the rest.*\n"

_DATA = {"%": "%25", "\r": "%0D", "\n": "%0A"}
_PROPERTY = {**_DATA, ":": "%3A", ",": "%2C"}


def on_github(environment: Mapping[str, str]) -> bool:
    """Decide by these environment variables whether this is a step of GitHub Actions."""
    return environment.get("GITHUB_ACTIONS") == "true"


def harmless(lines: Iterable[str]) -> Iterator[str]:
    """Yield the lines between two commands, which suspend and resume the processing of commands."""
    token = secrets.token_hex(16)
    yield f"::stop-commands::{token}"
    yield from lines
    yield f"::{token}::"


def error_lines(record: Record) -> list[str]:
    """Return GitHub's annotations: a line for each failure of the run, MOST_ANNOTATIONS at most."""
    failed = failures(record)
    shown = failed if len(failed) <= MOST_ANNOTATIONS else failed[: MOST_ANNOTATIONS - 1]
    rest = len(failed) - len(shown)
    lines = [_annotation(f"hypcheck: {failure.name}, {failure.group}", _message(failure)) for failure in shown]
    if rest:
        lines.append(
            _annotation("hypcheck", [f"and {counted(rest, 'more failure')}; report.md and junit.xml list them"])
        )
    return lines


def _message(failure: Failure) -> list[str]:
    """Return the lines of an annotation: the failure's message, and the command that shows it if there is one."""
    return [failure.message, *([f"replay: {failure.replay}"] if failure.replay else [])]


def _annotation(title: str, lines: Iterable[str]) -> str:
    """Make the workflow command that shows an error with this title and these lines of text."""
    message = "\n".join(map(escaped, lines))
    return f"::error title={_escaped(escaped(title), _PROPERTY)}::{_escaped(message, _DATA)}"


def _escaped(text: str, escapes: Mapping[str, str]) -> str:
    """Replace the characters that have an escape in `escapes`."""
    return "".join(escapes.get(character, character) for character in text)


def append_summary(record: Record, path: Path) -> str | None:
    """Append the report to a step's summary.

    Returns None, or the reason why this failed; that does not fail the run.
    """
    try:
        already = path.stat().st_size if path.exists() else 0
        with path.open("ab") as file:
            file.write(fitting(markdown.render(record), LARGEST_SUMMARY - already))
    except OSError as error:
        return f"no step summary: {path}: {system_reason(error)}"
    return None


def fitting(report: bytes, room: int) -> bytes:
    """Return the report; if it has more than `room` bytes, it is cut at the end of a line, with a note.

    Returns b"" if not even one line and the note fit.
    """
    if len(report) <= room:
        return report
    end = report.rfind(b"\n", 0, max(0, room - len(_CUT))) + 1
    return report[:end] + _CUT if end else b""
