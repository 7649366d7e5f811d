"""Everything that decides, in one table: a new decider is one entry of DECIDERS.

A decider answers `Questions` by numbers: +1, 0, −1 for a position, 1 and 0 for contact on a way or none, CANNOT_SAY
where it does not know, REFUSED for an invalid row. It may refuse invalid rows by InputError, too. tests/test_corpus.py
asks all of them all of `cases/`, and tests/test_properties.py what holds for every right answer.
"""

from __future__ import annotations

import ctypes
import os
import pickle
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np

import hypcheck
from hypcheck.cli.main import main
from hypcheck.geometry.pair import Pair
from hypcheck.implementations.builtin import methods
from hypcheck.runs.oracles import ORACLES
from tests.kernel.compiling import COMPILER, shared_library
from tests.kernel.emission.building import asking_pairs, library_of, missing
from tests.support import checkers, fractions_truth, inside, tilted_fractions
from tests.support.corpus import Questions
from tests.support.inside import (
    by_roots,
    exact_position,
    heights_position,
    integers_position,
    integers_whole_position,
    least_position,
    numpy_kernel_answer_sweeps,
    sweep_of,
)
from tests.support.inside import kernel_classify as classify

CANNOT_SAY, REFUSED = 2, 127
POSITIONS = ("", "axis")
"""The groups of rows about positions."""
SWEEPS = ("end", "end axis")
"""The groups of rows about straight ways."""
ENDED = ("axis heights",)
"""That of rows about hyperboloids that end."""
ENDED_WAYS = ("end axis heights",)
"""That of rows about ways beside them."""
ALL = POSITIONS + SWEEPS + ENDED + ENDED_WAYS
UPRIGHT = ("",)


@dataclass(frozen=True)
class Times:
    """Answers about ways, and bounds (n, 2) of the first contact, NaN where nothing is said."""

    answers: Sequence[int]
    first: np.ndarray


Answers = Sequence[int] | Times


@dataclass(frozen=True)
class Decider:
    """What decides: its name, how it is asked, and what it takes.

    `takes` are the sets of groups that it answers. `abstains` is the share of cases about which it may say that it
    cannot, and `every` says that `make test` asks it each so many-th case alone. `refuses` is false where callers check
    rows before. `takes_any_array` says that rows may be an array of any layout and type, or lists. `drawn` is false
    where rows that are drawn are not asked: it needs what frozen cases have, or is what the others are compared with.
    `lacks` is the reason why it cannot be asked here, or None.
    """

    name: str
    answer: Callable[[Questions], Answers]
    takes: tuple[str, ...] = POSITIONS
    abstains: float = 0.0
    every: int = 1
    refuses: bool = True
    takes_any_array: bool = False
    drawn: bool = True
    lacks: Callable[[], str | None] = lambda: None

    def __str__(self) -> str:
        return self.name


def answers_of(decider: Decider, questions: Questions) -> list[int]:
    """The answers without times."""
    result = decider.answer(questions)
    return list(result.answers if isinstance(result, Times) else result)


def by_row(ask: Callable[..., int], questions: Questions) -> list[int]:
    """The answers of what is asked one row at a time: the sizes, the centre, and the other groups by name."""
    asked = []
    for index, (sizes, center) in enumerate(zip(questions.sizes.tolist(), questions.center.tolist(), strict=True)):
        others = {name: getattr(questions, name)[index].tolist() for name in questions.groups.split()}
        asked.append(ask(tuple(sizes), center, **others))
    return asked


def of_rows(questions: Questions) -> list[int]:
    return hypcheck.classify(questions.rows).tolist()


def ends_of(heights) -> dict[str, float]:
    """Heights by name, none where there are none."""
    return {} if heights is None else dict(zip(("z_min", "z_max", "solid"), heights, strict=True))


def of_position(sizes, center, axis=None, heights=None) -> int:
    return hypcheck.position(*sizes, *center, axis=axis, **ends_of(heights))


def of_python(sizes, center, axis=None, heights=None) -> int:
    return exact_position(*sizes, *center, axis=axis, **ends_of(heights))


