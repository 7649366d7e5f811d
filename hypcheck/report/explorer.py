"""What the explorer of the page shows: the formulas as lists of steps, the row it begins with, and pictures of cases.

The script templates/explorer.js decides and draws. It runs the same programs that are proved and printed, step by step.
"""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from hypcheck.derivation.formulas import FORMULAS, REPAIRED
from hypcheck.derivation.program import needed
from hypcheck.geometry.pair import COLUMNS, trouble_with_row
from hypcheck.report.messages import short_row

ON_THE_RING = (1.0, 2.0, 1.0, 1.0, 2.5, 0.0, 0.0)
"""A row whose centre lies on the ring: exterior, with half a radius to the wall, and Δ is exactly 0."""

WIDTH, HEIGHT = 96.0, 64.0
"""The size of a small picture, in its own units."""

_STEEPEST = 1e300
"""A limit of the scale, so that no place in a picture is infinity times zero."""

_POINTS = 16
"""Straight pieces of the meridian in a small picture."""


@dataclass(frozen=True, slots=True)
class _Frame:
    """The part of the half plane that a small picture shows: its middle, and its units for one length across and up."""

    r: float
    z: float
    wide: float
    tall: float

    @classmethod
    def around(cls, r: float, z: float, b: float, d: float) -> _Frame:
        """The frame around a spheroid; heights have a scale of their own where it would be too thin to be seen."""
        wide, tall = min(WIDTH / 4 / b, _STEEPEST), min(HEIGHT / 4 / d, _STEEPEST)
        least = min(wide, tall)
        return cls(r, z, wide, tall) if max(wide, tall) > 4 * least else cls(r, z, least, least)

    def across(self, r: float) -> float:
        """The place of a distance from the axis, at most a picture beside the picture."""
        return _limited(WIDTH / 2 + (r - self.r) * self.wide, WIDTH)

    def up(self, z: float) -> float:
        """The place of a height."""
        return _limited(HEIGHT / 2 - (z - self.z) * self.tall, HEIGHT)


def _limited(place: float, size: float) -> float:
    return min(max(place, -size), 2 * size)


def formulas_as_json() -> str:
    """Every formula about a pair, Table 2 first: name, title, question, regimes, steps, and the step of the answer."""
    every = [each for each in (*FORMULAS.values(), *REPAIRED.values()) if each.classifies_pairs]
    listed = [
        {
            "name": each.name,
            "title": each.title,
            "question": each.question,
            "regimes": each.regimes,
            "answer": each.answer,
            "steps": [(step.name, step.operation, *step.arguments) for step in needed(each.program, (each.answer,))],
        }
        for each in every
    ]
    return json.dumps(listed, ensure_ascii=False, separators=(",", ":"))


def row_as_text(row: Sequence[float]) -> str:
    """The numbers of a row as the script reads them, each the shortest that is the same float64."""
    return " ".join(map(repr, row))


def can_be_drawn(row: Sequence[float]) -> bool:
    """Whether the half plane shows the truth about a row: a valid one of an upright spheroid that stands still."""
    return len(row) == len(COLUMNS) and trouble_with_row(row) is None


def small_picture(row: Sequence[float]) -> str:
    """Both bodies of a row of seven numbers near the spheroid, as an element of SVG: our own words and numbers."""
    alpha, gamma, b, d, x, y, z = row
    r = min(math.hypot(x, y), sys.float_info.max)
    frame = _Frame.around(r, z, b, d)
    wall = " ".join(_points(alpha, gamma, frame))
    drawn = (
        f'<polygon class="inside" points="{wall} {-WIDTH:g},0 {-WIDTH:g},{HEIGHT:g}"/>'
        f'<polyline class="wall" points="{wall}"/>'
        f'<ellipse class="body" cx="{WIDTH / 2:g}" cy="{HEIGHT / 2:g}" '
        f'rx="{b * frame.wide:.3g}" ry="{d * frame.tall:.3g}"/>'
    )
    head = f'<svg class="bodies" viewBox="0 0 {WIDTH:g} {HEIGHT:g}" role="img" aria-label="{short_row(row)}">'
    return f"{head}{drawn}</svg>"


def _points(alpha: float, gamma: float, frame: _Frame) -> Iterator[str]:
    """The meridian from the lower end of the picture to its upper end."""
    for step in range(_POINTS + 1):
        z = frame.z + (step / _POINTS - 0.5) * HEIGHT / frame.tall
        yield f"{frame.across(alpha * math.hypot(1, z / gamma)):.2f},{frame.up(z):.2f}"
