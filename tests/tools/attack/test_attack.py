"""The attack in a few seconds, and proof that it finds errors; answers in other rounding modes and builds."""

from __future__ import annotations

import ctypes
import sys

import numpy as np
import pytest

from tests.kernel.compiling import (
    CLANG,
    COMPILER,
    HEADER,
    IMPLEMENTATION,
    needs_clang,
    needs_compiler,
    shared_library,
)
from tests.support import inside
from tests.support.inside import LEVELS, generate
from tests.tools.attack.places import Scene, near_contact, scenes
from tests.tools.attack.rounding import DIRECTED, TO_NEAREST, rounded
from tests.tools.attack.strike import Batch, batches, drawn, strike, tally
from tests.tools.attack.subjects import Subject, of_library, one_by_one, subjects

ROWS = 8_000


@pytest.fixture(scope="module")
def struck():
    return list(batches(3, ROWS))


def test_short_attack_draws_rows_of_every_stratum_that_a_long_one_draws():
    """Scenes are large, so few rows must not mean none of them."""
    assert {stratum for stratum, _ in drawn(3, ROWS)} == {stratum for stratum, _ in drawn(3, 40 * ROWS)}


def test_no_kernel_answers_any_attack_row_wrongly(struck):
    _, wrong, rows = tally(strike(subjects(), struck))
    assert sum(wrong.values()) == 0, rows[0][0].tolist()


def built(folder, *options, header=None, compiler=COMPILER):
    (folder / "hypcheck.h").write_text(header or HEADER.read_text(encoding="utf-8"), encoding="utf-8")
    shared_library(folder, IMPLEMENTATION, *options, compiler=compiler)
    found = of_library(folder / "library.so", "built")
    assert found is not None
    return found


CONTRACTED = ("-std=gnu99", "-O3", "-march=native", "-ffp-contract=fast")


@needs_compiler
@pytest.mark.parametrize(
    ("compiler", "options"),
    [
        pytest.param(COMPILER, ("-DHYPCHECK_PLAIN", "-DHYPCHECK_SMALL_LIMBS"), id="plain-with-32-bit-limbs"),
        pytest.param(COMPILER, CONTRACTED, id="everything-contracted"),
        pytest.param(CLANG, CONTRACTED, id="by-clang", marks=needs_clang),
    ],
)
def test_no_compiler_and_option_makes_a_kernel_answer_any_attack_row_wrongly(compiler, options, struck, tmp_path):
    _, wrong, rows = tally(strike([built(tmp_path, *options, compiler=compiler)], struck[::3]))
    assert sum(wrong.values()) == 0, rows[0][0].tolist()


SABOTAGE = {
    "bounds a hundredth": {name: generate.CONSTANTS[name] / 100 for name in ("u_4", "u_8", "u_12", "u_16", "u_1536")},
    "margins reversed": {"more": generate.CONSTANTS["less"], "less": generate.CONSTANTS["more"]},
    "bounds of a leaning row a hundredth": {
        name: generate.CONSTANTS[name] / 100 for name in ("u_p_l", "u_k", "u_d_l", "u_F", "u_psi")
    },
    "margins of half spaces": {"unit": 0.0, "more": generate.CONSTANTS["less"], "less": generate.CONSTANTS["more"]},
    "products may overflow": {"farthest": sys.float_info.max},
}


@needs_compiler
@pytest.mark.parametrize("weaker", SABOTAGE.values(), ids=SABOTAGE)
def test_attack_finds_wrong_answers_of_a_kernel_with_a_bound_that_is_too_small(weaker, struck, tmp_path, monkeypatch):
    for name, value in weaker.items():
        monkeypatch.setitem(generate.CONSTANTS, name, value)
    subject = built(tmp_path, *CONTRACTED, header=generate.header())
    _, wrong, _ = tally(strike([subject], struck))
    assert sum(wrong.values()) > 0


