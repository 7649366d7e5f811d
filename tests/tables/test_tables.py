"""Tables in and out: the same answers as pair by pair, other columns passed through, memory flat."""

from __future__ import annotations

import csv
import io
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from hypcheck.answer import answer
from hypcheck.answers import answers
from hypcheck.cli.main import main
from hypcheck.geometry.pair import COLUMNS, Pair
from tests.support.pairs import pairs

# By hand: see tests/cli/test_classify.py.
ROWS = [
    (1.0, 2.0, 1.0, 1.0, 2.5, 0.0, 0.0),
    (1.0, 2.0, 1.0, 1.0, 2.0, 0.0, 0.0),
    (1.0, 2.0, 1.0, 1.0, 1.5, 0.0, 0.0),
    (4.0, 4.0, 1.0, 1.0, 0.0, 0.0, 0.0),
    (1e300, 1e300, 1e-300, 5e-324, 1.1e300, 0.0, 0.0),
]
ANSWERS = [
    ("1", "exterior", "false", "0.5"),
    ("0", "contact", "true", "0.0"),
    ("0", "contact", "false", "-0.5"),
    ("-1", "interior", "false", "3.0"),
    ("1", "exterior", "false", "inf"),
]
HEADER = ",".join(COLUMNS)
ADDED = "position,label,tangent,clearance"


def classify(source: Path, target: Path, *more: str) -> int:
    return main(["classify", "--input", str(source), "--output", str(target), *more])


def text_of(row: tuple[float, ...]) -> str:
    return ",".join(map(repr, row))


@example([Pair(5e-324, 1.0, 5.488980354903168e230, 1.0, 5.488980354903168e230, 0.5, 0.0)])  # 4e-463 radii apart
@example([Pair(3.0, 3.521074803988142e253, 2.0, 1.0, 1.0, 0.0, 0.5)])
@given(st.lists(pairs, min_size=1, max_size=12))
def test_answers_about_a_table_equal_answers_about_each_pair_to_the_last_bit(some):
    found = answers(np.array([pair.row for pair in some]))
    alone = [answer(pair) for pair in some]
    assert found.positions.tolist() == [int(one.decision.position) for one in alone]
    assert found.tangent.tolist() == [one.decision.tangent for one in alone]
    assert found.clearance.tolist() == [one.clearance for one in alone]


def test_classify_copies_every_byte_of_a_csv_outside_its_own_columns(tmp_path):
    source, target = tmp_path / "in.csv", tmp_path / "out.csv"
    begin = '"note, long",z,y,x, d ,"b",gamma,alpha,\n'
    rows = [
        '"a ""quoted"" cell\nof two lines",0,0,2.5, 1 ,"1",2,1,',
        "π,0.00,-0,+25e-1,1.,.1e1,2,1.0000000000000000000000001,end",
        '"",0,0,2.5,1,1,2,1,"  "',
        "  lead,0,0,2.5,1,1,2,1,trail \t",
    ]
    source.write_bytes(("\n\n" + begin + "\n   \n".join(rows) + "\n\n").encode())
    assert classify(source, target) == 0
    expected = begin.rstrip("\n") + f",{ADDED}\n" + "".join(f"{row},1,exterior,false,0.5\n" for row in rows)
    assert target.read_bytes() == expected.encode()
    table = list(csv.reader(io.StringIO(target.read_text(), newline="")))
    assert {len(row) for row in table} == {13}


def test_csv_keeps_the_line_ends_and_the_byte_order_mark_of_a_spreadsheet(tmp_path):
    source, target = tmp_path / "in.CSV", tmp_path / "out.csv"
    source.write_bytes('\ufeff"alpha",gamma,b,d,x,y,z\r\n1,2,1,1,2.5,0,0\r\n"1",2,1,1,2,0,"0"'.encode())
    assert classify(source, target) == 0
    lines = ["1,2,1,1,2.5,0,0,1,exterior,false,0.5", '"1",2,1,1,2,0,"0",0,contact,true,0.0', ""]
    assert target.read_bytes().decode() == "\r\n".join(['\ufeff"alpha",gamma,b,d,x,y,z,' + ADDED, *lines])


def test_jsonl_objects_get_four_keys_with_the_answer(tmp_path):
    source, target = tmp_path / "in.jsonl", tmp_path / "out.jsonl"
    objects = [
        '{"alpha":1,"gamma":2,"b":1,"d":1,"x":2.50,"y":0,"z":-0.0,"note":"\\u03c0 \\"}","n":12345678901234567890123}',
        ' { "z" : 0, "y": 0, "x" : 2, "d":1,"b":1e0 ,"gamma":2.0,"alpha":1,"nested":{"x":[1,null,true]} } ',
        json.dumps(dict(zip(COLUMNS, ROWS[4], strict=True))),
    ]
    source.write_bytes(("\ufeff" + "\r\n\n".join(objects)).encode())
    assert classify(source, target) == 0
    lines = target.read_text().splitlines()
    assert lines[0] == objects[0][:-1] + ', "position": 1, "label": "exterior", "tangent": false, "clearance": 0.5}'
    assert lines[1].startswith(objects[1].strip()[:-1])
    first, second, third = map(json.loads, lines)
    assert first["n"] == 12345678901234567890123
    assert (second["nested"], second["tangent"], second["clearance"]) == ({"x": [1, None, True]}, True, 0)
    assert (third["label"], third["clearance"]) == ("exterior", "inf")


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("kind", ["<f8", ">f8"])
@pytest.mark.parametrize("count", [1, 5, 8192, 8193])
def test_npy_in_any_layout_becomes_an_array_of_positions(tmp_path, order, kind, count):
    source, target = tmp_path / "in.npy", tmp_path / "out.npy"
    rows = np.resize(np.array([ROWS[2], ROWS[3], ROWS[0]]), (count, 7))
    np.save(source, np.asarray(rows, dtype=kind, order=order))
    assert classify(source, target) == 0
    found = np.load(target)
    assert (found.dtype, found.shape) == (np.int8, (count,))
    assert found.tolist() == np.resize([0, -1, 1], count).tolist()


