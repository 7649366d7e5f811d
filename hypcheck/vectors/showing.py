"""Cases as text for people, and rows of a family generated for other programs as JSON, CSV or npy."""

from __future__ import annotations

import io
import textwrap
from collections import Counter
from collections.abc import Callable, Iterator

import numpy as np

from hypcheck.errors import InputError
from hypcheck.geometry.pair import COLUMNS, TILTED_COLUMNS, TILTED_WAY_COLUMNS, Position
from hypcheck.geometry.rows import WAYS
from hypcheck.messages import counted, suggestion
from hypcheck.tables.numbers import hex_of, readable_text
from hypcheck.tables.streams import writing
from hypcheck.tables.strict_json import read_document
from hypcheck.truth.tilted.exact import Bracket
from hypcheck.vectors import frozen
from hypcheck.vectors.families import EXTREME, case_id, family_of, select
from hypcheck.vectors.family import Family, Metadata, Vector, VectorFile
from hypcheck.vectors.flags import FLAGS, TILTED_FLAGS, WAY_FLAGS
from hypcheck.vectors.format import content_of, read_metadata, vector_text
from hypcheck.vectors.frozen import AnyVector, InvalidRow, InvalidRowFile, VectorsFile
from hypcheck.vectors.tilted.format import TiltedVector, TiltedVectorFile, tilted_vector_text
from hypcheck.vectors.ways.format import WayFile, WayVector, way_text

SHOWN = (
    *frozen.NAMES,
    frozen.INVALID_NAME,
    *frozen.TILTED_NAMES,
    frozen.TILTED_INVALID_NAME,
    *frozen.WAY_NAMES,
    *frozen.INVALID_NAMES[WAYS],
)
"""The files, in the order in which they are listed."""

WIDTH = 100
"""Columns of a line of running text."""

_LABEL = 12


def list_lines() -> Iterator[str]:
    """Every set of vectors: its name, how many are frozen, and what it is."""
    width, together = max(map(len, SHOWN)), 0
    for name in SHOWN:
        path = str(frozen.path_of(name))
        document = read_document(path)  # of the cases the number alone is asked for
        head, _ = read_metadata(document, path, content_of(document, path))
        together += len(document.cases)
        mark = " (extreme: taken when asked for)" if head.extreme else ""
        yield f"{name:{width}}  {len(document.cases):4}  {head.title}{mark}"
    yield f"{'together':{width}}  {together:4}"


def _load(name: str) -> VectorsFile | InvalidRowFile:
    return frozen.load_invalid_rows(name) if name in frozen.INVALID_CONTENTS else frozen.load_any(name)


def family_lines(name: str) -> Iterator[str]:
    """What is known of a family, and its frozen cases counted."""
    file = _load(name)
    refused = ", all to be refused" if isinstance(file, InvalidRowFile) else ""
    yield from _metadata_lines(file.head)
    yield from _titled("cases", f"{len(file.cases)}, {file.cases[0].id} to {file.cases[-1].id}{refused}")
    if isinstance(file, InvalidRowFile):
        return
    if isinstance(file, WayFile):
        yield from _titled("answers", _counted(Counter("contact" if case.hit else "clear" for case in file.cases)))
    else:
        yield from _titled("positions", _counted(Counter(case.position.label for case in file.cases)))
    if isinstance(file, VectorFile):
        yield from _titled("kinds", _counted(Counter(case.kind.value for case in file.cases)))
    for flag, facts in file.flags.items():
        count = sum(flag in case.flags for case in file.cases)
        yield from _titled("flag", f"{flag}, {count} times: {facts.meaning} ({facts.bug_type})")


def case_lines(case: AnyVector) -> Iterator[str]:
    """A case with its labels and its proof."""
    if isinstance(case, WayVector):
        yield from _way_lines(case)
        return
    tilted = isinstance(case, TiltedVector)
    yield case.id
    for name, value in zip(TILTED_COLUMNS if tilted else COLUMNS, case.row, strict=True):
        yield f"{name:{_LABEL}}{value!r:24}{hex_of(value)}"
    yield from _titled("position", f"{case.position.label}, tangent" if case.tangent else case.position.label)
    if not isinstance(case, TiltedVector):
        yield from _titled("kind", f"{case.kind.value}: {case.kind.description}")
    yield from _titled("clearance", f"{case.clearance!r} spheroid radii ({hex_of(case.clearance)})")
    for position, distance in case.flips.items():
        yield from _titled("flip", f"{position.label} if each number may change by a relative {_distance(distance)}")
    yield from _titled("proof", _tilted_proof(case) if isinstance(case, TiltedVector) else _proof(case))
    for flag in case.flags:
        yield from _titled("flag", f"{flag}: {(TILTED_FLAGS if tilted else FLAGS)[flag].meaning}")


def _way_lines(case: WayVector) -> Iterator[str]:
    yield case.id
    for name, value in zip(TILTED_WAY_COLUMNS, case.row, strict=False):
        yield f"{name:{_LABEL}}{value!r:24}{hex_of(value)}"
    yield from way_answer_lines(case)
    for flag in case.flags:
        yield from _titled("flag", f"{flag}: {WAY_FLAGS[flag].meaning}")


