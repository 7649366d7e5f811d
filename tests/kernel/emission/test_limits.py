"""Emitted kernels at the limits of their region and format, where nothing is promised."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.geometry.pair import Position
from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.scene.model import Hyperboloid, Mover, Region, SceneModel, Span
from tests.kernel.emission.building import COMMAND, COMMANDS, asking, built, skip_without
from tests.support import inside
from tests.support.inside import EMITTED_LANGUAGES, emitted, plan_of
from tests.support.scenes import HILLS, scene

SIZES = (2.0, 17.8, 0.25, 0.15)
LANGUAGES = ("c", "cpp", "rust", "javascript", "python")


def rows_at(centres, sizes=SIZES):
    return np.column_stack([np.tile(sizes, (len(centres), 1)), np.array(centres, dtype=np.float64)])


@pytest.mark.parametrize("question", ["position", "exterior", "interior", "contact"])
@pytest.mark.parametrize("language", ["c", "javascript"])
def test_an_emitted_kernel_is_right_or_cannot_say_where_squares_overflow(question, language, tmp_path):
    skip_without(language)
    draw = np.random.default_rng(1)
    far = 10.0 ** draw.uniform(0, 37, (400, 3)) * draw.choice([0.0, 1.0, 1.0], (400, 3))
    rows = rows_at(far)
    found = asking(built(tmp_path, scene(SIZES, question), language, "float32"), language)(rows)
    truth = inside.positions(rows)
    right = truth if question == "position" else truth == Position[question.upper()]
    said = found != CANNOT_SAY
    assert (found[said] == right[said]).all()
    near = (rows[:, 4:] < 1e15).all(axis=1)
    assert said[near].all()
    assert not said.all()


@pytest.mark.parametrize("question", ["position", "interior", "contact"])
@pytest.mark.parametrize("language", LANGUAGES)
def test_an_emitted_kernel_calls_no_exterior_centre_interior_where_only_the_square_of_z_overflows(
    question, language, tmp_path
):
    """The line's slope is below 1: times a square of 2^1025 or so it is no larger than an R that is finite."""
    skip_without(language)
    z = 1.35e154 * np.linspace(1, 1.8, 40)
    rows = np.concatenate([rows_at(np.column_stack([x * z / SIZES[1], 0 * z, z])) for x in (1.0, 2.1, 2.5, 6.0)])
    truth = inside.positions(rows)
    right = truth if question == "position" else truth == Position[question.upper()]
    assert set(truth.tolist()) == {-1, 1}
    found = asking(built(tmp_path, scene(SIZES, question), language), language)(rows)
    said = found != CANNOT_SAY
    assert (found[said] == right[said]).all()


@pytest.mark.parametrize("language", LANGUAGES)
def test_an_emitted_kernel_answers_cannot_say_for_nan(language, tmp_path):
    skip_without(language)
    nan = math.nan
    for question in ("position", "interior"):
        kernel = asking(built(tmp_path, scene(SIZES, question), language), language)
        assert (kernel(rows_at([(nan, 0, 0), (0, nan, 0), (1, 1, nan)])) == CANNOT_SAY).all()


@pytest.mark.parametrize(
    ("precision", "sizes"),
    [
        ("float32", (1e6, 1e6, 1e-6, 1e-6)),
        ("float32", (1e9, 1.0, 1e-10, 1.0)),
        ("float32", (1e-9, 1.0, 1e10, 1.0)),
        ("float64", (1e75, 1e75, 1e-75, 1e-75)),
        ("float64", (1.0, 1e76, 1.0, 1e-76)),
        ("float64", (1e-76, 1e-76, 1e76, 1e76)),
    ],
)
def test_emit_refuses_sizes_whose_products_leave_the_float_format(precision, sizes):
    """Each of these once had a kernel that answered at random next to contact."""
    with pytest.raises(InputError, match=r"no kernel is made for alpha .*: .*\(hypcheck.Scene asks any\)"):
        plan_of(scene(sizes), precision)


def test_emit_refuses_a_region_beyond_the_float_format():
    with pytest.raises(InputError, match="products of the lengths in the region leave float32"):
        plan_of(scene(SIZES, z=Span(-1e30, 1e30)), "float32")


