"""A scene as plain values: hyperboloids, the mover, its region, and the question. reading.py makes them from a file.

Lengths are in one unit of the caller's choice (metres in the scenes that are shipped), angles in degrees. `alpha`,
`gamma` and `height` describe a hyperboloid in its own frame; `center` and `axis` put it into the scene.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, radians, sin, sqrt
from typing import Literal

QUESTIONS = ("position", "exterior", "interior", "contact")

Point = tuple[float, float, float]

UPRIGHT: Point = (0.0, 0.0, 1.0)
"""The axis of a hyperboloid or mover that is not tilted."""

FREE: Literal["free"] = "free"
"""The axis of a mover that each query names."""


def is_tilted(axis: Point | Literal["free"]) -> bool:
    """Decide whether an axis is tilted, or may be, because each query names it."""
    return axis == FREE or axis[0] != 0 or axis[1] != 0


@dataclass(frozen=True, slots=True)
class Span:
    """The numbers from `low` to `high`, both included; one number where they are equal."""

    low: float
    high: float

    @property
    def ends(self) -> tuple[float, float]:
        """Both ends."""
        return self.low, self.high

    @property
    def fixed(self) -> bool:
        """Whether the span is a single number."""
        return self.low == self.high

    def holds(self, value: float) -> bool:
        """Decide whether the number lies in the span."""
        return self.low <= value <= self.high


@dataclass(frozen=True, slots=True)
class Hyperboloid:
    """x²/α² + y²/α² − z²/γ² = 1 about `center` (equation (1) of the paper), of its own `name`.

    `height` is the range of z, from the centre's level, between whose ends the surface stands in the world; an end may
    be infinite, and None is without ends. Where it is `solid`, flat ends belong to it; else it is an open wall. `axis`
    points along the z of these, not 0 and of any length.
    """

    name: str
    alpha: float
    gamma: float
    center: Point = (0.0, 0.0, 0.0)
    height: Span | None = None
    axis: Point = UPRIGHT
    solid: bool = False


@dataclass(frozen=True, slots=True)
class MoverPart:
    """A smaller spheroid of semi-axes b, b, d within the mover's, at the mover's height while the mover is upright.

    Its centre is `arm` away from the mover's, `angle` degrees counterclockwise from the mover's heading.
    """

    b: float
    d: float
    arm: float
    angle: float = 0.0


@dataclass(frozen=True, slots=True)
class Mover:
    """The spheroid of semi-axes b, b, d (equation (4)) that moves. Its parts are tested if it is not clear itself.

    `axis` is any vector ≠ 0 along its axis of revolution, or FREE. Its parts have the same axis: a tilted mover is
    turned with them from upright about a horizontal line, the shortest way.
    """

    b: float
    d: float
    parts: tuple[MoverPart, ...] = ()
    axis: Point | Literal["free"] = UPRIGHT


def places_of_parts(
    parts: Sequence[MoverPart], centre: Sequence[float], heading: float, axis: Sequence[float]
) -> list[Point]:
    """Return the centres of a mover's parts, rounded.

    A tilted mover is turned from upright about a horizontal line, the shortest way, to the unit vector u along `axis`
    that does not point down. That takes a horizontal p to p − (p·u)/(1 + u_z) (u_x, u_y, 0) − (p·u) e_z.
    """
    x, y, z = centre
    turns = [(part.arm, radians(heading + part.angle)) for part in parts]
    arms = [(arm * cos(turn), arm * sin(turn)) for arm, turn in turns]
    if axis[0] == axis[1] == 0:
        return [(x + across, y + along, z) for across, along in arms]
    largest = max(map(abs, axis)) * (-1 if axis[2] < 0 else 1)
    u, v, w = (part / largest for part in axis)
    norm = sqrt(u * u + v * v + w * w)
    u, v, w = u / norm, v / norm, w / norm
    places = []
    for across, along in arms:
        sink = across * u + along * v
        back = sink / (1 + w)
        places.append((x + (across - back * u), y + (along - back * v), z - sink))
    return places


@dataclass(frozen=True, slots=True)
class Region:
    """The region of a centre, that of the mover in the scene's coordinates; None: no limit along that axis."""

    x: Span | None = None
    y: Span | None = None
    z: Span | None = None

    @property
    def spans(self) -> tuple[Span | None, Span | None, Span | None]:
        """The three spans in order."""
        return self.x, self.y, self.z


TURNS = ("executed", "obeyed", "free")


@dataclass(frozen=True, slots=True)
class Start:
    """The starts of flights: heights uniform in `z`, places uniform over a disc about the axis, any headings.

    The disc has the `radius`, or ends `margin` before the surface at that height; one of the two is None.
    """

    z: Span
    radius: float | None = None
    margin: float | None = None


@dataclass(frozen=True, slots=True)
class Flight:
    """The rules of a quadcopter's random flight over `distance`: those of the paper, and those that it leaves open.

    Each draw is a move straight on with the probability `straight`, up or down (half each) with the probability
    `vertical`, else a turn uniform within ±`largest_turn` degrees. Straight means ahead or, if `backward`, half of the
    time back. `turn` is one of TURNS: with "executed" a turn asks the procedure at the same place, ignores the answer
    and is followed by a step ahead; with "obeyed" it does so too, but is refused like a movement if the answer is no;
    with "free" it only turns. After a refusal the quadcopter turns by `refused_turn` degrees, left or right alike.
    """

    distance: float
    straight: float
    vertical: float
    largest_turn: float
    refused_turn: float
    backward: bool
    turn: str
    start: Start


@dataclass(frozen=True, slots=True)
class Walk:
    """The rules of a random walk: `steps` moves of length `step`, each after a turn uniform in ±`largest_turn` degrees.

    It begins at `start` with `heading` (degrees from the x axis). After a refusal the next turn is by `refused_turn`
    degrees more, left or right alike.
    """

    start: Point
    heading: float
    steps: int
    step: float
    largest_turn: float
    refused_turn: float


@dataclass(frozen=True, slots=True)
class SceneModel:
    """One or more hyperboloids, a mover, the region it moves in, and the `question` (one of QUESTIONS) to answer.

    `flight` and `walk` are for `hypcheck simulate` alone.
    """

    name: str
    question: str
    hyperboloids: tuple[Hyperboloid, ...]
    mover: Mover
    region: Region = Region()
    flight: Flight | None = None
    walk: Walk | None = None

    @property
    def tilted(self) -> bool:
        """Whether anything in it is tilted, or may."""
        return is_tilted(self.mover.axis) or any(is_tilted(body.axis) for body in self.hyperboloids)
