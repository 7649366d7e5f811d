"""Findings: one upright spheroid about the origin and one triangle, about which an engine is wrong, with a certificate.

With one triangle there is no mesh that could explain the error. With S = diag(b², b², d²) and h(n) = √(nᵀSn), every
direction n gives a lower bound s(n) = (min n·v − h(n)) / |n|, over the corners v, of the signed distance (how far
bodies are apart, or minus the depth by which a move along n separates them at most). So the certificates are:

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

import shutil
from collections.abc import Iterable, Sequence
from fractions import Fraction
from math import sqrt
from pathlib import Path
from string import Template

import msgspec
import numpy as np
from msgspec import Struct

from hypcheck.engines.engine import ENGINES, FOLDER, Engine


class Finding(Struct):
    """An engine's answer about the spheroid b, d about the origin and a triangle.

    `kind` is "false contact", "missed contact", "too near" or "too far". `reported` is the signed distance that is
    wrong, or None where its word contact or clear is. `error_mm` is proved, in millimetres at the 2 m tower;
    `direction` and `shares` are the certificate.
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


def read_findings(folder: Path) -> list[Finding]:
    """The findings in a folder, none if it has no file of them."""
    path = folder / "findings" / "findings.json"
    return msgspec.json.decode(path.read_bytes(), type=list[Finding]) if path.is_file() else []


def proved(finding: Finding) -> bool:
    """Whether the certificate proves at least nine tenths of the error, in rationals."""
    error = Fraction(finding.error_mm) * 9 / 10 / Fraction(finding.millimetres)
    if finding.kind in {"false contact", "too near"}:
        return _direction_proves(finding, error)
    squares, shares, point = _squares(finding), _exactly(finding.shares), _shared_point(finding)
    if sum(shares) != 1 or min(shares) < 0:
        return False
    if finding.kind == "missed contact":  # inside the spheroid smaller by a factor of 1 − error / least semi-axis
        factor = 1 - error / Fraction(min(finding.b, finding.d))
        return _inside(point, squares) <= factor * factor
    way = _exactly(finding.direction)
    above = Fraction(sqrt(_dot(squares, [each * each for each in way])) * (1 + 1e-12))  # more than h
    foot = [square * each / above for square, each in zip(squares, way, strict=True)]
    bound = Fraction(finding.reported or 0.0) - error
    apart = [x - y for x, y in zip(point, foot, strict=True)]
    return bound > 0 and _inside(foot, squares) <= 1 and _dot(apart, apart) <= bound * bound


def _direction_proves(finding: Finding, error: Fraction) -> bool:
    """Whether s(n) is at least the error, or greater by that than what the engine reported."""
    least, half2, length2 = _along(finding)
    bound = error + (Fraction(finding.reported or 0.0) if finding.kind == "too near" else 0)
    root2 = bound * bound * length2
    return _at_least_roots(least, half2, root2) if bound >= 0 else _root_and(least, root2, half2)


def _along(finding: Finding) -> tuple[Fraction, Fraction, Fraction]:
    """Along the direction n: the least n·v of the corners v, and the squares of h(n) and of |n|."""
    way = _exactly(finding.direction)
    least = min(_dot(way, _exactly(corner)) for corner in finding.corners)
    return least, _dot(_squares(finding), [each * each for each in way]), _dot(way, way)


def _shared_point(finding: Finding) -> list[Fraction]:
    """The point of the triangle with the shares of the corners."""
    return [_dot(_exactly(finding.shares), _exactly(column)) for column in zip(*finding.corners, strict=True)]


def _squares(finding: Finding) -> list[Fraction]:
    return [each * each for each in _exactly([finding.b, finding.b, finding.d])]


def _exactly(numbers: Iterable[float]) -> list[Fraction]:
    return [Fraction(each) for each in numbers]


def _dot(first: Sequence[Fraction], second: Sequence[Fraction]) -> Fraction:
    return sum((x * y for x, y in zip(first, second, strict=True)), Fraction(0))


def _inside(point: Sequence[Fraction], squares: Sequence[Fraction]) -> Fraction:
    """(x² + y²)/b² + z²/d², which is below 1 inside the spheroid."""
    return _dot([each * each for each in point], [1 / square for square in squares])


def _at_least_roots(value: Fraction, first: Fraction, second: Fraction) -> bool:
    """Whether value ≥ √first + √second."""
    rest = value * value - first - second
    return value >= 0 and rest >= 0 and rest * rest >= 4 * first * second


def _root_and(value: Fraction, first: Fraction, second: Fraction) -> bool:
    """Whether value + √first ≥ √second."""
    rest = second - first - value * value
    if value < 0:
        return rest <= 0 and rest * rest >= 4 * value * value * second
    return rest <= 0 or rest * rest <= 4 * value * value * first


_PYTHON = """print("contact:", contact, " distance:", distance)
sys.exit({wrong})
"""
_JAVASCRIPT = """console.log('contact:', contact, ' distance:', distance);
process.exit(Number({wrong}));
"""
_RUST = """    println!("contact: {{contact}}  distance: {{distance}}");
    std::process::exit(i32::from({wrong}));
}}
"""
_ENDS = {".py": ("# ", _PYTHON, "not "), ".mjs": ("// ", _JAVASCRIPT, "!"), ".rs": ("// ", _RUST, "!")}
"""By the ending of a file: what begins a comment, the last lines, and how a language says not."""

_INSTALLS = {
    "pip": "pip install {package}=={version}",
    "npm": "npm install {package}@{version}",
    "cargo": 'a package with parry = {{ package = "{package}", version = "={version}" }} below [dependencies]',
}