def test_kernels_answer_rightly_for_heights_whose_squares_underflow():
    """a = 1 on the axis: contact at the waist, interior anywhere above it, were it by 1e-300."""
    random = np.random.default_rng(9)
    for sizes in ((4.0, 1.0, 4.0, 4.0), (1.0, 4.0, 1.0, 2.0), (0.5, 4.0, 1.0, 2.0)):
        z = random.uniform(-1, 1, 3000) * 10.0 ** random.choice([-310, -300, -200, -162, -150, -45], 3000)
        scene = Scene("axis", sizes, np.zeros(3000), np.zeros(3000), z)
        _, wrong, _ = tally(strike(subjects(), [Batch("axis", scene, inside.positions(scene.rows), (TO_NEAREST,))]))
        assert sum(wrong.values()) == 0


FAR_ROWS = (  # |x|/b above 2e33; 3Δ and what it is compared with are products of some 1e300
    ((2.0, 17.8, 0.25, 0.15, 1e37, 0.0, 0.0), 1),
    ((2.0, 2.0, 1.0, 1.0, 1e39, 0.0, 0.0), 1),
    ((2.0, 2.0, 1.0, 1.0, 0.0, 0.0, -1e39), -1),
    (
        (
            *map(float.fromhex, ("0x1.8738799dce447p+50", "0x1.a7a1c4e3bdc09p+7", "0x1.af6b9bd2e5a1ap+0")),
            *map(float.fromhex, ("0x1.8e6b51a8c5abfp+0", "0x1.bda8372232493p+175", "0x0p+0", "0x1.e29409d35ecddp+132")),
        ),
        -1,
    ),
)


@needs_compiler
def test_kernels_call_far_centres_clear_under_every_rounding_mode(tmp_path):
    """Rounded down or towards zero an overflow looks like the largest finite number, whose differences mean nothing."""
    rows = np.array([row for row, _ in FAR_ROWS])
    right = [position for _, position in FAR_ROWS]
    build = built(tmp_path, *CONTRACTED)
    library = ctypes.CDLL(str(tmp_path / "library.so"))
    one = one_by_one(lambda *row: library.hypcheck_position(*map(ctypes.c_double, row)), "one", every=1)
    for mode in (TO_NEAREST, *DIRECTED):
        for subject in (build, one, *subjects()):
            with rounded(mode):
                found = subject.rows(rows).tolist()
            assert found == right, (mode, subject.name)


MODES = """
#include <fenv.h>
#include <xmmintrin.h>
int set_mode(int mode, int flush) {
    static const int modes[] = {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
    _mm_setcsr(_mm_getcsr() & ~0x8040u);
    if (flush) _mm_setcsr(_mm_getcsr() | 0x8040u);
    return fesetround(modes[mode]);
}
"""


@needs_compiler
@pytest.mark.parametrize(
    ("mode", "flush"), [(0, 1), (1, 0), (2, 1), (3, 0)], ids=["flushed", "upward", "downward-flushed", "towards-zero"]
)
def test_kernel_answers_do_not_depend_on_the_rounding_mode(mode, flush, tmp_path):
    """An engine may have set either; the rows are decided beforehand, under the usual rounding."""
    random = np.random.default_rng(mode)
    rows = near_contact(random, 6_000)
    rows[::50, 4:] *= 1e-310
    scene = next(scenes(random, 1, 5000))
    truth, truth_of_scene = inside.positions(rows), inside.positions(scene.rows)
    control = shared_library(tmp_path, MODES, "-frounding-math")
    written_in_c = [subject for subject in subjects() if subject.name in (*LEVELS, "pair, C")]
    for subject in written_in_c:
        found, of_scene = _under(control, (mode, flush), subject, rows, scene)
        assert (found == truth).all()
        assert (of_scene == truth_of_scene).all()


def _under(control, setting, subject: Subject, rows, scene):
    assert control.set_mode(*(ctypes.c_int(each) for each in setting)) == 0
    try:
        return subject.rows(rows), subject.scene(scene.sizes, scene.x, scene.y, scene.z)
    finally:
        control.set_mode(0, 0)
