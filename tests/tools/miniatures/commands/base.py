"""A right implementation in the protocol of commands; the others replace one step of it."""

import json
import os
import struct
import sys

from hypcheck.geometry.pair import Pair
from hypcheck.truth import exact

BINARY = "binary" in sys.argv


def write(data):
    data = data.encode() if isinstance(data, str) else data
    while data:
        data = data[os.write(1, data) :]


def right(rows):
    """Positions by integers, without numpy, which would take longer to load than all the rest."""
    return [int(exact.position(Pair(*row).lengths)) for row in rows]


def reply(sequence, answers):
    """The bytes of a reply; pairs are answers about ways with the times of contact."""
    if answers and isinstance(answers[0], tuple):
        return f"{sequence} {len(answers)}\n".encode() + timed(answers)
    body = struct.pack(f"{len(answers)}b", *answers) if BINARY else "".join(f"{each}\n" for each in answers).encode()
    return f"{sequence} {len(answers)}\n".encode() + body


def timed(pairs):
    if BINARY:
        hits, times = zip(*pairs, strict=True)
        return struct.pack(f"<{len(pairs)}b", *hits) + struct.pack(f"<{len(pairs)}d", *times)
    return "".join(f"1 {time!r}\n" if hit == 1 else f"{hit}\n" for hit, time in pairs).encode()


def unlucky(rows):
    return any(row[1] == 13.0 for row in rows)


def read(source, n, how, claims):
    numbers = 10 if how.startswith(("tilted-", "passage-")) else 7
    numbers += 3 if how.startswith("passage-") and "tilt" in claims else 0
    if how.endswith("binary"):
        return list(struct.iter_unpack(f"<{numbers}d", source.read(8 * numbers * n)))
    return [tuple(map(float, source.readline().split())) for _ in range(n)]


def serve(answers=right, *, on_unlucky=None, on_any=None, checksum=sum, claims=None):
    """Serve until the input ends.

    `on_unlucky(sequence, rows)` stands for the whole reply to a question with the unlucky row, `on_any` to any.
    """
    said = {"protocol": 1, "name": os.path.basename(sys.argv[0]), "binary": BINARY, "time": BINARY}
    write(json.dumps(said | (claims or {})) + "\n")
    while words := sys.stdin.buffer.readline().decode().split():
        rows = read(sys.stdin.buffer, int(words[2]), words[-1], claims or {})
        step = on_unlucky if unlucky(rows) else None
        if words[0] == "time":
            write(f"{words[1]} {1000 * int(words[3])} {checksum(answers(rows))}\n")
        elif on_any or step:
            (on_any or step)(int(words[1]), rows)
        else:
            write(reply(int(words[1]), answers(rows)))
