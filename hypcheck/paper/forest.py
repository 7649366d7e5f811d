"""`simulate forest`: the walker of the paper's section 3.1 among trees of both types, as JSON and as text."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from hypcheck.errors import InputError
from hypcheck.geometry.rows import Mask
from hypcheck.messages import counted
from hypcheck.paper.forest_walk import Trees, Verdicts, WalkSteps, judged, phantom_wall, steps_in_contact, walk
from hypcheck.paper.quadcopter import require_ordinary
from hypcheck.scene.model import SceneModel, Walk
from hypcheck.version import VERSION

SCHEMA = "1.1.0"

MOST_STEPS = 1_000_000

WINDOW = 0.1
"""Half of the side of the window that shows a wall closely, in units of the walker's b."""


@dataclass(frozen=True, slots=True)
class ForestPlan:
    """What is to be simulated: `steps` of the scene's walk, or as many as it says; `continuous`: the ways as well."""

    scene: SceneModel
    seed: int
    steps: int | None
    continuous: bool

    @property
    def rules(self) -> Walk:
        """The scene's walk. Raises InputError where it has none."""
        if self.scene.walk is None:
            raise InputError(f"the scene {self.scene.name!r} has no [walk]; docs/scenes.md has its keys")
        return self.scene.walk

    @property
    def count(self) -> int:
        """How many steps are tried. Raises InputError where they are too many."""
        steps = self.rules.steps if self.steps is None else self.steps
        if steps > MOST_STEPS:
            raise InputError(f"{steps:,} steps were asked for; it must be {MOST_STEPS:,} at most")
        return steps


def simulate_forest(plan: ForestPlan, advance: Callable[[int], object] = lambda _: None) -> dict[str, Any]:
    """The result, as schemas/simulate-forest-1.1.0.json has it; advanced by tried steps. Raises InputError."""
    require_ordinary(plan.scene)
    trees = Trees(plan.scene)
    steps = walk(trees, plan.rules, plan.scene.region, plan.count, plan.seed, advance)
    asked = ~steps.edge
    verdicts = judged(trees, steps.end[asked])
    free = np.asarray((verdicts.exterior | ~verdicts.asked).all(axis=1))
    phantom = np.zeros_like(steps.edge)
    phantom[asked] = free & steps.refused[asked]
    stops = _stops(trees, steps, phantom)
    blocking = {name for stop in stops if stop["kind"] == "phantom" for name in stop["trees"]}
    return {
        "hypcheck": VERSION,
        "schema": SCHEMA,
        "simulation": "forest",
        "scene": plan.scene.name,
        "seed": plan.seed,
        "walker": {"b": plan.scene.mover.b, "d": plan.scene.mover.d, "step": plan.rules.step},
        "trees": _trees(trees, plan.rules, blocking),
        "outside_stated_regime": trees.outside_regime,
        "steps": _steps(steps, phantom, free),
        "questions": _questions(verdicts),
        "phantoms": _phantoms(verdicts, free),
        "repaired": _repaired(verdicts),
        "ways": steps_in_contact(trees, steps) if plan.continuous else None,
        "path": [list(plan.rules.start), *steps.end[steps.made].tolist()],
        "stops": stops,
        "wall": _wall(trees, stops),
    }


def _trees(trees: Trees, rules: Walk, blocking: set[str]) -> list[dict[str, Any]]:
    return [
        {
            "name": tree.name,
            "type": trees.types[place],
            "alpha": tree.alpha,
            "gamma": tree.gamma,
            "center": list(tree.center),
            "height": None if tree.height is None else [tree.height.low, tree.height.high],
            "ring": trees.ring(place, rules.start[2]),
            "phantom": tree.name in blocking,
        }
        for place, tree in enumerate(trees.scene.hyperboloids)
    ]


def _steps(steps: WalkSteps, phantom: Mask, free: Mask) -> dict[str, int]:
    return {
        "tried": len(steps.edge),
        "made": _count(steps.made),
        "edge": _count(steps.edge),
        "contact": _count(steps.refused & ~phantom),
        "phantom": _count(phantom),
        "wrongly_allowed": _count(steps.made[~steps.edge] & ~free),
    }


def _questions(verdicts: Verdicts) -> dict[str, int]:
    return {
        "asked": _count(verdicts.asked),
        "outside_height": _count(~verdicts.asked),
        "line": _count(verdicts.line & verdicts.asked),
    }


def _phantoms(verdicts: Verdicts, free: Mask) -> dict[str, int]:
    """Tried steps that lead to a free place and are refused: by Table 2 in each precision, and after the line test."""
    ignored = ~verdicts.asked
    return {
        name: _count(free & ~(allowed | ignored).all(axis=1))
        for name, allowed in (
            ("float32", verdicts.single),
            ("float64", verdicts.double),
            ("float32_after_line", verdicts.single | verdicts.line),
            ("float32_repaired", verdicts.repaired_single),
            ("float64_repaired", verdicts.repaired_double),
        )
    }