def test_classify_converts_npy_to_csv_and_jsonl_and_back(tmp_path):
    np.save(tmp_path / "in.npy", ROWS)
    assert classify(tmp_path / "in.npy", tmp_path / "out.csv") == 0
    table = list(csv.DictReader((tmp_path / "out.csv").read_text().splitlines()))
    assert [tuple(float(row[name]) for name in COLUMNS) for row in table] == ROWS
    assert [tuple(row[name] for name in ADDED.split(",")) for row in table] == ANSWERS
    assert classify(tmp_path / "in.npy", tmp_path / "out.jsonl") == 0
    objects = [json.loads(line) for line in (tmp_path / "out.jsonl").read_text().splitlines()]
    assert [tuple(one[name] for name in COLUMNS) for one in objects] == ROWS
    assert [str(one["clearance"]) for one in objects] == [said[3] for said in ANSWERS]
    (tmp_path / "in.csv").write_text("\n".join([HEADER, *map(text_of, ROWS)]))
    assert classify(tmp_path / "in.csv", tmp_path / "out.npy") == 0
    assert np.load(tmp_path / "out.npy").tolist() == [1, 0, 0, -1, 1]


def test_classify_with_a_margin_adds_a_column_that_says_which_rows_are_clear_by_it(tmp_path):
    """Spheres outside a waist of radius 1, at distances that are differences; γ is so large that the waist is near."""
    rows = [(1.0, 8.0, 0.5, 0.5, 1.5 + gap, 0.0, 0.0) for gap in (0.25, 0.5, 0.75, -0.5)] + [
        (1.0, 8.0, -1.0, 1.0, 3.0, 0, 0)
    ]
    (tmp_path / "in.csv").write_text("\n".join([HEADER, *map(text_of, rows)]))
    np.save(tmp_path / "in.npy", rows)
    options = ["--margin", "0.4", "--on-invalid", "flag"]
    kept = ["0", "1", "1", "0", "127"]
    assert classify(tmp_path / "in.csv", tmp_path / "out.csv", *options) == 0
    table = list(csv.DictReader((tmp_path / "out.csv").read_text().splitlines()))
    assert [row["position_with_margin"] for row in table] == kept
    assert [row["position"] for row in table] == ["1", "1", "1", "0", "127"]
    assert classify(tmp_path / "in.npy", tmp_path / "out.jsonl", *options) == 0
    objects = [json.loads(line) for line in (tmp_path / "out.jsonl").read_text().splitlines()]
    assert [str(one["position_with_margin"]) for one in objects] == kept
    assert classify(tmp_path / "in.csv", tmp_path / "out.npy", *options) == 0
    assert list(map(str, np.load(tmp_path / "out.npy").tolist())) == kept


def test_a_margin_of_a_table_of_sweeps_is_refused(tmp_path, capsys):
    (tmp_path / "in.csv").write_text(HEADER + ",x1,y1,z1\n1,2,1,1,3,0,0,0,0,0\n")
    assert classify(tmp_path / "in.csv", tmp_path / "out.csv", "--margin", "1") == 2
    assert "--margin is for positions; x1, y1, z1 make the rows sweeps" in capsys.readouterr().err
    assert not (tmp_path / "out.csv").exists()


def run(words: list[str], data: bytes) -> subprocess.CompletedProcess[bytes]:
    program = [sys.executable, "-m", "hypcheck", "classify"]
    return subprocess.run([*program, *words], input=data, capture_output=True, check=False)


@pytest.mark.thorough
@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="the system does not report a process's peak memory")
@pytest.mark.parametrize("kind", ["csv", "jsonl", "npy"])
def test_memory_of_classify_does_not_grow_with_the_table(tmp_path, kind):
    """200,000 rows more: as bare numbers alone they would take 11 MB, as text 18 MB, if they were kept."""
    peaks = []
    for count in (100_000, 300_000):
        source = tmp_path / f"{count}.{kind}"
        if kind == "npy":
            np.save(source, np.broadcast_to(ROWS[0], (count, 7)))
        elif kind == "csv":
            source.write_text(f"{HEADER}\n" + f"{text_of(ROWS[0])}\n" * count)
        else:
            source.write_text((json.dumps(dict(zip(COLUMNS, ROWS[0], strict=True))) + "\n") * count)
        code = (
            "import sys; from hypcheck.cli.main import main; code = main(sys.argv[1:]);"
            "print(*(line.split()[1] for line in open('/proc/self/status') if 'VmHWM' in line)); sys.exit(code)"
        )
        words = ["classify", "--input", str(source), "--output", str(tmp_path / f"out.{kind}")]
        done = subprocess.run([sys.executable, "-c", code, *words], capture_output=True, check=True)
        peaks.append(int(done.stdout) / 1024)
    assert peaks[1] - peaks[0] < 8, peaks
