"""The compiled kernel behind the public functions: questions, threads, strides, and refused arguments."""

from __future__ import annotations

import ctypes
import threading

import numpy as np
import pytest

import hypcheck
from hypcheck.errors import InputError
from hypcheck.scene.model import QUESTIONS
from tests.support import inside
from tests.support.inside import compiled_kernel, numpy_kernel
from tests.tools.attack.places import near_contact, scenes

compiled = pytest.importorskip("hypcheck.kernel._compiled")

SIZES = (2.0, 17.8, 0.25, 0.15)


@pytest.fixture(scope="module")
def rows():
    return near_contact(np.random.default_rng(4), 3000)


@pytest.fixture(scope="module")
def scene():
    return next(scenes(np.random.default_rng(5), 1, 5000))


@pytest.fixture(scope="module")
def truth(rows):
    return inside.positions(rows)


@pytest.fixture(scope="module")
def scene_truth(scene):
    return inside.positions(scene.rows)


@pytest.mark.parametrize("kernel", [compiled_kernel, numpy_kernel], ids=["compiled", "numpy"])
@pytest.mark.parametrize("question", QUESTIONS)
def test_the_compiled_kernel_answers_each_question_as_the_exact_position_does(
    kernel, question, rows, scene, truth, scene_truth
):
    yes = {"exterior": 1, "interior": -1, "contact": 0}
    for right, (answers, refused) in (
        (truth, kernel.answer_rows(rows, question)),
        (scene_truth, kernel.answer_scene(scene.sizes, (scene.x, scene.y, scene.z), question)),
    ):
        assert refused == 0
        assert answers.tolist() == (right if question == "position" else (right == yes[question]).astype(int)).tolist()


@pytest.mark.parametrize("question", QUESTIONS)
@pytest.mark.parametrize("kernel", [compiled_kernel, numpy_kernel], ids=["compiled", "numpy"])
def test_the_compiled_kernel_answers_127_for_an_invalid_row_and_no_other_changes(kernel, question):
    random = np.random.default_rng(1)
    x, y, z = random.uniform(-4, 4, (3, 40_000))
    before, _ = kernel.answer_scene(SIZES, (x, y, z), question)
    places = random.permutation(40_000)[:60]
    for place, column, value in zip(places, [x, y, z] * 20, [np.nan, np.inf, -np.inf] * 20, strict=True):
        column[place] = value
    after, refused = kernel.answer_scene(SIZES, (x, y, z), question)
    assert refused == 60
    assert (after[places] == 127).all()
    others = np.ones(40_000, dtype=bool)
    others[places] = False
    assert (after[others] == before[others]).all()


@pytest.mark.parametrize("threads", [1, 2, 3, 7, np.int64(2), 10**9])
def test_classify_answers_do_not_depend_on_the_number_of_threads(threads, rows, scene, truth, scene_truth):
    assert (hypcheck.classify(rows, threads=threads) == truth).all()
    found = hypcheck.classify_scene(scene.sizes, scene.x, scene.y, scene.z, threads=threads)
    assert (found == scene_truth).all()
    assert hypcheck.classify(rows[:2], threads=threads).tolist() == truth[:2].tolist()
    assert hypcheck.classify(rows[:0], threads=threads).tolist() == []


@pytest.mark.parametrize("threads", [0, -1, 1.0, True, "2"])
def test_classify_refuses_an_invalid_number_of_threads(threads):
    with pytest.raises(InputError, match=r"threads is .*; it must be a whole number greater than 0"):
        hypcheck.classify([[1, 2, 1, 1, 2.5, 0, 0]], threads=threads)


def test_classify_refuses_an_unknown_question():
    with pytest.raises(
        InputError, match="question is 'inside'; it must be one of position, exterior, interior, contact"
    ):
        hypcheck.classify_scene(SIZES, 1, 2, 3, question="inside")


