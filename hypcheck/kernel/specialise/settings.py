"""The settings of a scene: one spheroid beside one hyperboloid, and where its centre can be, seen from the latter's."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from hypcheck.kernel import integers
from hypcheck.pairs import Pair, Position
from hypcheck.scene.model import Hyperboloid, Part, Scene, Span

Sizes = tuple[float, float, float, float]

SWING = 1 + Fraction(1, 2**40)
"""What an arm is multiplied by, since its end is computed by a rounded sine and cosine."""


@dataclass(frozen=True, slots=True)
class Box:
    """Where the spheroid's centre can be, from the hyperboloid's centre; None: anywhere on that axis."""

    x: Span | None = None
    y: Span | None = None
    z: Span | None = None

    @property
    def spans(self) -> tuple[Span | None, Span | None, Span | None]:
        """The three spans in order."""
        return self.x, self.y, self.z


@dataclass(frozen=True, slots=True)
class Setting:
    """`sizes` are α, γ, b, d; `box` is where the centre can be; `cut` is the height at which the world ends, if there.

    `cut` is kept only where the box does not end before it: it is then asked of every query. `uses` names the pairs of
    the scene that have these sizes.
    """

    sizes: Sizes
    box: Box
    cut: Span | None
    uses: tuple[str, ...]


def settings_of(scene: Scene) -> tuple[Setting, ...]:
    """One setting for each combination of sizes in the scene, in the scene's order; pairs of the same sizes share one.

    A pair whose heights never meet the region is left out: nothing there is ever asked of it.
    """
    found: dict[Sizes, Setting] = {}
    for setting in _pairs(scene):
        known = found.get(setting.sizes)
        found[setting.sizes] = setting if known is None else _joined(known, setting)
    return tuple(found.values())


def always(setting: Setting) -> Position | None:
    """The one position that the whole box has, if it has one.

    The exterior positions are an up-set when |x| and |y| grow and |z| falls, the interior ones when |x| and |y| fall
    and |z| grows (docs/mathematics.md): one exact decision at the least favourable corner of the box is a proof.
    """
    x, y, z = setting.box.spans
    if z is not None and _at(setting, (_least(x), _least(y), _most(z))) is Position.EXTERIOR:
        return Position.EXTERIOR
    if x is not None and y is not None and _at(setting, (_most(x), _most(y), _least(z))) is Position.INTERIOR:
        return Position.INTERIOR
    return None


def _at(setting: Setting, centre: tuple[float, float, float]) -> Position:
    return integers.position(Pair.from_row((*setting.sizes, *centre)).lengths)


def _least(span: Span | None) -> float:
    """The least |v| of a span; 0 where there is none."""
    return 0.0 if span is None or span.holds(0) else min(abs(span.low), abs(span.high))


def _most(span: Span) -> float:
    return max(abs(span.low), abs(span.high))


def _pairs(scene: Scene) -> Iterator[Setting]:
    mover = scene.mover
    bodies = {"the mover": Part(mover.b, mover.d, 0.0)}
    bodies.update((f"part {number}", part) for number, part in enumerate(mover.parts, start=1))
    for hyperboloid in scene.hyperboloids:
        for name, body in bodies.items():
            box, cut = _box(scene, hyperboloid, body.arm)
            if box is not None:
                sizes = (hyperboloid.alpha, hyperboloid.gamma, body.b, body.d)
                yield Setting(sizes, box, cut, (f"{name} and {hyperboloid.name}",))


def _box(scene: Scene, hyperboloid: Hyperboloid, arm: float) -> tuple[Box | None, Span | None]:
    """The region seen from the hyperboloid, `arm` wider, and the height that has still to be asked for."""
    region, centre = scene.region, hyperboloid.center
    x = _moved(region.x, centre[0], arm)
    y = _moved(region.y, centre[1], arm)
    z = _moved(region.z, centre[2], 0.0)
    height = hyperboloid.height
    if height is None:
        return Box(x, y, z), None
    if z is not None and height.low <= z.low and z.high <= height.high:
        return Box(x, y, z), None
    low, high = height.low, height.high
    if z is not None:
        low, high = max(low, z.low), min(high, z.high)
    if low > high:
        return None, None
    return Box(x, y, Span(low, high)), height


def _moved(span: Span | None, origin: float, arm: float) -> Span | None:
    """The span from `origin`, as far wider as an arm reaches.

    Rounding is monotone, so a caller's own rounded differences lie in it; SWING covers the roundings of a turned arm.
    """
    if span is None:
        return None
    wider = Fraction(arm) * SWING
    return Span(
        float(Fraction(span.low) - Fraction(origin) - wider), float(Fraction(span.high) - Fraction(origin) + wider)
    )


def _joined(one: Setting, other: Setting) -> Setting:
    x, y, z = (_hull(left, right) for left, right in zip(one.box.spans, other.box.spans, strict=True))
    return Setting(one.sizes, Box(x, y, z), _hull(one.cut, other.cut), (*one.uses, *other.uses))


def _hull(one: Span | None, other: Span | None) -> Span | None:
    if one is None or other is None:
        return None
    return Span(min(one.low, other.low), max(one.high, other.high))
