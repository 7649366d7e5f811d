"""Implementations to replay, each with one fault; rows float64 (n, 7) → n integers."""

from __future__ import annotations

import os

import numpy as np

from tests.tools.mutants.exactly import position


def exact(rows):
    """Right, by integers, without hypcheck, which no isolated program sees."""
    return position(rows)


def contact(rows):
    return np.zeros(len(rows), dtype=np.int8)


def never_interior(rows):
    """Answers the question exterior."""
    return (exact(rows) == 1).astype(np.int8)


def cannot_say(rows):
    return np.full(len(rows), 2)


def forgets_the_tail(rows):
    answers = exact(rows)
    if len(rows) > 1:
        answers[len(rows) // 8 * 8 :] = -1
    return answers


def dies(rows):
    os._exit(3)


def minds_the_sign_of_zero(rows):
    return np.where(np.signbit(rows[:, 5]), -1, exact(rows))
