"""Bad tables: exit 2, one message that names file, row, column and value, and no output."""

from __future__ import annotations

import io
import json
import os
import random
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.lib import format as npy

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


def changed(**values: object) -> str:
    return json.dumps(OBJECT | values)


def saved(array: object, tmp_path: Path) -> bytes:
    np.save(tmp_path / "made.npy", np.asarray(array), allow_pickle=True)
    data = (tmp_path / "made.npy").read_bytes()
    (tmp_path / "made.npy").unlink()
    return data


ROWS = np.array([[1, 2, 1, 1, 2.5, 0, 0]] * 9_000)


def test_npy_cut_off_at_any_byte_is_refused(tmp_path, capsys):
    data = saved(ROWS[:3], tmp_path)
    for length in range(len(data)):
        sentence = message(tmp_path, capsys, "in.npy", data[:length])
        if length < 128:
            assert sentence.startswith(" is not a .npy file, or one cut off in its header: ")
        else:
            have = (length - 128) // 56
            assert sentence == f" is cut off: its header says 3 rows, and the data ends after {have} of them"
    assert message(tmp_path, capsys, "in.npy", data + b"x").startswith(" goes on for 1 byte after its 3 rows")


def test_a_height_key_in_capitals_is_reported_even_after_many_other_keys(tmp_path, capsys):
    """Among the first keys the one is shown that must be written otherwise; behind them, what heights are called."""
    few, many = (changed(**dict.fromkeys((f"note_{n}" for n in range(count)), 1), Z_MAX=2) for count in (2, 300))
    assert message(tmp_path, capsys, "in.jsonl", few.encode()).endswith("'Z_MAX' must be written z_max")
    assert message(tmp_path, capsys, "in.jsonl", many.encode()).endswith("heights are written z_min, z_max, solid")


def test_npy_of_a_later_version_or_of_a_shape_beyond_an_index_is_refused(tmp_path, capsys):
    later, large = io.BytesIO(), io.BytesIO()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that numpy 1.17 is needed to read it
        npy.write_array(later, ROWS[:1], version=(3, 0))
    sentence = message(tmp_path, capsys, "in.npy", later.getvalue())
    assert sentence == " is a .npy file of version 3.0; it must be 1.0 or 2.0"
    npy.write_array_header_1_0(large, {"descr": "<f8", "fortran_order": False, "shape": (2**63, 7)})
    sentence = message(tmp_path, capsys, "in.npy", large.getvalue())
    assert sentence.startswith(" has a number of 2^63 or more in its shape; ")


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


@pytest.mark.parametrize(
    ("ending", "text"),
    [
        ("csv", "alpha,gamma,b,d,x,y,z,z_max\n1,2,1,1,3,0,0,1e999\n"),
        ("jsonl", '{"alpha": 1, "gamma": 2, "b": 1, "d": 1, "x": 3, "y": 0, "z": 0, "z_max": 1e999}\n'),
    ],
)
def test_a_height_beyond_float64_is_refused_and_is_not_taken_for_infinity(tmp_path, capsys, ending, text):
    assert "z_max is 1e999, which is too large for float64" in message(tmp_path, capsys, f"in.{ending}", text.encode())
