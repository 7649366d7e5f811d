"""An implementation with a case that ends whoever asks it, as where the system has no memory left."""

from __future__ import annotations

from fractions import Fraction

from hypcheck.casebook.families import FAMILIES
from hypcheck.gate import chunks
from hypcheck.gate.conformance import Rules
from hypcheck.gate.executors import serial
from hypcheck.gate.resume import saved_result
from hypcheck.gate.schedule import State, states, steps
from hypcheck.gate.tasks import Opening
from hypcheck.judge import Criterion
from hypcheck.methods.limits import Limits

KILLS = Opening("python:tests.gate.subjects:kills_who_asks", Limits())
UNLUCKY = chunks.cases(chunks.Chunk("uniform", 1, 2500, 2501)).rows
ENVIRONMENT = {"GATE_TEST_KILLS": UNLUCKY.tobytes().hex()}
"""What tells it the case; where that is not set, there is none."""


def steps_of(names, count):
    return list(steps((chunk for name in names for chunk in chunks.chunks(FAMILIES[name], 1, count)), refuses=False))


def rules_of(it):
    used = it.description
    return Rules(Criterion(used.question, used.precision, Fraction(8)), used.domain)


def here(opening, some):
    """The last state of steps performed in this process."""
    with opening.open() as it, serial(it, rules_of(it)) as performing:
        *_, (_, state) = states(some, performing, State(it.allowance))
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
    assert found.again == expected.again
    fault = found.tallies["uniform"].faults[0]
    assert fault.case == culprit.name(0)
    assert reason in fault.reason


def _holds(step):
    return (
        isinstance(step, chunks.Chunk)
        and step.family == "uniform"
        and bool(step.seed)
        and step.start <= 2500 < step.stop
    )
