"""The rows on which the kernels are measured: columns of one scene, the paper's cooling tower."""

from __future__ import annotations

import numpy as np

from hypcheck.casebook.families import FAMILIES
from hypcheck.casebook.placing import beside_surface
from hypcheck.casebook.scenes import BODY, TOWER
from hypcheck.pairs import Sizes
from hypcheck.rows import Columns

SIZES: Sizes = (*TOWER, *BODY)
SEED = 1
DISTINCT = 1_000_000
"""So many rows differ; a longer array repeats them, since to draw ten million takes longer than to measure them."""


def uniform(count: int) -> Columns:
    """Centres uniform in the box |x|, |y| ≤ 4 m, |z| ≤ 17.8 m about the tower (the workload "uniform")."""
    rows = FAMILIES["tower-body"].rows(SEED, min(count, DISTINCT))
    x, y, z = (np.resize(column, count) for column in rows[:, 4:].T)
    return x, y, z


def touching(count: int) -> Columns:
    """Centres within about 1e-15 radii of contact, on both sides of the wall and all over it."""
    random = np.random.Generator(np.random.PCG64(SEED))
    alpha, gamma, b, d = SIZES
    ratios = np.full(count, alpha / b), np.full(count, gamma / d)
    height = random.random(count) * gamma / d
    side = np.where(random.random(count) < 0.5, -1.0, 1.0) * (1 + (2 * random.random(count) - 1) * 1e-15)
    radius, level = beside_surface(*ratios, height, side)
    turn = 2 * np.pi * random.random(count)
    return radius * b * np.cos(turn), radius * b * np.sin(turn), level * d
