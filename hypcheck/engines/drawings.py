"""The pictures of the record: a finding as a section through both bodies, and a chart of each engine's own errors.

A finding's gap can be a millionth of its body. So the surroundings of the certificate's point are drawn a second time
beside the bodies, magnified until the gap is visible; the magnification is written below. A picture without that would
show bodies that seem to touch, as if the engine were right.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import floor, log10

import numpy as np

from hypcheck.engines.engine import ENGINES
from hypcheck.engines.findings import Finding
from hypcheck.engines.measure import EngineRecord, Measured
from hypcheck.engines.placing import FAMILIES
from hypcheck.geometry.rows import Floats

_BODY, _EDGE, _TRIANGLE = "#cfe3f5", "#1f6fb2", "#b2361f"
_HALF_SIDE = 45.0
"""Half of the side of the magnified square, in the picture's unit; the body's greater semi-axis is 100."""

_SHOWN = 30.0
"""The gap is drawn at most as long as this in the magnified square, and a tenth of it at least."""


def drawing(finding: Finding) -> str:
    """Return an SVG of both bodies, cut by the plane through the spheroid's axis and the certificate's direction.

    For a missed contact the plane goes through the certificate's point.
    """
    cut, foot = _section_of(finding)
    zoom = 100.0 / max(finding.b, finding.d)
    (u0, v0), (u1, v1) = (cut * zoom).tolist()
    magnified = _magnification(finding, zoom)
    unit = f"; one unit of the engine is {finding.millimetres:g} mm" if finding.millimetres != 1000.0 else ""
    return "\n".join(
        [
            '<svg xmlns="http://www.w3.org/2000/svg" viewBox="-150 -150 450 345" font-size="10">',
            '<rect x="-150" y="-150" width="450" height="345" fill="white"/>',
            f'<ellipse rx="{finding.b * zoom:.2f}" ry="{finding.d * zoom:.2f}" fill="{_BODY}" stroke="{_EDGE}"/>',
            f'<line x1="{u0:.2f}" y1="{-v0:.2f}" x2="{u1:.2f}" y2="{-v1:.2f}" stroke="{_TRIANGLE}" stroke-width="2"/>',
            f'<text x="-145" y="-135">{finding.engine} {finding.version}: {finding.said}</text>',
            f'<text x="-145" y="160">exact: {finding.proved}</text>',
            f'<text x="-145" y="174">in the engine\'s unit b = {finding.b!r}, d = {finding.d!r}{unit}</text>',
            '<text x="-145" y="188">red: the triangle</text>',
            *(_inset(finding, cut, foot, zoom, magnified) if magnified > 1.0 else ()),
            "</svg>",
            "",
        ]
    )


def _section_of(finding: Finding) -> tuple[Floats, Floats]:
    """Compute, in the plane of the picture, the ends (2, 2) of the triangle's section, and the point to magnify."""
    corners = np.array(finding.corners)
    point = np.array(finding.shares) @ corners
    toward = point if finding.kind == "missed contact" else np.array(finding.direction)
    level = np.array([toward[0], toward[1], 0.0])
    level = level / np.linalg.norm(level) if np.linalg.norm(level) > 0 else np.array([1.0, 0.0, 0.0])
    across = np.cross([0.0, 0.0, 1.0], level)
    cut = _section(corners @ across, np.stack([corners @ level, corners[:, 2]], axis=1))
    if finding.kind == "missed contact":
        return cut, np.array([point @ level, point[2]])
    pushed = toward * np.array([finding.b, finding.b, finding.d]) ** 2
    foot = pushed / np.sqrt(toward @ pushed)  # the spheroid's point at the certificate's direction
    return cut, np.array([foot @ level, foot[2]])


def _section(beside: Floats, points: Floats) -> Floats:
    """Cut a triangle by the plane of the picture; return the ends (2, 2) of its section, or of its nearest edge.

    `beside` (3,) are the signed distances of its corners from the plane, `points` (3, 2) their places in the plane.
    """
    ends = []
    for i, j in ((0, 1), (1, 2), (2, 0)):
        if (beside[i] < 0) != (beside[j] < 0):
            share = beside[i] / (beside[i] - beside[j])
            ends.append(points[i] + share * (points[j] - points[i]))
    near = np.argsort(np.abs(beside))[:2]
    return np.array(ends[:2] if len(ends) >= 2 else points[near])


def _magnification(finding: Finding, zoom: float) -> float:
    """Return the magnification near the point: a power of ten that makes the gap or the depth visible; 1 for none."""
    shown = finding.error_mm / finding.millimetres * zoom
    return 10.0 ** floor(log10(_SHOWN / shown)) if 0 < shown < _SHOWN else 1.0


