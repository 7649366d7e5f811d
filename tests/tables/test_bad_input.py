"""Bad tables: exit 2, one message that names file, row, column and value, and no output."""
# ruff: noqa: E501 - each table stands on one line with its message

from __future__ import annotations

import json
import os
import random
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.cli.main import main
from hypcheck.geometry.pair import COLUMNS

HEADER = ",".join(COLUMNS)
GOOD = "1,2,1,1,2.5,0,0"
OBJECT = dict(zip(COLUMNS, (1, 2, 1, 1, 2.5, 0, 0), strict=True))
LINE = json.dumps(OBJECT)


def message(tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, data: bytes) -> str:
    """The one line about a bad file, after checking everything else that must hold."""
    (tmp_path / name).write_bytes(data)
    assert main(["classify", "--input", str(tmp_path / name), "--output", str(tmp_path / "out.npy")]) == 2
    output, errors = capsys.readouterr()
    assert output == ""
    assert errors.count("\n") == 1
    assert os.listdir(tmp_path) == [name]
    begin = f"hypcheck: error: {tmp_path / name}"
    assert errors.startswith(begin)
    return errors[len(begin) :].removesuffix("\n")


def bad_row(row: str) -> str:
    """A table whose second row is bad, on line 5: a cell of two lines and a blank line come before it."""
    return f'{HEADER},note\n{GOOD},"two\nlines"\n\n{row},\n{GOOD},\n'


CSV = {
    "": " is empty; it must begin with a line of column names",
    "\n\n": " is empty; it must begin with a line of column names",
    HEADER: " has no rows below its header; nothing was asked",
    f"{HEADER}\n\n": " has no rows below its header; nothing was asked",
    f"{GOOD}\n": ", line 1: a row of numbers; the first line must hold the names of the columns",
    "alpha,gamma,b,d,x,y\n": ", line 1: column z is missing; it needs alpha, gamma, b, d, x, y, z, in any order",
    "alpha,b,d,x,z\n": ", line 1: columns gamma, y are missing; it needs alpha, gamma, b, d, x, y, z, in any order",
    "\nalpha,Gamma,b,d,x,y,z\n": ", line 2: column gamma is missing; 'Gamma' must be written gamma",
    "alpha,gama,b,d,x,y,z\n": ", line 1: column gamma is missing; 'gama' must be written gamma, if that is what it means",
    "alpha,gamma,b,d,x0,y,z\n": ", line 1: column x is missing; 'x0' must be written x",
    "α,gamma,b,d,x,y,z\n": ", line 1: column alpha is missing; 'α' must be written alpha",
    "alpha;gamma;b;d;x;y;z\n": ", line 1: columns alpha, gamma, b, d, x, y, z are missing; columns are separated by commas",
    f"{HEADER},d\n": ", line 1: column 'd' stands twice; it must stand once",
    f"n,{HEADER},n,n\n": ", line 1: column 'n' stands 3 times; it must stand once",
    f"{HEADER},position\n": ", line 1: column 'position' has the name of a column that the output adds; rename or remove it",
    f"{HEADER},tangent\n": ", line 1: column 'tangent' has the name of a column that the output adds; rename or remove it",
    bad_row("1,2,1,1,abc,0,0"): ", row 2 (line 5): x is 'abc'; it must be a decimal number such as 2.5 or -1e-3",
    bad_row("1,2,1,1,1,0,1_0"): ", row 2 (line 5): z is '1_0'; it must be a decimal number such as 2.5 or -1e-3",
    bad_row("1,2,1,1,1,0,１"): ", row 2 (line 5): z is '１'; it must be a decimal number such as 2.5 or -1e-3",
    bad_row("1,2,1,1,1,,0"): ", row 2 (line 5): y is empty; it must be a number",
    bad_row("1,2, ,1,1,0,0"): ", row 2 (line 5): b is empty; it must be a number",
    bad_row("1,nan,1,1,1,0,0"): ", row 2 (line 5): gamma is 'nan'; it must be finite",
    bad_row("1,2,1,1,1,0,-Infinity"): ", row 2 (line 5): z is '-Infinity'; it must be finite",
    bad_row("1,2,1,1,1e999,0,0"): ", row 2 (line 5): x is 1e999, which is too large for float64",
    bad_row("1,2,0,1,1,0,0"): ", row 2 (line 5): b is 0; a semi-axis must be greater than 0",
    bad_row("1,2,1,-3.0,1,0,0"): ", row 2 (line 5): d is -3.0; a semi-axis must be greater than 0",
    bad_row("1,2,1,1e-999,1,0,0"): ", row 2 (line 5): d is 1e-999, which is too small for float64; it must be greater than 0",
    f'{HEADER},n\n{GOOD},\n1,2,1,1,-,0,0,"a\r\nb\n"\n': ", row 2 (line 3): x is '-'; it must be a decimal number such as 2.5 or -1e-3",
    bad_row("1,2,1,1,1,0"): ", row 2 (line 5): 7 cells; the header has 8",
    bad_row("1,2,1,1,1,0,0,0"): ", row 2 (line 5): 9 cells; the header has 8",
    f"{HEADER}\n{GOOD}\n1": ", row 2 (line 3): 1 cell; the header has 7",
    f'{HEADER},n\n{GOOD},"cut\noff': ", line 2: the text ends inside quotes that begin here; the file may have been cut off",
    f'{HEADER},n\n{GOOD},"a"b\n': ", line 2: ',' expected after '\"'; what stands in quotes must end with a quote and a comma",
    f"{HEADER}\r{GOOD}\r": ", line 1: a carriage return stands within a row; lines must end with LF or CRLF",
    f"{HEADER}\n{GOOD}\n1,2,1\0,1,1,0,0\n": ", line 3: a NUL byte; it must be UTF-8 text",
    f'{HEADER},n\n{GOOD},"{"a" * 200_000}"\n': ", line 2: a cell is longer than 131072 characters; a quote may have been left open",
    f"{HEADER},n\n{GOOD},{'a,' * (1 << 20)}\n": ", line 2: longer than 1048576 bytes; a row, or a case, is one short line",
}  # fmt: skip


