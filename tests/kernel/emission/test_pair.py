"""Code for one pair of any sizes: right for frozen vectors in each language, with and without its floats."""

import ctypes
import importlib.util
import json
import shutil
import subprocess

import numpy as np
import pytest

from hypcheck.cli.main import main
from hypcheck.errors import InputError
from hypcheck.kernel.emission.pair import METHODS, emitted_pair
from hypcheck.vectors import frozen
from tests.kernel.emission.building import COMMANDS, skip_without

COMMAND = ["hypcheck", "emit"]
UNFILTERED = {"c": ("if (decided)", "if (0 && decided)"), "rust": ("if decided", "if false && decided")}
UNFILTERED |= {"cpp": UNFILTERED["c"], "python": ("if decided:", "if False:"), "javascript": UNFILTERED["c"]}
"""What takes the floats away, so that whole numbers decide each row."""


@pytest.fixture(scope="module")
def vectors():
    """A part of the frozen vectors of every family, the extreme ones too, and their positions."""
    found = [frozen.frozen_rows(name) for name in frozen.NAMES]
    rows = np.ascontiguousarray(np.vstack([each.rows[::9] for each in found]))
    return rows, np.concatenate([each.positions[::9] for each in found])


def answers(folder, language, text, rows):
    """The answers of a file in a language."""
    skip_without(language)
    path = folder / f"pair.{ {'c': 'c', 'cpp': 'cpp', 'rust': 'rs', 'python': 'py', 'javascript': 'mjs'}[language] }"
    path.write_text(text, encoding="utf-8")
    if language == "python":
        spec = importlib.util.spec_from_file_location("pair", path)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return np.array(module.classify(rows.tolist()))
    if language == "javascript":
        asked = f"import {{ predicate }} from {json.dumps(path.as_uri())}; console.log(JSON.stringify("
        asked += f"{json.dumps(rows.tolist())}.map(row => predicate(...row))))"
        node = [shutil.which("node"), "--input-type=module"]
        done = subprocess.run(node, input=asked, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return np.array(json.loads(done.stdout))
    library = folder / f"pair-{language}.so"
    end = ["-lm"] if language == "c" else []
    subprocess.run([*COMMANDS[language], str(path), *end, "-o", str(library)], check=True)
    found = np.empty(len(rows), dtype=np.int8)
    pointers = [array.ctypes.data_as(ctypes.c_void_p) for array in (rows, found)]
    ctypes.CDLL(str(library)).hypcheck_classify(ctypes.c_size_t(len(rows)), *pointers)
    return found


@pytest.mark.parametrize("filtered", [True, False])
@pytest.mark.parametrize("language", ["python", "c"])
def test_the_exact_code_answers_every_row_rightly_with_and_without_its_floats(tmp_path, vectors, language, filtered):
    text, (rows, positions) = emitted_pair("exact", language, COMMAND), vectors
    if not filtered:
        before, after = UNFILTERED[language]
        assert text.count(before) == 1
        text = text.replace(before, after)
    assert (answers(tmp_path, language, text, rows) == positions).all()


@pytest.mark.parametrize("language", ["cpp", "rust", "javascript"])
def test_the_whole_numbers_of_the_other_languages_answer_every_row_rightly(tmp_path, vectors, language):
    text, (rows, positions) = emitted_pair("exact", language, COMMAND), vectors
    before, after = UNFILTERED[language]
    assert text.count(before) == 1
    assert (answers(tmp_path, language, text.replace(before, after), rows) == positions).all()


def test_the_certified_code_is_right_or_cannot_say(tmp_path, vectors):
    rows, positions = vectors
    found = answers(tmp_path, "python", emitted_pair("certified", "python", COMMAND), rows)
    assert ((found == positions) | (found == 2)).all()
    assert 0.5 < (found == positions).mean() < 1


def test_the_exact_code_refuses_what_is_no_row(tmp_path):
    row = [2.0, 5.0, 1.0, 1.0, 3.0, 0.0, 0.0]
    rows = np.array([[*row[:place], bad, *row[place + 1 :]] for place in range(7) for bad in (np.nan, np.inf)])
    assert (answers(tmp_path, "python", emitted_pair("exact", "python", COMMAND), rows) == 127).all()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--method", "exact", "--scene", "tower"], "--scene is for a scene; --method exact is for one pair"),
        (["--method", "exact", "--precision", "float32"], "--precision is for a scene"),
        (["--method", "dual"], "--method is 'dual', which proves clear but no contact in floats; take exact"),
        (["--method", "fast"], "--method is 'fast'; it must be exact or certified"),
        ([], "emit needs --scene SCENE, or --method exact for one pair of any sizes"),
    ],
)
def test_a_bad_combination_of_options_is_refused_in_a_sentence(capsys, words, said):
    assert main(["emit", "--language", "python", *words]) == 2
    assert said in capsys.readouterr().err


def test_a_method_that_does_not_exist_is_refused():
    with pytest.raises(InputError, match="it must be exact or certified"):
        emitted_pair("roots", "c", COMMAND)
    assert METHODS == ("exact", "certified")
