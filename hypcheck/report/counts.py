"""What no schema can say of a line: that its bins and octaves are places on a scale, and hold no more than they can."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from hypcheck.bins import FARTHEST
from hypcheck.record import Line
from hypcheck.visible import shortened

_OCTAVE = re.compile(r"-?\d{1,4}|-?inf", re.ASCII)


def trouble_with(line: Line) -> str | None:
    """What is wrong with the counts of a line that fits its schema; None where nothing is."""
    checks = {"group": _of_group, "accuracy": _of_accuracy, "bounding": _of_bounding}
    check = checks.get(line["type"])
    return next(check(line), None) if check else None


def _of_group(line: Line) -> Iterator[str]:
    for octave in line["octaves"]:
        if not _OCTAVE.fullmatch(octave):
            yield f"octaves has {shortened(repr(octave), 20)}, which is neither a small whole number nor inf or -inf"
    for field in ("size_bins", "place_bins"):
        for number, (across, up, asked, wrong) in enumerate(line[field]):
            yield from _of_places((across, up), f"{field}[{number}]")
            yield from _of_counts(asked, wrong, f"{field}[{number}]")


def _of_accuracy(line: Line) -> Iterator[str]:
    for number, (octave, asked, wrong) in enumerate(line["octaves"]):
        where = f"octaves[{number}]"
        yield from _of_places(() if octave == "-inf" else (octave,), where)
        if isinstance(asked, str) or isinstance(wrong, str):
            yield f"{where} has a count that is no number"
        else:
            yield from _of_counts(asked, wrong, where)


def _of_bounding(line: Line) -> Iterator[str]:
    for number, (ratio, asked, wrong, _) in enumerate(line["overlap"]):
        if None in (ratio, asked, wrong):
            yield f"overlap[{number}] has null where only its last number may be that"
        else:
            yield from _of_counts(asked, wrong, f"overlap[{number}]")


def _of_places(places: Sequence[int], where: str) -> Iterator[str]:
    for place in places:
        if abs(place) > FARTHEST:
            yield f"{where} is at {_short(place)}; it must be between −{FARTHEST} and {FARTHEST}"


def _of_counts(asked: int, wrong: int, where: str) -> Iterator[str]:
    if not 0 <= wrong <= asked:
        yield f"{where} has {_short(wrong)} wrong answers of {_short(asked)}"


def _short(number: int) -> str:
    return shortened(str(number), 20)