@pytest.mark.parametrize(("text", "sentence"), CSV.items(), ids=range(len(CSV)))
def test_bad_csv_is_refused_naming_line_row_and_value(text, sentence, tmp_path, capsys):
    assert message(tmp_path, capsys, "in.csv", text.encode()) == sentence


def test_bad_csv_row_beyond_the_first_chunk_is_refused_naming_its_row_in_the_file(tmp_path, capsys):
    text = f"{HEADER}\n" + f"{GOOD}\n" * 20_000 + "1,2,1,1,x,0,0\n" + f"{GOOD}\n" * 5
    sentence = ", row 20001 (line 20002): x is 'x'; it must be a decimal number such as 2.5 or -1e-3"
    assert message(tmp_path, capsys, "in.csv", text.encode()) == sentence
    long = f"{HEADER},note\n" + f"{GOOD},{'a' * 1000}\n" * 3000 + f"{GOOD},".ljust(2000)
    data = long.encode() + b"\xe9\n"
    assert message(tmp_path, capsys, "in.csv", data) == ", line 3002: byte 0xe9 is not UTF-8; it must be UTF-8 text"
    assert message(tmp_path, capsys, "in.csv", long.encode() + b"\0").startswith(", line 3002: a NUL byte")


@pytest.mark.parametrize("data", [b"\x89PNG\r\n\x1a\n\0\0", "α".encode("utf-16"), b"\x1f\x8b\x08\0", b"\xff" * 100])
@pytest.mark.parametrize("name", ["in.csv", "in.jsonl"])
def test_binary_data_under_a_text_name_is_refused_at_line_1(name, data, tmp_path, capsys):
    assert re.fullmatch(r", line 1: .*; it must be UTF-8 text", message(tmp_path, capsys, name, data))


def changed(**values: object) -> str:
    return json.dumps(OBJECT | values)


