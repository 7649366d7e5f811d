"""Gating one implementation by the command that everyone uses, and what it said."""

from __future__ import annotations

import io
import tempfile
from contextlib import ExitStack, redirect_stderr, redirect_stdout
from dataclasses import dataclass, replace
from functools import lru_cache
from hashlib import sha256
from pathlib import Path
from typing import Any
from unittest.mock import patch

import pytest

from hypcheck.cli.main import main
from hypcheck.errors import Exit
from hypcheck.geometry.pair import Pair
from hypcheck.geometry.rows import Rows
from hypcheck.record import read
from hypcheck.record.lines import GroupLine
from hypcheck.runs import cases, judge, results
from hypcheck.runs.judge import Criterion
from tests.support.inside import Decision, passage_error
from tests.support.without_drawing import draw_nothing
from tests.tools.mutants.collection import Mutant
from tests.tools.mutants.expectation import Options

HARMLESS = frozenset({"right", "tolerated", "skipped", "refused"})
"""How a case may end without anybody minding."""

VERDICTS = {0: "passed", 1: "rejected"}
"""What an exit code says of the implementation; others say that it was not judged at all."""

_ABSTAINED = "abstained from all"
"""So a run says that it asked and got no answer to judge, which is exit code 2 and never a pass."""


@dataclass(frozen=True, slots=True)
class Ruling:
    """What one run said: its exit code, how many cases of each family failed, and how many were judged in all."""

    exit_code: int
    killed_by: dict[str, int]
    judged: int
    said: str = ""

    @property
    def verdict(self) -> str:
        """In a word."""
        if self.exit_code == Exit.USAGE and _ABSTAINED in self.said:
            return "rejected"
        return VERDICTS.get(self.exit_code, f"ended with {self.exit_code}")


@dataclass(frozen=True, slots=True)
class Result:
    """What became of a mutant: with what is asked of it, and without, where that must make the difference."""

    mutant: Mutant
    ruling: Ruling
    without: Ruling | None = None

    @property
    def as_expected(self) -> bool:
        """Whether the gate said what it must."""
        expected = "passed" if self.mutant.expectation.right else "rejected"
        return self.ruling.verdict == expected and (self.without is None or self.without.verdict == "passed")


def gate(mutant: Mutant, options: Options = ()) -> Result:
    """Gate a mutant with its claim, and with what is to be asked of it; `options` come on top."""
    expectation, options = mutant.expectation, (*mutant.isolation, *options)
    ruling = run(mutant.spec, (*expectation.claim, *expectation.asked, *options))
    if expectation.right or expectation.luck or not expectation.asked:
        return Result(mutant, ruling)
    return Result(mutant, ruling, without=run(mutant.spec, (*expectation.claim, *options)))


def run(spec: str, options: Options) -> Ruling:
    """`hypcheck verify SPEC` with these options, without the fresh rows that are asked where CI is set."""
    said = io.StringIO()
    with ExitStack() as stack:
        folder = stack.enter_context(tempfile.TemporaryDirectory())
        for each in (redirect_stdout(said), redirect_stderr(said)):
            stack.enter_context(each)
        for module, name, kept in _KEPT:
            stack.enter_context(patch.object(module, name, kept))
        patched = stack.enter_context(pytest.MonkeyPatch.context())
        patched.delenv("CI", raising=False)
        draw_nothing(patched)  # a ruling is in the record alone
        code = main(["verify", spec, "--out", folder, *options])
        path = Path(folder) / "record.jsonl"
        groups = read(path).of(GroupLine) if path.exists() else []
    killed_by = {line.family: failed for line in groups if (failed := _failed(line))}
    return Ruling(code, killed_by, sum(line.asked for line in groups), said.getvalue())


_flip_octaves, _judged = cases.flip_exponents, judge._judged
_octaves: dict[bytes, Any] = {}
_cases: dict[Any, judge.WrongCase] = {}


def _remembered(rows: Rows) -> Any:
    """How near rows are to another position, kept from run to run.

    It is a statistic of the rows in the record, no part of a ruling, and costs more than all the rest of a run.
    """
    key = sha256(rows.tobytes()).digest()
    if key not in _octaves:
        _octaves[key] = _flip_octaves(rows)
    return _octaves[key]


def _judged_before(index: int, pair: Pair, truth: Decision, answer: int, criterion: Criterion) -> judge.WrongCase:
    """What a wrong answer to a row is judged to be, kept from run to run: many answer the same row in the same way."""
    key = pair, answer, criterion
    if key not in _cases:
        _cases[key] = _judged(index, pair, truth, answer, criterion)
    return replace(_cases[key], index=index)


_KEPT = (
    (cases, "flip_exponents", _remembered),
    (judge, "_judged", _judged_before),
    (results, "cases_of_chunk", lru_cache(maxsize=256)(results.cases_of_chunk)),
    (passage_error, "is_tolerated", lru_cache(maxsize=1 << 16)(passage_error.is_tolerated)),
    (passage_error, "size_error", lru_cache(maxsize=1 << 16)(passage_error.size_error)),
)
"""What costs most of a run and does not depend on the implementation: where it stands, and what stands in for it."""


def _failed(line: GroupLine) -> int:
    return sum(number for status, number in line.counts.items() if status not in HARMLESS)