@pytest.mark.parametrize("height", [5e-324, 1e-200])
def test_emit_refuses_a_region_in_which_the_square_of_a_threshold_underflows(height):
    with pytest.raises(InputError, match="a border so near to the axis has no square"):
        plan_of(scene((1.0, 1.0, 1.0, 1.0), z=Span(height, height)))


@pytest.mark.parametrize("height", [Span(-1e60, 1.0), Span(-1e-60, 1e60), Span(-3.5e38, 0.1)])
@pytest.mark.parametrize("language", ["c", "cpp", "rust"])
def test_an_emitted_kernel_is_right_if_a_modelled_height_is_beyond_its_float_format(height, language, tmp_path):
    skip_without(language)
    tree = Hyperboloid("tree", 1.0, 2.0, height=height)
    hall = SceneModel("s", "position", (tree,), Mover(0.5, 0.5), Region(z=Span(-2.0, 2.0)))
    kernel = asking(built(tmp_path, hall, language, "float32"), language)
    rows = rows_at([(0.0, 0.0, 0.0), (1.2, 0.0, 0.0), (4.0, 0.0, 0.05)], (1.0, 2.0, 0.5, 0.5))
    assert kernel(rows).tolist() == [-1, 0, 1]


@pytest.mark.parametrize("precision", ["float64", "float32"])
def test_an_emitted_kernel_is_within_its_error_bound_on_the_border_of_its_region(precision, tmp_path):
    skip_without("c")
    kernel = asking(built(tmp_path, replace(HILLS, question="position"), "c", precision), "c")
    for body, stages in zip(HILLS.hyperboloids, plan_of(HILLS).settings, strict=True):
        x, y, z = stages.setting.box.spans
        ends = [(across, along, up) for across in x_ends(x) for along in x_ends(y) for up in x_ends(z)]
        near = [(body.alpha, 0.0, up) for up in x_ends(z)]
        rows = rows_at([*ends, *near], stages.setting.sizes)
        assert (kernel(rows) == inside.positions(rows)).all()


def x_ends(span):
    return span.low, span.high


@pytest.mark.parametrize("language", EMITTED_LANGUAGES)
def test_the_head_of_an_emitted_kernel_states_its_promise_and_its_region(language):
    """A kernel that does not look at a coordinate says so."""

    def head(**spans):
        text = emitted(plan_of(scene(SIZES, **spans)), language, COMMAND)
        return " ".join(text[:3000].replace(" * ", " ").replace("//! ", " ").replace("// ", " ").split())

    assert "promised of centres in the region of their sizes, its border included" in head()
    assert "as long as |x| and |y| are below 7.1e+150" in head()
    assert "At any other height the answer is worth nothing: z is not looked at" in head(z=Span(0.5, 0.5))
    fields = head(x=Span(9.0, 10.0), z=Span(-1.0, 1.0))
    assert "Outside it the answer is worth nothing: the centre is not looked at" in fields


@pytest.mark.parametrize("language", LANGUAGES)
def test_an_emitted_kernel_with_many_settings_answers_cannot_say_for_other_sizes(language, tmp_path):
    skip_without(language)
    trees = tuple(
        Hyperboloid(f"tree {number}", alpha, gamma, (0.0, 0.0, 0.0))
        for number, (alpha, gamma) in enumerate((a, g) for a in (0.7, 0.3, 0.5) for g in (9.0, 4.0, 6.0))
    )
    among = SceneModel("trees", "position", trees, Mover(0.3, 0.9), Region(z=Span(0.0, 0.0)))
    sizes = np.array([[tree.alpha, tree.gamma, 0.3, 0.9] for tree in trees])
    rows = np.column_stack([sizes, np.full(9, 0.9), np.zeros((9, 2))])
    strange = np.repeat(rows, 8, axis=0)
    for place in range(8):
        column, towards = place % 4, (-np.inf, np.inf)[place // 4]
        strange[place::8, column] = np.nextafter(strange[place::8, column], towards)
    asked = asking(built(tmp_path, among, language), language)
    queries = np.concatenate([rows, strange])
    # A library is asked by scene too, so of one pair of sizes at a time.
    tables = np.split(queries, len(queries)) if language in COMMANDS else [queries]
    found = np.concatenate([asked(table) for table in tables])
    assert (found[:9] == inside.positions(rows)).all()
    assert len(set(found[:9].tolist())) == 2
    assert (found[9:] == CANNOT_SAY).all()