JSONL = {
    "": " has no rows; nothing was asked",
    "\n \n": " has no rows; nothing was asked",
    f"{LINE}\n{LINE[:30]}": ", row 2 (line 2): not JSON at character 30: expecting value (the line may have been cut off)",
    f"{LINE}\n\n{LINE[:-1]}": ", row 2 (line 3): not JSON at character 66: expecting ',' delimiter (the line may have been cut off)",
    f"{LINE},\n": ", row 1 (line 1): not JSON at character 67: extra data",
    f"[{LINE}]\n": f", row 1 (line 1): {f'[{LINE}]'[:40]}… is not an object; it must be one, with alpha, gamma, b, d, x, y, z",
    "7\n": ", row 1 (line 1): 7 is not an object; it must be one, with alpha, gamma, b, d, x, y, z",
    '{"alpha":1,"gamma":2,"b":1,"d":1,"x":1,"y":0}': ", row 1 (line 1): key z is missing; it needs alpha, gamma, b, d, x, y, z, in any order",
    '{"Alpha":1,"gamma":2,"b":1,"d":1,"x":1,"y":0,"z":0}': ", row 1 (line 1): key alpha is missing; 'Alpha' must be written alpha",
    f'{{"b": 2, {LINE[1:]}': ", row 1 (line 1): key 'b' stands twice; it must stand once",
    f"{LINE}\n{changed(label='far')}": ", row 2 (line 2): key 'label' has the name of a key that the output adds; rename or remove it",
    LINE.replace("2.5", "NaN"): ", row 1 (line 1): NaN is not JSON; every number must be finite",
    LINE.replace("2.5", "-Infinity"): ", row 1 (line 1): -Infinity is not JSON; every number must be finite",
    LINE.replace("2.5", "1e999"): ", row 1 (line 1): x is 1e999, which is too large for float64",
    LINE.replace("2.5", "9" * 400): f", row 1 (line 1): x is {'9' * 40}…, which is too large for float64",
    LINE.replace("2.5", "9" * 5000): f", row 1 (line 1): x is {'9' * 40}…, which is too large for float64",
    LINE.replace("2.5", "025"): ", row 1 (line 1): not JSON at character 48: expecting ',' delimiter",
    f"{LINE}\n{changed(x=True)}": ", row 2 (line 2): x is true; it must be a number",
    f"{LINE}\n{changed(x=None)}": ", row 2 (line 2): x is null; it must be a number",
    f"{LINE}\n{changed(x='2.5')}": ', row 2 (line 2): x is "2.5"; it must be a number',
    f"{LINE}\n{changed(x=[2.5])}": ", row 2 (line 2): x is [2.5]; it must be a number",
    changed(b=0): ", row 1 (line 1): b is 0; a semi-axis must be greater than 0",
    changed(d=-1.5): ", row 1 (line 1): d is -1.5; a semi-axis must be greater than 0",
    "[" * 100_000: ", row 1 (line 1): nested too deeply; it must be one flat object",
}  # fmt: skip


@pytest.mark.parametrize(("text", "sentence"), JSONL.items(), ids=range(len(JSONL)))
def test_bad_jsonl_is_refused_naming_line_row_and_value(text, sentence, tmp_path, capsys):
    assert message(tmp_path, capsys, "in.jsonl", text.encode()) == sentence


def saved(array: object, tmp_path: Path) -> bytes:
    np.save(tmp_path / "made.npy", np.asarray(array), allow_pickle=True)
    data = (tmp_path / "made.npy").read_bytes()
    (tmp_path / "made.npy").unlink()
    return data


ROWS = np.array([[1, 2, 1, 1, 2.5, 0, 0]] * 9_000)


SHAPES = "(n, 7): alpha, gamma, b, d, x, y, z, or (n, 10): axis_x, axis_y, axis_z besides"


