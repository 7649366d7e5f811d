"""Implementations whose description names the groups of columns that they take: each row has these, in their order."""

from __future__ import annotations

import itertools
import shlex
import sys
from textwrap import dedent

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.implementations.description import Description, described
from hypcheck.implementations.implementation import open_implementation
from hypcheck.implementations.session import StartError
from tests.tools.miniatures import LIMITS, compiled_text, rows

WIDTHS = {"end": 3, "axis": 3, "heights": 3}
TAKEN = [
    (question, groups)
    for question, known in (("position", ("axis", "heights")), ("passage", ("end", "axis", "heights")))
    for count in range(len(known) + 1)
    for groups in itertools.combinations(known, count)
]
LEANING, ENDED, BOTH = ("axis",), ("heights",), ("axis", "heights")


def of_taken(*few):
    """All that can be taken, of which all but a few are thorough: one code gives all implementations their columns."""
    return [
        pytest.param(question, groups, marks=() if (question, groups) in few else pytest.mark.thorough)
        for question, groups in TAKEN
    ]


CHECK = """
import numpy as np

def right(rows, width, heights):
    # 1 where the first height and the width are as they must be; the sum of the row tells that all of it has arrived.
    assert rows.shape[1] == width, rows.shape
    assert not heights or (rows[:, -3:] == [-np.inf, np.inf, 0]).all(), rows[0]
    return (rows[:, :7].sum(axis=1) > 0).astype(int)
"""

SPEAKER = """
import json, sys
print(json.dumps({"protocol": 1, "name": "speaker", "binary": BINARY, **DESCRIPTION}), flush=True)
incoming, outgoing = sys.stdin.buffer, sys.stdout.buffer
while line := incoming.readline():
    _, sequence, count, form = line.decode().split()
    assert form.startswith("passage-" if PASSAGE else ("tilted-" if TILT else ("binary", "text"))), form
    n = int(count)
    if BINARY:
        rows = np.frombuffer(incoming.read(8 * WIDTH * n), dtype="<f8").reshape(n, WIDTH)
    else:
        rows = np.array([incoming.readline().split() for _ in range(n)], dtype=float).reshape(n, -1)
    answers = right(rows, WIDTH, HEIGHTS)
    body = answers.astype("i1").tobytes() if BINARY else b"".join(b"%d\\n" % answer for answer in answers)
    outgoing.write(b"%d %d\\n" % (int(sequence), n) + body)
    outgoing.flush()
"""

LIBRARY = """
#include <stddef.h>
#include <stdint.h>
#include <math.h>
const char *hypcheck_describe(void) { return DESCRIPTION; }
static int8_t right(size_t width, const double *row) {
    double sum = 0;
    for (int i = 0; i < 7; i++) sum += row[i];
    if (HEIGHTS && !(row[width - 3] == -INFINITY && row[width - 2] == INFINITY && row[width - 1] == 0)) return 2;
    return width == WIDTH && sum > 0;
}
#if PASSAGE
void hypcheck_passage_columns(size_t n, size_t width, const double *rows, int8_t *hits, double *times) {
    for (size_t i = 0; i < n; i++) hits[i] = times ? 2 : right(width, rows + i * width);
}
#else
void hypcheck_classify_columns(size_t n, size_t width, const double *rows, int8_t *positions) {
    for (size_t i = 0; i < n; i++) positions[i] = right(width, rows + i * width);
}
#endif
"""


def describing(question, groups):
    return {"question": question} | ({"takes": list(groups)} if groups else {})


def width_of(question, groups):
    return 7 + sum(WIDTHS[group] for group in {*groups, *(["end"] if question == "passage" else [])})


def asked_rows(question, groups):
    """Rows as a caller has them: heights are not known here."""
    some = [rows(30)]
    some += [rows(30)[:, 4:7][::-1]] if question == "passage" else []
    some += [np.random.default_rng(5).uniform(-1, 1, (30, 3))] if "axis" in groups else []
    return np.hstack(some)


def require_right(spec, question, groups):
    some = asked_rows(question, groups)
    with open_implementation(spec, LIMITS) as it:
        assert it.description.tilt == ("axis" in groups)
        answered = it.classify(some, batch=13)
        assert answered.answered.all(), answered.reasons
        assert answered.answers.tolist() == (some[:, :7].sum(axis=1) > 0).astype(int).tolist()
        assert set(answered.answers.tolist()) == {0, 1}


