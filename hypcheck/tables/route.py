"""From which file to which, and the format of each: by its name, or by the caller's word where the name is silent."""

from __future__ import annotations

import os
from dataclasses import dataclass

from hypcheck.errors import InputError

STREAM = "-"
"""The name that means standard input or standard output."""

FORMATS = ("csv", "jsonl", "npy")


@dataclass(frozen=True, slots=True)
class Route:
    """A table's file and its format, and those of its answers; "-" for the standard streams."""

    source: str
    source_format: str
    target: str
    target_format: str


def route(source: str, target: str, said: str | None) -> Route:
    """The route from `source` to `target`, `said` being the format of those whose names do not tell.

    Raises InputError where a format is unknown, or the two do not go together: text keeps its format, .npy becomes
    any, and anything becomes .npy (positions alone).
    """
    source_format = _of_name(source) or said
    if source_format is None:
        raise InputError(
            f"--input {source}: its name tells no format; say --format {', '.join(FORMATS[:-1])} or {FORMATS[-1]}"
        )
    target_format = _of_name(target) or said or (source_format if target == STREAM else None)
    if target_format is None:
        raise InputError(f"--output {target}: its name must end in .csv, .jsonl or .npy, or --format must tell")
    if said is not None and said not in (source_format, target_format):
        raise InputError(f"--format {said} contradicts the names {source} and {target}; leave it out")
    if source_format != target_format and "npy" not in (source_format, target_format):
        raise InputError(
            f"{source_format} cannot become {target_format}, since other columns are passed through as they stand; "
            f"--output must be {source_format} too, or npy"
        )
    return Route(source, source_format, target, target_format)


def _of_name(path: str) -> str | None:
    end = os.path.splitext(path)[1].lower().removeprefix(".")
    return end if path != STREAM and end in FORMATS else None