def _repaired(verdicts: Verdicts) -> dict[str, int]:
    """Tried steps on which Procedure 1 put right and Table 2 differ, in each precision; all trees together."""
    ignored = ~verdicts.asked
    return {
        name: _count((put_right | ignored).all(axis=1) != (printed | ignored).all(axis=1))
        for name, printed, put_right in (
            ("float32_differs", verdicts.single, verdicts.repaired_single),
            ("float64_differs", verdicts.double, verdicts.repaired_double),
        )
    }


def _stops(trees: Trees, steps: WalkSteps, phantom: Mask) -> list[dict[str, Any]]:
    """Every refusal but those at the edge: what refused it, and the free way to the nearest tree that did."""
    refused = np.flatnonzero(steps.refused)
    verdicts, gaps = judged(trees, steps.end[refused]), trees.gaps(steps.end[refused])
    against = verdicts.asked & ~verdicts.single
    return [
        {
            "kind": "phantom" if phantom[step] else "contact",
            "at": steps.start[step].tolist(),
            "tried": steps.end[step].tolist(),
            "trees": [trees.scene.hyperboloids[tree].name for tree in np.flatnonzero(against[place])],
            "gap": float(gaps[place][against[place]].min()),
        }
        for place, step in enumerate(refused.tolist())
    ]


def _wall(trees: Trees, stops: Sequence[dict[str, Any]]) -> dict[str, Any] | None:
    """The wall that stopped the walker with the most free way before her; None where there was none."""
    phantoms = [stop for stop in stops if stop["kind"] == "phantom"]
    if not phantoms:
        return None
    worst = max(phantoms, key=lambda stop: float(stop["gap"]))
    return phantom_wall(trees, np.array(worst["tried"]), WINDOW * trees.scene.mover.b)


def _count(those: Mask) -> int:
    return int(np.count_nonzero(those))


WIDTH = 100
SHOWN = 8
"""Phantoms that are listed one by one."""


def forest_lines(result: dict[str, Any]) -> Iterator[str]:
    """Line by line."""
    trees, walker, steps = result["trees"], result["walker"], result["steps"]
    wide = sum(tree["type"] == 1 for tree in trees)
    yield (
        f"{result['scene']}, seed {result['seed']}: {counted(len(trees), 'tree')} ({wide} of type 1, "
        f"{len(trees) - wide} of type 2), a walker of b = {walker['b']:g}, d = {walker['d']:g}"
    )
    yield from _regime_line(result["outside_stated_regime"])
    yield (
        f"{counted(steps['tried'], 'step')} of {walker['step']:g} tried by Table 2 in float32: {steps['made']:,} made, "
        f"{steps['contact']:,} rightly refused,"
    )
    yield f"  {steps['phantom']:,} stopped by a phantom, {steps['edge']:,} turned back at the region's edge"
    if steps["wrongly_allowed"]:
        lead = "leads" if steps["wrongly_allowed"] == 1 else "lead"
        yield f"  {steps['wrongly_allowed']:,} of the made ones {lead} into contact"
    yield from _question_lines(result["questions"])
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
    yield from _stop_lines(result["stops"])
    if result["ways"] is not None:
        ways = result["ways"]
        touching = "1 touches" if ways["touching"] == 1 else f"{ways['touching']:,} touch"
        yield f"{counted(ways['made'], 'made step')}: {touching} a tree on the way"
        for contact in ways["contacts"][:SHOWN]:
            start, end = (", ".join(f"{each:.3f}" for each in contact[name]) for name in ("start", "end"))
            yield f"  ({start}) to ({end}): {contact['tree']} first at {contact['first_upper']:.3g} of the way"


def _regime_line(names: list[str]) -> Iterator[str]:
    if names:
        listed = ", ".join(names[:SHOWN]) + (", …" if len(names) > SHOWN else "")
        text = f"Procedure 1 claims nothing about trees with (gamma/d)^2 < alpha/b: {len(names)}, {listed}"
        yield from textwrap.wrap(text, WIDTH)


def _question_lines(questions: dict[str, int]) -> Iterator[str]:
    asked, line = questions["asked"], questions["line"]
    share = f" ({100 * line / asked:.2f} %)" if asked else ""
    yield f"{counted(asked, 'question')}, one for each step and tree: a line answers {line:,} of them{share} without Δ"
    outside = questions["outside_height"]
    if outside:
        verbs = ("is", "has") if outside == 1 else ("are", "have")
        yield f"  {outside:,} more {verbs[0]} outside the modelled height and {verbs[1]} no answer"


def _stop_lines(stops: list[dict[str, Any]]) -> Iterator[str]:
    phantoms = [stop for stop in stops if stop["kind"] == "phantom"]
    for stop in phantoms[:SHOWN]:
        x, y, z = stop["tried"]
        yield f"  at ({x:.3f}, {y:.3f}, {z:.3f}), {stop['gap']:.2f} from touching: {', '.join(stop['trees'])}"
    if len(phantoms) > SHOWN:
        yield f"  and {len(phantoms) - SHOWN:,} more"
