"""Advice on methods: rules over the figures of a benchmark, and the section that states the advice.

A method is *reliable above* a distance on a workload if at most 1 in 1000 of its answers beyond that distance is wrong.
Faster means a lower ratio to the run's reference on its first timed workload, in a batch unless the need says
otherwise. A method whose interval overlaps with the fastest method's interval, or that differs from it by less than the
noise, is named with it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from hypcheck.messages import counted
from hypcheck.record import Record
from hypcheck.report import document
from hypcheck.report.measured import (
    BATCH,
    SINGLE,
    MeasuredMethod,
    by_ratio,
    measured_methods,
    noise_floor,
    reference,
    sweep_totals,
    timed_workloads,
    workloads,
)
from hypcheck.report.messages import figure, listed, pace, with_interval

DISTANCES = {"1e-12": 1e-12, "1e-9": 1e-9, "1e-6": 1e-6, "0.001": 1e-3}
"""Distances below which errors may not matter: of a metre, 1e-12 is an atom's width, 1e-3 a millimetre."""

BEYOND = "reliable beyond"
"""The beginning of a need that is about a distance."""

NEARLY = 8.0
"""A factor of distances: three octaves, the width of a point of the curves. Smaller differences are ignored."""

IN_FLOATS = ("paper", "algebraic", "roots", "foreign")
"""Kinds of methods that promise no more than their floats allow."""

EVERYWHERE, EVERYDAY = "all workloads", "everyday scenes"
"""The workloads of a need: all of them, or those that were timed. The others exist because methods err on them."""

POSITION, CLEAR = "position", "clear or not"
"""The question: one of three positions, or whether the bodies are apart."""


@dataclass(frozen=True, slots=True)
class Need:
    """What a user needs of a method.

    what: the need in words. where: the workloads that it covers. asked: the question. distance: the distance from
    contact below which errors do not matter. mode: whether rows are sent in a batch or one by one.
    """

    what: str
    where: str = EVERYWHERE
    asked: str = POSITION
    distance: float = 0.0
    mode: str = BATCH

    @property
    def words(self) -> str:
        """The need in words, without the workloads and the question if they are the usual ones."""
        usual = (EVERYWHERE, POSITION)
        return ", ".join([self.what, *(part for part in (self.where, self.asked) if part not in usual)])


@dataclass(frozen=True, slots=True)
class Advice:
    """The advice for a need.

    use: the fastest method that meets the need; `alike` are the methods as fast within the noise. workload: the
    workload whose times decided the choice. errs: workloads on which it is not reliable above the need's distance.
    """

    need: Need
    use: MeasuredMethod
    alike: tuple[MeasuredMethod, ...]
    workload: str
    errs: tuple[str, ...] = ()

    @property
    def ratio(self) -> float:
        """The time of the advised method divided by the time of the run's reference."""
        return self.use.ratio(self.workload, self.need.mode) or 0.0


@dataclass(frozen=True, slots=True)
class Recommendations:
    """The advice of a record; `unmet` are needs that no measured method meets."""

    advice: tuple[Advice, ...]
    unmet: tuple[Need, ...]


def recommendations(record: Record) -> Recommendations:
    """Return the advice of a record; it is empty if the record has no times, or is about sweeps.

    If several needs lead to the same advice, only that for the strictest need is kept.
    """
    timed = timed_workloads(record)
    advice: list[Advice] = []
    unmet: list[Need] = []
    if not timed or sweep_totals(record):  # the needs are about positions
        return Recommendations((), ())
    for need, candidates in _needs(measured_methods(record), timed):
        fastest = _fastest(record, candidates, timed[0], need.mode)
        if not fastest:
            unmet.append(need)
            continue
        errs = [name for name, line in fastest[0].accuracy.items() if line.reliable_above > need.distance]
        new = Advice(need, fastest[0], tuple(fastest[1:]), timed[0], tuple(errs))
        if not any(_covers(old, new) for old in advice):
            advice.append(new)
    return Recommendations(tuple(advice), tuple(unmet))


