"""A flight is made short and smooth with a given distance from every tree: scipy, with hypcheck's distance and normal.

The points between start and goal move. The cost is the length of the flight; the constraint says that the drone is at
least `CLEAR` away from the nearest tree at each of them. The gradient of the distance is the unit normal there: from
the nearest point to the centre, since the drone is a ball. Nothing is differenced. What comes out is judged by the
exact first contact. Run it by

    pip install scipy hypcheck
    python optimise_flight.py
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import minimize

from hypcheck import Mover, Scene

DRONE = Mover(0.4, 0.4)
CLEAR = 0.5
START, GOAL = np.array([-2.0, 0.3, 1.5]), np.array([14.0, 0.3, 1.5])
POINTS = 30


def trees() -> Scene:
    """Five trees that stand in the way."""
    centers = [[2, 0, 0], [5, 1.4, 0], [6, -1.2, 0], [9, 0.8, 0], [12, -0.4, 0]]
    return Scene.from_arrays([0.3, 0.4, 0.3, 0.4, 0.3], 4.0, centers, mover=DRONE, z_min=-1, z_max=8, solid=True)


def length(inner: np.ndarray) -> tuple[float, np.ndarray]:
    """The sum of squared steps, which is least for even steps on a short way, and its gradient."""
    path = np.vstack([START, inner.reshape(-1, 3), GOAL])
    steps = np.diff(path, axis=0)
    return float((steps**2).sum()), 2 * (steps[:-1] - steps[1:]).ravel()


def optimised(scene: Scene) -> np.ndarray:
    """The flight's points, (POINTS + 2, 3)."""
    share = np.linspace(0, 1, POINTS + 2)[1:-1, None]
    first = START + share * (GOAL - START) + np.sin(np.pi * share) * [0, 2.5, 0.5]

    def room(inner: np.ndarray) -> np.ndarray:
        return scene.nearest(inner.reshape(-1, 3)).distance_lower - CLEAR

    def room_gradient(inner: np.ndarray) -> np.ndarray:
        centers = inner.reshape(-1, 3)
        away = centers - scene.nearest(centers).point
        rows = np.zeros((POINTS, POINTS, 3))
        rows[np.arange(POINTS), np.arange(POINTS)] = away / np.linalg.norm(away, axis=1)[:, None]
        return rows.reshape(POINTS, -1)

    found = minimize(
        length,
        first.ravel(),
        jac=True,
        method="SLSQP",
        constraints={"type": "ineq", "fun": room, "jac": room_gradient},
        options={"maxiter": 200},
    )
    return np.vstack([START, found.x.reshape(-1, 3), GOAL])


def main() -> None:
    """Optimise, judge, say it."""
    scene = trees()
    path = optimised(scene)
    judged = scene.first_contact(path)
    straight = scene.first_contact([START, GOAL])
    flown = float(np.sqrt((np.diff(path, axis=0) ** 2).sum(axis=1)).sum())
    print(f"straight: {'contact' if straight.hit else 'clear'}, {float(np.linalg.norm(GOAL - START)):.2f} m")
    least = judged.least.distance_lower
    print(f"optimised: {'contact' if judged.hit else 'clear'}, {flown:.2f} m, at least {least:.3f} m away")


if __name__ == "__main__":
    main()
