"""`simulate … --ends`: the errors of a test by the centre's height when a tower, or a tree, ends.

The paper restricts a flight "up to the maximum height of the cooling tower", and does not mention the body's extent. So
its flights test only the centre's height: below the tower's end the wall is treated as infinite, above it as absent.
Here each position is decided exactly beside the real wall, between its two heights (docs/mathematics.md, "Towers that
end"). The option does not change flights and walks.

An answer is *dangerous* if the test by the centre's height allows a position that the real wall does not allow, and
*needless* if it refuses a position that the real wall allows. Inside an open wall no answer is dangerous, because its
end only removes wall. Beyond the wall, and near trees, some answers are.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hypcheck.errors import InputError
from hypcheck.geometry.pair import UPRIGHT, Position, Sizes
from hypcheck.geometry.rows import Columns, Floats, Mask, Positions
from hypcheck.kernel.scene import Scene
from hypcheck.paper.flights import Moves
from hypcheck.paper.motion import MARGIN, VerdictCounts, body_or_rotors, headed, of, positions, valid
from hypcheck.paper.quadcopter import Craft, Direction
from hypcheck.scene.model import SceneModel

SHOWN = 12
"""Places at which the answers differ that are listed one by one."""


def require_ends(scene: SceneModel) -> None:
    """Raise InputError if no hyperboloid of the scene ends."""
    if all(body.height is None for body in scene.hyperboloids):
        raise InputError(f"--ends: nothing in the scene {scene.name!r} ends; give its hyperboloids a height")


@dataclass(slots=True)
class EndVerdicts(VerdictCounts):
    """Counts of answers about a tower by the centre's height, compared with exact answers about the wall that ends.

    `asked` is the number of moves that were tested; at the end of `reaching` of them the body reaches beyond an end. If
    only the centre's height were tested, exactly otherwise, `needless` of these would be refused though valid, and
    `dangerous` would be allowed though not valid. `beyond` is the number of draws that lead above the tower's height
    and are not tested; `touching` of them meet the wall, which the centre's height does not show.
    """

    asked: int = 0
    reaching: int = 0
    needless: int = 0
    dangerous: int = 0
    beyond: int = 0
    touching: int = 0

    def watch(self, craft: Craft, moves: Moves) -> None:
        """Count the results of a draw of many flights."""
        some = moves.tested
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
    """Return a mask of the bodies that may extend beyond an end at these heights; ends do not matter for the others."""
    if craft.height is None:
        return np.zeros(z.shape, dtype=np.bool_)
    d = max(craft.sizes[3], craft.rotor[3])
    slack = MARGIN * (np.abs(z) + d)
    return np.asarray((z + d + slack >= craft.height.high) | (z - d - slack <= craft.height.low))


def valid_between(craft: Craft, at: Columns, heading: Direction) -> Mask:
    """Return a mask of the exactly valid positions beside the wall that ends: the body or every rotor is interior."""
    return body_or_rotors(craft, at, heading, lambda sizes, at: _positions(craft, sizes, at) == Position.INTERIOR)


def _positions(craft: Craft, sizes: Sizes, at: Columns) -> Positions:
    """Decide the positions of spheroids of these sizes beside the wall that ends, exactly."""
    low, high = (-np.inf, np.inf) if craft.height is None else (craft.height.low, craft.height.high)
    return positions(sizes, at, np.tile((*UPRIGHT, low, high, float(craft.solid)), (len(at[0]), 1)))


def beside_trees(scene: SceneModel, at: Floats, at_height: Mask, exterior: Mask) -> dict[str, Any]:
    """Return the errors of the test by the centre's height at these places, (n, 3), for the trees, (m,), for JSON.

    `at_height` (n, m) is a mask of centres at a tree's height, `exterior` (n, m) a mask of movers that are exterior to
    the tree without ends.
    """
    walker = replace(scene.mover, parts=())
    ended = [
        Scene(replace(scene, question="position", hyperboloids=(tree,), mover=walker)) for tree in scene.hyperboloids
    ]
    positions = np.stack([tree.classify(*at.T) for tree in ended], axis=1) if len(at) else np.empty(at_height.shape)
    by_center, by_ends = exterior | ~at_height, positions == Position.EXTERIOR
    free_by_center, free_by_ends = np.asarray(by_center.all(axis=1)), np.asarray(by_ends.all(axis=1))
    places = np.argwhere(by_center != by_ends)[:SHOWN].tolist()
    return {
        "questions": {"asked": int(at_height.size), **_differing(by_center, by_ends)},
        "steps": {"asked": len(at), **_differing(free_by_center, free_by_ends)},
        "places": [
            {"at": at[place].tolist(), "tree": scene.hyperboloids[tree].name, "dangerous": bool(by_center[place, tree])}
            for place, tree in places
        ],
    }


def _differing(by_center: Mask, by_ends: Mask) -> dict[str, int]:
    """Count the needless and the dangerous answers of the test by the centre's height; masks are of valid positions."""
    return {
        "needless": int(np.count_nonzero(by_ends & ~by_center)),
        "dangerous": int(np.count_nonzero(by_center & ~by_ends)),
    }
