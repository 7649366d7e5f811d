"""Findings: one upright spheroid about the origin and one triangle, about which an engine is wrong, with a certificate.

An engine is wrong if its error stays at the tightest settings that it offers, and is beyond the tolerance that it
states there; or if it contradicts itself: it says contact, and reports that the same bodies are apart. With one
triangle there is no mesh that could explain the error. With S = diag(b², b², d²) and h(n) = √(nᵀSn), every direction n
gives a lower bound s(n) = (min n·v − h(n)) / |n|, over the corners v, of the signed distance (how far bodies are apart,
or minus the depth by which a move along n separates them at most). So the certificates are:

- a *direction* n with s(n) > 0: the bodies are clear. With any s(n): no distance below it is right, no depth beyond
  −s(n).
- *shares* of the corners, which add up to 1: the point of the triangle with these shares lies inside the spheroid.
  And with it, for a distance that is too large, the point of the spheroid at a direction: their distance is an upper
  bound.

`proved` decides all of that in rationals, where a root is compared by squares. For an engine that is given a hull
only what holds for every body inside the spheroid is claimed.

A finding has two files that need the engine alone: a reproduction, and a picture of the section through the bodies.
Each engine's folder has a template, reproduction.*.txt: it makes both bodies and asks the engine. What it is asked and
how it ends (1 while the engine is wrong) is the same for all engines of a language and stands here.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from math import sqrt
from pathlib import Path
from string import Template

import msgspec
from msgspec import Struct

from hypcheck.engines.engine import ENGINES, FOLDER, Engine

KINDS = ("contradiction", "too near", "missed contact", "false contact", "too far")
"""The kinds of findings, in the order in which the record shows them."""


class Finding(Struct):
    """A wrong answer of an engine about the spheroid of semi-axes b, b, d about the origin and a triangle.

    `kind` is one of KINDS. `reported` is the wrong signed distance, or None if the answer contact or clear is wrong.
    `error_mm` is the proved error in millimetres at the 2 m tower, and `millimetres` is the number of millimetres in
    one unit of the engine; `direction` and `shares` are the certificate. `said` is the answer, in words, at the setting
    that the engine is judged by, `at_other` that at its other one, empty if it offers none. `proved` is the proved
    fact in words; `file` and `picture` are the names of the reproduction and the drawing.
    """

    engine: str
    version: str
    kind: str
    b: float
    d: float
    corners: list[list[float]]
    reported: float | None
    direction: list[float]
    shares: list[float]
    error_mm: float
    millimetres: float
    said: str
    proved: str
    file: str
    picture: str
    at_other: str = ""

    @property
    def contradicts(self) -> bool:
        """Whether the engine says contact and also reports that the same bodies are apart."""
        return self.said.startswith("contact, and")

    @property
    def of_body(self) -> float:
        """The error divided by the spheroid's least semi-axis."""
        return self.error_mm / (self.millimetres * min(self.b, self.d))


_BY_DIRECTION = {"contradiction", "false contact", "too near"}
"""The kinds that a direction proves; shares of the corners prove the others."""


def read_findings(folder: Path) -> list[Finding]:
    """Read the findings in a folder; the list is empty if it has no file of them."""
    path = folder / "findings" / "findings.json"
    return msgspec.json.decode(path.read_bytes(), type=list[Finding]) if path.is_file() else []


def proved(finding: Finding) -> bool:
    """Decide in rational arithmetic whether the certificate proves at least nine tenths of the error."""
    error = Fraction(finding.error_mm) * 9 / 10 / Fraction(finding.millimetres)
    if finding.kind in _BY_DIRECTION:
        return _direction_proves(finding, error)
    squares, shares, point = _squares(finding), _exactly(finding.shares), _shared_point(finding)
    if sum(shares) != 1 or min(shares) < 0:
        return False
    if finding.kind == "missed contact":  # inside the spheroid smaller by a factor of 1 − error / least semi-axis
        factor = 1 - error / Fraction(min(finding.b, finding.d))
        return _inside(point, squares) <= factor * factor
    way = _exactly(finding.direction)
    above = Fraction(sqrt(_dot(squares, [number * number for number in way])) * (1 + 1e-12))  # more than h
    foot = [square * number / above for square, number in zip(squares, way, strict=True)]
    bound = Fraction(finding.reported or 0.0) - error
    apart = [x - y for x, y in zip(point, foot, strict=True)]
    return bound > 0 and _inside(foot, squares) <= 1 and _dot(apart, apart) <= bound * bound