def way_answer_lines(case: WayVector) -> Iterator[str]:
    """The answer about a way, and its proof."""
    yield from _titled("answer", "contact on the way" if case.hit else "clear all along")
    if case.first is not None:
        yield from _titled("first", f"contact at t from {case.first[0]!r} to {case.first[1]!r}")
    pieces = case.witness.pieces
    if pieces:
        until = readable_text(pieces[-1][1])
        yield from _titled("proof", f"clear up to t {_said(until)}, by {counted(len(pieces), 'multiplier')}")
    if case.witness.time is not None:
        proof = "a double root" if case.witness.double_root is not None else "points"
        yield from _titled("proof", f"contact at t {_said(readable_text(case.witness.time))}, by {proof}")


def _distance(distance: float | Bracket) -> str:
    if isinstance(distance, float):
        return repr(distance)
    return repr(distance.upper) if distance.lower == distance.upper else f"{distance.lower!r} … {distance.upper!r}"


def invalid_row_lines(case: InvalidRow, names: tuple[str, ...]) -> Iterator[str]:
    """A row of numbers of these names that must be refused, and where it is at fault."""
    yield case.id
    for name, value, bits in zip(names, case.row, case.bits, strict=True):
        yield f"{name:{_LABEL}}{value!r:24}{bits:016x}{'  at fault' if name in case.columns else ''}"
    yield from _titled("expected", frozen.EXPECTED)


def vector_of(name: str) -> AnyVector:
    """The case of that id, frozen or generated. Raises InputError where there is none."""
    if "/" in name:
        return _generated(name)
    file = _load(_family_of(name)) if _family_of(name) in SHOWN else None
    if isinstance(file, VectorFile | TiltedVectorFile | WayFile):
        for case in file.cases:
            if case.id == name:
                return case
    raise InputError(f"there is no case or family {name!r}; {_hint(_family_of(name))}")


def invalid_row_of(name: str) -> InvalidRow:
    """The row to be refused that has that id. Raises InputError where there is none."""
    family = _family_of(name)
    for case in frozen.load_invalid_rows(family).cases if family in frozen.INVALID_CONTENTS else ():
        if case.id == name:
            return case
    raise InputError(f"there is no case {name!r}; {_hint(family)}")


def show(name: str, *, as_json: bool) -> Iterator[str]:
    """The lines about a family or a case; a case as it stands in a file where JSON is asked for. Raises InputError."""
    if name in SHOWN:
        if as_json:
            yield from frozen.path_of(name).read_text(encoding="utf-8").splitlines()
        else:
            yield from family_lines(name)
    elif _family_of(name) in frozen.INVALID_CONTENTS:
        bad, columns = invalid_row_of(name), frozen.load_invalid_rows(_family_of(name)).columns
        yield from (frozen.invalid_row_text(bad),) if as_json else invalid_row_lines(bad, columns)
    else:
        case = vector_of(name)
        yield from (_json_text(case),) if as_json else case_lines(case)


def _json_text(case: AnyVector) -> str:
    if isinstance(case, WayVector):
        return way_text(case)
    return tilted_vector_text(case) if isinstance(case, TiltedVector) else vector_text(case)


def _generated(name: str) -> AnyVector:
    from hypcheck.vectors.freezing import generated_case  # noqa: PLC0415 - frozen cases are shown without the oracles

    return generated_case(name)


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


def _tilted_proof(case: TiltedVector) -> str:
    witness = case.witness
    if witness.multiplier is not None:
        return f"S + λH is positive definite at λ {_said(readable_text(witness.multiplier))}"
    if witness.double_root is not None:
        return f"det(S + λH) has the double root λ {_said(readable_text(witness.double_root))}, M + λD ≥ 0 there"
    points = " and ".join(f"({', '.join(map(readable_text, point))})" for point in witness.offsets)
    where = "on the surface" if len(witness.offsets) == 1 else "on both sides of the surface"
    return f"in the spheroid and {where}: the centre + b (s, t, w) for (s, t, w) = {points}"


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
    if family in SHOWN:
        return f"the last one is {_load(family).cases[-1].id}"
    return suggestion(family, SHOWN)


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
    from hypcheck.vectors.freezing import generated_text  # noqa: PLC0415 - bare rows need no oracles

    return generated_text(family, seed, count).encode()


def as_csv(family: Family, seed: int, count: int) -> bytes:
    """A table of ids and rows, as `hypcheck classify --input` takes it."""
    lines = [",".join(("id", *family.columns))]
    quote = '"' if "," in family.name else ""  # the names of families for given sizes have commas
    for index, row in enumerate(family.rows(seed, count).tolist()):
        lines.append(",".join((f"{quote}{case_id(family, seed, index)}{quote}", *map(repr, row))))
    return ("\n".join(lines) + "\n").encode()


def as_npy(family: Family, seed: int, count: int) -> bytes:
    """The rows alone, little-endian float64."""
    file = io.BytesIO()
    np.lib.format.write_array(file, family.rows(seed, count).astype("<f8"), version=(1, 0))
    return file.getvalue()


FORMATS: dict[str, Callable[[Family, int, int], bytes]] = {"json": as_json, "csv": as_csv, "npy": as_npy}
