"""What `hypcheck emit` writes in C, a representative set, and the questions that each kernel is asked.

    python -m tests.tools.evidence.emitted_kernels FOLDER

asks the compiled kernels of a folder in a process of its own, for counts of coverage are written when it ends. Answers
are judged as those of any implementation: right but for the bound that the kernel tells, or for what it cannot say.
"""

from __future__ import annotations

import ctypes
import json
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.scene.model import FREE, Hyperboloid, Mover, Region, SceneModel, Span
from hypcheck.scene.reading import read_scene, shipped_scenes
from tests.kernel.emission.building import COMMAND, answers, answers_by_scene, pointer, worst_error
from tests.kernel.emission.test_pair import UNFILTERED
from tests.kernel.emission.test_tilted import SCENES as TILTED
from tests.kernel.emission.test_whole import answers_as, centres, expected, forest, told
from tests.support.inside import METHODS, ScenePlan, emitted, emitted_pair, emitted_whole, plan_of, whole_plan
from tests.tools.attack import places
from tests.tools.attack.strike import truth_of
from tests.tools.evidence.battery.constructed import BESIDE_TANGENCIES
from tests.tools.evidence.battery.questions import frozen
from tests.tools.evidence.emitted_rows import ask_limits
from tests.tools.evidence.emitted_whole import ask_ends, ends_of
from tests.tools.evidence.seeds import ROWS

EVERY = 9
"""Of frozen vectors each so many-th is asked."""

COUNT = 24
"""Rows of each family for a kernel of a scene."""

MOST_LIMITS = 12
"""Settings of a whole scene, the mover's before its parts', that are asked at their limits: others share functions."""

Kernels = dict[str, tuple[str, Callable[[Path], None]]]
"""The text in C and what asks the library, by name."""


def kernels() -> Kernels:
    """All of them."""
    found: Kernels = {}
    for name, scene, precision in _scenes():
        plan = plan_of(scene, precision)
        found[name] = emitted(plan, "c", COMMAND), _asks_scene(plan)
    for name, scene in _whole_scenes():
        found[name] = emitted_whole(scene, whole_plan(scene), "c", COMMAND), _asks_whole(scene)
    for method in METHODS:
        found[f"method {method}"] = emitted_pair(method, "c", COMMAND), _asks_method(method != "exact")
    text = emitted_pair("exact", "c", COMMAND)
    found["method exact, without its floats"] = text.replace(*UNFILTERED["c"]), _asks_method(False)
    return found


def _scenes() -> Iterator[tuple[str, SceneModel, str]]:
    for name in shipped_scenes():
        for precision in ("float64", "float32")[: 1 + (name != "forest")]:
            yield f"{name} {precision}", read_scene(name), precision
    tower = read_scene("tower")
    for question in ("position", "exterior", "contact"):
        yield f"tower {question}", replace(tower, question=question), "float64"
    for name, scene in TILTED.items():
        yield name, scene, "float64"
    yield "the tower, any axis, contact", replace(TILTED["the tower, any axis"], question="contact"), "float64"
    hill = Hyperboloid("hill", 0.61, 6.0, (5.0, -3.25, 0.375), Span(-0.9, 5.0))
    yield "a hill", SceneModel("a hill", "position", (hill,), Mover(0.3, 0.9), Region(z=Span(-1.0, 4.0))), "float64"


def _whole_scenes() -> Iterator[tuple[str, SceneModel]]:
    yield "whole, parts", _with_odd_ends(forest(4))
    yield "whole, contact", _with_odd_ends(forest(8, "contact"))
    yield "whole, exterior, everywhere", _with_odd_ends(forest(4, "exterior", (), Region()))


def _with_odd_ends(scene: SceneModel) -> SceneModel:
    """The last hyperboloid longer, its heights downwards; and another, by itself, that ends before its waist."""
    *others, last = scene.hyperboloids
    longer = replace(last, axis=(0.0, 0.0, -2.0), height=Span(-4.5, 1.5))
    lone = Hyperboloid("lone", 1.0, 1.0, (-4.5, -4.5, 0.25), Span(0.6, 1.5))
    return replace(scene, hyperboloids=(*others, longer, lone))


def _answered_alike(library: Path, rows: np.ndarray) -> np.ndarray:
    """The answers to rows, which are the same by scene."""
    found = answers(library, rows)
    assert (found == answers_by_scene(library, rows)).all()
    return found