def _template_of(engine: Engine) -> Path:
    """The engine's template, reproduction.ENDING.txt."""
    folder = FOLDER / Path(engine.files[1 if engine.manager == "cargo" else 0]).parent
    return next(folder.glob("reproduction.*.txt"))


def write_findings(folder: Path, findings: Sequence[Finding]) -> list[Finding]:
    """Write the findings' files anew, and findings.json; the findings with the names of their files."""
    shutil.rmtree(folder / "findings", ignore_errors=True)
    (folder / "findings").mkdir(parents=True)
    named = []
    for found in findings:
        stem = f"findings/{found.engine}-{found.kind.replace(' ', '-')}"
        file, picture = stem + Path(_template_of(ENGINES[found.engine]).stem).suffix, stem + ".svg"
        (folder / file).write_text(reproduction(found), encoding="utf-8")
        (folder / picture).write_text(drawing(found), encoding="utf-8")
        named.append(msgspec.structs.replace(found, file=file, picture=picture))
    (folder / "findings" / "findings.json").write_bytes(msgspec.json.format(msgspec.json.encode(named)) + b"\n")
    return named


def reproduction(found: Finding) -> str:
    """The text of a reproduction."""
    engine = ENGINES[found.engine]
    path = _template_of(engine)
    comment, end, negated = _ENDS[Path(path.stem).suffix]
    install = _INSTALLS[engine.manager].format(package=engine.package, version=engine.version)
    lines = [
        f"{found.engine} {found.version} says {found.said}. Exact: {found.proved} (at a tower of 2 m).",
        *_proof(found),
    ]
    head = "".join(f"{comment}{line}\n" for line in [*lines, f"Needs: {install}. Ends with 1 while it is wrong."])
    values = {"b": repr(found.b), "d": repr(found.d), "corners": repr(found.corners)}
    body = Template(path.read_text(encoding="utf-8")).substitute(values)
    return head + body + end.format(wrong=_wrong(found, negated))


def _wrong(found: Finding, negated: str) -> str:
    """The condition that the engine is wrong, in all languages alike but for the word not."""
    if found.kind in {"false contact", "missed contact"}:
        return "contact" if found.kind == "false contact" else f"{negated}contact"
    sign, error = (1, "<") if found.kind == "too near" else (-1, ">")
    return f"distance {error} {(found.reported or 0.0) + sign * 0.9 * found.error_mm / found.millimetres!r}"


def _proof(found: Finding) -> list[str]:
    """The certificate in words."""
    n = f"n = ({', '.join(map(repr, found.direction))})"
    if found.kind in {"false contact", "too near"}:
        least, half2, length2 = _along(found)
        return [
            f"Certificate: with {n}, every corner v of the triangle has n·v >= {float(least):.17g}, and every",
            f"point x of the spheroid has n·x <= sqrt(b²(nx² + ny²) + d² nz²) = {sqrt(half2):.17g};",
            f"|n| = {sqrt(length2):.17g}.",
        ]
    shares = ", ".join(map(repr, found.shares))
    point = _shared_point(found)
    where = ", ".join(f"{float(each):.17g}" for each in point)
    first = f"Certificate: the point p = ({where}) of the triangle, which has the"
    if found.kind == "missed contact":
        inside = float(_inside(point, _squares(found)))
        return [first, f"shares {shares} of the corners, has (x² + y²)/b² + z²/d² = {inside:.17g} < 1."]
    return [
        first,
        f"shares {shares} of the corners, is so near to the spheroid's point S n/sqrt(n·S n), S = diag(b², b², d²),",
        f"{n}.",
    ]


def drawing(found: Finding) -> str:
    """An SVG of the section by the plane through the spheroid's axis and the certificate's direction, or point."""
    corners = np.array(found.corners)
    toward = np.array(found.direction) if found.kind != "missed contact" else np.array(found.shares) @ corners
    level = np.array([toward[0], toward[1], 0.0])
    level = level / np.linalg.norm(level) if np.linalg.norm(level) > 0 else np.array([1.0, 0.0, 0.0])
    across = np.cross([0.0, 0.0, 1.0], level)
    cut = _section(corners @ across, np.stack([corners @ level, corners[:, 2]], axis=1))
    zoom = 100.0 / max(found.b, found.d)
    (u0, v0), (u1, v1) = (cut * zoom).tolist()
    scale = found.millimetres
    return "\n".join(
        [
            '<svg xmlns="http://www.w3.org/2000/svg" viewBox="-150 -150 300 330" font-size="10">',
            '<rect x="-150" y="-150" width="300" height="330" fill="white"/>',
            f'<ellipse rx="{found.b * zoom:.2f}" ry="{found.d * zoom:.2f}" fill="#cfe3f5" stroke="#1f6fb2"/>',
            f'<line x1="{u0:.2f}" y1="{-v0:.2f}" x2="{u1:.2f}" y2="{-v1:.2f}" stroke="#b2361f" stroke-width="2"/>',
            f'<text x="-145" y="-135">{found.engine} {found.version}: {found.said}</text>',
            f'<text x="-145" y="160">exact: {found.proved}</text>',
            f'<text x="-145" y="174">b = {found.b * scale:g} mm, d = {found.d * scale:g} mm; red: the triangle</text>',
            "</svg>",
            "",
        ]
    )


def _section(beside: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Where a triangle meets the plane of the picture: the ends (2, 2) of its section, or of its nearest edge."""
    ends = []
    for i, j in ((0, 1), (1, 2), (2, 0)):
        if (beside[i] < 0) != (beside[j] < 0):
            share = beside[i] / (beside[i] - beside[j])
            ends.append(points[i] + share * (points[j] - points[i]))
    near = np.argsort(np.abs(beside))[:2]
    return np.array(ends[:2] if len(ends) >= 2 else points[near])
