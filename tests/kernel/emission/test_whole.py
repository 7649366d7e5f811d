"""Kernels of whole scenes: what hypcheck.Scene answers, in all five languages, and what verify asks of every kernel."""

from __future__ import annotations

import ctypes
import json
import shutil
import subprocess
from dataclasses import replace

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.scene.model import Hyperboloid, Mover, MoverPart, Region, SceneModel, Span
from tests.kernel.emission.building import (
    COMMAND,
    asking,
    built_of,
    load_module,
    pointer,
    skip_without,
    worst_error,
)
from tests.support.inside import EMITTED_LANGUAGES, Scene, emitted_whole, whole_plan

PARTS = (MoverPart(0.1, 0.05, 0.135, 45.0), MoverPart(0.1, 0.05, 0.135, 165.0), MoverPart(0.08, 0.05, 0.135, 285.0))


def forest(trees, question="position", parts=PARTS, region=None):
    rng = np.random.default_rng(trees)
    sizes, centres = rng.uniform((0.2, 2), (1.5, 6), (trees, 2)).tolist(), rng.uniform(-6, 6, (trees, 2)).tolist()
    bodies = tuple(
        Hyperboloid(
            f"tree {k}",
            *size,
            (*centre, 0.25 * (k % 4)),
            Span(-1.0, 3.0 + 0.5 * (k % 3)) if k % 2 else None,
            solid=k % 4 == 3,
        )
        for k, (size, centre) in enumerate(zip(sizes, centres, strict=True))
    )
    return SceneModel("trees", question, bodies, Mover(0.25, 0.15, parts), region or Region(z=Span(-2.0, 6.0)))


def built(folder, scene, language, plan):
    return built_of(folder, emitted_whole(scene, plan, language, COMMAND), language)


def told(path, language, columns):
    """What the kernel answers about the whole scene; `columns` are x, y, z and the heading."""
    if language == "python":
        whole_of = load_module(path).whole
        return np.array([whole_of(*each) for each in columns.T.tolist()], np.int8)
    if language == "javascript":
        script = f"import {{ whole }} from {json.dumps(str(path))};\n"
        script += "import { readFileSync } from 'fs';\n"
        script += "console.log(JSON.stringify(JSON.parse(readFileSync(0)).map((each) => whole(...each))));"
        asking_script = path.with_name("whole.mjs")
        asking_script.write_text(script, encoding="utf-8")
        node, sent = str(shutil.which("node")), json.dumps(columns.T.tolist())
        done = subprocess.run([node, str(asking_script)], input=sent, capture_output=True, text=True, check=True)
        return np.array(json.loads(done.stdout), np.int8)
    found = np.full(columns.shape[1], 99, np.int8)
    kept = [np.ascontiguousarray(column) for column in columns]
    ctypes.CDLL(str(path)).hypcheck_whole(ctypes.c_size_t(len(found)), *map(pointer, kept), pointer(found))
    return found


def centres(count):
    rng = np.random.default_rng(11)
    return np.stack([*rng.uniform(-7, 7, (2, count)), rng.uniform(-2.5, 6.5, count), rng.uniform(0, 360, count)])


def answers_as(found, answers, abstained=0.02):
    """Whether a kernel answers as the scene, but for a share of centres at most, near ends, of which it answers 2."""
    return bool(((found == answers) | (found == 2)).all()) and ((found == 2) & (answers != 2)).mean() <= abstained


def expected(scene, columns):
    """What the scene says; 2 where the centre is outside of its region."""
    found = Scene(scene).classify(*columns)
    span = scene.region.z
    return np.where((columns[2] < span.low) | (columns[2] > span.high), 2, found)


@pytest.fixture(scope="module")
def small():
    """A scene, the plan of its kernel, centres, and what the scene says of them."""
    scene, columns = forest(4), centres(700)
    answers = expected(scene, columns)
    assert set(answers.tolist()) == {-1, 0, 1, 2}
    return scene, whole_plan(scene), columns, answers


QUICK = ("c", "python")
LANGUAGES = [pytest.param(name, marks=[] if name in QUICK else pytest.mark.thorough) for name in EMITTED_LANGUAGES]


@pytest.mark.slow
@pytest.mark.parametrize("language", LANGUAGES)
def test_an_emitted_whole_scene_kernel_answers_as_the_scene(language, small, tmp_path):
    skip_without(language)
    scene, plan, columns, answers = small
    assert answers_as(told(built(tmp_path, scene, language, plan), language, columns), answers)