def _asks_scene(plan: ScenePlan) -> Callable[[Path], None]:
    def ask(library: Path) -> None:
        def both(rows: np.ndarray) -> np.ndarray:
            found = answers(library, rows)
            for axis in np.unique(rows[:, 7:], axis=0):
                alike = (rows[:, 7:] == axis).all(axis=1)
                assert (found[alike] == answers_by_scene(library, rows[alike])).all()
            return found

        worst, asked = worst_error(both, plan, COUNT)
        assert worst <= plan.bound_u, worst
        assert asked
        for stages in plan.settings:
            alpha, gamma, b, d = stages.setting.sizes
            _ask_odd(library, np.array([alpha, gamma, b, d, alpha + (b + d) / 2, 0, 0]), stages.setting.axis)
            for rows in _wide(np.array(stages.setting.sizes), stages.setting.axis, plan.format.name == "float32"):
                both(rows)
            ask_limits(plan, stages, partial(_answered_alike, library))

    return ask


def _wide(sizes: np.ndarray, axis: object, single: bool) -> Iterator[np.ndarray]:
    """Rows in and beyond the region, up to where squares overflow; for any axis, of all lengths and directions.

    Many blocks follow each other that lines decide, that the search has to, and of both. Nothing is promised of most of
    these, but that both entries say the same.
    """
    random, count = np.random.default_rng(4), 40 * 256 + 13
    alpha, gamma, b, _ = sizes
    far = 10.0 ** random.uniform(-3, 20 if single else 160, (count, 2))
    z = gamma * random.uniform(-3, 3, count)
    at_surface = alpha * np.sqrt(1 + (z / gamma) ** 2) + random.uniform(-1.5, 1.5, count) * b
    kind = random.integers(0, 4, count)
    kind[: 20 * 256] = np.repeat([0, 3, 2, 2], 5 * 256)
    x = np.choose(kind, [at_surface, far[:, 0], 50 * at_surface, 0.9 * alpha * random.random(count)])
    z = np.choose(kind, [z, far[:, 1], z, 0.1 * z])
    rows = np.column_stack([np.tile(sizes, (count, 1)), x, 0 * x, z])
    rows[-1, 4], rows[-2, 6], rows[-3, 5] = np.nan, np.inf, -np.inf
    rows = rows.astype(np.float32).astype(np.float64) if single else rows
    rows[:, :4] = sizes
    if axis is None:
        yield rows
    elif axis != FREE:
        yield np.column_stack([rows, np.tile(np.array(axis, float), (count, 1))])
    else:
        for length in (1.0, 1e-300, 1e300, 5e-324):
            for given in (random.standard_normal(3), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (1e-160, 0.0, 1.0)):
                yield np.column_stack([rows, np.tile(np.array(given) * length, (count, 1))])


def _ask_odd(library: Path, row: np.ndarray, axis: object) -> None:
    """Sizes that the scene has not are answered "cannot say", and so is an axis that is none, or another.

    The place is one where the answer depends on the axis.
    """
    width = 7 if axis is None else 10
    given = (1.0, 2.0, 3.0) if axis == FREE or axis is None else axis
    rows = np.tile(np.array([*row, *given])[:width], (4 + 5 * (width > 7), 1))
    for column in range(4):
        rows[column, column] = np.nextafter(rows[column, column], np.inf)
    if width > 7:
        rows[4, 7:], rows[5, 7:], rows[6, 8], rows[7, 7], rows[8, 9] = 0, np.nan, np.inf, -np.inf, np.inf
    for one in rows:
        found = answers(library, one[None]), answers_by_scene(library, one[None])
        assert [each.tolist() for each in found] == [[CANNOT_SAY]] * 2, one