def _direction_proves(finding: Finding, error: Fraction) -> bool:
    """Decide whether s(n) is at least the error, or exceeds the reported distance by at least the error.

    The second holds for the kind "too near". s(n) is the lower bound at the head of this module, n the direction.
    """
    least, half2, length2 = _along(finding)
    bound = error + (Fraction(finding.reported or 0.0) if finding.kind == "too near" else 0)
    root2 = bound * bound * length2
    return _at_least_roots(least, half2, root2) if bound >= 0 else _root_and(least, root2, half2)


def _along(finding: Finding) -> tuple[Fraction, Fraction, Fraction]:
    """Return, for the direction n, the least n·v of the corners v, and the squares of h(n) and of |n|."""
    way = _exactly(finding.direction)
    least = min(_dot(way, _exactly(corner)) for corner in finding.corners)
    return least, _dot(_squares(finding), [number * number for number in way]), _dot(way, way)


def _shared_point(finding: Finding) -> list[Fraction]:
    """Return the point of the triangle with the finding's shares of the corners."""
    return [_dot(_exactly(finding.shares), _exactly(column)) for column in zip(*finding.corners, strict=True)]


def _squares(finding: Finding) -> list[Fraction]:
    """Return b², b² and d², exactly."""
    return [axis * axis for axis in _exactly([finding.b, finding.b, finding.d])]


def _exactly(numbers: Iterable[float]) -> list[Fraction]:
    return [Fraction(number) for number in numbers]


def _dot(first: Sequence[Fraction], second: Sequence[Fraction]) -> Fraction:
    return sum((x * y for x, y in zip(first, second, strict=True)), Fraction(0))


def _inside(point: Sequence[Fraction], squares: Sequence[Fraction]) -> Fraction:
    """Return (x² + y²)/b² + z²/d² of a point, which is below 1 inside the spheroid; `squares` are b², b² and d²."""
    return _dot([coordinate * coordinate for coordinate in point], [1 / square for square in squares])


def _at_least_roots(value: Fraction, first: Fraction, second: Fraction) -> bool:
    """Decide whether value ≥ √first + √second."""
    rest = value * value - first - second
    return value >= 0 and rest >= 0 and rest * rest >= 4 * first * second


def _root_and(value: Fraction, first: Fraction, second: Fraction) -> bool:
    """Decide whether value + √first ≥ √second."""
    rest = second - first - value * value
    if value < 0:
        return rest <= 0 and rest * rest >= 4 * value * value * second
    return rest <= 0 or rest * rest <= 4 * value * value * first


_PYTHON = """

for settings in ("{first}", "{last}"):
    contact, distance = ask(settings != "default")
    print(f"{{settings}} settings: contact: {{contact}}, distance: {{distance}}")
sys.exit({wrong})
"""
_JAVASCRIPT = """
let contact, distance;
for (const settings of ['{first}', '{last}']) {{
  [contact, distance] = ask(settings !== 'default');
  console.log(`${{settings}} settings: contact: ${{contact}}, distance: ${{distance}}`);
}}
process.exit(Number({wrong}));
"""
_RUST = """    println!("contact: {{contact}}, distance: {{distance}}");
    std::process::exit(i32::from({wrong}));
}}
"""
_ENDS = {".py": ("# ", _PYTHON, "not "), ".mjs": ("// ", _JAVASCRIPT, "!"), ".rs": ("// ", _RUST, "!")}
"""For each ending of a file name: the beginning of a comment, the last lines of a reproduction, the word for not."""

