"""Positions of ellipsoids with any matrix, in floats: by the maximum of the concave φ on either side of 0."""

from __future__ import annotations

import numpy as np

STEPS = 80


def dual_positions(rows, change):
    """Answers, int8 (n,), to rows (n, 10) whose matrices M, (n, 3, 3), are changed; contact where M is no body's.

    φ(λ) = λ CᵀD(M+λD)⁻¹MC − 1 − λ is above 0 for some λ > 0 outside, for some λ < 0 inside.
    """
    with np.errstate(all="ignore"):
        alpha, gamma, b, d = rows[:, :4].T
        centre, axis = rows[:, 4:7], rows[:, 7:]
        axis = axis / np.abs(axis).max(axis=1, keepdims=True)
        axis = axis / np.sqrt((axis * axis).sum(axis=1, keepdims=True))
        M = np.eye(3) / (b * b)[:, None, None] + (1 / d**2 - 1 / b**2)[:, None, None] * axis[:, :, None] * axis[:, None]
        M = change(M)
        D = np.stack([1 / alpha**2, 1 / alpha**2, -1 / gamma**2], axis=1)
        sound = np.isfinite(M).all(axis=(1, 2)) & np.isfinite(D).all(axis=1)
        values, vectors = np.linalg.eigh(np.where(sound[:, None, None], M, np.eye(3)))
        sound &= values[:, 0] > 0
        half = vectors / np.sqrt(np.where(sound[:, None], values, 1))[:, None]
        poles, turned = np.linalg.eigh(np.swapaxes(half, 1, 2) @ (D[:, :, None] * half))
        frame = half @ turned  # frameᵀ M frame = 1, frameᵀ D frame = poles
        center = np.linalg.solve(frame, centre[:, :, None])[:, :, 0]
        outside, inside = (_greatest(poles, center * center, side) for side in (1, -1))
    answers = np.where(outside > 0, 1, np.where(inside > 0, -1, 0))
    return np.where(sound, answers, 0).astype(np.int8)


def _greatest(poles, squares, side):
    """The greatest φ that a search by thirds finds between 0 and the end of the interval on that side."""
    ends = -1 / poles[:, 0] if side > 0 else -1 / poles[:, -1]

    def phi(at):
        return (at[:, None] * poles * squares / (1 + at[:, None] * poles)).sum(axis=1) - 1 - at

    low, high = np.zeros(len(poles)), ends * (1 - 1e-15)
    for _ in range(STEPS):
        first, second = low + (high - low) / 3, high - (high - low) / 3
        better = phi(first) < phi(second)
        low, high = np.where(better, first, low), np.where(better, high, second)
    return np.nan_to_num(phi((low + high) / 2), nan=-1.0)
