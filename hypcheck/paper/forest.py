"""`simulate forest`: a walk among trees that obeys Procedure 1 in float32, and the exact verdict on each step.

The walker of the paper's section 3.1 goes among trees of both types, as in a game.

Numbers that depend only on the sizes are computed once for each tree, as Table 2 computes them before its loop. Table
2's input is the walker's centre minus the tree's, rounded to float64; exact positions use the exact difference.

Before a step is made, the position to which it leads is tested against all trees that exist at that height. Steps
beyond the scene's region are refused without a test. Only a step's end is tested: between two free places it may touch
a trunk (`steps_in_contact`). A phantom is contact that Procedure 1 in float32 reports at a free place; `phantom_wall`
shows its surroundings.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from hypcheck.derivation.evaluation import loop_body
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS, REPAIRED
from hypcheck.errors import InputError
from hypcheck.geometry.pair import Position, Sizes
from hypcheck.geometry.rows import Columns, Floats, Mask
from hypcheck.paper.ends import beside_trees, require_ends
from hypcheck.paper.motion import MOST_CONTACTS, first_contact, stays_on_side
from hypcheck.paper.quadcopter import any_angle, require_ordinary, turned
from hypcheck.paper.trees import Places, Trees
from hypcheck.scene.model import Region, SceneModel, Walk
from hypcheck.vectors.draw import Draw, unit_of
from hypcheck.version import VERSION as HYPCHECK


class Procedure1:
    """Table 2 as printed, or the repaired Procedure 1, in one float format.

    Steps that depend only on trees' sizes are computed once, before the loop over places.
    """

    def __init__(self, trees: Trees, precision: str, *, repaired: bool = False) -> None:
        columns = dict(zip(("alpha", "gamma", "b", "d"), trees.sizes.T, strict=True))
        self._trees = trees
        formula = REPAIRED["procedure-1-repaired"] if repaired else FORMULAS["table-2"]
        self._body = loop_body(formula.program, float_arithmetic(precision), columns, (formula.answer,))

    def valid(self, at: Places) -> Mask:
        """Return a mask (n, m) of the trees that allow the movement, for which the procedure says exterior."""
        (answer,) = self._body(dict(zip("xyz", self._trees.offsets(at), strict=True)))
        return np.asarray(answer)


VERSION = 1
"""Version of the walk, raised whenever it draws other words."""

CHUNK = 256
"""Steps judged at a time."""


@dataclass(frozen=True, slots=True)
class WalkSteps:
    """The tried steps, in order: from `start` to `end`, (n, 3); steps in the masks `edge` and `refused` were not made.

    `refused` are the steps that Procedure 1 in float32 did not allow.
    """

    start: Places
    end: Places
    edge: Mask
    refused: Mask

    @property
    def made(self) -> Mask:
        """A mask of the steps that were made."""
        return ~(self.edge | self.refused)


@dataclass(frozen=True, slots=True)
class Verdicts:
    """The truth and the answers for each tried step within the region and each tree, (n, m).

    `asked`: the tree exists at that height, so its answer counts; `exterior`: the walker is exactly exterior; `line`:
    one line proves this. `printed` and `repaired` are, by format, masks of steps that Table 2 and the repaired
    Procedure 1 allow.
    """

    asked: Mask
    exterior: Mask
    line: Mask
    printed: dict[str, Mask]
    repaired: dict[str, Mask]

    def by_all(self, answers: Mask) -> Mask:
        """Return a mask of the steps that are allowed by the answers about all tested trees, (n,)."""
        return np.asarray((answers | ~self.asked).all(axis=1))


def walk(
    trees: Trees, rules: Walk, region: Region, steps: int, seed: int, advance: Callable[[int], object] = lambda _: None
) -> WalkSteps:
    """Try `steps` steps, calling `advance` for each. Raises InputError if the walk would begin outside the region."""
    if not bool(_inside(region, np.array([rules.start]))[0]):
        raise InputError(f"the walk starts at {list(rules.start)}, outside the scene's region")
    words = Draw("forest-walk", VERSION, seed).words(2 * steps).reshape(steps, 2)
    shares = unit_of(words[:, 0])
    wander, recover = (2 * shares - 1) * rules.largest_turn, np.where(words[:, 1] & np.uint64(1) == 0, 1.0, -1.0)
    turns = any_angle(wander), any_angle(wander + recover * rules.refused_turn)
    procedure, heading = Procedure1(trees, "float32"), any_angle(np.array(rules.heading))
    start, end = np.empty((steps, 3)), np.empty((steps, 3))
    edge, refused = np.zeros(steps, dtype=np.bool_), np.zeros(steps, dtype=np.bool_)
    here, stopped = np.array(rules.start), False
    for step in range(steps):
        cosine, sine = turns[int(stopped)]
        heading = turned(heading, (cosine[step], sine[step]))
        start[step], end[step] = here, here + rules.step * np.array([*heading, 0.0])
        tried = end[step : step + 1]
        edge[step] = not _inside(region, tried)[0]
        refused[step] = not edge[step] and not (procedure.valid(tried) | ~trees.modelled(tried)).all()
        stopped = bool(edge[step] or refused[step])
        if not stopped:
            here = end[step]
        advance(1)
    return WalkSteps(start, end, edge, refused)


def judged(trees: Trees, at: Places) -> Verdicts:
    """Return the verdicts about a walker at these places."""
    printed, repaired = (
        {
            precision: _in_parts(trees, at, Procedure1(trees, precision, repaired=put_right).valid)
            for precision in ("float32", "float64")
        }
        for put_right in (False, True)
    )
    questions = (trees.modelled, trees.exterior, trees.proved_by_line)
    at_height, exterior, line = (_in_parts(trees, at, question) for question in questions)
    return Verdicts(at_height, exterior, line, printed, repaired)


def _in_parts(trees: Trees, at: Places, ask: Callable[[Places], Mask]) -> Mask:
    """Return the answers of `ask` for many places, CHUNK of them at a time, (n, m)."""
    none = np.empty((0, len(trees.sizes)), dtype=np.bool_)
    return np.concatenate([none, *(ask(at[place : place + CHUNK]) for place in range(0, len(at), CHUNK))])


def _inside(region: Region, at: Places) -> Mask:
    """Return a mask of the places in the region, (n,)."""
    inside = np.ones(len(at), dtype=np.bool_)
    for column, span in zip(at.T, region.spans, strict=True):
        if span is not None:
            inside &= (column >= span.low) & (column <= span.high)
    return inside


CELLS = 121


def phantom_wall(trees: Trees, place: Floats, half: float) -> dict[str, Any]:
    """Return the answers over a square around a place at its height: lines of letters from the least y to the greatest.

    e: exterior to every tree, c: not; upper case if float32 answers differently. x varies along a line.
    """
    steps = np.linspace(-half, half, CELLS)
    y, x = np.meshgrid(place[1] + steps, place[0] + steps, indexing="ij")
    at = np.stack([x.ravel(), y.ravel(), np.full(x.size, place[2])], axis=1)
    ignored, exterior, valid = (
        _in_parts(trees, at, ask)
        for ask in (lambda part: ~trees.modelled(part), trees.exterior, Procedure1(trees, "float32").valid)
    )
    truth, answer = (exterior | ignored).all(axis=1), (valid | ignored).all(axis=1)
    letters = np.where(truth, np.where(answer, "e", "E"), np.where(answer, "C", "c")).reshape(CELLS, CELLS)
    return {
        "center": place.tolist(),
        "half": half,
        "wrong": int(np.count_nonzero(truth != answer)),
        "points": int(truth.size),
        "lines": ["".join(line) for line in letters.tolist()],
    }


def steps_in_contact(trees: Trees, steps: WalkSteps) -> dict[str, Any]:
    """Count the made steps that touch an existing tree, decided exactly; return also first contacts of some of them."""
    start, end = steps.start[steps.made], steps.end[steps.made]
    here, there = ((x, y, z) for x, y, z in (start.T, end.T))
    at_height, touched = trees.modelled(end), np.zeros((len(end), len(trees.sizes)), dtype=np.bool_)
    for place, tree in enumerate(trees.scene.hyperboloids):
        exterior = stays_on_side(Position.EXTERIOR, _four(trees.sizes[place]), here, there, tree.center)
        touched[:, place] = at_height[:, place] & ~exterior
    touching = np.flatnonzero(touched.any(axis=1))
    return {
        "made": len(end),
        "touching": len(touching),
        "contacts": [_contact(trees, here, there, step, touched[step]) for step in touching[:MOST_CONTACTS].tolist()],
    }


def _contact(trees: Trees, start: Columns, end: Columns, step: int, touched: Mask) -> dict[str, Any]:
    """Return the first contact on a step that touches these trees."""
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


def _four(sizes: Floats) -> Sizes:
    alpha, gamma, b, d = map(float, sizes)
    return alpha, gamma, b, d


SCHEMA = "1.1.0"

MOST_STEPS = 1_000_000

WINDOW = 0.1
"""Half of the side of the window that shows a wall closely, in units of the walker's b."""