def _covers(old: Advice, new: Advice) -> bool:
    """Decide whether `old` advises the same method for a stricter need, so that `new` adds nothing."""
    questions, where = (old.need.asked, new.need.asked), (old.need.where, new.need.where)
    stricter = old.need.distance <= new.need.distance and questions in _COVERED and where in _COVERED
    wider = not old.errs or (old.errs, *where) == (new.errs, EVERYDAY, EVERYDAY)
    return old.use is new.use and old.need.mode == new.need.mode and stricter and wider


_COVERED = (
    *((need, need) for need in (EVERYWHERE, EVERYDAY, POSITION, CLEAR)),
    (EVERYWHERE, EVERYDAY),
    (POSITION, CLEAR),
)
"""Pairs of workloads, or of questions: advice for the first of a pair also holds for the second."""


def _needs(methods: Sequence[MeasuredMethod], timed: Sequence[str]) -> Iterator[tuple[Need, list[MeasuredMethod]]]:
    """Yield each need with the methods that meet it."""
    position = [method for method in methods if method.line.question == "position"]
    clear = [method for method in methods if method.line.question in ("position", "exterior")]
    exact = [method for method in position if method.never_wrong]
    yield Need("never a wrong answer"), exact
    yield Need("never a wrong answer, one query a call", mode=SINGLE), exact
    row_by_row = [method for method in exact if method.tier == "python"]
    if row_by_row:  # by batches: a single call may take no longer than the empty call that is subtracted
        yield Need("never a wrong answer, a call a row from Python"), row_by_row
    floats = [method for method in position if not method.exact and method.line.kind in IN_FLOATS]
    for precision in ("float64", "float32"):
        yield from _nearest(f"plain {precision}", [method for method in floats if method.line.precision == precision])
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
        if any(method.tier == "numpy" for method in fitting):
            yield need, [method for method in fitting if method.tier == "numpy"]
    yield from _nearest(
        "a mesh, because an engine has one", [method for method in methods if method.line.kind == "mesh"]
    )


def _nearest(what: str, methods: Sequence[MeasuredMethod]) -> Iterator[tuple[Need, list[MeasuredMethod]]]:
    """Yield one need: reliability at most NEARLY times as far from contact as the most reliable of these methods.

    It comes with the methods that meet it. Yields nothing if no method is reliable at any distance.
    """
    best = min((method.reliable_above for method in methods), default=math.inf)
    if best < math.inf:
        distance = NEARLY * best
        need = Need(f"{what}; errors end by {figure(distance)}" if best else f"{what}; none wrong", distance=distance)
        yield need, [method for method in methods if method.reliable_above <= distance]


def _reliable(
    methods: Iterable[MeasuredMethod], distance: float, names: Sequence[str] | None = None
) -> list[MeasuredMethod]:
    """Return the methods that are reliable above the distance on all workloads, or on those of these `names`."""

    def is_reliable(method: MeasuredMethod) -> bool:
        lines = [line for name, line in method.accuracy.items() if names is None or name in names]
        return bool(lines) and all(line.reliable_above <= distance for line in lines)

    return [method for method in methods if method.line.kind != "bounding" and is_reliable(method)]


def _fastest(record: Record, methods: Iterable[MeasuredMethod], workload: str, mode: str) -> list[MeasuredMethod]:
    """Return the fastest method, then those as fast within the noise, by their ratios; empty if none was timed."""
    ranked = by_ratio(methods, workload, mode)
    if not ranked:
        return []
    best = ranked[0]
    limit = (best.ratio(workload, mode) or 0.0) * (1 + (noise_floor(record, workload, mode) or 0.0))
    high = best.ratio_interval(workload, mode)[1]
    return [
        method
        for method in ranked
        if method is best
        or (method.ratio(workload, mode) or 0.0) <= limit
        or method.ratio_interval(workload, mode)[0] <= high
    ]


