"""Calls each public function under every rounding mode, with and without subnormal numbers; prints what differs.

Run as `python -m tests.kernel.environment_calls FIRST OTHER...`, numbers of settings: hypcheck is loaded under FIRST.
Numbers are made, and answers compared, in the default environment alone. x86-64 and glibc only.
"""

from __future__ import annotations

import ctypes
import dataclasses
import json
import math
import random
import struct
import sys
from contextlib import contextmanager
from dataclasses import fields
from fractions import Fraction
from pathlib import Path

import numpy as np

from tests.support.inside import swept

CASES = Path(__file__).parents[2] / "cases"
FTZ, DAZ = 0x8000, 0x40
SETTINGS = [*(rounding << 13 | flush for rounding in range(4) for flush in (0, FTZ | DAZ)), FTZ, DAZ]
CONTROL = 0xFFC0
PLACE = 28
"""Of MXCSR in the fenv_t of glibc."""

_library = ctypes.PyDLL(None)


def control():
    room = (ctypes.c_char * 64)()
    _library.fegetenv(room)
    return int.from_bytes(room.raw[PLACE : PLACE + 4], "little") & CONTROL


def set_control(word):
    room = (ctypes.c_char * 64)()
    _library.fegetenv(room)
    room[PLACE : PLACE + 4] = struct.pack("<I", 0x1F80 | word)
    _library.fesetenv(room)


@contextmanager
def environment(setting):
    set_control(setting)
    try:
        yield
        left = control()
    finally:
        set_control(0)
    assert left == 0x1F80 | setting, f"the environment was {0x1F80 | setting:#x}, and is {left:#x}"


def frozen(pattern, step):
    """Rows of the frozen vectors whose files match, by their width, with their positions or hits."""
    rows = {}
    for path in sorted(CASES.glob(pattern)):
        for case in json.loads(path.read_text(encoding="utf-8"))["cases"][::step] if "invalid" not in path.name else ():
            row = [float.fromhex(each) for each in case["hex"]]
            rows.setdefault(len(row), []).append((row, case["position"] if "position" in case else case["hit"]))
    return rows


def size(draw):
    return draw.choice([5e-324, 1.7976931348623157e308, 2.0 ** draw.randint(-1074, 1023), draw.uniform(0.5, 4)])


def wide_rows(draw, count):
    return [
        [*(size(draw) for _ in range(4)), *(draw.choice([-1, 0, 1]) * size(draw) for _ in range(3))]
        for _ in range(count)
    ]


def scene(draw, exponent):
    """A scene whose numbers are about 2^exponent, and centres in it that are near to touching."""

    def about(most):
        return math.ldexp(draw.uniform(1, most), exponent)

    alpha, gamma, b, d = about(2), about(8), about(2), about(4)
    at = [draw.choice([-1, 1]) * math.ldexp(about(2), draw.randint(-4, 1)) for _ in range(3)]
    text = (
        f'name = "trees"\nquestion = "position"\n[mover]\nb = {b!r}\nd = {d!r}\n'
        f"[[hyperboloid]]\nname = 'tree'\nalpha = {alpha!r}\ngamma = {gamma!r}\ncenter = {at!r}\n"
    )
    centres = []
    for _ in range(6):
        side, turn = draw.choice([alpha + b, alpha - b]), draw.choice([0, 0, 1.5707963267948966, draw.uniform(0, 6)])
        x, y = at[0] + side * math.cos(turn), at[1] + side * math.sin(turn)
        centres.append(
            (x, y, at[2] + draw.choice([0, 0, math.ldexp(draw.uniform(-1, 1), exponent - draw.randint(0, 40))]))
        )
    return text, np.array(centres), (alpha, gamma, b, d), at


ISSUE = (
    'name = "trees"\nquestion = "position"\n[mover]\nb = {b!r}\nd = {d!r}\n[[hyperboloid]]\nname = "tree"\n'
    "alpha = {alpha!r}\ngamma = {gamma!r}\ncenter = [{x!r}, 0.0, 0.0]\n"
)
"""In contact; rounded downward and flushed to zero its differences of centres lose what tells."""


def issue_scene():
    mantissa = "0x1.56e1fc2f8f359p"
    alpha, gamma, b, d = (float.fromhex(f"{mantissa}{power}") for power in (-998, -995, -999, -997))
    at, x = float.fromhex("-0x1.e825d36022e53p-999"), float.fromhex("-0x1.7b32f1fbb4217p-997")
    text = ISSUE.format(alpha=alpha, gamma=gamma, b=b, d=d, x=at)
    return text, np.array([[x, 0.0, 0.0]]), (alpha, gamma, b, d), [at, 0.0, 0.0]


def inputs():
    draw = random.Random(42)  # noqa: S311
    pairs = frozen("extreme-*.json", 6)
    for width, rows in frozen("[!wet]*.json", 80).items():
        pairs.setdefault(width, []).extend(rows)
    pairs[10] = frozen("tilted-[!iw]*.json", 40)[10]
    sweeps = frozen("way-*.json", 150)[10]
    scenes = [
        issue_scene(),
        *(scene(draw, exponent) for exponent in (-1030, -998, -60, 0, 40, 1000)),
    ]
    return pairs, wide_rows(draw, 60), sweeps, scenes