def _asks_whole(scene: SceneModel) -> Callable[[Path], None]:
    def ask(library: Path) -> None:
        columns = centres(900)
        columns[0, :2], columns[2, 2:4], columns[3, 4:6] = np.nan, np.inf, (np.nan, -1e301)
        found = told(library, "c", columns)
        if scene.region.z is not None:
            columns[:, :6] = 0
            columns[2, :6] = 99.0  # beyond the region: nothing can be said, as of numbers that are none
            right = np.where(columns[2] == 99.0, CANNOT_SAY, expected(scene, np.where(columns == 99.0, 0.0, columns)))
            assert answers_as(found, right)
        loaded, kept = ctypes.CDLL(str(library)), np.ascontiguousarray(columns[:, 6:])
        still = np.full(kept.shape[1], 99, np.int8)
        loaded.hypcheck_whole(ctypes.c_size_t(len(still)), *map(pointer, kept[:3]), None, pointer(still))
        headed = told(library, "c", np.vstack([kept[:3], np.zeros((1, len(still)))]))
        assert (still == headed).all()  # no headings are headings of 0
        ask_ends(scene, partial(told, library, "c"))
        plan = whole_plan(scene)
        pairs = partial(_answered_alike, library)
        assert worst_error(pairs, plan, COUNT)[0] <= plan.bound_u
        for stages in plan.settings:
            for rows in _wide(np.array(stages.setting.sizes), None, False):
                pairs(rows)
        of_mover = (scene.mover.b, scene.mover.d)
        for stages in sorted(plan.settings, key=lambda stages: stages.setting.sizes[2:] != of_mover)[:MOST_LIMITS]:
            ask_limits(plan, stages, pairs)
        for column in range(4):
            for value in (np.nan, np.inf, -np.inf, 1e308):
                odd = np.array([[0.0], [0.0], [0.0], [0.0]])
                odd[column] = value
                said = told(library, "c", odd)
                assert (said == CANNOT_SAY).all() or (value == 1e308 and column < 3)
        for body in scene.hyperboloids:
            ends = ends_of(body) or [body.center[2]]
            level = sum(ends) / len(ends) - body.center[2]
            _ask_pair(library, np.array([body.alpha, body.gamma, scene.mover.b, scene.mover.d, 0, 0, level]))

    return ask


def _ask_pair(library: Path, row: np.ndarray) -> None:
    """Far out, on the axis, and with other sizes."""
    rows = np.tile(row, (6, 1))
    rows[0, 4] = 1e3
    for column in range(4):
        rows[2 + column, column] = np.nextafter(row[column], np.inf)
    right = [1, int(truth_of(row[None])[0]), *[CANNOT_SAY] * 4]
    assert answers(library, rows).tolist() == right
    for one, position in zip(rows, right, strict=True):
        assert answers_by_scene(library, one[None]).tolist() == [position]


def _asks_method(may_pass: bool) -> Callable[[Path], None]:
    def ask(library: Path) -> None:
        asked = [(each.rows, each.right) for each in frozen(EVERY) if each.kind == ROWS]
        random = np.random.default_rng(3)
        drawn = [make(random, 400) for make in (places.near_contact, places.on_the_ring, places.grid, places.far)]
        ring = np.array(
            [[1.0, 2, 1, 1, 2.5, 0, 0], [7, 7, 1, 1, 10, 0, 0], [1, 2, 1, 1, 2, 0, 0], [2, 1, 2, 1, 4, 0, 0]]
        )
        subnormal = np.array(
            [[1.0, 2, 1, 1, 2, 5e-324, 0], [1, 2, 1, 1, 2, 0, 5e-324], [1, 2, 1, 1, 0, 1e-320, 1e-310]]
        )
        next_to_it = np.array([[1.0, 2, 1, 1, 2, 0, 0], [4, 2, 2, 1, 6, 0, 0]]) * 2.0**-1023  # sizes on both sides
        drawn += [np.array(BESIDE_TANGENCIES, float), ring, subnormal, next_to_it]
        asked += [(rows, truth_of(rows)) for rows in drawn]
        odd = np.tile(np.array([1.0, 2, 1, 1, 3, 0, 0]), (21, 1))
        odd[np.arange(21), np.repeat(np.arange(7), 3)] = np.tile([np.nan, np.inf, -np.inf], 7)
        asked += [(odd, np.full(21, 127))]
        for rows, right in asked:
            valid = right != 127
            found = answers(library, rows)
            assert ((found == right) | (may_pass & (found == CANNOT_SAY)))[valid].all()
            assert (found[~valid] == 127).all() or may_pass

    return ask


def main(folder: Path) -> None:
    """Asks each library of the folder; its file `names` has the names by their numbers."""
    names, made = json.loads((folder / "names").read_text(encoding="utf-8")), kernels()
    for number, name in enumerate(names):
        library = folder / f"kernel-{number}.so"
        described = ctypes.CDLL(str(library)).hypcheck_describe
        described.restype = ctypes.c_char_p
        assert json.loads(described())["protocol"] == 1
        made[name][1](library)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
