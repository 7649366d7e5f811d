"""Routines printed: what is printed gives what the routine is run to, and a language's reserved names are refused."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.program import steps_of
from hypcheck.derivation.routines import Loop, Routine, run
from hypcheck.kernel.emission.dialects import dialect_of, routines_text
from hypcheck.kernel.specialise.tilted_search import search_of
from hypcheck.scene.reading import read_scene
from tests.support.inside import plan_of

STEPS = 71


def test_the_printed_search_gives_the_same_answers_as_running_the_routine():
    """From the axis to far outside: every answer occurs; where it changes, down to neighbouring numbers."""
    plan = plan_of(replace(read_scene("tower-simplest"), question="position"))
    constants, routine, scope = plan.settings[0].last.constants, search_of(STEPS), {"math": math}
    exec(routines_text([routine], dialect_of("python"), "float64"), scope)  # noqa: S102 - our own text

    def answer(r):
        given = {"R": r * r, "zz": 0.25, "height": 0.5}
        found = run(routine, float_arithmetic("float64"), {**given, **constants})
        assert scope["search"](*given.values(), *(constants[name] for name in routine.record)) == found
        return found

    asked = [(answer(r), r) for r in np.geomspace(1e-4, 1e4, 16).tolist()]
    assert {found for found, _ in asked} == {-1, 0, 1}
    for (before, low), (after, high) in pairwise(asked):
        left, right = low, high
        while before != after and left < (middle := (left + right) / 2) < right:
            left, right = (middle, right) if answer(middle) == before else (left, middle)


def test_a_name_that_a_language_reserves_is_refused():
    loop = Loop(2, (("short", "x", "y"),), steps_of("y = short + 1"))
    routine = Routine("r", "One more, twice.", ("x",), (loop,), "short")
    assert "short = y" in routines_text([routine], dialect_of("python"), "float64")
    with pytest.raises(ValueError, match="short is not a name in c"):
        routines_text([routine], dialect_of("c"), "float64")