def calls(pairs, wide, sweeps, scenes):
    """Names and functions of no argument, each with the truth or None; what they return is compared."""
    import hypcheck

    upright = np.array([row for row, _ in pairs[7]] + wide)
    tilted = np.array([row for row, _ in pairs[10]] + [[*row, 1.0, 5e-324, -2.0] for row in wide])
    yield "classify", lambda: hypcheck.classify(upright)
    yield "classify tilted", lambda: hypcheck.classify(tilted)
    yield "classify by Python", lambda: hypcheck.classify(upright, question="contact")
    yield "classify of a list", lambda: hypcheck.classify(upright.tolist(), threads=2)
    few = np.concatenate([upright[::20], upright[-12:]])
    for row in few.tolist():
        yield f"position {row}", lambda row=row: hypcheck.position(*row)
        yield f"position with an axis {row}", lambda row=row: hypcheck.position(*row, axis=(5e-324, 0.0, 1.0))
        yield f"position with an array {row}", lambda row=row: hypcheck.position(*row, axis=np.array([5e-324, 1, 1]))
        yield f"classify_scene {row}", lambda row=row: hypcheck.classify_scene(row[:4], *few.T[4:])
        yield f"Prepared {row}", lambda row=row: hypcheck.classify_scene(hypcheck.Prepared(tuple(row[:4])), *few.T[4:])
    for row in few[::9].tolist():
        yield f"tilted {row}", lambda row=row: hypcheck.classify_scene(row[:4], *few.T[4:], axis=[0, 5e-324, 5e-324])
    for rows in (upright[::60], tilted[1::45]):
        yield f"clearance of {rows.shape[1]} numbers", lambda rows=rows: hypcheck.clearance(rows)
    for row, _ in sweeps:
        yield f"passage {row}", lambda row=row: _shown(hypcheck.passage(row[:4], row[4:7], row[7:]))
    for number, (text, centres, _, _) in enumerate(scenes):
        yield from scene_calls(hypcheck, number, text, centres)


def scene_calls(hypcheck, number, text, centres):
    def made():
        return hypcheck.Scene.from_text(text)

    ends = centres[::-1] * 0.75
    yield f"Scene.classify {number}", lambda: made().classify(*centres.T)
    yield f"Scene.position {number}", lambda: [made().position(*centre) for centre in centres.tolist()]
    yield f"Scene.passage {number}", lambda: made().passage(centres, ends)
    yield f"Scene.nearest {number}", lambda: made().nearest(*centres.T)


def _shown(passage):
    return [passage.start, passage.end, passage.hit, passage.first_lower, passage.first_upper]


def as_bits(result):
    """The result as text that tells any two results apart."""
    if dataclasses.is_dataclass(result):
        own = [field.name for field in fields(result) if field.repr]
        more = [name for name in ("normal", "tie", "first_lower", "first_upper", "index") if hasattr(result, name)]
        return [as_bits(getattr(result, name)) for name in own + more]
    array = np.asarray(result)
    return [array.dtype.str, array.shape, array.tobytes().hex()]


def truths(pairs, sweeps, scenes):
    """Positions that are known without the functions that are called, or by their exact oracle."""
    upright = [position for _, position in pairs[7]]
    found = {"classify tilted": [position for _, position in pairs[10]], "classify": upright}
    for row, hit in sweeps:
        found[f"passage {row}"] = hit
    for number, (_, centres, sizes, at) in enumerate(scenes):
        offsets = [[Fraction(x) - Fraction(u) for x, u in zip(each, at, strict=True)] for each in centres.tolist()]
        found[f"Scene.classify {number}"] = [int(swept.passage(sizes, each, each).start) for each in offsets]
        found[f"Scene.position {number}"] = found[f"Scene.classify {number}"]
    return found


def main():
    first, *others = (SETTINGS[int(number)] for number in sys.argv[1:])
    given = inputs()
    trouble = []
    with environment(first):
        functions = list(calls(*given))
    answers = {}
    for setting in (first, *others):
        for name, function in functions:
            try:
                with environment(setting):
                    result = function()
            except Exception as error:  # noqa: BLE001 - every row is valid
                trouble.append(f"{name}: {setting:#x}: {error!r}")
                continue
            before = answers.setdefault(name, result)
            if as_bits(before) != as_bits(result):
                trouble.append(f"{name}: {setting:#x} against {first:#x}: {result!r} against {before!r}")
    known = truths(given[0], given[2], given[3])
    for name, truth in known.items() if not trouble else ():
        told = answers[name][2] if name.startswith("passage") else list(answers[name])[: len(truth)]
        if told != truth:
            trouble.append(f"{name}: {told} where {truth} is right")
    json.dump({"calls": len(functions), "truths": len(known), "trouble": trouble}, sys.stdout)


if __name__ == "__main__":
    main()
