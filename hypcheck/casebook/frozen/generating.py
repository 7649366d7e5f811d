"""Rows of a family for other programs: labelled and proved as JSON, or as bare numbers."""

from __future__ import annotations

import io
from collections.abc import Callable

import numpy as np

from hypcheck.casebook.families import EXTREME, case_id, family_of, select
from hypcheck.casebook.family import Family
from hypcheck.errors import InputError
from hypcheck.pairs import COLUMNS
from hypcheck.tables.streams import writing


def generate(name: str, seed: int, count: int, form: str, target: str) -> None:
    """Write the first `count` rows of a family's seed to `target` ("-" is standard output) in one of FORMATS.

    The same bytes on every machine. Raises InputError where there is no such family, or `target` cannot be written.
    """
    data = FORMATS[form](_family(name), seed, count)
    with writing(target) as writer:
        writer.write(data)


def _family(name: str) -> Family:
    if name == EXTREME or any(mark in name for mark in "*?["):
        raise InputError(f"{name!r} is a pattern; name one family, such as {select([name])[0].name}")
    return family_of(name)


def as_json(family: Family, seed: int, count: int) -> bytes:
    """A vector file whose cases have generated ids."""
    from hypcheck.casebook.frozen.freezing import assembled, head_of  # noqa: PLC0415 - bare rows need no oracles
    from hypcheck.casebook.frozen.labels import labelled  # noqa: PLC0415
    from hypcheck.casebook.frozen.writing import vectors_text  # noqa: PLC0415

    rows = family.rows(seed, count).tolist()
    cases = labelled((case_id(family, seed, index), tuple(row)) for index, row in enumerate(rows))
    made_by = f"hypcheck cases generate {family.name} --seed {seed} --count {count}"
    return vectors_text(assembled(head_of(family, made_by), cases)).encode()


def as_csv(family: Family, seed: int, count: int) -> bytes:
    """A table of ids and rows, as `hypcheck classify --input` takes it."""
    lines = [",".join(("id", *COLUMNS))]
    quote = '"' if "," in family.name else ""  # the names of families for given sizes have commas
    for index, row in enumerate(family.rows(seed, count).tolist()):
        lines.append(",".join((f"{quote}{case_id(family, seed, index)}{quote}", *map(repr, row))))
    return ("\n".join(lines) + "\n").encode()


def as_npy(family: Family, seed: int, count: int) -> bytes:
    """The rows alone, little-endian float64 (n, 7)."""
    file = io.BytesIO()
    np.lib.format.write_array(file, family.rows(seed, count).astype("<f8"), version=(1, 0))
    return file.getvalue()


FORMATS: dict[str, Callable[[Family, int, int], bytes]] = {"json": as_json, "csv": as_csv, "npy": as_npy}
