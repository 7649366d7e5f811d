"""Implementations whose description says tilt: each question comes in rows of ten numbers, in every way of asking."""

from __future__ import annotations

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.geometry.rows import with_axis
from hypcheck.implementations.domain import Domain, claimed, representable
from hypcheck.implementations.implementation import open_implementation
from hypcheck.implementations.protocol import row_text
from hypcheck.implementations.session import StartError
from tests.support.tilted_fractions import exact_position
from tests.tools.miniatures import LIMITS, command, compiled, function, rows, signs, truth

SHARED = ("-shared", "-fPIC")


def tilted_rows(n: int = 40):
    """Rows of everyday, each with another axis."""
    return np.column_stack([rows(n, lucky=True), np.random.default_rng(11).uniform(-2.0, 2.0, (n, 3))])


def tilted_truth(some):
    """Their positions, by the matrices."""
    return [exact_position(row) for row in some.tolist()]


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return compiled("tilted", tmp_path_factory.mktemp("tilted") / "tilted.so", *SHARED)


@pytest.mark.slow
@pytest.mark.parametrize("spec", [command("tilted"), command("tilted", "binary"), function("tilted")])
def test_an_implementation_with_tilt_gets_rows_of_ten_numbers_for_upright_pairs_too(spec):
    leaning, upright = tilted_rows(12), rows(12, lucky=True)
    expected = tilted_truth(leaning)
    assert len(set(expected)) > 1
    with open_implementation(spec, LIMITS) as it:
        assert it.description.tilt
        assert it.classify(leaning).answers.tolist() == expected
        assert it.classify(leaning, batch=7).answers.tolist() == expected
        assert it.classify(upright).answers.tolist() == truth(upright).tolist()


def test_a_command_with_tilt_is_timed_on_rows_of_ten_numbers():
    with open_implementation(command("tilted", "binary"), LIMITS) as it:
        assert it.time(tilted_rows(4), 3) == 3000
        assert it.time(rows(4, lucky=True), 2, row_by_row=True) == 8000


def test_an_implementation_without_tilt_refuses_rows_of_ten_numbers():
    with (
        open_implementation(command("right"), LIMITS) as it,
        pytest.raises(InputError, match=r"shape \(40, 10\); it must be \(n, 7\): alpha"),
    ):
        it.classify(tilted_rows())


def test_a_library_with_tilt_is_called_by_its_tilted_functions_for_rows_and_scenes(library):
    some, upright = tilted_rows(700), rows(700)
    expected = np.sign(some[:, 4] + some[:, 7]).tolist()
    one = some.copy()
    one[:, :4], one[:, 7:] = some[0, :4], some[0, 7:]
    with open_implementation(f"library:{library}", LIMITS) as it:
        assert it.scene
        assert it.classify(some).answers.tolist() == expected
        assert it.classify(upright).answers.tolist() == signs(upright).tolist()
        assert it.classify(one, by_scene=True).answers.tolist() == np.sign(one[:, 4] + one[:, 7]).tolist()
        assert it.time(some, 3) > 0
        assert it.time(one, 3, by_scene=True) > 0
        with pytest.raises(InputError, match="rows of several sizes"):
            it.classify(np.vstack([one[:1], [[*one[0, :7], *some[1, 7:]]]]), by_scene=True)


def test_a_library_with_tilt_that_does_not_export_the_tilted_function_is_refused(tmp_path):
    lacking = compiled("tilted", tmp_path / "lacking.so", *SHARED, "-DLACKS")
    with pytest.raises(StartError) as caught:
        open_implementation(f"library:{lacking}", LIMITS)
    assert caught.value.exit_code == 5
    assert str(caught.value) == (
        f"library:{lacking} could not be started: '{lacking}' has no symbol hypcheck_classify_tilted; it must export "
        'void hypcheck_classify_tilted(size_t n, const double *rows10, int8_t *positions), in C++ as extern "C", '
        'since it describes itself with "tilt": true'
    )


def test_answer_127_is_allowed_for_an_axis_without_a_direction_and_for_nan():
    some = tilted_rows(4)
    some[1, 7:], some[2, 8] = 0.0, np.nan
    with open_implementation(function("tilted"), LIMITS) as it:
        answered = it.classify(some)
    assert answered.answered.all()
    assert (answered.answers == 127).tolist() == [False, True, True, False]


def test_row_text_of_ten_numbers_reads_back_to_the_bit():
    some = with_axis(rows(300)) * np.pi
    some[0, 7:] = -0.0, 5e-324, 1e308
    back = np.array([line.split() for line in b"".join(row_text(some)).splitlines()], dtype=np.float64)
    assert back.tobytes() == some.tobytes()


def test_the_magnitude_range_of_a_domain_ignores_the_axis_but_the_precision_limits_it():
    some = tilted_rows(3)
    some[0, 7:] = 1e300, -1e300, 1e300
    some[1, 7:] = 1e-300, 0.0, 0.0
    assert Domain(magnitude=(1e-2, 10.0)).holds(some).all()
    assert representable(some, "float32").tolist() == [False, False, True]
    assert claimed(some, Domain(), "float32").tolist() == [2]
    assert claimed(some, Domain(), "float64").tolist() == [0, 1, 2]
