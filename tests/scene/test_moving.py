"""[flight] and [walk]: the tables of a scene that say how its mover moves."""

from __future__ import annotations

import json
from importlib import resources

import pytest

from hypcheck.errors import InputError
from hypcheck.scene.model import Flight, Span, Start, Walk
from hypcheck.scene.reading import parse_scene
from tests.scene.test_reading import LEAST
from tests.scene.test_schema import accepted, places, replaced, tomllib
from tests.support.records import violations

SCHEMA = json.loads(
    resources.files("hypcheck.scene").joinpath("schemas", "scene-1.2.0.json").read_text(encoding="utf-8")
)
MOVING = (
    LEAST
    + """
[flight]
distance = 500
straight = 0.25
vertical = 0.5
largest_turn = 45
refused_turn = 90
backward = true
turn = "free"
[flight.start]
z = 3
radius = 1.5

[walk]
start = [1, -2, 0.5]
heading = -30
steps = 20
step = 0.25
largest_turn = 10
refused_turn = 60
"""
)


def changed(old, new):
    assert MOVING.count(old) == 1
    return MOVING.replace(old, new)


def test_flight_and_walk_of_a_scene_with_every_key_are_read():
    scene = parse_scene(MOVING)
    assert scene.flight == Flight(
        500.0, 0.25, 0.5, 45.0, 90.0, backward=True, turn="free", start=Start(Span(3.0, 3.0), radius=1.5)
    )
    assert scene.walk == Walk((1.0, -2.0, 0.5), -30.0, 20, 0.25, 10.0, 60.0)
    assert parse_scene(changed("radius = 1.5", "margin = 0")).flight.start == Start(Span(3.0, 3.0), margin=0.0)


def test_a_scene_needs_neither_flight_nor_walk():
    scene = parse_scene(LEAST)
    assert scene.flight is None
    assert scene.walk is None


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (changed("distance = 500", ""), "line 5: [flight] has no distance; it must be a finite number above 0"),
        (changed("straight = 0.25", "straight = 1.5"), "line 7: [flight]: straight is 1.5; it must be a number from 0"),
        (changed("straight = 0.25", "straight = 0.75"), "line 8: [flight]: straight and vertical add up to 1.25; they"),
        (changed("largest_turn = 45", "largest_turn = 181"), "line 9: [flight]: largest_turn is 181; it must be a"),
        (changed("backward = true", "backward = 1"), "line 11: [flight]: backward is 1; it must be true or false"),
        (changed('turn = "free"', 'turn = "left"'), "line 12: [flight]: turn is "),
        (changed("[flight.start]\nz = 3\nradius = 1.5", ""), "line 5: [flight] has no start; it must be a table"),
        (changed("radius = 1.5", ""), "line 13: [flight].start must have either a radius or a margin"),
        (changed("radius = 1.5", "radius = 1.5\nmargin = 1"), "line 13: [flight].start must have either"),
        (changed("radius = 1.5", "radius = -1.5"), "line 15: [flight].start: radius is -1.5; it must be a finite"),
        (changed("steps = 20", "steps = 20.0"), "line 20: [walk]: steps is 20.0; it must be a whole number"),
        (changed("steps = 20", "steps = -1"), "line 20: [walk]: steps is -1; "),
        (changed("steps = 20", "steps = true"), "line 20: [walk]: steps is true; "),
        (changed("step = 0.25", "step = 0"), "line 21: [walk]: step is 0; it must be a finite number above 0"),
        (changed("[1, -2, 0.5]", "[1, -2]"), "line 18: [walk]: start is [1, -2]; it must be three finite numbers"),
        (changed("heading = -30", "heading = nan"), "line 19: [walk]: heading is nan; it must be a number of degrees"),
        (
            changed("refused_turn = 60", "refused = 60"),
            'line 23: [walk] has the key "refused", which is not known; did',
        ),
        (
            changed("straight = 0.25", "straight = 0").replace("vertical = 0.5", "vertical = 0"),
            "line 7: [flight]: nothing ever moves",
        ),
    ],
)
def test_invalid_flight_or_walk_is_refused_naming_key_and_line(text, message):
    with pytest.raises(InputError) as caught:
        parse_scene(text)
    assert message in str(caught.value)


def test_scene_reader_and_schema_agree_on_flight_and_walk():
    content = tomllib.loads(MOVING)
    assert violations(content, SCHEMA, closed=True) == []
    for path in list(places(content)):
        if path[0] in ("flight", "walk"):
            for value in (None, True, -1.0, 0, 2, 500.0, "", "free", [1.0, 2.0], [1.0, 2.0, 3.0], {}, {"z": 1}):
                other = replaced(content, path, value)
                assert accepted(other) == (not violations(other, SCHEMA)) or "straight" in path or "vertical" in path
