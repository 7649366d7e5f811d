"""A command that crashes, hangs, drips and garbles, in the protocol: `flaky_command.py SEED FOLDER [binary]`."""

from __future__ import annotations

import json
import os
import random
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3]))

import hypcheck
from tests.tools.soak.moods import dice, happen, mood

BINARY = "binary" in sys.argv


def write(data: bytes) -> None:
    """All of it."""
    while data:
        data = data[os.write(1, data) :]


def body(answers: list[int]) -> bytes:
    """Answers as they are sent."""
    return struct.pack(f"{len(answers)}b", *answers) if BINARY else "".join(f"{each}\n" for each in answers).encode()


def read(n: int, how: str) -> list[tuple[float, ...]]:
    """The rows of a question."""
    if how == "binary":
        return list(struct.iter_unpack("<7d", sys.stdin.buffer.read(56 * n)))
    return [tuple(map(float, sys.stdin.buffer.readline().split())) for _ in range(n)]


def instead(how: str, sequence: int, answers: list[int], random_: random.Random) -> bytes | None:
    """What it writes instead of its reply; None where it writes that."""
    n, right = len(answers), body(answers)
    head = f"{sequence} {n}\n".encode()
    replies = {
        "reports an error": b"error \x1b[31m" + random_.randbytes(20).replace(b"\n", b" ") + b"\n",
        "garbles": random_.randbytes(random_.choice((1, 10, 5000))),
        "answers too few": head + body(answers[:-1]),
        "answers too many": head + right + body([0]),
        "answers another question": f"{sequence + random_.choice((-1, 1))} {n}\n".encode() + right,
        "answers nonsense": head + body([random_.choice((3, -7, 100)) for _ in answers]),
        "answers wrongly": head + body([random_.choice((-1, 0, 1)) for _ in answers]),
    }
    return replies.get(how)


def misbehave(how: str, reply: bytes) -> bytes:
    """What it does before the reply, and what is left to be written of that."""
    happen(how)
    match how:
        case "drip":
            for number in range(8):
                write(reply[number : number + 1])
                time.sleep(0.002)
            return reply[8:]
        case "floods standard error":
            os.write(2, b"all is \x00 well\n" * 20_000)
        case "leaves a child":
            subprocess.Popen(["sleep", "60"])  # noqa: S607 - it holds our pipes
            os._exit(4)
        case "closes its output":
            os.close(1)
            time.sleep(60)
        case "stops halfway":
            write(reply[:1])
            time.sleep(60)
        case "leaves a file":
            tempfile.NamedTemporaryFile(delete=False, dir=sys.argv[2]).close()  # its own folder, which is not ours
    return reply


def main() -> None:
    """Serve until the input ends."""
    random_ = dice()
    write(json.dumps({"protocol": 1, "name": "flaky", "binary": BINARY}).encode() + b"\n")
    while words := sys.stdin.buffer.readline().decode().split():
        rows = read(int(words[2]), words[-1])
        answers = hypcheck.classify(rows).tolist()
        how = mood(random_)
        reply = instead(how, int(words[1]), answers, random_)
        write(misbehave(how, f"{words[1]} {len(answers)}\n".encode() + body(answers) if reply is None else reply))


main()