def _inset(finding: Finding, cut: Floats, foot: Floats, zoom: float, times: float) -> Iterator[str]:
    """Yield the SVG of the square beside the bodies: the surroundings of the point `foot`, magnified `times` times.

    Only the near part of the spheroid is drawn, as a polygon. `zoom` is the scale of the bodies in the picture.
    """
    reach = 2.0 * _HALF_SIDE / (zoom * times)
    middle = np.arctan2(foot[1] / finding.d, foot[0] / finding.b)
    spread = min(np.pi, 3.0 * reach / min(finding.b, finding.d))
    angles = middle + np.linspace(-spread, spread, 65)
    # Differences from the foot are computed directly, so that no digits are lost if the gap is a millionth of the body.
    half = (angles - middle) / 2
    turned = -2.0 * np.sin(half)[:, np.newaxis] * np.stack([np.sin(middle + half), -np.cos(middle + half)], axis=1)
    rim = np.vstack([turned * [finding.b, finding.d], [-foot]]) * zoom * times
    line = _near(cut - foot, reach) * zoom * times
    yield '<clipPath id="square"><rect x="170" y="-45" width="90" height="90"/></clipPath>'
    yield '<g clip-path="url(#square)"><g transform="translate(215 0)">'
    yield f'<polygon points="{_points(rim)}" fill="{_BODY}" stroke="{_EDGE}"/>'
    yield f'<polyline points="{_points(line)}" fill="none" stroke="{_TRIANGLE}" stroke-width="2"/>'
    yield '</g></g><rect x="170" y="-45" width="90" height="90" fill="none" stroke="#555"/>'
    u, v = (foot * zoom).tolist()
    yield f'<path d="M{u:.2f},{-v:.2f} L170,0" stroke="#555" stroke-dasharray="3 3" fill="none"/>'
    yield f'<text x="170" y="60">magnified {times:,.0f} times</text>'


def _near(ends: Floats, reach: float) -> Floats:
    """Return the part of a segment within twice `reach` of its point nearest to the origin."""
    along = ends[1] - ends[0]
    length = float(np.linalg.norm(along))
    if length == 0:
        return ends
    way = along / length
    middle = float(np.clip(-(ends[0] @ way), 0.0, length))
    shares = np.clip([middle - 2 * reach, middle + 2 * reach], 0.0, length)
    return np.asarray(ends[0] + shares[:, np.newaxis] * way)


def _points(points: Floats) -> str:
    """Return points (n, 2) as the text of an SVG attribute, whose y axis points down."""
    return " ".join(f"{np.clip(x, -1e4, 1e4):.2f},{np.clip(-y, -1e4, 1e4):.2f}" for x, y in points.tolist())


_LEAST, _MOST = -7, 3
"""The ends of the chart's axis, as powers of ten of a millimetre."""


def chart(record: EngineRecord) -> str:
    """Return an SVG of an engine's worst own error in each family: a ring at default settings, a dot at the others."""
    names = [name for name in FAMILIES if any(measured.family == name for measured in record.default)]
    bottom = 22 * len(names) + 30
    marks = [f'<text x="10" y="16">{record.name} {record.version}: own worst error, mm at the tower of 2 m</text>']
    for power in range(_LEAST, _MOST + 1, 2):
        x = _place(10.0**power)
        marks.append(f'<line x1="{x:.1f}" y1="24" x2="{x:.1f}" y2="{bottom}" stroke="#ddd"/>')
        marks.append(f'<text x="{x:.1f}" y="{bottom + 14}" text-anchor="middle">{10.0**power:g}</text>')
    marks.append(f'<text x="{_place(0.0):.1f}" y="{bottom + 14}" text-anchor="middle">0</text>')
    for place, name in enumerate(names):
        y = 22 * place + 40
        marks.append(f'<text x="10" y="{y + 4}">{name}</text>')
        ring, dot = (_place(own_worst(one, name)) for one in (record.default, record.tightest or record.default))
        marks.append(f'<line x1="{ring:.1f}" y1="{y}" x2="{dot:.1f}" y2="{y}" stroke="#888"/>')
        marks.append(f'<circle cx="{ring:.1f}" cy="{y}" r="5" fill="white" stroke="{_EDGE}"/>')
        marks.append(f'<circle cx="{dot:.1f}" cy="{y}" r="3" fill="{_EDGE}"/>')
    engine = ENGINES[record.name]
    what = f"ring: default settings; dot: the {engine.other}" if engine.adjustable else "it offers no setting"
    marks.append(f'<text x="10" y="{bottom + 32}">{what}</text>')
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 520 {bottom + 40}" font-size="11">'
    return "\n".join([head, f'<rect width="520" height="{bottom + 40}" fill="white"/>', *marks, "</svg>", ""])


def _place(millimetres: float) -> float:
    """Return the x coordinate of an error in the chart; an error of 0 is at the left end of its axis."""
    power = log10(millimetres) if millimetres > 0 else _LEAST - 1
    return 130.0 + 370.0 * (min(max(power, _LEAST - 1), _MOST) - (_LEAST - 1)) / (_MOST - _LEAST + 1)


def own_worst(measured: Sequence[Measured], family: str) -> float:
    """Return the worst own error of a family on any mesh, in millimetres; 0 if there is none."""
    return max((measurement.own_worst_mm for measurement in measured if measurement.family == family), default=0.0)
