"""Conditions of a measurement: load and frequency of the machine, and which compilers and packages are absent.

A reader of a record needs them before trusting its times. They are checked once, before the first measurement.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import asdict, replace
from pathlib import Path
from types import MappingProxyType

from hypcheck.bench import foreign
from hypcheck.bench.c_library import compiled
from hypcheck.bench.contenders import COMPILER, contenders
from hypcheck.bench.plan import BenchPlan
from hypcheck.errors import UnavailableError
from hypcheck.implementations.description import QUESTIONS
from hypcheck.implementations.meshes import COAL, FCL, MeshLibrary
from hypcheck.implementations.session import StartError
from hypcheck.record import Recorder
from hypcheck.record.fields import decoded
from hypcheck.record.lines import NotStartedLine
from hypcheck.record.measurements import AbsentLine, CompilerLine


def governor() -> str | None:
    """What sets the processor's frequency, if the system tells; unless it is "performance", times vary."""
    with suppress(OSError):
        return Path("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor").read_text(encoding="utf-8").strip()
    return None


def load() -> tuple[float, float, float] | None:
    """The mean number of processes that wanted a processor during 1, 5 and 15 minutes, if the system tells."""
    with suppress(OSError, AttributeError):
        short, middle, long = (round(average, 2) for average in os.getloadavg())
        return short, middle, long
    return None


def plan_with_needs(plan: BenchPlan, recorder: Recorder) -> BenchPlan:
    """The plan with what is available and what is missing, which the record says too.

    Raises InputError naming a method that does not exist.
    """
    for need in sorted({each.needs for each in contenders(plan).values()} - {""}):
        plan = _looked_for(need, plan, recorder)
    return plan


def needs_met(plan: BenchPlan, recorder: Recorder) -> BenchPlan:
    """The plan with the methods of its SPECs; those that cannot be started are recorded instead.

    Raises InputError if a text is no SPEC.
    """
    found: list[foreign.ForeignMethod] = []
    for spec in plan.specs:
        try:
            taken = [*contenders(plan), *(each.name for each in found)]
            layout = QUESTIONS[plan.question].layout
            found.append(foreign.foreign_method(spec, plan.limits, taken, tilted=plan.tilted, layout=layout))
        except StartError as error:  # noqa: PERF203 - a process is started in each turn
            recorder.add(NotStartedLine(spec=spec, name=spec, trouble=str(error)))
    return replace(plan, foreign=tuple(found))


def note_absent(recorder: Recorder, what: str, reason: str) -> None:
    """Record once that something is not available, and why."""
    if not any(isinstance(line, AbsentLine) and line.what == what for line in recorder.lines):
        recorder.add(AbsentLine(what=what, reason=reason))


def _looked_for(need: str, plan: BenchPlan, recorder: Recorder) -> BenchPlan:
    try:
        return _FINDERS[need](plan, recorder)
    except UnavailableError as error:
        note_absent(recorder, need, str(error))
        return replace(plan, missing=(*plan.missing, need))


def _compiler(plan: BenchPlan, recorder: Recorder) -> BenchPlan:
    library, compiler = compiled(plan.folder)
    recorder.add(decoded(asdict(compiler), CompilerLine))
    return replace(plan, compiled=library)


def _engine(engine: MeshLibrary) -> Callable[[BenchPlan, Recorder], BenchPlan]:
    def find(plan: BenchPlan, _recorder: Recorder) -> BenchPlan:
        trouble = engine.trouble()
        if trouble is not None:
            raise UnavailableError(trouble)
        return plan

    return find


_FINDERS: Mapping[str, Callable[[BenchPlan, Recorder], BenchPlan]] = MappingProxyType(
    {COMPILER: _compiler, **{engine.title: _engine(engine) for engine in (FCL, COAL)}}
)
"""Each raises UnavailableError if it finds nothing."""