def of_columns(questions: Questions) -> list[int]:
    """A table of columns by name."""
    names = ("alpha", "gamma", "b", "d", "x", "y", "z", "axis_x", "axis_y", "axis_z", "z_min", "z_max", "solid")
    rows = questions.rows
    return hypcheck.classify(dict(zip(names, rows.T, strict=False))).tolist()


def of_least_value(questions: Questions) -> list[int]:
    """The least value on the wall and the discs, which knows no polynomial of the pair."""
    found = [least_position(Pair.from_row(row)) for row in questions.rows.tolist()]
    return [CANNOT_SAY if position is None else int(position) for position in found]


def of_rule(questions: Questions) -> list[int]:
    return [int(heights_position(Pair.from_row(row))) for row in questions.rows.tolist()]


def of_integers(sizes, center, axis=None) -> int:
    """The last stage in Python, which decides alone here."""
    if axis is None:
        return int(integers_position(Pair(*sizes, *center).lengths))
    return int(integers_whole_position((*sizes, *center, *axis)))


def of_ways_in_numpy(questions: Questions) -> list[int]:
    return numpy_kernel_answer_sweeps(np.ascontiguousarray(questions.rows))[0].tolist()


def of_ways_in_c(questions: Questions) -> list[int]:
    return classify.kernel().answer_sweeps(np.ascontiguousarray(questions.rows))[0].tolist()


def of_scene_call(sizes, center, axis=None) -> int:
    return int(hypcheck.classify_scene(sizes, *([number] for number in center), axis=axis)[0])


def of_prepared(sizes, center, axis=None) -> int:
    return int(hypcheck.classify_scene(hypcheck.Prepared(sizes, axis=axis), *center)[0])


def scene_of(sizes, axis=None) -> hypcheck.Scene:
    """The pair as a scene of one hyperboloid."""
    alpha, gamma, b, d = sizes
    lines = [f"alpha = {alpha!r}", f"gamma = {gamma!r}", "[mover]", f"b = {b!r}", f"d = {d!r}"]
    lines += [] if axis is None else [f"axis = {list(axis)!r}"]
    return hypcheck.Scene.from_text("\n".join(['name = "one"', "[[hyperboloid]]", *lines]))


def of_scene(sizes, center, axis=None) -> int:
    return int(scene_of(sizes, axis).classify(*center))


def of_scene_step(sizes, center, axis=None) -> int:
    return scene_of(sizes, axis).position(*center)


def of_scene_passage(sizes, center, end, axis=None) -> int:
    return int(scene_of(sizes, axis).passage(center, end).hit)


def of_clearance(questions: Questions) -> list[int]:
    """The position of a clearance; its bounds and those of the distance must be about that position."""
    found = hypcheck.clearance(questions.rows)
    contact = found.position == 0
    assert (np.where(contact, found.upper, -found.lower) <= 0).all()
    assert (found.lower <= found.upper).all()
    assert (found.distance_lower <= found.distance_upper).all()
    assert (found.distance_upper[contact] == 0).all()
    for case, lower, upper in zip(questions.cases, found.lower.tolist(), found.upper.tolist(), strict=False):
        true = float(case["clearance"])
        assert lower <= np.nextafter(true, np.inf), case["id"]
        assert upper >= np.nextafter(true, -np.inf), case["id"]
    return found.position.tolist()


def of_command(questions: Questions) -> list[int]:
    """What `hypcheck classify` writes for a table."""
    with tempfile.TemporaryDirectory() as folder:
        given, result = Path(folder, "rows.npy"), Path(folder, "answers.npy")
        np.save(given, np.asarray(questions.rows))
        assert main(["classify", "--input", str(given), "--output", str(result), "--on-invalid", "flag"]) == 0
        return np.load(result).tolist()


def of_passage(questions: Questions) -> Times:
    """hypcheck.passage, whose bounds of the first contact are neighbouring floats."""
    ends = [{}] * len(questions)
    if questions.heights is not None:
        ends = [dict(zip(("z_min", "z_max", "solid"), three, strict=True)) for three in questions.heights.tolist()]
    found = [
        hypcheck.passage(tuple(sizes), start, end, *axis, **heights)
        for heights, sizes, start, end, *axis in zip(
            ends,
            *(part.tolist() for part in (questions.sizes, questions.center, questions.end)),
            *([] if questions.axis is None else [questions.axis.tolist()]),
            strict=True,
        )
    ]
    first = [(passage.first_lower, passage.first_upper) if passage.hit else (np.nan, np.nan) for passage in found]
    return Times([int(passage.hit) for passage in found], np.array(first).reshape(-1, 2))