def dominated_methods(record: Record) -> list[tuple[MeasuredMethod, MeasuredMethod]]:
    """Return each method that another one beats, with the fastest of those that beat it.

    A method beats another of the same tier and question if it is certainly faster, and errs no farther from contact.
    """
    methods = [method for method in measured_methods(record) if method.line.kind != "bounding"]
    timed = [name for name in workloads(record) if any((name, BATCH) in method.speed for method in methods)]
    pairs = []
    for method in methods:
        faster = [other for other in methods if _beats(other, method, timed)]
        if faster:
            pairs.append((method, min(faster, key=lambda other: other.ratio(timed[0]) or math.inf)))
    return pairs


def _beats(other: MeasuredMethod, method: MeasuredMethod, timed: Sequence[str]) -> bool:
    """Decide whether `other` is certainly faster than `method` on these workloads, and errs no farther from contact."""
    if (other.tier, other.line.question) != (method.tier, method.line.question):
        return False
    if (method.exact and not other.exact) or method.accuracy.keys() != other.accuracy.keys():
        return False
    if any(other.accuracy[name].reliable_above > line.reliable_above for name, line in method.accuracy.items()):
        return False
    shared = [name for name in timed if method.ratio(name) is not None and other.ratio(name) is not None]
    return bool(shared) and all(other.ratio_interval(name)[1] < method.ratio_interval(name)[0] for name in shared)


_HOW = document.prose(
    "The fastest method that meets the need, by its ratio to the run's reference; nanoseconds are this machine's."
    " Methods that are as fast within the intervals or the noise of the run are named beside it. *Reliable above* a"
    " distance: at most 1 in 1000 answers beyond it is wrong, on every workload that the need covers. A need"
    " without a line of its own is met by the advice for a stricter one. Methods that were not measured are not"
    " advised: gate a method on your own scene before you rely on it. If you need the right answer at every row and"
    " do not want to choose, take the code of `hypcheck emit --method exact`."
)


def advice_sections(record: Record) -> Iterator[document.Section]:
    """Yield the section that states the advice; nothing if there is no advice."""
    chosen = recommendations(record)
    if not chosen.advice:
        return
    known = workloads(record)
    scenes = listed([known[name].title for name in timed_workloads(record)])
    other = reference(record)
    notes: list[document.Text] = [
        *_price_sentences(record),
        f"Everyday scenes are the workloads that were timed: {scenes}.",
    ]
    notes += [
        (f"No measured method meets this need: {need.what}, {need.where}, {need.asked}.") for need in chosen.unmet
    ]
    worse = [
        (document.Code(loser.name), " (", document.Code(winner.name), ")")
        for loser, winner in dominated_methods(record)
    ]
    if worse:
        lead = "Beaten by a method of the same tier that is certainly faster and errs no farther from contact: "
        notes.append((lead, document.joined(worse), "."))
    lines: list[document.Text] = [
        (
            document.Strong(line.need.words),
            ": ",
            document.Code(line.use.name),
            f", {pace(line.ratio, other or 'the reference')}.",
        )
        for line in chosen.advice
    ]
    how = document.Paragraph(_HOW)
    yield document.Section(
        "Which method to use when",
        (document.bullets(lines), how, _advice_table(chosen.advice, other), document.bullets(notes)),
    )


def advice_facts(record: Record) -> Iterator[str]:
    """Yield the advice of a benchmark: a sentence without a full stop for each need."""
    other = reference(record) or "the reference"
    for line in recommendations(record).advice:
        yield f"{line.need.words}: {line.use.name}, {pace(line.ratio, other)}"


def _price_sentences(record: Record) -> Iterator[document.Text]:
    """Yield the price of exactness in a batch: the fastest never-wrong method's time, over the fastest other's.

    Both are the fastest of their kind on the first timed workload. Yields nothing if a kind has no method.
    """
    timed, known = timed_workloads(record), workloads(record)
    ranked = by_ratio(measured_methods(record), timed[0]) if timed else []
    never = next((method for method in ranked if method.never_wrong), None)
    fastest = next((method for method in ranked if method.wrong and method.line.kind != "bounding"), None)
    if never is not None and fastest is not None:
        ratios = [(known[name].title, never.ratio(name), fastest.ratio(name)) for name in timed]
        times = listed([f"{figure(mine / other)} times ({title})" for title, mine, other in ratios if mine and other])
        distance = fastest.reliable_above
        ends = (
            f"errors end at {figure(distance)}" if distance < math.inf else "reliable at no distance on some workload"
        )
        err: document.Text = (document.Code(fastest.name), f", the fastest of those that err ({ends})")
        yield (
            "The price of exactness: in a batch ",
            document.Code(never.name),
            f" takes {times} as long as ",
            err,
            ".",
        )


