"""Cases as text for people, and rows of a family generated for other programs as JSON, CSV or npy."""

from __future__ import annotations

import io
import textwrap
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from itertools import chain, repeat

import numpy as np

from hypcheck.answer import kind_as_text
from hypcheck.errors import InputError
from hypcheck.geometry.pair import Pair
from hypcheck.messages import suggestion
from hypcheck.proof_text import passage_proof_lines, proof_lines
from hypcheck.tables.numbers import hex_of
from hypcheck.tables.streams import open_input, replace_output
from hypcheck.tables.strict_json import read_document
from hypcheck.truth.backward_error import Bracket
from hypcheck.vectors import frozen
from hypcheck.vectors.cases import Vector, case_text
from hypcheck.vectors.draw import Family
from hypcheck.vectors.families import ALL, EXTREME, case_id, family_of, select
from hypcheck.vectors.format import Content, Metadata, read_metadata
from hypcheck.vectors.freezing import generated_case, generated_text
from hypcheck.vectors.frozen import ALL_NAMES
from hypcheck.vectors.invalid_rows import EXPECTED, InvalidRow

WIDTH = 100
"""Columns of a line of running text."""

_LABEL = 12


def list_lines() -> Iterator[str]:
    """Yield a line for every set of vectors: its name, its number of frozen vectors, and its title."""
    width, together = max(map(len, ALL_NAMES)), 0
    for name in ALL_NAMES:
        path = str(frozen.path_of(name))
        document = read_document(path)  # only the number of cases is needed
        head, _ = read_metadata(document)
        together += len(document.cases)
        mark = " (extreme: taken when asked for)" if head.extreme else ""
        yield f"{name:{width}}  {len(document.cases):4}  {head.title}{mark}"
    yield f"{'together':{width}}  {together:4}"


def family_lines(name: str) -> Iterator[str]:
    """Yield the description of a family, and the numbers of its frozen cases."""
    file = frozen.load(name)
    refused = ", all to be refused" if file.content.refused else ""
    yield from _metadata_lines(file.head)
    yield from _titled("cases", f"{len(file.cases)}, {file.cases[0].id} to {file.cases[-1].id}{refused}")
    if file.content.refused:
        return
    if file.content.about_sweeps:
        yield from _titled("answers", _counted("contact" if case.hit else "clear" for case in file.cases))
    else:
        yield from _titled("positions", _counted(case.position.label for case in file.cases))
        if not file.content.tilted and not file.content.ended:
            yield from _titled("kinds", _counted(case.kind.value for case in file.cases))
    for flag, facts in file.flags.items():
        count = sum(flag in case.flags for case in file.cases)
        yield from _titled("flag", f"{flag}, {count} times: {facts.meaning} ({facts.bug_type})")


def case_lines(case: Vector | InvalidRow, content: Content) -> Iterator[str]:
    """Yield a case of a file with that content, with its labels and its proof."""
    yield case.id
    if isinstance(case, InvalidRow):
        for name, value, bits in zip(content.columns, case.row, case.bits, strict=True):
            yield f"{name:{_LABEL}}{value!r:24}{bits:016x}{'  at fault' if name in case.columns else ''}"
        yield from _titled("expected", EXPECTED)
        return
    for name, value in zip(content.columns, case.row, strict=True):
        yield f"{name:{_LABEL}}{value!r:24}{hex_of(value)}"
    yield from (_sweep_lines if content.about_sweeps else _position_lines)(case)
    for label, line in zip(chain(["proof"], repeat("")), _proof(case, content), strict=False):
        yield f"{label:{_LABEL}}{line}"
    for flag in case.flags:
        yield from _titled("flag", f"{flag}: {content.flags[flag].meaning}")


def _position_lines(case: Vector) -> Iterator[str]:
    """Yield the labels of a case about a position."""
    yield from _titled("position", f"{case.position.label}, tangent" if case.tangent else case.position.label)
    if case.kind is not None:
        yield from _titled("kind", kind_as_text(case.kind))
    if case.clearance is not None:
        yield from _titled("clearance", f"{case.clearance!r} spheroid radii ({hex_of(case.clearance)})")
    for position, distance in case.flips.items():
        yield from _titled("flip", f"{position.label} if each number may change by a relative {_distance(distance)}")


def _sweep_lines(case: Vector) -> Iterator[str]:
    """Yield the labels of a case about a sweep."""
    yield from _titled("answer", "contact on the sweep" if case.hit else "clear all along")
    if case.first is not None:
        yield from _titled("first", f"contact at t from {case.first[0]!r} to {case.first[1]!r}")