@pytest.mark.parametrize(
    ("array", "sentence"),
    [
        (ROWS.astype(np.float32), " holds float32; it must hold float64"),
        (ROWS.astype(np.int64), " holds int64; it must hold float64"),
        (ROWS.astype(object), " holds object; it must hold float64"),
        (ROWS.astype("U5"), " holds <U5; it must hold float64"),
        (ROWS.astype(complex), " holds complex128; it must hold float64"),
        (ROWS[:, :6], f" has shape (9000, 6); it must be {SHAPES}"),
        (ROWS[0], f" has shape (7,); it must be {SHAPES}"),
        (ROWS[None], f" has shape (1, 9000, 7); it must be {SHAPES}"),
        (ROWS[:0], " has no rows; nothing was asked"),
    ],
)
def test_npy_of_another_type_or_shape_is_refused(array, sentence, tmp_path, capsys):
    assert message(tmp_path, capsys, "in.npy", saved(array, tmp_path)) == sentence


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize(
    ("column", "value", "sentence"),
    [
        (4, np.nan, "x is nan; it must be finite"),
        (1, np.inf, "gamma is inf; it must be finite"),
        (2, 0, "b is 0.0; a semi-axis must be greater than 0"),
        (3, -1, "d is -1.0; a semi-axis must be greater than 0"),
    ],
)
def test_npy_with_a_bad_row_is_refused_naming_row_and_column(column, value, sentence, order, tmp_path, capsys):
    rows = ROWS.copy()
    rows[8_500, column] = value
    data = saved(np.asarray(rows, order=order), tmp_path)
    assert message(tmp_path, capsys, "in.npy", data) == f", row 8501: {sentence}"


def test_npy_cut_off_at_any_byte_is_refused(tmp_path, capsys):
    data = saved(ROWS[:3], tmp_path)
    for length in range(len(data)):
        sentence = message(tmp_path, capsys, "in.npy", data[:length])
        if length < 128:
            assert sentence.startswith(" is no .npy file, or one cut off in its header: ")
        else:
            have = (length - 128) // 56
            assert sentence == f" is cut off: its header says 3 rows, and the data ends after {have} of them"
    assert message(tmp_path, capsys, "in.npy", data + b"x").startswith(" goes on for 1 byte after its 3 rows")


@pytest.mark.parametrize("shape", ["9**9**9", "(9**9, 7)", "[x for x in y]", "f(7)", "(-x, 7)"])
def test_npy_whose_header_holds_an_expression_is_refused(shape, tmp_path, capsys):
    head = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}}}".ljust(117).encode() + b"\n"
    data = b"\x93NUMPY\x01\x00" + len(head).to_bytes(2, "little") + head
    assert message(tmp_path, capsys, "in.npy", data) == (
        " is no .npy file, or one cut off in its header: it has an expression where a plain value must stand"
    )


class Touching:
    """Creates a file if it is unpickled."""

    def __init__(self, path: str) -> None:
        self.path = path

    def __reduce__(self):
        return (open, (self.path, "w"))


def test_npy_with_pickled_objects_is_never_unpickled(tmp_path, capsys):
    array = np.full((1, 7), Touching(str(tmp_path / "touched")))
    message(tmp_path, capsys, "in.npy", saved(array, tmp_path))


@given(st.sampled_from(["csv", "jsonl", "npy"]), st.integers(0, 2**32), st.sampled_from(["fail", "flag"]))
def test_a_damaged_table_is_answered_or_refused_in_one_sentence(tmp_path_factory, kind, seed, on_invalid):
    """Good files with bytes changed, removed and doubled: an answer or one sentence, and never half an output."""
    folder = tmp_path_factory.mktemp("damaged")
    good = {
        "csv": f'{HEADER},note\n{GOOD},"a, b"\n{GOOD},\n'.encode(),
        "jsonl": f"{LINE}\n{changed(note='π')}\n".encode(),
        "npy": saved(ROWS[:2], folder),
    }
    dice = random.Random(seed)  # noqa: S311 - damage, not secrets
    data = bytearray(good[kind])
    for _ in range(dice.randint(1, 4)):
        place = dice.randrange(len(data))
        match dice.randrange(3):
            case 0:
                data[place] = dice.choice([dice.randrange(256), *b'",{}[]0e-\n\r\0'])
            case 1:
                del data[place : place + dice.randint(1, 9)]
            case 2:
                data[place:place] = data[place : place + dice.randint(1, 9)]
    (folder / f"in.{kind}").write_bytes(data)
    words = ["--input", str(folder / f"in.{kind}"), "--output", str(folder / f"out.{kind}"), "--on-invalid", on_invalid]
    code = main(["classify", *words])
    assert code in (0, 2)
    assert sorted(os.listdir(folder)) == [f"in.{kind}"] + [f"out.{kind}"] * (code == 0)
