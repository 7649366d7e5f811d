"""Random flights a second time, one at a time and step by step: slow, in plain Python, with exact positions."""

from __future__ import annotations

import math
from dataclasses import dataclass

from tests.support.fractions_truth import exact_position


@dataclass
class Count:
    """What happened to one flight."""

    executions: int = 0
    touching: int = 0
    accepted: int = 0
    vertical: int = 0
    refused: int = 0
    redrawn: int = 0


class Quadcopter:
    """A body and four rotors in a tower; angles in radians."""

    def __init__(self, scene):
        (tower,) = scene.hyperboloids
        self.alpha, self.gamma, self.height = tower.alpha, tower.gamma, tower.height
        self.mover, self.rules = scene.mover, scene.flight

    def position(self, b, d, x, y, z):
        """Exactly."""
        return exact_position((self.alpha, self.gamma, b, d, x, y, z))

    def asked(self, x, y, z, heading):
        """Whether a position is valid, and whether the rotors had to be asked."""
        body = self.position(self.mover.b, self.mover.d, x, y, z)
        if body != 0:
            return body == -1, False
        for part in self.mover.parts:
            angle = heading + math.radians(part.angle)
            at = (x + part.arm * math.cos(angle), y + part.arm * math.sin(angle), z)
            if self.position(part.b, part.d, *at) != -1:
                return False, True
        return True, True

    def begin(self, height, share, around, heading):
        """Where a flight begins: shares of 1 for the height and for the area of the disc, angles for the rest."""
        start = self.rules.start
        z = start.z.low + (start.z.high - start.z.low) * height
        wall = self.alpha * math.sqrt(1 + (z / self.gamma) ** 2)
        radius = (start.radius if start.margin is None else wall - start.margin) * math.sqrt(share)
        return [radius * math.cos(around), radius * math.sin(around), z, heading]

    def fly(self, state, step, moves, choose):
        """Fly until so many moves are accepted. `choose` gives (chance, up or ahead, left, share of the turn)."""
        count, due, rules = Count(), False, self.rules
        while count.accepted < moves:
            chance, forth, left, share = choose()
            x, y, z, heading = state
            turning = False
            if due:
                x, y = x + step * math.cos(heading), y + step * math.sin(heading)
            elif chance < rules.straight:
                sense = forth if rules.backward else 1
                x, y = x + sense * step * math.cos(heading), y + sense * step * math.sin(heading)
            elif chance < rules.straight + rules.vertical:
                z += forth * step
                if self.height is not None and not self.height.low <= z <= self.height.high:
                    count.redrawn += 1
                    continue
            else:
                turning, before = True, heading
                heading += math.radians((2 * share - 1) * rules.largest_turn)
                state[3] = heading
                if rules.turn == "free":
                    continue
            valid, touching = self.asked(x, y, z, heading)
            count.executions += 1
            count.touching += touching
            if turning and not (rules.turn == "obeyed" and not valid):
                due = True
                continue
            if turning:
                heading = before
            if valid:
                count.accepted += 1
                count.vertical += z != state[2]
                state[:3] = x, y, z
            else:
                count.refused += 1
                state[3] = heading + math.radians(rules.refused_turn) * (1 if left else -1)
            due = False
        return count