_INSTALLS = {
    "pip": "pip install {package}=={version}",
    "npm": "npm install {package}@{version}",
    "cargo": 'a package with parry = {{ package = "{package}", version = "={version}" }} below [dependencies]',
}


def template_of(engine: Engine) -> Path:
    """Return the path of the engine's template, reproduction.ENDING.txt."""
    folder = FOLDER / Path(engine.files[1 if engine.manager == "cargo" else 0]).parent
    return next(folder.glob("reproduction.*.txt"))


def reproduction(finding: Finding) -> str:
    """Return the text of the program that reproduces a finding."""
    engine = ENGINES[finding.engine]
    path = template_of(engine)
    comment, end, negated = _ENDS[Path(path.stem).suffix]
    install = _INSTALLS[engine.manager].format(package=engine.package, version=engine.version)
    lines = [
        f"{finding.engine} {finding.version} says {finding.said}. Exact: {finding.proved} (at a tower of 2 m).",
        *_settings_of(finding, engine),
        *_proof(finding),
    ]
    head = "".join(f"{comment}{line}\n" for line in [*lines, f"Needs: {install}. Ends with 1 while it is wrong."])
    values = {"b": repr(finding.b), "d": repr(finding.d), "corners": repr(finding.corners)}
    body = Template(path.read_text(encoding="utf-8")).substitute(values)
    first, last = ("default", engine.other) if engine.tightens else (engine.other, "default")
    return head + body + end.format(wrong=_wrong(finding, negated), first=first, last=last)


def _settings_of(finding: Finding, engine: Engine) -> list[str]:
    """Return lines with the engine's answers at its settings, in words, and its unit."""
    size = f"b = {finding.b!r}, d = {finding.d!r}"
    unit = f"Lengths are in the engine's unit, {finding.millimetres:g} mm of the tower; {size}."
    if not engine.adjustable:
        return [f"Settings: {engine.default.words}.", unit]
    if not engine.tightens:
        return [
            f"That is at its default settings: {engine.default.words}.",
            f"With its {engine.other} it says {finding.at_other}: {engine.tightest.words}.",
            unit,
        ]
    return [
        f"That is at its tightest settings: {engine.tightest.words}.",
        f"At its default settings it says {finding.at_other}: {engine.default.words}.",
        unit,
    ]


def _wrong(finding: Finding, negated: str) -> str:
    """Return the condition that the engine is wrong, as code. `negated` is the language's word for not."""
    if finding.kind == "contradiction":
        return {"not ": "contact and distance > 0", "!": "contact && distance > 0.0"}[negated]
    if finding.kind in {"false contact", "missed contact"}:
        return "contact" if finding.kind == "false contact" else f"{negated}contact"
    sign, error = (1, "<") if finding.kind == "too near" else (-1, ">")
    return f"distance {error} {(finding.reported or 0.0) + sign * 0.9 * finding.error_mm / finding.millimetres!r}"


def _proof(finding: Finding) -> list[str]:
    """Return the certificate in words, line by line."""
    n = f"n = ({', '.join(map(repr, finding.direction))})"
    if finding.kind in _BY_DIRECTION:
        least, half2, length2 = _along(finding)
        return [
            f"Certificate: with {n}, every corner v of the triangle has n·v >= {float(least):.17g}, and every",
            f"point x of the spheroid has n·x <= sqrt(b²(nx² + ny²) + d² nz²) = {sqrt(half2):.17g};",
            f"|n| = {sqrt(length2):.17g}.",
        ]
    shares = ", ".join(map(repr, finding.shares))
    point = _shared_point(finding)
    where = ", ".join(f"{float(coordinate):.17g}" for coordinate in point)
    first = f"Certificate: the point p = ({where}) of the triangle, which has the"
    if finding.kind == "missed contact":
        inside = float(_inside(point, _squares(finding)))
        return [first, f"shares {shares} of the corners, has (x² + y²)/b² + z²/d² = {inside:.17g} < 1."]
    return [
        first,
        f"shares {shares} of the corners, is so near to the spheroid's point S n/sqrt(n·S n), S = diag(b², b², d²),",
        f"{n}.",
    ]
