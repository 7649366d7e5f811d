"""The result of `simulate forest` in words."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from typing import Any

from hypcheck.visible import counted

WIDTH = 100
SHOWN = 8
"""Phantoms that are told one by one."""


def forest_lines(result: dict[str, Any]) -> Iterator[str]:
    """Line by line."""
    trees, walker, steps = result["trees"], result["walker"], result["steps"]
    wide = sum(tree["type"] == 1 for tree in trees)
    yield (
        f"{result['scene']}, seed {result['seed']}: {counted(len(trees), 'tree')} ({wide} of type 1, "
        f"{len(trees) - wide} of type 2), a walker of b = {walker['b']:g}, d = {walker['d']:g}"
    )
    yield from _regime(result["outside_stated_regime"])
    yield (
        f"{counted(steps['tried'], 'step')} of {walker['step']:g} tried by Table 2 in float32: {steps['made']:,} made, "
        f"{steps['contact']:,} rightly refused,"
    )
    yield f"  {steps['phantom']:,} stopped by a phantom, {steps['edge']:,} turned back at the region's edge"
    if steps["wrongly_allowed"]:
        lead = "leads" if steps["wrongly_allowed"] == 1 else "lead"
        yield f"  {steps['wrongly_allowed']:,} of the made ones {lead} into contact"
    yield from _questions(result["questions"])
    phantoms = result["phantoms"]
    yield (
        f"phantoms, contact with nothing: {phantoms['float32']:,} in float32, {phantoms['float64']:,} in float64, "
        f"{phantoms['float32_after_line']:,} in float32 where the line is asked first"
    )
    yield (
        f"  Procedure 1 put right: {phantoms['float32_repaired']:,} in float32, {phantoms['float64_repaired']:,} in "
        f"float64; it decides {result['repaired']['float32_differs']:,} and "
        f"{result['repaired']['float64_differs']:,} steps otherwise"
    )
    yield from _stops(result["stops"])
    if result["ways"] is not None:
        ways = result["ways"]
        touching = "1 touches" if ways["touching"] == 1 else f"{ways['touching']:,} touch"
        yield f"{counted(ways['made'], 'made step')}: {touching} a tree on the way"
        for contact in ways["contacts"][:SHOWN]:
            start, end = (", ".join(f"{each:.3f}" for each in contact[name]) for name in ("start", "end"))
            yield f"  ({start}) to ({end}): {contact['tree']} first at {contact['first_upper']:.3g} of the way"


def _regime(names: list[str]) -> Iterator[str]:
    if names:
        listed = ", ".join(names[:SHOWN]) + (", …" if len(names) > SHOWN else "")
        told = f"Procedure 1 claims nothing about trees with (gamma/d)^2 < alpha/b: {len(names)}, {listed}"
        yield from textwrap.wrap(told, WIDTH)


def _questions(questions: dict[str, int]) -> Iterator[str]:
    asked, line = questions["asked"], questions["line"]
    share = f" ({100 * line / asked:.2f} %)" if asked else ""
    yield f"{counted(asked, 'question')}, one for each step and tree: a line answers {line:,} of them{share} without Δ"
    outside = questions["outside_height"]
    if outside:
        verbs = ("is", "has") if outside == 1 else ("are", "have")
        yield f"  {outside:,} more {verbs[0]} outside the modelled height and {verbs[1]} no answer"


def _stops(stops: list[dict[str, Any]]) -> Iterator[str]:
    phantoms = [stop for stop in stops if stop["kind"] == "phantom"]
    for stop in phantoms[:SHOWN]:
        x, y, z = stop["tried"]
        yield f"  at ({x:.3f}, {y:.3f}, {z:.3f}), {stop['gap']:.2f} from touching: {', '.join(stop['trees'])}"
    if len(phantoms) > SHOWN:
        yield f"  and {len(phantoms) - SHOWN:,} more"
