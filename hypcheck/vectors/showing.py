"""Cases as text for people, and rows of a family generated for other programs as JSON, CSV or npy."""

from __future__ import annotations

import io
import textwrap
from collections import Counter
from collections.abc import Callable, Iterator

import numpy as np

from hypcheck.errors import InputError
from hypcheck.geometry.pair import COLUMNS, Position
from hypcheck.messages import suggestion
from hypcheck.tables.numbers import hex_of, readable_text
from hypcheck.tables.streams import writing
from hypcheck.vectors import frozen
from hypcheck.vectors.families import EXTREME, case_id, family_of, parse_case_id, select
from hypcheck.vectors.family import BLOCK, Family, Metadata, Vector, VectorFile
from hypcheck.vectors.flags import FLAGS
from hypcheck.vectors.format import vector_text
from hypcheck.vectors.frozen import InvalidRow

WIDTH = 100
"""Columns of a line of running text."""

_LABEL = 12


def list_lines() -> Iterator[str]:
    """Every set of vectors: its name, how many are frozen, and what it is."""
    files = {name: (frozen.load(name).head, len(frozen.load(name).cases)) for name in frozen.NAMES}
    bad = frozen.load_invalid_rows()
    files[frozen.INVALID_NAME] = (bad.head, len(bad.cases))
    width = max(map(len, files))
    for name, (head, count) in files.items():
        mark = " (extreme: taken when asked for)" if head.extreme else ""
        yield f"{name:{width}}  {count:4}  {head.title}{mark}"
    yield f"{'together':{width}}  {sum(count for _, count in files.values()):4}"


def family_lines(name: str) -> Iterator[str]:
    """What is known of a family, and its frozen cases counted."""
    if name == frozen.INVALID_NAME:
        bad = frozen.load_invalid_rows()
        yield from _metadata_lines(bad.head)
        yield from _titled("cases", f"{len(bad.cases)}, {bad.cases[0].id} to {bad.cases[-1].id}, all to be refused")
        return
    file = frozen.load(name)
    yield from _metadata_lines(file.head)
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


def invalid_row_lines(case: InvalidRow) -> Iterator[str]:
    """A row that must be refused, and where it is at fault."""
    yield case.id
    for name, value, bits in zip(COLUMNS, case.row, case.bits, strict=True):
        yield f"{name:{_LABEL}}{value!r:24}{bits:016x}{'  at fault' if name in case.columns else ''}"
    yield from _titled("expected", frozen.EXPECTED)


def vector_of(name: str) -> Vector:
    """The case of that id, frozen or generated. Raises InputError where there is none."""
    if "/" in name:
        return _generated(name)
    family = _family_of(name)
    if family in frozen.NAMES:
        for case in frozen.load(family).cases:
            if case.id == name:
                return case
    raise InputError(f"there is no case or family {name!r}; {_hint(family)}")


def invalid_row_of(name: str) -> InvalidRow:
    """The row to be refused that has that id. Raises InputError where there is none."""
    for case in frozen.load_invalid_rows().cases:
        if case.id == name:
            return case
    raise InputError(f"there is no case {name!r}; {_hint(frozen.INVALID_NAME)}")


def show(name: str, *, as_json: bool) -> Iterator[str]:
    """The lines about a family or a case; a case as it stands in a file where JSON is asked for. Raises InputError."""
    if name in frozen.NAMES or name == frozen.INVALID_NAME:
        if as_json:
            yield from frozen.path_of(name).read_text(encoding="utf-8").splitlines()
        else:
            yield from family_lines(name)
    elif _family_of(name) == frozen.INVALID_NAME:
        bad = invalid_row_of(name)
        yield from (frozen.invalid_row_text(bad),) if as_json else invalid_row_lines(bad)
    else:
        case = vector_of(name)
        yield from (vector_text(case),) if as_json else case_lines(case)


def _generated(name: str) -> Vector:
    from hypcheck.vectors.labels import labelled  # noqa: PLC0415 - frozen cases are shown without the oracles

    case = parse_case_id(name)
    block, place = divmod(case.index, BLOCK)
    row = tuple(case.family.block(case.seed, block)[place].tolist())
    return labelled([(case_id(case.family, case.seed, case.index), row)])[0]


def _metadata_lines(head: Metadata) -> Iterator[str]:
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
        return f"g(λ) > 0 at λ {_said(readable_text(witness.multiplier))} in {interval}"
    if witness.double_root is not None:
        return f"g has the double root m {_said(readable_text(witness.double_root))}"
    points = " and ".join(f"({', '.join(map(readable_text, point))})" for point in witness.offsets)
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
    if family == frozen.INVALID_NAME:
        return f"the last one is {frozen.load_invalid_rows().cases[-1].id}"
    if family in frozen.NAMES:
        file: VectorFile = frozen.load(family)
        return f"the last one is {file.cases[-1].id}"
    return suggestion(family, (*frozen.NAMES, frozen.INVALID_NAME))


def generate(name: str, seed: int, count: int, form: str, target: str) -> None:
    """Write the first `count` rows of a family's seed to `target` ("-" is standard output) in one of FORMATS.

    The same bytes on every machine. Raises InputError where there is no such family, or `target` cannot be written.
    """
    data = FORMATS[form](_family_to_generate(name), seed, count)
    with writing(target) as writer:
        writer.write(data)


def _family_to_generate(name: str) -> Family:
    if name == EXTREME or any(mark in name for mark in "*?["):
        raise InputError(f"{name!r} is a pattern; name one family, such as {select([name])[0].name}")
    return family_of(name)


def as_json(family: Family, seed: int, count: int) -> bytes:
    """A vector file whose cases have generated ids."""
    from hypcheck.vectors.format import vectors_text  # noqa: PLC0415
    from hypcheck.vectors.freezing import assembled, metadata_of  # noqa: PLC0415 - bare rows need no oracles
    from hypcheck.vectors.labels import labelled  # noqa: PLC0415

    if family.tilted:
        raise InputError(f"{family.name} has tilted spheroids, whose labels no file holds yet; use csv or npy")
    rows = family.rows(seed, count).tolist()
    cases = labelled((case_id(family, seed, index), tuple(row)) for index, row in enumerate(rows))
    made_by = f"hypcheck cases generate {family.name} --seed {seed} --count {count}"
    return vectors_text(assembled(metadata_of(family, made_by), cases)).encode()


def as_csv(family: Family, seed: int, count: int) -> bytes:
    """A table of ids and rows, as `hypcheck classify --input` takes it."""
    lines = [",".join(("id", *family.columns))]
    quote = '"' if "," in family.name else ""  # the names of families for given sizes have commas
    for index, row in enumerate(family.rows(seed, count).tolist()):
        lines.append(",".join((f"{quote}{case_id(family, seed, index)}{quote}", *map(repr, row))))
    return ("\n".join(lines) + "\n").encode()


def as_npy(family: Family, seed: int, count: int) -> bytes:
    """The rows alone, little-endian float64 (n, 7 or 10)."""
    file = io.BytesIO()
    np.lib.format.write_array(file, family.rows(seed, count).astype("<f8"), version=(1, 0))
    return file.getvalue()


FORMATS: dict[str, Callable[[Family, int, int], bytes]] = {"json": as_json, "csv": as_csv, "npy": as_npy}
