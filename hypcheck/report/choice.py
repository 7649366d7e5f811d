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
from hypcheck.record.measurements import Speed
from hypcheck.report.measured import BATCH, SINGLE, Measured, measured, noise_floor, workloads
from hypcheck.report.text import figure

DISTANCES = {"1e-12": 1e-12, "1e-9": 1e-9, "1e-6": 1e-6, "0.001": 1e-3}
"""Flip distances below which errors may not matter: a metre's 1e-12 is an atom's width, its 1e-3 a millimetre."""

BEYOND = "reliable beyond"
"""How a need begins that is about a distance."""

NEARLY = 8.0
"""Three octaves, as wide as a point of the curves: a method that is ten times as slow is not advised for less."""

IN_FLOATS = ("paper", "algebraic", "roots", "foreign")
"""Kinds that promise no more than their floats allow."""

EVERYWHERE, EVERYDAY = "all workloads", "everyday scenes"
"""Where a need is: on every workload, or on those that were timed; the others are there because methods err on them."""

POSITION, CLEAR = "position", "clear or not"
"""What is asked: one of three positions, or whether the two are apart."""


@dataclass(frozen=True, slots=True)
class Need:
    """What is needed, where, and what is asked; errors nearer to contact than `distance` do not matter."""

    what: str
    where: str = EVERYWHERE
    asked: str = POSITION
    distance: float = 0.0
    mode: str = BATCH


@dataclass(frozen=True, slots=True)
class Advice:
    """For a need the fastest method that fills it, those that are not told from it, and where it errs nevertheless.

    `errs` are workloads on which it is not reliable above the need's distance.
    """

    need: Need
    use: Measured
    alike: tuple[Measured, ...]
    workload: str
    errs: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Choice:
    """The advice of a record: for each need, what fills it; `unmet` are needs that nothing measured fills."""

    advice: tuple[Advice, ...]
    unmet: tuple[Need, ...]


def choice(record: Record) -> Choice:
    """What the record advises; nothing where it has no times. Of needs that lead to the same the strictest is told."""
    timed = [name for name in workloads(record) if any(line.workload == name for line in record.of(Speed))]
    advice: list[Advice] = []
    unmet: list[Need] = []
    if not timed:
        return Choice((), ())
    for need, candidates in _needs(measured(record), timed):
        found = _fastest(record, candidates, timed[0], need.mode)
        if not found:
            unmet.append(need)
            continue
        errs = [name for name, line in found[0].accuracy.items() if float(line.reliable_above) > need.distance]
        new = Advice(need, found[0], tuple(found[1:]), timed[0], tuple(errs))
        if not any(_covers(old, new) for old in advice):
            advice.append(new)
    return Choice(tuple(advice), tuple(unmet))


def _covers(old: Advice, new: Advice) -> bool:
    """Whether the same method was advised for a stricter need, so that the new one goes without saying."""
    asked, where = (old.need.asked, new.need.asked), (old.need.where, new.need.where)
    stricter = old.need.distance <= new.need.distance and asked in _COVERED and where in _COVERED
    wider = not old.errs or (old.errs, *where) == (new.errs, EVERYDAY, EVERYDAY)
    return old.use is new.use and old.need.mode == new.need.mode and stricter and wider


_COVERED = (
    *((each, each) for each in (EVERYWHERE, EVERYDAY, POSITION, CLEAR)),
    (EVERYWHERE, EVERYDAY),
    (POSITION, CLEAR),
)
"""Who is advised for the first needs no advice for the second."""


