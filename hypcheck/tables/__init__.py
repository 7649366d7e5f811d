"""Tables of rows and of answers: which files they are, and in which format."""

from __future__ import annotations

import os
from dataclasses import dataclass

from hypcheck.errors import InputError

STREAM = "-"
"""The name that means standard input or standard output."""

FORMATS = ("csv", "jsonl", "npy")


@dataclass(frozen=True, slots=True)
class Route:
    """The file of a table and its format, and the file of its answers and its format; "-" means a standard stream."""

    source: str
    source_format: str
    target: str
    target_format: str


def route(source: str, target: str, stated: str | None) -> Route:
    """Find the formats of `source` and `target`; `stated` is the format of names without a known ending.

    Raises InputError if a format is unknown, or the two do not fit: text keeps its format, .npy can become any format,
    and any format can become .npy, which holds only the positions.
    """
    source_format = _format_of_name(source) or stated
    if source_format is None:
        raise InputError(
            f"--input {source}: its name must end in .csv, .jsonl or .npy, or --format must name one of them"
        )
    target_format = _format_of_name(target) or stated or (source_format if target == STREAM else None)
    if target_format is None:
        raise InputError(
            f"--output {target}: its name must end in .csv, .jsonl or .npy, or --format must name one of them"
        )
    if stated is not None and stated not in (source_format, target_format):
        raise InputError(f"--format {stated} contradicts the names {source} and {target}; leave it out")
    if source_format != target_format and "npy" not in (source_format, target_format):
        raise InputError(
            f"{source_format} cannot become {target_format}, because the text of other columns is copied; "
            f"--output must be {source_format} too, or npy"
        )
    return Route(source, source_format, target, target_format)


def _format_of_name(path: str) -> str | None:
    """Return the format that the end of a name says; None if it says none."""
    end = os.path.splitext(path)[1].lower().removeprefix(".")
    return end if path != STREAM and end in FORMATS else None