def test_the_c_function_answers_with_the_position_if_the_question_is_unknown(scene, scene_truth):
    library = ctypes.CDLL(compiled.__file__)
    answers = np.full(len(scene.x), 99, np.int8)
    sizes, columns = np.array(scene.sizes), (scene.x, scene.y, scene.z)
    pointers = [ctypes.c_void_p(array.ctypes.data) for array in (sizes, *columns, answers)]
    for question in (-1, 4, 1 << 20):
        refused = library.hypcheck_ask_scene(question, pointers[0], ctypes.c_size_t(len(answers)), *pointers[1:])
        assert refused == 0
        assert (answers == scene_truth).all()


@pytest.mark.parametrize("bad", [0, 320])
def test_an_error_in_one_part_of_the_rows_is_raised_in_the_caller_after_the_other_parts_are_done(bad):
    done = []

    def part(start, _):
        if start == bad:
            raise MemoryError("no room")
        done.append(start)
        return 0

    with pytest.raises(MemoryError, match="no room"):
        compiled_kernel.in_parts(part, 1000, 3)
    assert sorted([bad, *done]) == [0, 320, 640]


def test_classify_scene_is_exact_for_columns_of_any_stride_type_and_alignment(scene, scene_truth):
    """Of so many rows that threads share them."""
    count = 2 * compiled_kernel.ROWS_A_THREAD // len(scene.x) + 1
    right = np.tile(scene_truth, count)
    table = np.tile(np.column_stack([scene.x, scene.y, scene.z]), (count, 1))
    x, y, z = np.ascontiguousarray(table.T)
    assert (hypcheck.classify_scene(scene.sizes, *table.T) == right).all()
    assert (hypcheck.classify_scene(scene.sizes, x[::-1], y[::-1], z[::-1]) == right[::-1]).all()
    assert (hypcheck.classify_scene(scene.sizes, *(each.astype(">f8") for each in (x, y, z))) == right).all()
    shifted = np.frombuffer(b"\0" + x.tobytes(), np.float64, len(x), 1)
    assert not shifted.flags.aligned
    assert (hypcheck.classify_scene(scene.sizes, shifted, y, z) == right).all()


def test_classify_is_exact_for_rows_of_any_alignment(rows, truth):
    shifted = np.frombuffer(b"\0" + rows.tobytes(), np.float64, rows.size, 1).reshape(rows.shape)
    assert (hypcheck.classify(shifted) == truth).all()


def test_the_compiled_extension_refuses_wrong_buffers_in_one_sentence():
    out, rows = np.zeros(2, np.int8), np.ones((2, 7))
    for sentence, *arguments in (
        ("a question is a number from 0 to 3", 4, rows, out),
        ("seven or ten numbers for each answer", 0, rows, np.zeros(3, np.int8)),
        ("a buffer of format d is needed, not f", 0, rows.astype(np.float32), out),
        ("a buffer of format b is needed, not B", 0, rows, np.zeros(2, np.uint8)),
        ("not C-contiguous", 0, rows.T, out),
    ):
        with pytest.raises(ValueError, match=sentence):
            compiled.ask(*arguments)
    with pytest.raises(ValueError, match="as many x, y and z"):
        compiled.ask_scene(0, SIZES, np.ones(2), np.ones(2), np.ones(3), out)
    frozen = np.zeros(2, np.int8)
    frozen.flags.writeable = False
    with pytest.raises(ValueError, match="read-only"):
        compiled.ask(0, rows, frozen)


def test_few_rows_are_not_divided_and_many_are_divided_into_whole_blocks_for_the_threads(monkeypatch):
    parts, threads = [], set()

    def part(start, stop):
        parts.append((start, stop))
        threads.add(threading.current_thread().name)
        return stop - start

    assert compiled_kernel.in_parts(part, 1000, None) == 1000
    assert parts == [(0, 1000)]
    parts.clear()
    assert compiled_kernel.in_parts(part, 1000, 3) == 1000
    assert sorted(parts) == [(0, 320), (320, 640), (640, 1000)]
    assert len(threads) == 3
    many = 5 * compiled_kernel.ROWS_A_THREAD
    for most in (2, 9):
        monkeypatch.setenv("HYPCHECK_THREADS", str(most))
        parts.clear()
        assert compiled_kernel.in_parts(part, many, None) == many
        assert len(parts) == min(most, 5)
