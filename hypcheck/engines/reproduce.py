"""Findings as files that need the engine alone: a reproduction, and a picture of the section through the bodies.

Each engine's folder has a template, reproduction.*.txt: it makes both bodies and asks the engine. What it is asked and
how it ends (1 while the engine is wrong) is the same for all engines of a language and stands here.
"""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path
from string import Template

import msgspec
import numpy as np

from hypcheck.engines.findings import Finding
from hypcheck.engines.install import command
from hypcheck.engines.table import ENGINES, FOLDER, Engine

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


def template_of(engine: Engine) -> Path:
    """The engine's template."""
    folder = FOLDER / Path(engine.files[1 if engine.manager == "cargo" else 0]).parent
    return next(folder.glob("reproduction.*.txt"))


def _ending(engine: Engine) -> str:
    """What the name of a reproduction ends in."""
    return Path(template_of(engine).stem).suffix


def write_findings(folder: Path, findings: Sequence[Finding]) -> list[Finding]:
    """Write the findings' files anew, and findings.json; the findings with the names of their files."""
    shutil.rmtree(folder / "findings", ignore_errors=True)
    (folder / "findings").mkdir(parents=True)
    named = []
    for found in findings:
        engine = ENGINES[found.engine]
        stem = f"findings/{found.engine}-{found.kind.replace(' ', '-')}"
        file, picture = stem + _ending(engine), stem + ".svg"
        (folder / file).write_text(reproduction(found), encoding="utf-8")
        (folder / picture).write_text(drawing(found), encoding="utf-8")
        named.append(msgspec.structs.replace(found, file=file, picture=picture))
    (folder / "findings" / "findings.json").write_bytes(msgspec.json.format(msgspec.json.encode(named)) + b"\n")
    return named


def reproduction(found: Finding) -> str:
    """The text of a reproduction."""
    engine = ENGINES[found.engine]
    path = template_of(engine)
    comment, end, negated = _ENDS[_ending(engine)]
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
        way, scale = np.array(found.direction), np.array([found.b, found.b, found.d])
        least = (np.array(found.corners) @ way).min()
        half = np.linalg.norm(way * scale)
        return [
            f"Certificate: with {n}, every corner v of the triangle has n·v >= {least:.17g}, and every",
            f"point x of the spheroid has n·x <= sqrt(b²(nx² + ny²) + d² nz²) = {half:.17g};",
            f"|n| = {np.linalg.norm(way):.17g}.",
        ]
    shares = ", ".join(map(repr, found.shares))
    point = np.array(found.shares) @ np.array(found.corners)
    inside = float(((point / [found.b, found.b, found.d]) ** 2).sum())
    lines = [
        f"Certificate: the point p = ({', '.join(f'{each:.17g}' for each in point)}) of the triangle, which has the"
    ]
    if found.kind == "missed contact":
        return [*lines, f"shares {shares} of the corners, has (x² + y²)/b² + z²/d² = {inside:.17g} < 1."]
    return [
        *lines,
        f"shares {shares} of the corners, is so near to the spheroid's point S n/sqrt(n·S n), S = diag(b², b², d²),",
        f"{n}.",
    ]


def run_reproduction(found: Finding, folder: Path, cache: Path) -> int:
    """Run a finding's file beside the installed engine; its exit code: 1 while the engine is wrong."""
    engine = ENGINES[found.engine]
    words = command(engine, cache, folder)[:-1]
    home = (cache / engine.name).absolute()
    if engine.manager == "cargo":
        (home / "examples").mkdir(exist_ok=True)
        shutil.copyfile(folder / found.file, home / "examples" / "finding.rs")
        words = (
            "cargo",
            "run",
            "--release",
            "--quiet",
            "--manifest-path",
            str(home / "Cargo.toml"),
            "--example",
            "finding",
        )
    else:
        place = home / f"finding{Path(found.file).suffix}"
        shutil.copyfile(folder / found.file, place)
        words = (words[0], str(place))
    return subprocess.run(words, capture_output=True, check=False, timeout=600).returncode  # noqa: S603


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
