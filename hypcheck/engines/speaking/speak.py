"""What every adapter in Python shares: the scene's files, and the protocol of commands (docs/protocol.md).

Import it before the engine: standard output is for replies alone, and an engine that prints there prints on standard
error instead. Beside the protocol it understands `distance SEQ N tilted-text`: N lines of one decimal follow, the
signed distance as the engine reports it, nan where it reports none.
"""

from __future__ import annotations

import json
import math
import os
import struct
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

Point = Sequence[float]
Answer = Callable[[Point, Point], float]
"""From the spheroid's centre and its rotation, a quaternion x, y, z, w."""

TIGHTEST = sys.argv[2:] == ["tightest"]
"""Whether the engine is asked at the tightest settings that it offers; else at those that it has by default."""

_REPLIES = os.fdopen(os.dup(1), "wb")
os.dup2(2, 1)


class Scene:
    """The scene in a folder: α, γ, b, d; the hyperboloid's mesh; points on the spheroid, for its hull."""

    def __init__(self, folder: str) -> None:
        self.alpha, self.gamma, self.b, self.d = map(float, Path(folder, "sizes.txt").read_text().split())
        self.vertices, self.triangles = _off(Path(folder, "surface.off"))
        self.body, _ = _off(Path(folder, "body.off"))

    @property
    def round(self) -> bool:
        """Whether the spheroid is a ball: the engine's sphere takes its place then."""
        return self.b == self.d


def _off(path: Path) -> tuple[list[list[float]], list[list[int]]]:
    lines = path.read_text().split("\n")
    count, faces = map(int, lines[1].split()[:2])
    vertices = [[float(word) for word in line.split()] for line in lines[2 : 2 + count]]
    return vertices, [[int(word) for word in line.split()[1:4]] for line in lines[2 + count : 2 + count + faces]]


def turn(axis: Point) -> list[float]:
    """The rotation that takes the z axis to a line along `axis`, as a quaternion x, y, z, w."""
    length = math.hypot(*axis)
    x, y, z = (each / length for each in axis)
    if z < 0:  # the other end of the same line
        x, y, z = -x, -y, -z
    half = math.hypot(1 + z, x, y)
    return [-y / half, x / half, 0.0, (1 + z) / half]


def matrix(q: Point) -> list[list[float]]:
    """The matrix of a rotation."""
    x, y, z, w = q
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]


def serve(scene: Scene, name: str, version: str, touches: Answer, distance: Answer, precision: str = "float64") -> None:
    """Answer questions until standard input ends."""
    sizes = [scene.alpha, scene.gamma, scene.b, scene.d]
    described: dict[str, Any] = {"protocol": 1, "name": name, "version": version, "language": "python"}
    described |= {"precision": precision, "question": "contact", "tilt": True, "binary": True, "time": True}
    _say(json.dumps(described | {"domain": {"settings": [{"sizes": sizes, "axis": "free"}]}}))
    for line in sys.stdin.buffer:
        word, number, count, *rest = line.decode().split()
        poses = list(_poses(int(count), rest[-1]))
        try:
            _reply(word, f"{number} {count}", poses, rest, distance if word == "distance" else touches)
        except Exception as error:  # noqa: BLE001 - whatever the engine raises is its answer
            _say(f"error {type(error).__name__}: {error}".replace("\n", " ")[:4000])


def _reply(word: str, head: str, poses: list[tuple[Point, Point]], rest: list[str], answer: Answer) -> None:
    if word == "time":
        began, total = time.perf_counter_ns(), 0
        for _ in range(int(rest[0])):
            total = sum(int(answer(*pose)) for pose in poses)
        _say(f"{head.split(maxsplit=1)[0]} {time.perf_counter_ns() - began} {total}")
        return
    values = [answer(*pose) for pose in poses]
    if rest[-1].endswith("binary"):
        _say(head, bytes(int(value) for value in values))
    else:
        texts = [repr(float(value)) if word == "distance" else str(int(value)) for value in values]
        _say("\n".join([head, *texts]))


def _poses(count: int, form: str) -> Iterator[tuple[Point, Point]]:
    for _ in range(count):
        if form.endswith("binary"):
            row = struct.unpack("<10d", sys.stdin.buffer.read(80))
        else:
            row = tuple(map(float, sys.stdin.buffer.readline().split()))
        yield row[4:7], turn(row[7:])


def _say(text: str, raw: bytes = b"") -> None:
    _REPLIES.write(text.encode() + b"\n" + raw)
    _REPLIES.flush()
