"""The behaviour of an implementation on a question: mostly right, sometimes not; the same for the same seed."""

from __future__ import annotations

import os
import random
import signal
import sys
import time
from pathlib import Path

MOODS = {
    "right": 120,
    "drip": 3,
    "reports an error": 3,
    "garbles": 3,
    "answers too few": 1,
    "answers too many": 1,
    "answers another question": 2,
    "answers nonsense": 3,
    "answers wrongly": 3,
    "floods standard error": 2,
    "grabs memory": 1,
    "leaves a child": 2,
    "exits": 2,
    "segfaults": 2,
    "closes its output": 1,
    "hangs": 1,
    "stops halfway": 1,
    "leaves a file": 2,
}
"""What it may do, and how often."""


def dice() -> random.Random:
    """For this process: of the seed and of how many there were before it, which a file in the folder tells."""
    seed, folder = sys.argv[1], Path(sys.argv[2])
    count = folder / "starts"
    with count.open("ab") as file:
        file.write(b".")
    return random.Random(f"{seed}/{count.stat().st_size}")  # noqa: S311 - nothing secret


def mood(random_: random.Random) -> str:
    """The next one."""
    (found,) = random_.choices(tuple(MOODS), tuple(MOODS.values()))
    return found


def happen(how: str) -> None:
    """What it does to itself, in whatever language it is asked; nothing where it only answers in a way of its own."""
    match how:
        case "grabs memory":
            _KEPT.append(b"\1" * (400 << 20))
            time.sleep(60)
        case "exits":
            os._exit(3)
        case "segfaults":
            os.kill(os.getpid(), signal.SIGSEGV)
        case "hangs":
            time.sleep(60)


_KEPT: list[bytes] = []
