"""An implementation with a case that kills the process that asks it, as if the system had no memory left."""

from __future__ import annotations

from fractions import Fraction

from hypcheck.implementations.session import Limits
from hypcheck.isolation.launch import Isolation
from hypcheck.runs import cases
from hypcheck.runs.executors import execution_here
from hypcheck.runs.judge import Criterion
from hypcheck.runs.results import JudgingRules
from hypcheck.runs.resume import saved_result
from hypcheck.runs.schedule import ImplementationOpener, RunState, perform_steps, steps_of_chunks
from hypcheck.vectors.families import FAMILIES

KILLS = ImplementationOpener("python:tests.runs.faulty:kills_who_asks", Limits(isolation=Isolation("off")))
"""Isolated, it could not kill the process that asks it."""

UNLUCKY = cases.cases_of_chunk(cases.CaseChunk("uniform", 1, 2500, 2501)).rows
ENVIRONMENT = {"GATE_TEST_KILLS": UNLUCKY.tobytes().hex()}
"""What tells it the case; where that is not set, there is none."""


def steps_of(names, count, pace):
    chunks = (cases.family_chunks(FAMILIES[name], 1, count, pace.chunk_rows) for name in names)
    return list(steps_of_chunks((chunk for some in chunks for chunk in some), pace=pace))


def rules_of(it):
    used = it.description
    return JudgingRules(Criterion(used.question, used.precision, Fraction(8)), used.domain)


def here(opening, some):
    """The last state of steps performed in this process."""
    with opening.open() as it, execution_here(it, rules_of(it)) as performing:
        *_, (_, state) = perform_steps(some, performing, RunState(it.allowance))
        return state


def without_culprit(some):
    """The step that asks the unlucky case, and the others."""
    (culprit,) = [step for step in some if _holds(step)]
    return culprit, [step for step in some if step != culprit]


def require_one_crash(found, expected, culprit, reason):
    """The result is the expected one, but for the cases of the culprit, all of which crashed for the reason."""
    tower = [saved_result(each).tallies["tower-body"] for each in (found, expected)]
    assert tower[0] == tower[1]
    counts = dict(found.tallies["uniform"].counts)
    assert counts.pop("crash") == len(culprit)
    assert counts == expected.tallies["uniform"].counts
    assert found.retest == expected.retest
    fault = found.tallies["uniform"].faults[0]
    assert fault.case == culprit.name(0)
    assert reason in fault.reason


def _holds(step):
    return (
        isinstance(step, cases.CaseChunk)
        and step.family == "uniform"
        and bool(step.seed)
        and step.start <= 2500 < step.stop
    )
