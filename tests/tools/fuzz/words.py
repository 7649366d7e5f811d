"""Input in words: descriptions, numbers, names of cases, whole command lines."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Callable

from hypcheck.cli.main import main
from hypcheck.cli.options import bytes_of
from hypcheck.errors import InputError
from hypcheck.geometry.rows import as_rows
from hypcheck.implementations.description import Description, described_by_json, parse_domain
from hypcheck.implementations.spec import parse_spec
from hypcheck.runs.replay import case_of
from hypcheck.tables.numbers import number_of_text
from hypcheck.vectors.families import parse_case_id, select
from hypcheck.vectors.showing import show
from tests.tools.fuzz import seeds
from tests.tools.fuzz.judging import require_sentence
from tests.tools.fuzz.workplace import at_home

LONGEST = 1 << 17
"""Bytes of an argument, of which Linux takes no more."""


def word(data: bytes) -> str:
    """As Python has the arguments of a command line."""
    return data[:LONGEST].decode("utf-8", "surrogateescape")


def _also(call: Callable[[], object]) -> None:
    """Read by another reader as well; that it refuses is no end of the matter."""
    try:
        call()
    except InputError as error:
        require_sentence(str(error))


def description(data: bytes) -> None:
    """What an implementation says of itself."""
    found = described_by_json(data, Description(name=""), ("protocol", "name"))
    found.domain.holds(as_rows(seeds.ROWS))
    for text in (found.name, found.version, found.language):
        require_sentence(text or "-")


def domain(data: bytes) -> None:
    """What --domain says."""
    parse_domain(word(data)).holds(as_rows(seeds.ROWS))


def number(data: bytes) -> None:
    """A length, and a size of memory."""
    _also(lambda: bytes_of(word(data)))
    try:
        number_of_text("alpha", word(data))
    except ValueError as error:  # the end of a sentence
        raise InputError(str(error)) from None


def spec(data: bytes) -> None:
    """Where an implementation is."""
    require_sentence(str(parse_spec(word(data))))


def case(data: bytes) -> None:
    """A case's name, and what else it might be."""
    text = word(data)
    _also(lambda: parse_case_id(text))
    _also(lambda: select(text.split(",")))
    _also(lambda: list(show(text, as_json=False)))
    with at_home():
        case_of(text)


def arguments(data: bytes) -> None:
    """A whole command line: an answer, or 2 and one sentence on standard error."""
    words = [each for each in word(data).split("\n") if "\0" not in each]
    out, err = (io.TextIOWrapper(io.BytesIO(), encoding="utf-8") for _ in range(2))
    with at_home(), contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = main(["--no-settings", *words])
    err.flush()
    said = err.buffer.getvalue().decode()
    assert code in (0, 1, 2, 5), (code, said)
    if code == 2:
        first, *more = said.splitlines()
        assert first.startswith("hypcheck: error: "), said
        assert len(more) <= 1, said
        raise InputError(first)