def own_method_facts(record: Record) -> Iterator[str]:
    """Yield sentences about each of the user's methods: where its errors end, and its time on each workload."""
    methods, other, known = measured_methods(record), reference(record) or "the reference", workloads(record)
    for method in methods:
        if not method.foreign:
            continue
        end = method.reliable_above
        errors = (
            "reliable at no distance" if end == math.inf else f"errors end at {figure(end)}" if end else "none wrong"
        )
        yield f"{method.name}: {method.wrong:,} of {counted(method.asked, 'answer')} wrong, {errors}"
        for name in known:
            line, ratio = method.speed.get((name, BATCH)), method.ratio(name)
            if line is not None and ratio is not None:
                time = f"{with_interval(line.median_ns, line.ci95_ns)} ns a row in a batch"
                yield f"{method.name}, {known[name].title}: {time}, {pace(ratio, other, method.ratio_interval(name))}"


def best_rival_facts(record: Record) -> Iterator[str]:
    """Compare each of the user's methods with the fastest other method that errs no farther from contact."""
    methods, timed = measured_methods(record), timed_workloads(record)
    for method in methods:
        own = method.ratio(timed[0]) if timed else None
        if not method.foreign or not own:
            continue
        rivals = [
            other
            for other in methods
            if not other.foreign
            and other.line.question == method.line.question
            and other.accuracy.keys() == method.accuracy.keys()
            and all(
                other.accuracy[name].reliable_above <= line.reliable_above for name, line in method.accuracy.items()
            )
        ]
        best = next(iter(by_ratio(rivals, timed[0])), None)
        rival = None if best is None else best.ratio(timed[0])
        if best is None or not rival:
            yield f"{method.name}: no other method that was measured is as reliable"
        else:
            yield f"{method.name}: {pace(own / rival, f'{best.name}, the fastest that is as reliable')}"


def own_method_sections(record: Record) -> Iterator[document.Section]:
    """Yield the section about the user's methods: comparison, errors and times; nothing without such methods."""
    items = [f"{fact}." for fact in (*best_rival_facts(record), *own_method_facts(record))]
    if items:
        yield document.Section("Your methods", (document.bullets(items),))


def advised_method_sections(record: Record) -> Iterator[document.Section]:
    """Yield the section that describes the advised methods; nothing if there is no advice."""
    advised = {advice.use.name: advice.use for advice in recommendations(record).advice}
    if advised:
        items: list[document.Text] = [
            (
                document.Code(name),
                f", {method.tier}: {method.line.title}",
                f"; {note}" if (note := method.line.note) else "",
                ".",
            )
            for name, method in advised.items()
        ]
        yield document.Section("What these methods are", (document.bullets(items),), level=3)


def _advice_table(advice: tuple[Advice, ...], reference: str | None) -> document.Block:
    """Make the table of the advice; `reference` names the method that the ratios refer to."""
    before, after = (
        document.columns("you need | use | in | asked"),
        document.columns("# ns a query | # judged | as fast | not reliable on"),
    )
    heads = (*before, document.against(reference), *after)
    return document.table("which method to use when", heads, [_advice_row(line) for line in advice])


def _advice_row(advice: Advice) -> document.Row:
    """Make the row of the table for one need and its advised method."""
    line = advice.use.speed[advice.workload, advice.need.mode]
    return (
        advice.need.what,
        document.Code(advice.use.name),
        advice.need.where,
        advice.need.asked,
        document.paced(line.ratio or 0.0, line.ratio_ci95),
        document.measured(line.median_ns),
        document.count(advice.use.asked),
        document.joined([document.Code(other.name) for other in advice.alike]),
        ", ".join(advice.errs),
    )
