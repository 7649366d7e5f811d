"""Flights start where the quadcopter may be; other starts are refused before the first draw."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.paper.motion import valid
from hypcheck.paper.quadcopter import any_angle, craft_of, require_valid_start, rims
from hypcheck.paper.tower import TowerPlan
from hypcheck.scene.model import Span, Start
from hypcheck.scene.reading import read_scene
from hypcheck.vectors.draw import Draw

TOWER = read_scene("tower")
STEEP = replace(TOWER, hyperboloids=(replace(TOWER.hyperboloids[0], gamma=2.0),))
CRAFT = craft_of(STEEP)


def starts(count):
    """Discs that reach from deep inside to beyond the wall, over spans of heights on both sides of the waist."""
    draw = Draw("starts")
    low, high = np.sort(draw.between(2 * count, -6, 6).reshape(2, count), axis=0)
    radius, margin = draw.between(count, 1.2, 2.4), draw.between(count, 0.15, 0.3)
    margin = np.where(np.arange(count) % 6 == 1, draw.between(count, 1.6, 2.2), margin)  # beyond the axis in places
    for place in range(count):
        span = Span(float(low[place]), float(high[place]))
        yield Start(span, margin=float(margin[place])) if place % 2 else Start(span, radius=float(radius[place]))


def rim_is_valid(start):
    """Whether the quadcopter is valid at 101 heights on the rim, at 8 headings: exactly, but of samples."""
    z = np.repeat(np.linspace(start.z.low, start.z.high, 101), 8)
    heading = any_angle(np.tile(np.arange(8) * 45.0, 101))
    at = (rims(CRAFT, start, z), np.zeros(len(z)), z)
    return bool(valid(CRAFT, at, heading).all())


def test_flight_simulation_refuses_a_start_disc_exactly_if_a_place_on_its_rim_is_invalid():
    told = {True: 0, False: 0}
    for start in starts(300):
        expected = rim_is_valid(start)
        told[expected] += 1
        if expected:
            require_valid_start("x", CRAFT, start)
        else:
            with pytest.raises(InputError, match="has flights start where neither the body nor all four rotors are"):
                require_valid_start("x", CRAFT, start)
    assert min(told.values()) > 50


def test_a_flight_that_starts_outside_the_tower_is_refused_before_it_is_drawn():
    flight = replace(TOWER.flight, start=Start(Span(-17.8, 17.8), radius=9.0))
    with pytest.raises(InputError, match=r"the scene 'cooling tower': \[flight.start\] radius = 9.0 has flights start"):
        _ = TowerPlan(replace(TOWER, flight=flight), 1, 5.0, 0.2, 0).flight