def of_method(name: str, questions: Questions) -> list[int]:
    """A built-in method of `verify` and `bench`."""
    return methods()[name].answer(questions.rows).tolist()


def of_oracle(name: str, questions: Questions) -> list[int]:
    """The positions of an oracle; where it says them, a case's tangency and kind must be those of its label."""
    oracle = ORACLES[name]
    opinions = oracle.ask(questions.rows)
    for case, opinion in zip(questions.cases, opinions, strict=False):
        assert opinion.tangent in (None, case["tangent"]), case["id"]
        assert None in (opinion.kind, case.get("kind")) or opinion.kind == case["kind"], case["id"]
    return [CANNOT_SAY if opinion.position is None else int(opinion.position) for opinion in opinions]


def of_float_filter(questions: Questions) -> list[int]:
    return inside.positions(np.ascontiguousarray(questions.rows)).tolist()


def of_discriminant(questions: Questions) -> Times:
    """The passage by the roots of the discriminant, which is asked where steps do not decide."""
    ways = [sweep_of(row[:4], row[4:7], row[7:10], row[10:] or None) for row in questions.rows.tolist()]
    found = [by_roots(way) for way in ways]
    first = [(passage.first_lower, passage.first_upper) if passage.hit else (np.nan, np.nan) for passage in found]
    return Times([int(passage.hit) for passage in found], np.array(first).reshape(-1, 2))


def of_fractions(questions: Questions) -> list[int]:
    """Decisions of the tests' own, in fractions."""
    truth = tilted_fractions if questions.groups else fractions_truth
    return [truth.exact_position(row) for row in questions.rows.tolist()]


ASK = """
import pickle, sys
import hypcheck
while True:
    rows = pickle.load(sys.stdin.buffer)
    sys.stdout.buffer.write(pickle.dumps(hypcheck.classify(rows, on_invalid="flag").tolist()))
    sys.stdout.buffer.flush()
"""


@cache
def process(name: str, value: str) -> subprocess.Popen[bytes]:
    """A Python that answers rows, with a variable of the environment that chooses its kernel."""
    return subprocess.Popen(
        [sys.executable, "-c", ASK], stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=os.environ | {name: value}
    )


def of_kernel(name: str, value: str, questions: Questions) -> list[int]:
    asked = process(name, value)
    asked.stdin.write(pickle.dumps(questions.rows))
    asked.stdin.flush()
    return pickle.load(asked.stdout)  # noqa: S301 - of our own process


@cache
def lacks_level(level: str) -> str | None:
    """Why the compiled kernel cannot use an instruction set here, or None."""
    words = [sys.executable, "-c", "import hypcheck; hypcheck.classify([[1, 2, 1, 1, 5, 0, 0]])"]
    done = subprocess.run(
        words, env=os.environ | {"HYPCHECK_LEVEL": level}, capture_output=True, text=True, check=False
    )
    return None if done.returncode == 0 else f"there is no {level} here"


@cache
def folder() -> Path:
    """Where files of this process are built; it is removed at the end."""
    made = tempfile.TemporaryDirectory()
    KEPT.append(made)
    return Path(made.name)


KEPT: list[Any] = []


@cache
def emitted(method: str, language: str) -> Callable[[np.ndarray], np.ndarray]:
    """What answers rows: the code that `hypcheck emit` writes, compiled as a user would."""
    suffix = {"c": "c", "cpp": "cpp", "rust": "rs", "javascript": "mjs", "python": "py"}[language]
    file = folder() / f"{method}.{suffix}"
    assert main(["emit", "--method", method, "--language", language, "--output", str(file)]) == 0
    if language == "javascript":
        return partial(asked_of_node, node(file))
    return asking_pairs(library_of(file, language), language)


