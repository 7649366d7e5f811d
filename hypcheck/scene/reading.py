"""Reading a scene file: TOML, complete and strict. An unknown key or an impossible value is refused in one sentence.

docs/scenes.md explains the keys; schemas/scene-1.2.0.json has them for editors and other programs. The tables [flight]
and [walk] say how `hypcheck simulate` moves the mover.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from fractions import Fraction
from importlib import resources

from hypcheck import strict, toml
from hypcheck.errors import InputError
from hypcheck.messages import suggestion
from hypcheck.scene import model
from hypcheck.strict import StrictTable

_FLIGHT = ("distance", "straight", "vertical", "largest_turn", "refused_turn", "backward", "turn", "start")
_START = ("z", "radius", "margin")
_WALK = ("start", "heading", "steps", "step", "largest_turn", "refused_turn")


def _flight(top: StrictTable) -> model.Flight | None:
    """Read the flight in the table [flight]; None if there is no such table. Raises InputError."""
    table = top.table("flight", _FLIGHT)
    if table is None:
        return None
    flight = model.Flight(
        distance=table.required("distance", strict.positive),
        straight=table.required("straight", _share),
        vertical=table.required("vertical", _share),
        largest_turn=table.required("largest_turn", _turn),
        refused_turn=table.required("refused_turn", _turn),
        backward=table.required("backward", strict.truth),
        turn=table.required("turn", strict.one_of(*model.TURNS)),
        start=_start(table),
    )
    moving = flight.straight + flight.vertical
    if moving > 1:
        table.refuse(f"[flight]: straight and vertical add up to {moving!r}; they must not exceed 1", "vertical")
    if moving == 0 and flight.turn == "free":
        table.refuse("[flight]: nothing ever moves: straight and vertical are 0, and turns are free", "straight")
    return flight


def _start(flight: StrictTable) -> model.Start:
    """Read the table [flight].start. Raises InputError."""
    table = flight.table("start", _START)
    if table is None:
        flight.refuse("[flight] has no start; it must be a table with z, and radius or margin")
    start = model.Start(
        z=table.required("z", _span_or_number),
        radius=table.optional("radius", strict.not_negative, None),
        margin=table.optional("margin", strict.not_negative, None),
    )
    if (start.radius is None) == (start.margin is None):
        table.refuse("[flight].start must have either a radius or a margin")
    return start


def _walk(top: StrictTable) -> model.Walk | None:
    """Read the walk in the table [walk]; None if there is no such table. Raises InputError."""
    table = top.table("walk", _WALK)
    if table is None:
        return None
    return model.Walk(
        start=table.required("start", strict.point),
        heading=table.required("heading", _turn),
        steps=table.required("steps", strict.integer),
        step=table.required("step", strict.positive),
        largest_turn=table.required("largest_turn", _turn),
        refused_turn=table.required("refused_turn", _turn),
    )


SUFFIX = ".toml"

MOST_HYPERBOLOIDS = 20_000
MOST_PARTS = 100
"""The most hyperboloids and parts of a file. A scene that is made in Python (scene.model) may have more."""

_ARRAY = "an array of tables, [[{}]]"
_SCENE = ("name", "question", "hyperboloid", "mover", "region", "flight", "walk")
_HYPERBOLOID = ("name", "alpha", "gamma", "center", "height", "axis", "solid")
_MOVER = ("b", "d", "part", "axis")
_PART = ("b", "d", "arm", "angle")
_REGION = ("x", "y", "z")


def read_scene(name: str) -> model.SceneModel:
    """Read the scene in a file, or the shipped scene of that name (see shipped_scenes). Raises InputError."""
    return parse_scene(*_file(name))


def shipped_scenes() -> tuple[str, ...]:
    """Return the names of the scenes that come with the package, in alphabetical order."""
    files = (path.name for path in resources.files("hypcheck.scene").joinpath("shipped").iterdir())
    return tuple(sorted(file.removesuffix(SUFFIX) for file in files if file.endswith(SUFFIX)))


def shipped_text(name: str) -> str:
    """Return the TOML text of a shipped scene."""
    return resources.files("hypcheck.scene").joinpath("shipped", name + SUFFIX).read_text(encoding="utf-8")


def parse_scene(text: str, source: str = "the scene") -> model.SceneModel:
    """Read the scene that a TOML text describes; `source` names it in errors. Raises InputError naming key and line."""
    return _scene(strict.table_of(text, source, "the scene", _SCENE))


def _scene(top: StrictTable) -> model.SceneModel:
    """Read a whole scene. Raises InputError."""
    name = top.required("name", strict.text)
    question = top.optional("question", strict.one_of(*model.QUESTIONS), "position")
    hyperboloids = _hyperboloids(top)
    scene = model.SceneModel(name, question, hyperboloids, _mover(top), _region(top), _flight(top), _walk(top))
    endless = any(body.height and math.inf in map(abs, body.height.ends) for body in hyperboloids)
    for key, moving in (("flight", scene.flight), ("walk", scene.walk)):
        if moving is not None:
            if endless:
                top.refuse(f"[{key}] is of a scene in which a height is infinite; leave out such a height", key)
            if scene.tilted:
                top.refuse(
                    f"[{key}] is of a scene in which something is tilted; simulations fly and walk upright among what "
                    "is upright: leave out axis (simulate tower --pitch tilts the craft)",
                    key,
                )
    return scene


def _file(name: str) -> tuple[str, str]:
    """Return the text of the scene of that name, and its name in messages. Raises InputError."""
    if not name.endswith(SUFFIX) and name in shipped_scenes():
        return shipped_text(name), f"the shipped scene {name}"
    try:
        return toml.text_of(name), name
    except FileNotFoundError:
        meant = suggestion(
            name.removesuffix(SUFFIX), shipped_scenes(), otherwise="it must be a file, or a shipped scene:"
        )
        raise InputError(f"{name}: there is no such file; {meant}") from None


def _hyperboloids(top: StrictTable) -> tuple[model.Hyperboloid, ...]:
    """Read the tables [[hyperboloid]], one at least, with different names. Raises InputError."""
    numbers: dict[str, int] = {}
    result = []
    for number, table in enumerate(
        top.tables("hyperboloid", _HYPERBOLOID, _ARRAY.format("hyperboloid"), most=MOST_HYPERBOLOIDS), start=1
    ):
        body = model.Hyperboloid(
            name=table.optional("name", strict.text, f"hyperboloid {number}"),
            alpha=table.required("alpha", strict.positive),
            gamma=table.required("gamma", strict.positive),
            center=table.optional("center", strict.point, (0.0, 0.0, 0.0)),
            height=table.optional("height", _height, None),
            axis=table.optional("axis", strict.direction, model.UPRIGHT),
            solid=table.optional("solid", strict.truth, False),
        )
        first = numbers.setdefault(body.name, number)
        if first != number:
            same = table.origin.shown(body.name)
            table.refuse(f"hyperboloid {number} is called {same} as hyperboloid {first} is; names must differ", "name")
        result.append(body)
    if not result:
        top.refuse("the scene has no hyperboloid; it must have one [[hyperboloid]] at least", "hyperboloid")
    return tuple(result)


def _mover(top: StrictTable) -> model.Mover:
    """Read the table [mover]. Raises InputError."""
    table = top.table("mover", _MOVER)
    if table is None:
        top.refuse("the scene has no [mover]; it must have one, with b and d")
    b, d = (table.required(name, strict.positive) for name in ("b", "d"))
    return model.Mover(b, d, tuple(_parts(table, b, d)), table.optional("axis", _axis_or_free, model.UPRIGHT))


def _parts(mover: StrictTable, b: float, d: float) -> Iterable[model.MoverPart]:
    """Yield the parts of the mover, each within it. Raises InputError."""
    for number, table in enumerate(mover.tables("part", _PART, _ARRAY.format("mover.part"), most=MOST_PARTS), start=1):
        part = model.MoverPart(
            b=table.required("b", strict.positive),
            d=table.required("d", strict.positive),
            arm=table.required("arm", strict.not_negative),
            angle=table.optional("angle", strict.number, 0.0),
        )
        if not within(part, b, d):
            table.refuse(
                f"mover part {number} reaches beyond the mover (b = {b!r}, d = {d!r}); it must lie within it, "
                "because it is tested only if the mover is not clear"
            )
        yield part


def within(part: model.MoverPart, b: float, d: float) -> bool:
    """Decide exactly whether the part lies in the closed spheroid of semi-axes b, b, d, which are float64 values.

    Divide lengths by b and d as Theorem 1 does: the mover is the unit ball, the part has semi-axes p, p, q and its
    centre is e away. The square of the distance of its point at (e + p c, q s), c² + s² = 1, is
    (p² − q²) c² + 2 e p c + e² + q². For p ≥ q it is convex in c and largest at c = 1; else at c = e p/(q² − p²), or at
    1 where that is beyond. Turned about the part's own axis, a point is farthest in the plane of both axes.
    """
    p, e, q = Fraction(part.b) / Fraction(b), Fraction(part.arm) / Fraction(b), Fraction(part.d) / Fraction(d)
    bend = q * q - p * p
    if bend <= 0 or e * p >= bend:
        return e + p <= 1
    return e * e + q * q + (e * p) ** 2 / bend <= 1


def _region(top: StrictTable) -> model.Region:
    """Read the table [region]; a Region without limits if there is none. Raises InputError."""
    table = top.table("region", _REGION)
    if table is None:
        return model.Region()
    return model.Region(*(table.optional(name, _span_or_number, None) for name in _REGION))


_turn = strict.number_with("a number of degrees, from -180 to 180", -180, 180)
_share = strict.number_with("a number from 0 to 1", 0, 1)
_axis_or_free = strict.or_word(model.FREE, strict.direction)


def _height(value: object) -> model.Span:
    """Read the two heights at which a hyperboloid ends; infinite if it does not end. Raises ValueError."""
    return _span(value, "two numbers, finite or infinite, [low, high] with low < high", infinite=True)


def _span(
    value: object, wanted: str = "two finite numbers, [low, high] with low < high", *, infinite: bool = False
) -> model.Span:
    """Read a span of more than one number. Raises ValueError with the text `wanted`."""
    low, high = strict.numbers_of(value, 2, wanted, infinite=infinite)
    if not low < high:
        raise ValueError(wanted)
    return model.Span(low, high)


def _span_or_number(value: object) -> model.Span:
    """Read a span, or a single number as a span of that number alone. Raises ValueError."""
    if isinstance(value, list):
        return _span(value)
    only = strict.number_of(value, "a finite number, or two, [low, high] with low < high")
    return model.Span(only, only)
