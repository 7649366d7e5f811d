"""summary.json: what a program wants to know of a run. The schema is schemas/summary-1.2.0.json beside this file."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from hypcheck.record import Line, Record, plain
from hypcheck.record.fields import as_json
from hypcheck.record.lines import Description, Drift, Equation, Finding, Group, Proof, WrongAnswer
from hypcheck.record.lines import Implementation as Tested
from hypcheck.report.digest import (
    Implementation,
    OracleTotal,
    TimingTotal,
    implementations,
    oracle_totals,
    timing_totals,
    under_test,
    unlisted,
    worst_case,
    worst_error_u,
)
from hypcheck.report.failure import Failure
from hypcheck.report.measured import Measured, measured
from hypcheck.report.verdict import failures, verdict

if TYPE_CHECKING:
    from hypcheck.report.write import Around

SCHEMA = "1.2.0"

Fields = dict[str, Any]


def render(record: Record, _around: Around | None = None) -> bytes:
    """The summary as JSON in UTF-8; a lone surrogate, which UTF-8 has not, becomes a question mark."""
    text = json.dumps(plain(summary(record)), ensure_ascii=False, allow_nan=False, indent=2)
    return (text + "\n").encode("utf-8", "replace")


def summary(record: Record) -> Fields:
    """The summary; its keys and their order are the same for every run."""
    ended = verdict(record)
    wholes = {each.name: each.line for each in under_test(record) if isinstance(each.line, Tested)}
    footer = record.footer
    return {
        "hypcheck": record.header.hypcheck,
        "schema": SCHEMA,
        "exit_code": footer and footer.exit_code,
        "passed": ended.passed,
        "truncated": record.footer is None,
        "verdict": ended.sentence,
        "started": record.header.started,
        "seconds": footer and footer.seconds,
        "settings": as_json(record.header.settings) if record.header.settings else None,
        "oracles": {total.name: _oracle(total) for total in oracle_totals(record)},
        "equations": _equations(record.of(Equation)),
        "proofs": _proofs(record.of(Proof)),
        "findings": _findings(record),
        "implementations": [_implementation(each, wholes.get(each.name)) for each in implementations(record)],
        "timings": [_timing(total) for total in timing_totals(record)],
        "methods": [_method(each) for each in measured(record)],
        "failures": [_failure(each) for each in failures(record)],
    }


def _oracle(total: OracleTotal) -> Fields:
    fields = {
        "asked": total.asked,
        "agreed": total.agreed,
        "undecided": total.undecided,
        "disagreements": total.disagreements,
        "seconds": round(total.seconds, 3),
        "stages": total.stages,
    }
    return fields if total.unavailable is None else {**fields, "unavailable": total.unavailable}


def _equations(lines: Iterable[Equation]) -> Fields:
    verdicts: dict[str, list[str]] = {"holds": [], "misprint": [], "false": []}
    for line in lines:
        verdicts.setdefault(line.verdict, []).append(line.number)
    return verdicts


def _proofs(lines: list[Proof]) -> Fields:
    holding = sum(line.holds for line in lines)
    return {"asked": len(lines), "hold": holding, "fail": len(lines) - holding}


def _findings(record: Record) -> Fields:
    """Errors of formulas in exact arithmetic, counted by formula, family, side of the regimes and cause; and drift."""
    lines = record.of(Finding)
    return {
        "inside_stated_regimes": sum(line.inside for line in lines),
        "outside_stated_regimes": sum(not line.inside for line in lines),
        "unlisted": sum(map(unlisted, lines)),
        "drift": [line.sentence for line in record.of(Drift)],
    }


def _implementation(each: Implementation, whole: Tested | None) -> Fields:
    return {
        "name": each.name,
        "spec": each.spec,
        "precision": each.precision,
        "question": each.question,
        "exact": each.exact,
        **_counts(each.asked, each.statuses, each.mistakes, each.worst),
        "families": {group.family: _family(group) for group in each.groups},
        "statuses": each.statuses,
        **({} if whole is None else _whole(whole)),
    }


def _whole(line: Tested) -> Fields:
    """What is known of an implementation under test beside its families."""
    return {
        "declared": _claims(line.declared),
        "judged_as": _claims(line.used),
        "restarts": line.restarts,
        "asked_again": as_json(line.again),
    }


def _claims(description: Description) -> Fields:
    return {name: as_json(description)[name] for name in ("question", "precision", "domain")}


def _family(group: Group) -> Fields:
    return _counts(group.asked, group.counts, group.mistakes, worst_case(group.worst))


def _counts(asked: int, statuses: dict[str, int], mistakes: dict[str, int], worst: WrongAnswer | None) -> Fields:
    return {
        "asked": asked,
        **{status: statuses.get(status, 0) for status in ("right", "tolerated", "wrong", "excused")},
        "mistakes": {name: mistakes.get(name, 0) for name in ("false-clear", "false-contact", "wrong-side")},
        "worst_backward_error_u": worst_error_u(worst),
        "worst_case": None if worst is None else worst.case,
    }


def _timing(total: TimingTotal) -> Fields:
    return {
        "name": total.name,
        "workload": total.workload,
        "rows": total.rows,
        "median_ns": total.median_ns,
        "ratio": total.ratio,
    }


def _method(each: Measured) -> Fields:
    line = each.line
    counts = ("asked", "wrong", "false_clear", "false_contact", "wrong_side", "abstained", "reliable_above")
    times = ("workload", "mode", "rows", "median_ns", "ratio", "ratio_ci95")
    return {
        "name": each.name,
        **_fields(line, ("tier", "kind", "precision", "question", "exact")),
        "asked": each.asked,
        "wrong": each.wrong,
        "reliable_above": each.reliable_above,
        "workloads": {
            name: {field: getattr(found, field) for field in counts} for name, found in each.accuracy.items()
        },
        "times": [_fields(found, times) for found in each.speed.values()],
    }


def _fields(line: Line, names: Iterable[str]) -> Fields:
    return {name: getattr(line, name) for name in names}


def _failure(failure: Failure) -> Fields:
    return {
        "subject": failure.subject,
        "name": failure.name,
        "group": failure.group,
        "kind": failure.kind,
        "message": failure.message,
        "case": failure.case,
        "count": failure.count,
    }