NODE = """
import { readSync, writeSync } from "node:fs";
const { predicate, tilted, passage } = await import(process.argv[1]);
const taken = (count) => {
  const bytes = Buffer.alloc(count);
  for (let at = 0, more = 1; at < count; at += more)
    if (!(more = readSync(0, bytes, at, count - at, null))) process.exit();
  return new Float64Array(bytes.buffer, bytes.byteOffset, count / 8);
};
for (;;) {
  const [count, wide] = taken(16), rows = taken(8 * count * wide);
  const asked = { 7: predicate, 10: tilted, 13: passage }[wide];
  const one = (_, at) => asked(...rows.subarray(wide * at, wide * at + wide));
  writeSync(1, new Int8Array(count).map(one));
}
"""


def node(file: Path) -> subprocess.Popen[bytes]:
    """A node that answers rows by the kernel in a file: one starts more slowly than it answers."""
    words = ["node", "--input-type=module", "--eval", NODE, str(file)]
    return subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE)


def asked_of_node(process: subprocess.Popen[bytes], rows: np.ndarray) -> np.ndarray:
    process.stdin.write(np.array(rows.shape, float).tobytes() + np.ascontiguousarray(rows).tobytes())
    process.stdin.flush()
    answers = np.frombuffer(process.stdout.read(len(rows)), np.int8)
    assert len(answers) == len(rows), "node ended"
    return answers


def of_emitted(method: str, language: str, questions: Questions) -> list[int]:
    return emitted(method, language)(questions.rows).tolist()


def of_emitted_tilted(method: str, language: str, questions: Questions) -> list[int]:
    """The same of code that is given an axis in any case."""
    axis = np.tile([0.0, 0.0, 1.0], (len(questions), 1)) if questions.axis is None else questions.axis
    return of_emitted(method, language, replace(questions, axis=axis))


@cache
def header() -> ctypes.CDLL:
    """The C header, compiled for a program of its own."""
    with tempfile.TemporaryDirectory(dir=folder()) as place:
        core = Path(hypcheck.__file__).parent / "kernel" / "core"
        source = '#define HYPCHECK_IMPLEMENTATION\n#include "hypcheck.h"\n'
        return shared_library(Path(place), source, "-O0", "-I", str(core))


def of_header(questions: Questions) -> Answers:
    rows = np.ascontiguousarray(questions.rows)
    answers, times = np.full(len(rows), 99, np.int8), np.full(len(rows), np.nan)
    name = "hypcheck_passage" if "end" in questions.groups else "hypcheck_classify"
    name += "_ended" if "heights" in questions.groups else "_tilted" if "axis" in questions.groups else ""
    outputs = (answers, times) if "end" in questions.groups else (answers,)
    given = (array.ctypes.data_as(ctypes.c_void_p) for array in (rows, *outputs))
    getattr(header(), name)(ctypes.c_size_t(len(rows)), *given)
    if len(outputs) == 1:
        return answers.tolist()
    return Times(answers.tolist(), np.stack([times, np.full(len(rows), np.nan)], axis=1))


def lacks_compiler() -> str | None:
    return None if COMPILER else "there is no C compiler"


def lacks_language(language: str) -> str | None:
    return f"there is no {missing(language)}" if missing(language) else None


LANGUAGES = ("c", "cpp", "rust", "javascript", "python")
LEVELS = ("plain", "sse2", "avx2", "avx512")

