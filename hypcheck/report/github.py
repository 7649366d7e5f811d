"""Output for GitHub Actions: annotations on standard output, and the summary of the job's step.

Workflow commands are lines that begin with "::", after blanks too; "##[" anywhere in a line is the older form. Foreign
text is printed between a pair of commands that suspends both forms.
"""

from __future__ import annotations

import secrets
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from hypcheck.errors import system_reason
from hypcheck.messages import counted, escaped
from hypcheck.record import Record
from hypcheck.report.markdown import render
from hypcheck.report.verdict import Failure, failures

MOST_ANNOTATIONS = 10
"""Errors of one step that GitHub shows; the last one counts those that are left out."""

LARGEST_SUMMARY = (1 << 20) - 1
"""Bytes of a step's summary, at most: GitHub drops a larger one."""

_CUT = b"\n*Cut here: a step summary is less than 1 MiB. report.md has the rest.*\n"

_DATA = {"%": "%25", "\r": "%0D", "\n": "%0A"}
_PROPERTY = {**_DATA, ":": "%3A", ",": "%2C"}


def on_github(environment: Mapping[str, str]) -> bool:
    """Whether these environment variables are those of a step of GitHub Actions."""
    return environment.get("GITHUB_ACTIONS") == "true"


def harmless(lines: Iterable[str]) -> Iterator[str]:
    """The lines, between commands that suspend and resume the processing of commands."""
    token = secrets.token_hex(16)
    yield f"::stop-commands::{token}"
    yield from lines
    yield f"::{token}::"


def error_lines(record: Record) -> list[str]:
    """A line for each failure of the run, MOST_ANNOTATIONS at most."""
    found = failures(record)
    shown = found if len(found) <= MOST_ANNOTATIONS else found[: MOST_ANNOTATIONS - 1]
    rest = len(found) - len(shown)
    lines = [_annotation(f"hypcheck: {each.name}, {each.group}", _message(each)) for each in shown]
    if rest:
        lines.append(
            _annotation("hypcheck", [f"and {counted(rest, 'more failure')}; report.md and junit.xml list them"])
        )
    return lines


def _message(failure: Failure) -> list[str]:
    return [failure.message, *([f"replay: {failure.replay}"] if failure.replay else [])]


def _annotation(title: str, lines: Iterable[str]) -> str:
    message = "\n".join(map(escaped, lines))
    return f"::error title={_escaped(escaped(title), _PROPERTY)}::{_escaped(message, _DATA)}"


def _escaped(text: str, escapes: Mapping[str, str]) -> str:
    return "".join(escapes.get(character, character) for character in text)


def append_summary(record: Record, path: Path) -> str | None:
    """Append the report to a step's summary; returns the reason if that fails, which does not fail the run."""
    try:
        already = path.stat().st_size if path.exists() else 0
        with path.open("ab") as file:
            file.write(fitting(render(record), LARGEST_SUMMARY - already))
    except OSError as error:
        return f"no step summary: {path}: {system_reason(error)}"
    return None


def fitting(report: bytes, room: int) -> bytes:
    """The report; if it has more than `room` bytes, it is cut at the end of a line, with a note."""
    if len(report) <= room:
        return report
    end = report.rfind(b"\n", 0, max(0, room - len(_CUT))) + 1
    return report[:end] + _CUT if end else b""
