"""A right implementation in the protocol of commands; the others replace one step of it."""

import json
import os
import struct
import sys

BINARY = "binary" in sys.argv


def write(data):
    data = data.encode() if isinstance(data, str) else data
    while data:
        data = data[os.write(1, data) :]


def whole(values):
    """The values as integers in one unit, on which no position depends."""
    ratios = [value.as_integer_ratio() for value in values]
    unit = max(denominator for _, denominator in ratios)
    return [numerator * (unit // denominator) for numerator, denominator in ratios]


def position(alpha, gamma, b, d, x, y, z):
    """The coefficient rule of docs/mathematics.md in integers: A, B, P and Q are multiplied by U = b²d²."""
    alpha, b, x, y = (each * each for each in whole((alpha, b, x, y)))
    gamma, d, z = (each * each for each in whole((gamma, d, z)))
    A, B, P, Q, U = alpha * d, gamma * b, (x + y) * d, z * b, b * d
    c2, c1, c0 = A - B + U - P - Q, -A * B + U * (A - B) + B * P - A * Q, -A * B * U
    delta = -4 * c2**3 * c0 + c2**2 * c1**2 + 18 * c2 * c1 * c0 - 4 * c1**3 - 27 * c0**2
    slope_at_B, slope_at_A = 3 * B * B + 2 * c2 * B + c1, 3 * A * A - 2 * c2 * A + c1
    if delta <= 0:
        return int(Q == 0 and slope_at_B == 0 and A * U < B * B)
    if c2 < 0 < c1:
        return int(not (c2 < -3 * B and slope_at_B > 0))
    return -int(c2 < 3 * A and slope_at_A > 0)


def right(rows):
    """Positions without hypcheck, which no isolated program sees, and without numpy, which takes long to load."""
    return [position(*row) for row in rows]


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