@dataclass(frozen=True, slots=True)
class ForestPlan:
    """The plan of a simulation: `steps` of the scene's walk, by default the scene's number.

    `continuous`: sweeps are decided too; `ends`: places are also decided beside trees with their ends.
    """

    scene: SceneModel
    seed: int
    steps: int | None
    continuous: bool
    ends: bool = False

    @property
    def rules(self) -> Walk:
        """The scene's walk. Raises InputError if it has none."""
        if self.scene.walk is None:
            raise InputError(f"the scene {self.scene.name!r} has no [walk]; docs/scenes.md has its keys")
        return self.scene.walk

    @property
    def count(self) -> int:
        """The number of tried steps. Raises InputError if they are too many."""
        steps = self.rules.steps if self.steps is None else self.steps
        if steps > MOST_STEPS:
            raise InputError(f"{steps:,} steps are too many; the limit is {MOST_STEPS:,}")
        return steps


def simulate_forest(plan: ForestPlan, advance: Callable[[int], object] = lambda _: None) -> dict[str, Any]:
    """Simulate a walk; return the result in the form of schemas/simulate-forest-1.1.0.json.

    `advance` gets the number of tried steps. Raises InputError for a plan that is not valid.
    """
    require_ordinary(plan.scene)
    if plan.ends:
        require_ends(plan.scene)
    trees = Trees(plan.scene)
    steps = walk(trees, plan.rules, plan.scene.region, plan.count, plan.seed, advance)
    tested = ~steps.edge
    verdicts = judged(trees, steps.end[tested])
    free = verdicts.by_all(verdicts.exterior)
    phantom = np.zeros_like(steps.edge)
    phantom[tested] = free & steps.refused[tested]
    stops = _stops(trees, steps, phantom)
    blocking = {name for stop in stops if stop["kind"] == "phantom" for name in stop["trees"]}
    ends = beside_trees(plan.scene, steps.end[tested], verdicts.asked, verdicts.exterior) if plan.ends else None
    return {
        "hypcheck": HYPCHECK,
        "schema": SCHEMA,
        "simulation": "forest",
        "scene": plan.scene.name,
        "seed": plan.seed,
        "walker": {"b": plan.scene.mover.b, "d": plan.scene.mover.d, "step": plan.rules.step},
        "trees": _trees(trees, plan.rules, blocking),
        "outside_stated_regime": trees.outside_regime,
        "steps": _steps(steps, phantom, free),
        "questions": {
            "asked": _count(verdicts.asked),
            "outside_height": _count(~verdicts.asked),
            "line": _count(verdicts.line & verdicts.asked),
        },
        "phantoms": _phantoms(verdicts, free),
        "repaired": {
            f"{name}_differs": _count(verdicts.by_all(put_right) != verdicts.by_all(verdicts.printed[name]))
            for name, put_right in verdicts.repaired.items()
        },
        "ways": steps_in_contact(trees, steps) if plan.continuous else None,
        "path": [list(plan.rules.start), *steps.end[steps.made].tolist()],
        "stops": stops,
        "wall": _wall(trees, stops),
        **({"ends": ends} if plan.ends else {}),
    }


