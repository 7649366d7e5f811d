"""A Python function that fails in the ways a function can; the seed and its folder are in the environment."""

from __future__ import annotations

import contextlib
import os
import sys
import threading
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3]))

import hypcheck
from tests.tools.soak import moods

sys.argv = ["flaky", os.environ["HYPCHECK_SOAK_SEED"], os.environ["HYPCHECK_SOAK_FOLDER"]]
_DICE = moods.dice()


def classify(rows):
    """Positions, mostly."""
    right, how = hypcheck.classify(rows), moods.mood(_DICE)
    moods.happen(how)
    misbehave(how)
    replies = {
        "answers too few": right[:-1],
        "answers too many": np.append(right, 0),
        "answers nonsense": right * 0 + 77,
        "answers another question": right.astype(float),
        "answers wrongly": np.roll(right, 1),
    }
    return replies.get(how, right)


def misbehave(how):
    """What it does before it answers."""
    match how:
        case "reports an error":
            raise ValueError("\x1b[31m" + "x" * 10_000)
        case "garbles":
            for handle in range(3, 12):
                with contextlib.suppress(OSError):
                    os.write(handle, b"\xff" * 100)
        case "floods standard error":
            print("all is well\n" * 20_000)  # noqa: T201 - that is the fault
        case "leaves a child":
            threading.Thread(target=time.sleep, args=(60,), daemon=True).start()
        case "closes its output":
            sys.exit("goodbye")
        case "stops halfway":
            time.sleep(60)
