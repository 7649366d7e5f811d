"""Which method to use when: rules over what a benchmark measured, and nothing that somebody knows better.

A method is *reliable above* a flip distance on a workload when at most 1 in 1000 of its answers beyond that distance is
wrong. Faster means a lower ratio to the run's reference on its first timed workload, in a batch unless said otherwise.
Methods whose intervals overlap with the fastest's, or which the run's noise does not tell from it, are named with it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

from hypcheck.record import Record
from hypcheck.report.measured import BATCH, SINGLE, Measured, measured, noise_floor, workloads
from hypcheck.report.text import figure

DISTANCES = (1e-12, 1e-9, 1e-6, 1e-3)
"""Flip distances below which errors may not matter: a metre's 1e-12 is an atom's width, its 1e-3 a millimetre."""

IN_FLOATS = ("paper", "algebraic", "roots", "foreign")
"""Kinds that promise no more than their floats allow."""


@dataclass(frozen=True, slots=True)
class Advice:
    """For a need the fastest method that fills it, those that are not told from it, and where it errs nevertheless.

    `errs` are workloads on which it is not reliable above the distance that was asked for. Everyday scenes are the
    workloads that were timed; the others are there because methods err on them.
    """

    need: str
    use: Measured
    alike: tuple[Measured, ...]
    mode: str
    workload: str
    errs: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Choice:
    """The advice of a record: for each need, what fills it; `unmet` are needs that nothing measured fills."""

    advice: tuple[Advice, ...]
    unmet: tuple[str, ...]


def choice(record: Record) -> Choice:
    """What the record advises; nothing where it has no times."""
    advice: list[Advice] = []
    unmet: list[str] = []
    timed = [name for name in workloads(record) if any(line["workload"] == name for line in record.of("speed"))]
    if not timed:
        return Choice((), ())
    everything = measured(record)
    for need, candidates, distance, mode in _needs(everything, timed):
        found = _fastest(record, candidates, timed[0], mode)
        if not found:
            unmet.append(need)
            continue
        errs = tuple(name for name, line in found[0].accuracy.items() if float(line["reliable_above"]) > distance)
        advice.append(Advice(need, found[0], tuple(found[1:]), mode, timed[0], errs))
    return Choice(tuple(advice), tuple(unmet))


Need = tuple[str, list[Measured], float, str]
"""What is needed, the methods that fill it, the flip distance above which they must be reliable, and the mode."""


def _needs(found: Sequence[Measured], timed: Sequence[str]) -> Iterator[Need]:
    position = [each for each in found if each.line["question"] == "position"]
    exact = [each for each in position if each.exact and each.asked and not each.wrong]
    yield "the exact answer, always", exact, 0.0, BATCH
    yield "the exact answer, one query at a time", exact, 0.0, SINGLE
    floats = [each for each in position if not each.exact and each.line["kind"] in IN_FLOATS]
    for precision in ("float64", "float32"):
        mine = [each for each in floats if each.line["precision"] == precision]
        best = min((each.reliable_above for each in mine), default=math.inf)
        need = f"plain {precision}, as near to contact as that goes: errors end at {figure(best)}"
        yield need, [each for each in mine if each.reliable_above <= best < math.inf], best, BATCH
    clear = [each for each in found if each.line["question"] in ("position", "exterior")]
    for distance in DISTANCES:
        words = f"errors closer to contact than {distance:g} do not matter"
        yield f"{words}, in any scene measured", _reliable(position, distance), distance, BATCH
        yield f"{words}, in everyday scenes", _reliable(position, distance, timed), distance, BATCH
        yield (
            f"{words}, in everyday scenes, only whether it is clear",
            _reliable(clear, distance, timed),
            distance,
            BATCH,
        )
    meshes = [each for each in found if each.line["kind"] == "mesh"]
    best = min((each.reliable_above for each in meshes), default=math.inf)
    if meshes:
        need = f"a mesh because an engine has one: errors end at {figure(best)}"
        yield need, [each for each in meshes if each.reliable_above == best], best, BATCH


def _reliable(found: Iterable[Measured], distance: float, names: Sequence[str] | None = None) -> list[Measured]:
    """Those that are reliable above the distance on all workloads, or on the named ones."""

    def holds(each: Measured) -> bool:
        lines = [line for name, line in each.accuracy.items() if names is None or name in names]
        return bool(lines) and all(float(line["reliable_above"]) <= distance for line in lines)

    return [each for each in found if each.line["kind"] != "bounding" and holds(each)]


def _fastest(record: Record, found: Iterable[Measured], workload: str, mode: str) -> list[Measured]:
    """The fastest, and behind it those that are not told from it, by their ratios."""
    ranked = sorted(
        ((ratio, each) for each in found if (ratio := each.ratio(workload, mode)) is not None),
        key=lambda pair: pair[0],
    )
    if not ranked:
        return []
    least, best = ranked[0]
    floor = noise_floor(record, workload, mode) or 0.0
    high = _interval(best, workload, mode)[1]
    return [
        each
        for ratio, each in ranked
        if each is best or ratio <= least * (1 + floor) or _interval(each, workload, mode)[0] <= high
    ]


def _interval(each: Measured, workload: str, mode: str) -> tuple[float, float]:
    line = each.speed[workload, mode]
    low, high = line["ratio_ci95"] or (line["ratio"], line["ratio"])
    return float(low), float(high)


def beaten(record: Record) -> list[tuple[Measured, Measured]]:
    """Methods with one of the same tier and question that is faster beyond doubt and reliable at least as near."""
    found = [each for each in measured(record) if each.line["kind"] != "bounding"]
    timed = [name for name in workloads(record) if any((name, BATCH) in each.speed for each in found)]
    if not timed:
        return []
    pairs = []
    for each in found:
        faster = [other for other in found if _beats(other, each, timed)]
        if faster:
            pairs.append((each, min(faster, key=_by_ratio(timed[0]))))
    return pairs


def _reach(each: Measured, workload: str) -> float:
    return float(each.accuracy[workload]["reliable_above"])


def _by_ratio(workload: str) -> Callable[[Measured], float]:
    return lambda each: each.ratio(workload) or math.inf


def _beats(other: Measured, each: Measured, timed: Sequence[str]) -> bool:
    if (other.tier, other.line["question"]) != (each.tier, each.line["question"]):
        return False
    if (each.exact and not other.exact) or each.accuracy.keys() != other.accuracy.keys():
        return False
    if any(_reach(other, name) > _reach(each, name) for name in each.accuracy):
        return False
    shared = [name for name in timed if each.ratio(name) is not None and other.ratio(name) is not None]
    return bool(shared) and all(_interval(other, name, BATCH)[1] < _interval(each, name, BATCH)[0] for name in shared)