def _trees(trees: Trees, rules: Walk, blocking: set[str]) -> list[dict[str, Any]]:
    """Describe each tree for JSON; `blocking` has the names of those that refused a step."""
    return [
        {
            "name": tree.name,
            "type": trees.types[place],
            "alpha": tree.alpha,
            "gamma": tree.gamma,
            "center": list(tree.center),
            "height": None if tree.height is None else list(tree.height.ends),
            "ring": trees.ring(place, rules.start[2]),
            "phantom": tree.name in blocking,
        }
        for place, tree in enumerate(trees.scene.hyperboloids)
    ]


def _steps(steps: WalkSteps, phantom: Mask, free: Mask) -> dict[str, int]:
    """Count the tried steps by what happened to them, for JSON."""
    return {
        "tried": len(steps.edge),
        "made": _count(steps.made),
        "edge": _count(steps.edge),
        "contact": _count(steps.refused & ~phantom),
        "phantom": _count(phantom),
        "wrongly_allowed": _count(steps.made[~steps.edge] & ~free),
    }


def _phantoms(verdicts: Verdicts, free: Mask) -> dict[str, int]:
    """Count the refused steps to a free place: those of each procedure, and those of Table 2 after the line test."""
    answers = {
        **verdicts.printed,
        "float32_after_line": verdicts.printed["float32"] | verdicts.line,
        **{f"{name}_repaired": allowed for name, allowed in verdicts.repaired.items()},
    }
    return {name: _count(free & ~verdicts.by_all(allowed)) for name, allowed in answers.items()}


def _stops(trees: Trees, steps: WalkSteps, phantom: Mask) -> list[dict[str, Any]]:
    """Return every refusal inside the region: its cause, and the gap to the nearest tree that refused."""
    refused = np.flatnonzero(steps.refused)
    verdicts, gaps = judged(trees, steps.end[refused]), trees.gaps(steps.end[refused])
    against = verdicts.asked & ~verdicts.printed["float32"]
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
    """Return the invisible wall that stopped the walker with the largest gap; None if there was none."""
    phantoms = [stop for stop in stops if stop["kind"] == "phantom"]
    if not phantoms:
        return None
    worst = max(phantoms, key=lambda stop: float(stop["gap"]))
    return phantom_wall(trees, np.array(worst["tried"]), WINDOW * trees.scene.mover.b)


def _count(those: Mask) -> int:
    return int(np.count_nonzero(those))