def _proof(case: Vector, content: Content) -> Iterable[str]:
    """Return the lines of the proof as `hypcheck classify` prints them."""
    if not content.about_sweeps:
        return proof_lines(Pair.from_row(case.row), case.certificate)
    return passage_proof_lines(None if content.ended else case.passage_certificate, ended=content.ended)


def _distance(distance: Bracket) -> str:
    """Write a flip distance, as one number if both ends are equal."""
    return repr(distance.upper) if distance.lower == distance.upper else f"{distance.lower!r} … {distance.upper!r}"


def case_named(name: str) -> tuple[Vector | InvalidRow, Content]:
    """Return the case with that id, frozen or generated, and the content of its file. Raises InputError."""
    if "/" in name:
        return generated_case(name)
    family = _family_of(name)
    if family in ALL and family not in ALL_NAMES:
        raise InputError(f"{family} has no frozen cases; 'hypcheck cases generate {family}' makes rows of it")
    if family not in ALL_NAMES:
        raise InputError(f"there is no case or family {name!r}; {suggestion(family, ALL_NAMES)}")
    file = frozen.load(family)
    for case in file.cases:
        if case.id == name:
            return case, file.content
    raise InputError(f"there is no case {name!r}; the last one is {file.cases[-1].id}")


def show(name: str, *, as_json: bool) -> Iterator[str]:
    """Yield the lines about a family or a case; with `as_json` a case as in a vector file. Raises InputError."""
    if name not in ALL_NAMES:
        case, content = case_named(name)
        yield from (case_text(case, content),) if as_json else case_lines(case, content)
    elif as_json:
        with open_input(str(frozen.path_of(name))) as file:
            yield from file.read().decode().splitlines()
    else:
        yield from family_lines(name)


def _metadata_lines(head: Metadata) -> Iterator[str]:
    """Yield the metadata of a file as text."""
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


def _counted(names: Iterable[str]) -> str:
    """Write how often each name occurs, the most frequent first."""
    return ", ".join(f"{count} {name}" for name, count in Counter(names).most_common())


def _titled(label: str, text: str) -> list[str]:
    """Wrap a text behind a label in the first column."""
    return textwrap.wrap(
        text,
        WIDTH,
        initial_indent=f"{label:{_LABEL}}",
        subsequent_indent=" " * _LABEL,
        break_long_words=False,
        break_on_hyphens=False,
    )


def _family_of(name: str) -> str:
    """Return the part of a frozen case's id before the number; any other name unchanged."""
    family, _, number = name.rpartition("-")
    return family if number.isdecimal() else name


def generate(name: str, seed: int, count: int, form: str, target: str) -> None:
    """Write the first `count` rows of a family's seed to `target` ("-" is standard output) in one of FORMATS.

    The bytes are the same on every machine. Raises InputError if there is no such family, or `target` cannot be
    written.
    """
    data = FORMATS[form](_family_to_generate(name), seed, count)
    with replace_output(target) as writer:
        writer.write(data)


def _family_to_generate(name: str) -> Family:
    """Return the family of that name. Raises InputError, for a pattern too."""
    if name == EXTREME or any(mark in name for mark in "*?["):
        raise InputError(f"{name!r} is a pattern; name one family, such as {select([name])[0].name}")
    return family_of(name)


def as_json(family: Family, seed: int, count: int) -> bytes:
    """Return a vector file whose cases have generated ids."""
    return generated_text(family, seed, count).encode()


def as_csv(family: Family, seed: int, count: int) -> bytes:
    """Return a table of ids and rows, as `hypcheck classify --input` takes it."""
    lines = [",".join(("id", *family.columns))]
    quote = '"' if "," in family.name else ""  # the names of families for fixed sizes have commas
    for index, row in enumerate(family.rows(seed, count).tolist()):
        lines.append(",".join((f"{quote}{case_id(family, seed, index)}{quote}", *map(repr, row))))
    return ("\n".join(lines) + "\n").encode()


def as_npy(family: Family, seed: int, count: int) -> bytes:
    """Return the rows alone as a .npy file of little-endian float64."""
    file = io.BytesIO()
    np.lib.format.write_array(file, family.rows(seed, count).astype("<f8"), version=(1, 0))
    return file.getvalue()


FORMATS: dict[str, Callable[[Family, int, int], bytes]] = {"json": as_json, "csv": as_csv, "npy": as_npy}