@pytest.mark.thorough
@pytest.mark.parametrize("language", EMITTED_LANGUAGES)
def test_the_pairs_of_a_whole_scene_kernel_are_within_8_u(language, small, tmp_path):
    skip_without(language)
    scene, plan, _, _ = small
    worst, asked = worst_error(asking(built(tmp_path, scene, language, plan), language), plan, 2)
    assert worst <= 8
    assert asked > 50


@pytest.mark.slow
@pytest.mark.parametrize("question", ["exterior", "interior", "contact"])
def test_a_whole_scene_kernel_answers_the_question_of_its_scene(question, small, tmp_path):
    scene, columns = replace(small[0], question=question), small[2]
    answers = expected(scene, columns)
    assert set(answers.tolist()) == {0, 1, 2}
    assert answers_as(told(built(tmp_path, scene, "python", small[1]), "python", columns), answers)


STUMPS = tuple(
    Hyperboloid(f"stump {k}", 0.75, 2.0, (6.0 * k, 0.0, 0.1 * k), Span(-1.0, 2.0), solid=k == 1) for k in range(2)
)


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_whole_scene_kernel_never_calls_a_mover_clear_that_touches_a_rim_or_an_end(language, tmp_path):
    """Centres about the ends of an open and of a solid stump, inside of them, outside, above and on the rims."""
    skip_without(language)
    rng, count = np.random.default_rng(5), 3000
    scene = SceneModel("stumps", "position", STUMPS, Mover(0.3, 0.2))
    number, turn = rng.integers(0, 2, count), rng.uniform(0, 2 * np.pi, count)
    off = 0.75 * 2**0.5 + rng.choice([-1, 1], count) * rng.uniform(0, 0.5, count)
    level = rng.choice([-1.0, 2.0], count) + rng.uniform(-0.3, 0.3, count) + 0.1 * number
    columns = np.stack([6.0 * number + off * np.cos(turn), off * np.sin(turn), level, np.zeros(count)])
    answers = Scene(scene).classify(*columns)
    assert set(answers.tolist()) == {-1, 0, 1}
    path = built(tmp_path, scene, language, whole_plan(scene))
    found = told(path, language, columns)
    assert answers_as(found, answers, abstained=0.5)
    assert {-1, 0, 1, 2} == set(found.tolist())
    high = np.array([[0.0, 1e9], [0.0, 0.0], [2.3, 9.0], [0.0, 0.0]])
    assert told(path, language, high).tolist() == [1, 1]


def test_a_whole_scene_kernel_is_right_for_a_trunk_with_one_end_whose_axis_points_down(tmp_path):
    down = Hyperboloid("down", 0.75, 2.0, (0.0, 0.0, 0.0), Span(-2.0, float("inf")), (0.0, 0.0, -3.0), solid=True)
    scene = SceneModel("s", "position", (down,), Mover(0.3, 0.2), Region(z=Span(-9.0, 9.0)))
    levels = np.array([-8.0, 0.0, 1.5, 1.9, 2.15, 2.25, 8.0])
    columns = np.stack([np.zeros(7), np.zeros(7), levels, np.zeros(7)])
    found = told(built(tmp_path, scene, "python", whole_plan(scene)), "python", columns)
    assert Scene(scene).classify(*columns).tolist() == [-1, -1, -1, 0, 0, 1, 1]
    assert found.tolist() == [-1, -1, -1, 2, 2, 1, 1]


def test_a_whole_scene_kernel_answers_cannot_say_for_nan_and_outside_of_the_region(small, tmp_path):
    path = built(tmp_path, small[0], "python", small[1])
    nan, most = float("nan"), 1.7976931348623157e308
    for centre in ((nan, 0, 0, 0), (0, float("inf"), 0, 0), (0, 0, 7, 0), (0, 0, nan, 0), (0, 0, 0, nan)):
        assert load_module(path).whole(*centre) == 2
    assert load_module(path).whole(most, most, 0.0) == 1


def test_a_whole_scene_kernel_is_refused_if_the_mover_is_tilted():
    scene = replace(forest(2, parts=()), mover=Mover(0.25, 0.15, (), (1.0, 0.0, 1.0)))
    with pytest.raises(InputError, match="no kernel is made for a whole scene whose mover is tilted"):
        whole_plan(scene)


@pytest.mark.thorough
def test_a_whole_scene_kernel_of_200_different_trees_answers_as_the_scene(tmp_path):
    skip_without("c")
    scene, columns = forest(200, parts=()), centres(20_000)
    path = built(tmp_path, scene, "c", whole_plan(scene))
    assert answers_as(told(path, "c", columns), expected(scene, columns))
