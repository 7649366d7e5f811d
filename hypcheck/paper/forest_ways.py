"""The ways between a walker's positions: which steps touch a tree before their end, and when first.

A step is made or refused for the place it leads to. From one free place to another it may still brush a trunk.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from hypcheck.casebook.draw import Floats
from hypcheck.pairs import Position
from hypcheck.paper.flights_craft import Point
from hypcheck.paper.forest_trees import Mask, Places, Trees
from hypcheck.paper.forest_walk import Steps
from hypcheck.paper.motion import always, first_contact

TOLD = 12
"""First contacts that are told one by one."""


def ways(trees: Trees, steps: Steps) -> dict[str, Any]:
    """How many of the made steps touch a tree that stands there, decided exactly, and first contacts of some."""
    start, end = steps.start[steps.made], steps.end[steps.made]
    here, there = _columns(start), _columns(end)
    asked, touched = trees.modelled(end), np.zeros((len(end), len(trees.sizes)), dtype=np.bool_)
    for place, tree in enumerate(trees.scene.hyperboloids):
        exterior = always(Position.EXTERIOR, _four(trees.sizes[place]), here, there, tree.center)
        touched[:, place] = asked[:, place] & ~exterior
    touching = np.flatnonzero(touched.any(axis=1))
    return {
        "made": len(end),
        "touching": len(touching),
        "contacts": [_contact(trees, here, there, step, touched[step]) for step in touching[:TOLD].tolist()],
    }


def _contact(trees: Trees, start: Point, end: Point, step: int, touched: Mask) -> dict[str, Any]:
    """The first contact on a step that touches these trees."""
    bodies = [(place, trees.scene.hyperboloids[place]) for place in np.flatnonzero(touched).tolist()]
    (lower, upper), name = min(
        (first_contact(_four(trees.sizes[place]), start, end, step, tree.center), tree.name) for place, tree in bodies
    )
    return {
        "start": [float(column[step]) for column in start],
        "end": [float(column[step]) for column in end],
        "tree": name,
        "first_lower": lower,
        "first_upper": upper,
    }


def _columns(places: Places) -> Point:
    x, y, z = places.T
    return x, y, z


def _four(sizes: Floats) -> tuple[float, float, float, float]:
    alpha, gamma, b, d = map(float, sizes)
    return alpha, gamma, b, d