def _needs(found: Sequence[Measured], timed: Sequence[str]) -> Iterator[tuple[Need, list[Measured]]]:
    position = [each for each in found if each.line.question == "position"]
    clear = [each for each in found if each.line.question in ("position", "exterior")]
    exact = [each for each in position if each.never_wrong]
    yield Need("never a wrong answer"), exact
    yield Need("never a wrong answer, one query a call", mode=SINGLE), exact
    row_by_row = [each for each in exact if each.tier == "python"]
    if row_by_row:  # by their batches: a single call may take no longer than the empty one that is taken off
        yield Need("never a wrong answer, a call a row from Python"), row_by_row
    floats = [each for each in position if not each.exact and each.line.kind in IN_FLOATS]
    for precision in ("float64", "float32"):
        yield from _nearest(f"plain {precision}", [each for each in floats if each.line.precision == precision])
    for words, distance in DISTANCES.items():
        what = f"{BEYOND} {words}"
        yield Need(what, distance=distance), _reliable(position, distance)
        yield Need(what, EVERYDAY, distance=distance), _reliable(position, distance, timed)
        yield Need(what, EVERYDAY, CLEAR, distance), _reliable(clear, distance, timed)
    words, distance = next(iter(DISTANCES.items()))
    what = f"{BEYOND} {words}, in numpy"
    for need, fitting in (
        (Need("never a wrong answer, in numpy"), exact),
        (Need(what, distance=distance), _reliable(position, distance)),
        (Need(what, EVERYDAY, distance=distance), _reliable(position, distance, timed)),
    ):
        if any(each.tier == "numpy" for each in fitting):
            yield need, [each for each in fitting if each.tier == "numpy"]
    yield from _nearest("a mesh, because an engine has one", [each for each in found if each.line.kind == "mesh"])


def _nearest(what: str, found: Sequence[Measured]) -> Iterator[tuple[Need, list[Measured]]]:
    """Those of the found that are reliable nearest to contact, or not NEARLY times as far from it."""
    best = min((each.reliable_above for each in found), default=math.inf)
    if best < math.inf:
        distance = NEARLY * best
        need = Need(f"{what}; errors end by {figure(distance)}" if best else f"{what}; none wrong", distance=distance)
        yield need, [each for each in found if each.reliable_above <= distance]


def _reliable(found: Iterable[Measured], distance: float, names: Sequence[str] | None = None) -> list[Measured]:
    """Those that are reliable above the distance on all workloads, or on the named ones."""

    def holds(each: Measured) -> bool:
        lines = [line for name, line in each.accuracy.items() if names is None or name in names]
        return bool(lines) and all(float(line.reliable_above) <= distance for line in lines)

    return [each for each in found if each.line.kind != "bounding" and holds(each)]


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
    ratio = line.ratio or 0.0
    return line.ratio_ci95 or (ratio, ratio)


@dataclass(frozen=True, slots=True)
class Price:
    """The fastest method that was never wrong, the fastest that was, and the ratios of their times by workload."""

    never: Measured
    fastest: Measured
    ratios: tuple[tuple[str, float], ...]


def price(record: Record) -> Price | None:
    """What it costs never to be wrong in a batch, the fastest being those of the first timed workload.

    None where not both were timed there.
    """
    timed = [name for name in workloads(record) if any(line.workload == name for line in record.of(Speed))]
    ranked = sorted(
        ((ratio, each) for each in measured(record) for name in timed[:1] if (ratio := each.ratio(name)) is not None),
        key=lambda pair: pair[0],
    )
    never = next((pair for pair in ranked if pair[1].never_wrong), None)
    fastest = next((pair for pair in ranked if pair[1].wrong and pair[1].line.kind != "bounding"), None)
    if never is None or fastest is None:
        return None
    pairs = [(name, never[1].ratio(name), fastest[1].ratio(name)) for name in timed]
    return Price(never[1], fastest[1], tuple((name, mine / other) for name, mine, other in pairs if mine and other))


def beaten(record: Record) -> list[tuple[Measured, Measured]]:
    """Methods with one of the same tier and question that is faster beyond doubt and reliable at least as near."""
    found = [each for each in measured(record) if each.line.kind != "bounding"]
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
    return float(each.accuracy[workload].reliable_above)


def _by_ratio(workload: str) -> Callable[[Measured], float]:
    return lambda each: each.ratio(workload) or math.inf


def _beats(other: Measured, each: Measured, timed: Sequence[str]) -> bool:
    if (other.tier, other.line.question) != (each.tier, each.line.question):
        return False
    if (each.exact and not other.exact) or each.accuracy.keys() != other.accuracy.keys():
        return False
    if any(_reach(other, name) > _reach(each, name) for name in each.accuracy):
        return False
    shared = [name for name in timed if each.ratio(name) is not None and other.ratio(name) is not None]
    return bool(shared) and all(_interval(other, name, BATCH)[1] < _interval(each, name, BATCH)[0] for name in shared)
