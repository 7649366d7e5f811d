"""Code for one pair of any sizes: right for frozen vectors in each language, with and without its floats."""

import re
import subprocess
from fractions import Fraction

import numpy as np
import pytest

from hypcheck.cli.main import main
from hypcheck.derivation.evaluation import outputs
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.geometry.pair import COLUMNS
from hypcheck.kernel.programs import dual
from hypcheck.vectors import frozen
from tests.kernel.emission.building import asking_pairs, built_of, skip_without
from tests.support.inside import emitted_pair

COMMAND = ["hypcheck", "emit"]
UNFILTERED = {
    "c": ("if (decided)", "if (0 && decided)"),
    "rust": ("FLOATS_DECIDE && decided", "FLOATS_DECIDE && false && decided"),
}
UNFILTERED |= {"cpp": UNFILTERED["c"], "python": ("if decided:", "if False:"), "javascript": UNFILTERED["c"]}
"""What takes the floats away, so that whole numbers decide each row."""


@pytest.fixture(scope="module")
def vectors():
    """A part of the frozen vectors of every family, the extreme ones too, and their positions."""
    found = [frozen.load(name) for name in frozen.NAMES]
    rows = np.ascontiguousarray(np.vstack([each.rows[::9] for each in found]))
    return rows, np.concatenate([each.positions[::9] for each in found])


def answers(folder, language, text, rows):
    """The answers of a file in a language."""
    skip_without(language)
    return asking_pairs(built_of(folder, text, language), language)(rows)


THOROUGH = [pytest.param(language, marks=pytest.mark.thorough) for language in ("cpp", "rust", "javascript")]


@pytest.mark.parametrize("language", ["python", "c", *THOROUGH])
def test_emitted_exact_pair_code_is_right_without_its_float_stage(tmp_path, vectors, language):
    text, (rows, positions) = emitted_pair("exact", language, COMMAND), vectors
    before, after = UNFILTERED[language]
    assert text.count(before) == 1
    assert (answers(tmp_path, language, text.replace(before, after), rows) == positions).all()


def test_emitted_exact_pair_code_of_rust_compiles_without_a_named_edition(tmp_path):
    skip_without("rust")
    (tmp_path / "pair.rs").write_text(emitted_pair("exact", "rust", COMMAND), encoding="utf-8")
    command = ["rustc", "--emit", "metadata", "--crate-type", "lib", "pair.rs"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("method", ["dual", "local-maximum"])
def test_emitted_dual_form_pair_code_decides_every_row_of_ordinary_families(tmp_path, method):
    named = ("tower-body", "tower-rotors", "forest-type-1", "flight", "uniform", "on-surface", "ring")
    found = [frozen.load(name) for name in named]
    rows, positions = np.vstack([each.rows for each in found]), np.concatenate([each.positions for each in found])
    assert (answers(tmp_path, "python", emitted_pair(method, "python", COMMAND), rows) == positions).all()


@pytest.mark.parametrize("method", ["dual", "local-maximum"])
def test_emitted_dual_form_pair_code_with_a_wrong_multiplier_is_never_wrong(tmp_path, vectors, method):
    rows, positions = vectors
    text, found = emitted_pair(method, "python", COMMAND), "        lambda_found = B - v_"
    assert text.count(found) == 1
    given = answers(tmp_path, "python", text.replace(found, f"{found[:-6]}0.75 * B - 0.75 * v_"), rows)
    assert ((given == positions) | (given == 2)).all()
    assert 0.3 < (given == 2).mean() < 0.9


def test_the_dual_form_program_bounds_the_errors_of_phi_and_of_its_slope(vectors):
    rows, wanted = vectors[0][::2], ("in_range", "lambda_", "phi", "e", "phi_slope", "slope_error")
    inputs = {**dict(zip(COLUMNS, rows.T, strict=True)), **dual.CONSTANTS}
    in_range, *numbers = outputs(dual.DUAL, float_arithmetic("float64"), inputs, wanted)
    assert in_range.sum() > 300
    for row, found in zip(rows[in_range].tolist(), np.stack(numbers, axis=1)[in_range].tolist(), strict=True):
        alpha, gamma, b, d, x, y, z = map(Fraction, row)
        multiplier, phi, error, slope, slope_error = map(Fraction, found)
        A, B, P, Q = (alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / (b * b), (z / d) ** 2
        V, W = B - multiplier, A + multiplier
        assert abs(phi - (P * multiplier / W - Q * multiplier / V - multiplier - 1)) <= error
        assert abs(slope - (P * A / W**2 - Q * B / V**2 - 1)) <= slope_error


def test_emit_for_one_pair_refuses_a_precision(capsys):
    assert main(["emit", "--language", "python", "--method", "exact", "--precision", "float32"]) == 2
    assert "--precision is for a scene" in capsys.readouterr().err


@pytest.mark.parametrize(
    "words",
    [
        ["--method", "dual", "--language", "python"],
        ["--method", "exact", "--language", "c", "--prefix", "mine"],
        ["--scene", "tower", "--language", "c"],
        ["--scene", "tower", "--language", "rust", "--precision", "float32", "--question", "exterior"],
        ["--scene", "forest", "--language", "python", "--whole"],
    ],
)
def test_emitted_code_names_the_command_with_the_options_that_were_given(capsys, words):
    assert main(["emit", *words]) == 0
    found = re.search("hypcheck emit [^`\n]*", capsys.readouterr().out)
    assert found[0].split() == ["hypcheck", "emit", *words]
