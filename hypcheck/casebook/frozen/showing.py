"""The casebook for people: a list of what there is, a family, a case."""

from __future__ import annotations

import textwrap
from collections import Counter
from collections.abc import Iterator

from hypcheck.casebook import vectors
from hypcheck.casebook.families import case_id, parse_case_id
from hypcheck.casebook.family import BLOCK
from hypcheck.casebook.frozen import refusals
from hypcheck.casebook.frozen.flags import FLAGS
from hypcheck.casebook.frozen.model import Head, Vector, VectorFile
from hypcheck.casebook.frozen.refusals import Refusal
from hypcheck.casebook.frozen.texts import hex_of
from hypcheck.casebook.frozen.writing import vector_text
from hypcheck.classification.rationals import readable
from hypcheck.errors import InputError
from hypcheck.pairs import COLUMNS, Position
from hypcheck.suggesting import advice

WIDTH = 100
"""Columns of a line of running text."""

_LABEL = 12


def list_lines() -> Iterator[str]:
    """Every set of vectors: its name, how many are frozen, and what it is."""
    files = {name: (vectors.load(name).head, len(vectors.load(name).cases)) for name in vectors.NAMES}
    bad = vectors.load_refusals()
    files[refusals.NAME] = (bad.head, len(bad.cases))
    width = max(map(len, files))
    for name, (head, count) in files.items():
        mark = " (extreme: taken when asked for)" if head.extreme else ""
        yield f"{name:{width}}  {count:4}  {head.title}{mark}"
    yield f"{'together':{width}}  {sum(count for _, count in files.values()):4}"


def family_lines(name: str) -> Iterator[str]:
    """What is known of a family, and its frozen cases counted."""
    if name == refusals.NAME:
        bad = vectors.load_refusals()
        yield from _head_lines(bad.head)
        yield from _titled("cases", f"{len(bad.cases)}, {bad.cases[0].id} to {bad.cases[-1].id}, all to be refused")
        return
    file = vectors.load(name)
    yield from _head_lines(file.head)
    yield from _titled("cases", f"{len(file.cases)}, {file.cases[0].id} to {file.cases[-1].id}")
    yield from _titled("positions", _counted(Counter(case.position.label for case in file.cases)))
    yield from _titled("kinds", _counted(Counter(case.kind.value for case in file.cases)))
    for flag, facts in file.flags.items():
        count = sum(flag in case.flags for case in file.cases)
        yield from _titled("flag", f"{flag}, {count} times: {facts.meaning} ({facts.bug_type})")


def case_lines(case: Vector) -> Iterator[str]:
    """A case with its labels and its proof."""
    yield case.id
    for name, value in zip(COLUMNS, case.row, strict=True):
        yield f"{name:{_LABEL}}{value!r:24}{hex_of(value)}"
    yield from _titled("position", f"{case.position.label}, tangent" if case.tangent else case.position.label)
    yield from _titled("kind", f"{case.kind.value}: {case.kind.description}")
    yield from _titled("clearance", f"{case.clearance!r} spheroid radii ({hex_of(case.clearance)})")
    for position, distance in case.flips.items():
        yield from _titled("flip", f"{position.label} if each number may change by a relative {distance!r}")
    yield from _titled("proof", _proof(case))
    for flag in case.flags:
        yield from _titled("flag", f"{flag}: {FLAGS[flag].meaning}")


def refusal_lines(case: Refusal) -> Iterator[str]:
    """A row that must be refused, and where it is at fault."""
    yield case.id
    for name, value, bits in zip(COLUMNS, case.row, case.bits, strict=True):
        yield f"{name:{_LABEL}}{value!r:24}{bits:016x}{'  at fault' if name in case.columns else ''}"
    yield from _titled("expected", refusals.EXPECTED)


def vector_of(name: str) -> Vector:
    """The case of that id, frozen or generated. Raises InputError where there is none."""
    if "/" in name:
        return _generated(name)
    family = _family_of(name)
    if family in vectors.NAMES:
        for case in vectors.load(family).cases:
            if case.id == name:
                return case
    raise InputError(f"there is no case or family {name!r}; {_hint(family)}")


def refusal_of(name: str) -> Refusal:
    """The row to be refused that has that id. Raises InputError where there is none."""
    for case in vectors.load_refusals().cases:
        if case.id == name:
            return case
    raise InputError(f"there is no case {name!r}; {_hint(refusals.NAME)}")


def show(name: str, *, as_json: bool) -> Iterator[str]:
    """The lines about a family or a case; a case as it stands in a file where JSON is asked for. Raises InputError."""
    if name in vectors.NAMES or name == refusals.NAME:
        if as_json:
            yield from vectors.path_of(name).read_text(encoding="utf-8").splitlines()
        else:
            yield from family_lines(name)
    elif _family_of(name) == refusals.NAME:
        bad = refusal_of(name)
        yield from (refusals.refusal_text(bad),) if as_json else refusal_lines(bad)
    else:
        case = vector_of(name)
        yield from (vector_text(case),) if as_json else case_lines(case)


def _generated(name: str) -> Vector:
    from hypcheck.casebook.frozen.labels import labelled  # noqa: PLC0415 - frozen cases are shown without the oracles

    case = parse_case_id(name)
    block, place = divmod(case.index, BLOCK)
    row = tuple(case.family.block(case.seed, block)[place].tolist())
    return labelled([(case_id(case.family, case.seed, case.index), row)])[0]


def _head_lines(head: Head) -> Iterator[str]:
    yield f"{head.name}, version {head.version}: {head.title}"
    for label, text in (
        ("source", head.source),
        ("purpose", head.purpose),
        ("in a game", head.game),
        ("in a drone", head.drone),
        ("regimes", f"{head.regimes} (a = α/b, c = γ/d)"),
        ("made by", head.made_by),
    ):
        yield from _titled(label, text)


def _proof(case: Vector) -> str:
    witness = case.witness
    if witness.multiplier is not None:
        interval = "(0, c²)" if case.position is Position.EXTERIOR else "(−a², 0)"
        return f"g(λ) > 0 at λ {_said(readable(witness.multiplier))} in {interval}"
    if witness.double_root is not None:
        return f"g has the double root m {_said(readable(witness.double_root))}"
    points = " and ".join(f"({', '.join(map(readable, point))})" for point in witness.offsets)
    where = "on the surface" if len(witness.offsets) == 1 else "on both sides of the surface"
    return f"in the spheroid and {where}: the centre + (b s, b t, d w) for (s, t, w) = {points}"


def _said(text: str) -> str:
    return text if text.startswith("≈") else f"= {text}"


def _counted(counter: Counter[str]) -> str:
    return ", ".join(f"{count} {name}" for name, count in counter.most_common())


def _titled(label: str, text: str) -> list[str]:
    return textwrap.wrap(
        text,
        WIDTH,
        initial_indent=f"{label:{_LABEL}}",
        subsequent_indent=" " * _LABEL,
        break_long_words=False,
        break_on_hyphens=False,
    )


def _family_of(name: str) -> str:
    """What stands before the number of a frozen case's id; the whole of any other name."""
    family, _, number = name.rpartition("-")
    return family if number.isdecimal() else name


def _hint(family: str) -> str:
    if family == refusals.NAME:
        return f"the last one is {vectors.load_refusals().cases[-1].id}"
    if family in vectors.NAMES:
        file: VectorFile = vectors.load(family)
        return f"the last one is {file.cases[-1].id}"
    return advice(family, (*vectors.NAMES, refusals.NAME))