DECIDERS = (
    Decider("hypcheck.classify", of_rows, takes=POSITIONS + ENDED, takes_any_array=True),
    Decider("hypcheck.classify of columns by name", of_columns, takes=ENDED),
    Decider("hypcheck.position", partial(by_row, of_position), takes=POSITIONS + ENDED),
    Decider("hypcheck.position, in Python", partial(by_row, of_python), takes=POSITIONS + ENDED),
    Decider("whole numbers in Python", partial(by_row, of_integers), refuses=False),
    Decider("hypcheck.classify_scene", partial(by_row, of_scene_call)),
    Decider("hypcheck.Prepared", partial(by_row, of_prepared)),
    Decider("hypcheck.Scene.classify", partial(by_row, of_scene), every=24),
    Decider("hypcheck.Scene.position", partial(by_row, of_scene_step), every=24),
    Decider("hypcheck.clearance", of_clearance, takes_any_array=True),
    Decider("hypcheck classify, the command", of_command, every=4),
    Decider(
        "the numpy kernel",
        partial(of_kernel, "HYPCHECK_KERNEL", "numpy"),
        takes=POSITIONS + ENDED,
        takes_any_array=True,
    ),
    *(
        Decider(
            f"the kernel with {level}", partial(of_kernel, "HYPCHECK_LEVEL", level), lacks=partial(lacks_level, level)
        )
        for level in LEVELS
    ),
    Decider("the C header", of_header, lacks=lacks_compiler),
    Decider("the C header, ends", of_header, takes=ENDED, abstains=0.3, lacks=lacks_compiler),
    Decider("the least value", of_least_value, takes=ENDED, abstains=0.085, every=24, refuses=False),
    Decider("the rule in the height", of_rule, takes=ENDED, refuses=False),
    *(
        Decider(
            f"emitted {language}",
            partial(of_emitted, "exact", language),
            takes=UPRIGHT,
            lacks=partial(lacks_language, language),
        )
        for language in LANGUAGES
    ),
    *(
        Decider(
            f"emitted {method}, {language}",
            partial(of_emitted, method, language),
            takes=UPRIGHT,
            abstains=0.5,
            drawn=language == "python",
            lacks=partial(lacks_language, language),
        )
        for method in ("certified", "dual", "local-maximum")
        for language in LANGUAGES
    ),
    *(
        Decider(
            f"emitted {method}, {language}",
            partial(of_emitted_tilted, method, language),
            takes=SWEEPS if method == "passage" else POSITIONS,
            every={"python": 24, "javascript": 4}.get(language, 1),
            abstains=0.4,
            drawn=language == "c",
            lacks=partial(lacks_language, language),
        )
        for method in ("tilted", "passage")
        for language in LANGUAGES
    ),
    Decider("builtin:exact-integers", partial(of_method, "exact-integers"), takes=UPRIGHT, refuses=False),
    Decider("the float filter", of_float_filter, takes=POSITIONS + ENDED),
    Decider("oracle: exact", partial(of_oracle, "exact"), every=16, refuses=False),
    Decider("oracle: nearest", partial(of_oracle, "nearest"), every=6, refuses=False),
    Decider("oracle: roots", partial(of_oracle, "roots"), every=16, refuses=False),
    Decider("oracle: heights", partial(of_oracle, "heights"), every=24, refuses=False),
    Decider(
        "oracle: mesh",
        partial(of_oracle, "mesh"),
        takes=POSITIONS + ENDED,
        every=48,
        abstains=0.4,
        refuses=False,
        lacks=ORACLES["mesh"].available,
    ),
    Decider("fractions", of_fractions, every=24, refuses=False, drawn=False),
    Decider("certificates", checkers.check_positions, every=8, refuses=False, drawn=False),
    Decider("hypcheck.passage", of_passage, takes=SWEEPS, every=5),
    Decider("passage by the discriminant", of_discriminant, takes=SWEEPS, every=36, refuses=False, drawn=False),
    Decider("hypcheck.Scene.passage", partial(by_row, of_scene_passage), takes=SWEEPS, every=10),
    Decider("builtin:passage-certified", partial(of_method, "passage-certified"), takes=("end",), refuses=False),
    Decider("the C header, ways", of_header, takes=SWEEPS, abstains=0.1, lacks=lacks_compiler),
    Decider("the numpy kernel, ways", of_ways_in_numpy, takes=SWEEPS, abstains=0.7),
    Decider("hypcheck.passage, ends", of_passage, takes=ENDED_WAYS, every=4, refuses=False, drawn=False),
    Decider("the kernel, ways and ends", of_ways_in_c, takes=ENDED_WAYS, abstains=0.2, refuses=False, drawn=False),
    Decider("the numpy kernel, ways and ends", of_ways_in_numpy, ENDED_WAYS, 1.0, refuses=False, drawn=False),
    Decider("certificates of ways", checkers.check_ways, takes=SWEEPS, every=6, refuses=False, drawn=False),
)