@pytest.mark.parametrize(
    ("question", "groups"),
    of_taken(("position", BOTH), ("passage", ENDED)),
)
def test_python_function_gets_exactly_the_columns_that_it_takes(tmp_path, question, groups):
    answer = f"right(rows, {width_of(question, groups)}, {'heights' in groups})"
    source = f"{CHECK}\nhypcheck = {describing(question, groups)!r}\ndef answers(rows):\n    return {answer}\n"
    (tmp_path / "taking.py").write_text(source)
    require_right(f"python:{tmp_path / 'taking.py'}:answers", question, groups)


IN_TEXT = ("position", LEANING), ("passage", BOTH)
IN_BINARY = ("position", ENDED), ("passage", LEANING)


@pytest.mark.parametrize(
    ("question", "groups", "binary"),
    [
        pytest.param(*each.values, binary, marks=each.marks)
        for binary, few in ((False, IN_TEXT), (True, IN_BINARY))
        for each in of_taken(*few)
    ],
)
def test_command_gets_exactly_the_columns_that_it_takes(tmp_path, question, groups, binary):
    facts = {
        "DESCRIPTION": describing(question, groups),
        "BINARY": binary,
        "PASSAGE": question == "passage",
        "TILT": "axis" in groups,
        "WIDTH": width_of(question, groups),
        "HEIGHTS": "heights" in groups,
    }
    script = tmp_path / "speaker.py"
    script.write_text(CHECK + "".join(f"{name} = {value!r}\n" for name, value in facts.items()) + SPEAKER)
    require_right(f"command:{shlex.join([sys.executable, str(script)])}", question, groups)


@pytest.mark.parametrize(
    ("question", "groups"),
    of_taken(("position", ENDED), ("passage", ("end", *BOTH))),
)
def test_library_with_the_function_for_rows_of_any_width_is_called_by_it(tmp_path, question, groups):
    description = str(describing(question, groups)).replace("'", '\\"')
    facts = {
        "DESCRIPTION": f'"{description}"',
        "PASSAGE": int(question == "passage"),
        "WIDTH": width_of(question, groups),
        "HEIGHTS": int("heights" in groups),
    }
    source = "".join(f"#define {name} {value}\n" for name, value in facts.items()) + LIBRARY
    require_right(f"library:{compiled_text(source, tmp_path / 'taking.so')}", question, groups)


def test_library_that_takes_heights_without_the_function_for_them_is_refused(tmp_path):
    source = dedent("""
        #include <stddef.h>
        #include <stdint.h>
        const char *hypcheck_describe(void) { return "{\\"takes\\": [\\"heights\\"]}"; }
        void hypcheck_classify(size_t n, const double *rows, int8_t *positions) { (void)n, (void)rows; *positions = 0; }
    """)
    with pytest.raises(StartError) as caught:
        open_implementation(f"library:{compiled_text(source, tmp_path / 'lacking.so')}", LIMITS)
    assert str(caught.value).endswith(
        "no symbol hypcheck_classify_columns; it must export void hypcheck_classify_columns(size_t n, size_t width, "
        'const double *rows, int8_t *positions), in C++ as extern "C", since it describes itself with '
        '"takes": ["heights"]'
    )


@pytest.mark.parametrize(
    ("raw", "sentence"),
    [
        ({"takes": "axis"}, "takes is 'axis'; it must be a list of end, axis, heights, of none, some or all"),
        ({"takes": ["axis", "axis"]}, "it must be a list of end, axis, heights"),
        ({"takes": ["tilt"]}, r"takes is \['tilt'\]; it must be a list of end, axis, heights"),
        ({"takes": [["axis"]]}, "it must be a list of end, axis, heights"),
        ({"takes": ["end"]}, "takes an end, but its question is 'position'; .* belongs to the question \"passage\""),
        ({"takes": ["axis"], "tilt": False}, "takes an axis, but its tilt is false; leave tilt out, or make it true"),
    ],
)
def test_wrong_groups_of_a_description_are_refused_by_a_sentence_that_states_the_right_ones(raw, sentence):
    with pytest.raises(InputError, match=sentence):
        described(raw, Description("it"))


def test_columns_of_a_description_have_one_order_whatever_the_order_of_its_groups():
    taken = described({"question": "passage", "takes": ["heights", "axis"]}, Description("it"))
    assert taken.columns[7:] == ("x1", "y1", "z1", "axis_x", "axis_y", "axis_z", "z_min", "z_max", "solid")
    assert described({"question": "passage", "takes": ["end"]}, Description("it")).columns == taken.columns[:10]
    assert described({"tilt": True}, Description("it")) == described({"takes": ["axis"]}, Description("it"))
