"""`simulate … --ends`: what the centre's height misses where a tower, or a tree, ends.

The paper restricts a flight "up to the maximum height of the cooling tower", and says nothing of the body. So its
flights ask where the centre is alone: below its end a wall goes on for ever, above it there is none. Here each position
is decided exactly beside the wall as it is, between its two heights (docs/mathematics.md, "Towers that end"). Flights
and walks go as they go without this option.

An answer is *dangerous* where the centre's height allows what the wall that ends does not, and *needless* where it
refuses what that wall allows. Inside an open wall none is dangerous: its end only takes wall away. Beyond it, and about
trees, some are.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hypcheck.errors import InputError
from hypcheck.geometry.pair import UPRIGHT, Position, Sizes
from hypcheck.geometry.rows import Columns, Floats, Mask, Positions
from hypcheck.kernel.classify import classify
from hypcheck.kernel.scene import Scene
from hypcheck.paper.flights import Moves
from hypcheck.paper.motion import MARGIN, VerdictCounts, all_four, headed, of, valid
from hypcheck.paper.quadcopter import Craft, Direction
from hypcheck.scene.model import SceneModel

SHOWN = 12
"""Places at which the answers differ that are listed one by one."""


def require_ends(scene: SceneModel) -> None:
    """Raise InputError where nothing in the scene ends."""
    if all(body.height is None for body in scene.hyperboloids):
        raise InputError(f"--ends: nothing in the scene {scene.name!r} ends; give its hyperboloids a height")


@dataclass(slots=True)
class EndVerdicts(VerdictCounts):
    """Answers about a tower by the centre's height, against the exact ones about the wall that ends.

    Of the `asked` moves the body is `reaching` beyond an end where so many lead to, and there `needless` are valid and
    would be refused, `dangerous` not valid and allowed, if the centre's height were all and the rest exact. Of the
    `beyond` draws that lead to beyond the tower's height, at which nothing is asked, `touching` meet the wall, which a
    centre's height does not tell.
    """

    asked: int = 0
    reaching: int = 0
    needless: int = 0
    dangerous: int = 0
    beyond: int = 0
    touching: int = 0

    def watch(self, craft: Craft, moves: Moves) -> None:
        """Count the results of a draw of many flights."""
        some = np.flatnonzero((moves.accepted | moves.refused) & ~moves.turning)
        self.asked += len(some)
        near = some[_reaching(craft, moves.end[2][some])]
        at, heading = of(moves.end, near), headed(moves.before, near)
        self.reaching += len(near)
        by_center, by_ends = valid(craft, at, heading), valid_between(craft, at, heading)
        self._count("needless", by_ends & ~by_center)
        self._count("dangerous", by_center & ~by_ends)
        beyond = np.flatnonzero(moves.vertical & ~moves.executed)
        self.beyond += len(beyond)
        self._count("touching", _positions(craft, craft.sizes, of(moves.end, beyond)) == Position.CONTACT)


def _reaching(craft: Craft, z: Floats) -> Mask:
    """Which bodies at these heights may reach beyond an end; where none does, an end changes nothing."""
    if craft.height is None:
        return np.zeros(z.shape, dtype=np.bool_)
    d = max(craft.sizes[3], craft.rotor[3])
    slack = MARGIN * (np.abs(z) + d)
    return np.asarray((z + d + slack >= craft.height.high) | (z - d - slack <= craft.height.low))


def valid_between(craft: Craft, at: Columns, heading: Direction) -> Mask:
    """Which positions are exactly valid beside the wall that ends: the body interior, or every rotor."""
    result = np.asarray(_positions(craft, craft.sizes, at) == Position.INTERIOR)
    near = np.flatnonzero(~result)
    rotors = craft.rotors(of(at, near), headed(heading, near))
    result[near] = all_four(_positions(craft, craft.rotor, rotors) == Position.INTERIOR)
    return result


def _positions(craft: Craft, sizes: Sizes, at: Columns) -> Positions:
    low, high = (-np.inf, np.inf) if craft.height is None else (craft.height.low, craft.height.high)
    fixed = np.tile((*UPRIGHT, low, high, float(craft.solid)), (len(at[0]), 1))
    return np.asarray(classify(np.column_stack([np.tile(sizes, (len(at[0]), 1)), *at, fixed])), dtype=np.int8)


def beside_trees(scene: SceneModel, at: Floats, asked: Mask, exterior: Mask) -> dict[str, Any]:
    """What the centre's height misses at these places, (n, 3), of the trees, (m,), as JSON has it.

    `asked` (n, m) says where the centre is at a tree's height, `exterior` (n, m) where the mover is exterior to the
    tree if that had no ends.
    """
    walker = replace(scene.mover, parts=())
    ended = [
        Scene(replace(scene, question="position", hyperboloids=(tree,), mover=walker)) for tree in scene.hyperboloids
    ]
    positions = np.stack([tree.classify(*at.T) for tree in ended], axis=1) if len(at) else np.empty(asked.shape)
    by_center, by_ends = exterior | ~asked, positions == Position.EXTERIOR
    free_by_center, free_by_ends = np.asarray(by_center.all(axis=1)), np.asarray(by_ends.all(axis=1))
    places = np.argwhere(by_center != by_ends)[:SHOWN].tolist()
    return {
        "questions": {"asked": int(asked.size), **_differing(by_center, by_ends)},
        "steps": {"asked": len(at), **_differing(free_by_center, free_by_ends)},
        "places": [
            {"at": at[place].tolist(), "tree": scene.hyperboloids[tree].name, "dangerous": bool(by_center[place, tree])}
            for place, tree in places
        ],
    }


def _differing(by_center: Mask, by_ends: Mask) -> dict[str, int]:
    return {
        "needless": int(np.count_nonzero(by_ends & ~by_center)),
        "dangerous": int(np.count_nonzero(by_center & ~by_ends)),
    }
