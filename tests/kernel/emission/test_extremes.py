"""Emitted kernels for extreme sizes, where the maximum of the dual function is very near to 0 or to a pole."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.runs import judge
from hypcheck.scene.model import QUESTIONS, Span
from tests.kernel.emission.building import asking, built, worst_error, worst_of
from tests.support.inside import plan_of
from tests.support.scenes import scene

RATIOS = [
    (1.4619391426938503e-10, 115039041460.553, 0.08788600961991147, 3.198985040311613e-21),
    (3.07379422875493e-05, 14820778059.778082, 7707076.266055296, 1.1402201256191407e-05),
    (1.1720837614637915e-67, 1.275928552211674e-43, 3.737174981799962e-29, 3.9742199486608103e58),
    (11686786.999059252, 1.0427925340918041e-07, 0.014610797552124532, 3575.264084000083),
]
"""Kernels for these once answered contact far from it, or clear in contact."""


@pytest.mark.parametrize("question", QUESTIONS)
@pytest.mark.parametrize("sizes", RATIOS)
def test_emitted_kernels_for_sizes_of_any_ratio_have_backward_errors_within_8_u(sizes, question, tmp_path):
    chosen = scene(sizes, question)
    worst, asked = worst_error(asking(built(tmp_path, chosen, "python"), "python"), plan_of(chosen), 256)
    assert asked > 500
    assert worst <= 8


@pytest.mark.parametrize("sizes", [(2.0, 17.8, 0.25, 0.15), (0.61, 28.0, 0.3, 0.9)])
def test_an_emitted_kernel_is_within_its_error_bound_near_the_asymptotic_cone(sizes, tmp_path):
    """Up to 10¹⁴⁰ metres from the waist, at any nearness to the cone that the hyperboloid approaches."""
    chosen = scene(sizes)
    draw = np.random.default_rng(3)
    z = 10.0 ** draw.uniform(2, 140, 1500)
    off = draw.choice([-1.0, 1.0], 1500) * 2.0 ** draw.uniform(-53, -1, 1500)
    rows = np.column_stack([np.tile(sizes, (1500, 1)), sizes[0] / sizes[1] * z * (1 + off), np.zeros(1500), z])
    criterion = judge.Criterion("position", "float64", Fraction(8))
    assert worst_of(asking(built(tmp_path, chosen, "python"), "python"), rows, criterion) <= 8


@pytest.mark.parametrize(
    ("precision", "sizes", "z"),
    [
        ("float32", (5.9e-43, 704.43, 9.8e-57, 4.9e-9), Span(0.0, 0.0)),
        ("float32", (1.4e-85, 1e-48, 2e70, 1.4e79), Span(1e-48, 1e-48)),
    ],
)
def test_emit_refuses_sizes_whose_scale_leaves_the_float_format(precision, sizes, z):
    with pytest.raises(InputError, match=r"no kernel is made for .* is not a normal number of float32"):
        plan_of(scene(sizes, z=z), precision)
