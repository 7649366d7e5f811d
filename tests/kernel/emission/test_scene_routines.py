"""Code for whole scenes of tilted movers and hyperboloids, and for their sweeps: what hypcheck.Scene says, or 2."""

import ctypes

import numpy as np
import pytest

import hypcheck
from hypcheck.cli.main import main
from tests.kernel.emission.building import asking, library_of, load_module, pointer, skip_without
from tests.support.inside import dialect_of

SCENE = """
name = "tilted"
[[hyperboloid]]
alpha = 1.0
gamma = 2.0
axis = [0.3, 0.1, 1]
height = [-3, 3]
[[hyperboloid]]
alpha = 0.5
gamma = 2.0
center = [5, 1, 0.25]
[[hyperboloid]]
alpha = 0.75
gamma = 1.5
center = [-4, 3, 0]
height = [-2, 2]
solid = true
[[hyperboloid]]
alpha = 1.5
gamma = 2.0
center = [2, -4, 0]
height = [-0.02, 0.02]
[mover]
b = 0.25
d = 0.15
axis = AXIS
"""
FIXED, FREE = SCENE.replace("AXIS", "[0.2, 0, 1]"), SCENE.replace("AXIS", '"free"')
UPRIGHT = SCENE.replace("axis = [0.3, 0.1, 1]\n", "").replace("axis = AXIS\n", "")
BOX = ((-7, -5, -5), (7, 5, 5))
LANGUAGES = ("c", "python", "cpp", "rust", "javascript")


def in_languages(*texts):
    """Each case in every language; in CI all in C, and the first in Python."""
    return [
        pytest.param(
            *text, language, marks=[pytest.mark.thorough] * (language != "c" and (language != "python" or place > 0))
        )
        for place, text in enumerate(texts)
        for language in LANGUAGES
    ]


def emitted(folder, text, language, *options):
    skip_without(language)
    scene, path = folder / "scene.toml", folder / f"kernel.{dialect_of(language).extension}"
    scene.write_text(text, encoding="utf-8")
    assert main(["emit", "--scene", str(scene), *options, "--language", language, "--output", str(path)]) == 0
    return library_of(path, language)


def rows_of(count, places, *, free=False):
    rng = np.random.default_rng(7)
    parts = [rng.uniform(*BOX, (count, 3)) for _ in range(places)]
    return np.hstack([*parts, *([rng.normal(size=(count, 3))] if free else [])])


def beside_ring(count):
    """Steep sweeps past the wall of the lowest hyperboloid, which is a ring."""
    rng = np.random.default_rng(5)
    off, turn = 1.5 + rng.uniform(-0.5, 0.5, (2, count)), rng.uniform(0, 2 * np.pi, count)
    sweeps = [
        np.stack([2 + r * np.cos(turn), r * np.sin(turn) - 4, np.full(count, z)], 1)
        for r, z in zip(off, (1, -1), strict=True)
    ]
    return np.hstack(sweeps)


def answers_of(path, language, name, rows):
    """What a file says of rows, and the times of sweeps."""
    if language == "python":
        module = load_module(path)
        times = [module.first_contact(*row) for row in rows.tolist()] if name == "sweep" else []
        return np.array([getattr(module, name)(*row) for row in rows.tolist()]), np.array(times)
    if language == "javascript":
        return asking(path, language, name)(rows), np.array([])
    found, times = np.full(len(rows), 99, np.int8), np.full(len(rows), np.nan)
    many = getattr(ctypes.CDLL(str(path)), f"hypcheck_{name}_rows")
    given = (found, times) if name == "sweep" else (found,)
    many(ctypes.c_size_t(len(rows)), *map(pointer, (np.ascontiguousarray(rows), *given)))
    return found, times


@pytest.mark.parametrize(
    ("text", "question", "language"), in_languages((FREE, "position"), (FIXED, "position"), (FIXED, "exterior"))
)
def test_emitted_code_of_a_tilted_scene_answers_as_the_scene(tmp_path, text, question, language):
    free, count = text is FREE, 100 if language == "python" else 1000
    rows = rows_of(count, 1, free=free)
    scene = hypcheck.Scene.from_text(text.replace("name =", f'question = "{question}"\nname ='))
    answers = scene.classify(rows[:, :3], **({"axis": rows[:, 3:]} if free else {}))
    path = emitted(tmp_path, text, language, "--whole", "--question", question)
    found, _ = answers_of(path, language, "whole", rows)
    assert ((found == answers) | (found == 2)).all()
    assert (found == 2).mean() < 0.04 or language == "python"  # of 100
    assert {0, 1} <= set(found.tolist())


@pytest.mark.parametrize(("text", "language"), in_languages((FREE,), (FIXED,), (UPRIGHT,)))
def test_emitted_sweeps_of_a_scene_answer_as_the_scene(tmp_path, text, language):
    free, count = text is FREE, 20 if language == "python" else 150
    rows = rows_of(count, 2, free=free)
    rows[::2, :6] = beside_ring(len(rows[::2]))
    scene = hypcheck.Scene.from_text(text)

    def passage(sweeps):
        return scene.passage(sweeps[:, :3], sweeps[:, 3:6], **({"axis": sweeps[:, 6:]} if free else {}))

    found, times = answers_of(emitted(tmp_path, text, language, "--sweeps"), language, "sweep", rows)
    assert ((found == passage(rows).hit) | (found == 2)).all()
    assert (found[1::2] == 2).mean() < 0.15 or language == "python"  # of 10
    hits = np.flatnonzero(found == 1)[:: max(1, count // 10)][:4]  # an exact time beside ends takes a tenth of a second
    assert len(hits)
    if len(times):
        exact = passage(rows[hits])
        assert not (times[hits] > exact.first_upper).any()
        assert np.median(exact.first_lower - times[hits]) < 1e-9


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--whole", "--sweeps"), "give one of them"),
        (("--sweeps", "--question", "interior"), "--question is about positions"),
        (("--sweeps", "--precision", "float32"), "need float64"),
        (("--sweeps", "--proof", "p.v"), "--proof is for kernels of pairs"),
    ],
)
def test_emit_refuses_options_that_do_not_apply_to_code_for_sweeps(capsys, options, words):
    assert main(["emit", "--scene", "tower", *options, "--language", "c"]) == 2
    assert words in capsys.readouterr().err
