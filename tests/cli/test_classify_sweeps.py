"""`hypcheck classify` of sweeps: one with --end, and tables whose rows have an end, against the frozen sweeps."""

from __future__ import annotations

import csv
import json
import math

import numpy as np
import pytest

from hypcheck.cli.main import main
from tests.support.corpus import files

SEVEN = ("alpha", "gamma", "b", "d", "x", "y", "z")
END, AXIS = ("x1", "y1", "z1"), ("axis_x", "axis_y", "axis_z")
FAMILIES = ("way-tunnelling", "way-grazing", "way-ring", "way-still", "tilted-way-ring", "tilted-way-uniform")
CASES = [case for name in FAMILIES for case in files()[name]["cases"]]


def words(row):
    sizes = [word for name, value in zip(SEVEN[:4], row, strict=False) for word in (f"--{name}", repr(value))]
    vectors = zip(("--center", "--end", "--axis"), (row[4:7], row[7:10], row[10:]), strict=True)
    return [*sizes, *(word for name, vector in vectors if vector for word in (name, *map(repr, vector)))]


@pytest.mark.parametrize("case", CASES[::9], ids=lambda case: case["id"])
def test_one_sweep_is_answered_with_its_label_and_a_proof(capsys, case):
    assert main(["classify", *words(case["row"]), "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert (said["hit"], said["first"]) == (int(case["hit"]), case["first"])
    assert said["label"] == ("contact" if case["hit"] else "clear")
    assert said["proof"] == case["certificate"] or said["proof"]["pieces"] or said["proof"]["time"] is not None
    assert main(["classify", *words(case["row"])]) == 0
    text = capsys.readouterr().out
    assert text.startswith(said["label"])
    assert ("first" in text) == case["hit"]
    assert "proof" in text


def test_text_about_a_sweep_names_ends_times_and_what_proves_them(capsys):
    sweep = ["--alpha", "1", "--gamma", "2", "--b", "1", "--d", "1", "--center", "2", "-1", "0", "--end", "2", "1", "0"]
    assert main(["classify", *sweep]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "contact, only touched for an instant"
    assert lines[1] == "first      contact between the times 0.49999999999999994 and 0.5; 0 is the start, 1 the end"
    assert lines[2] == "ends       exterior at the start, exterior at the end"
    assert lines[-1].endswith("at the time 1/2 the surfaces touch: m = 1 is a double root.")


def test_sweep_without_a_rational_certificate_has_bounds_and_no_proof(capsys, monkeypatch):
    def without(row):
        raise ValueError("the way touches the surface at an irrational time alone")

    monkeypatch.setattr("hypcheck.answer.prove_passage", without)  # no row of few digits is known to do so
    sweep = words((1.0, 2.0, 1.0, 1.0, 2.0, -1.0, 0.0, 2.0, 1.0, 0.0))
    assert main(["classify", *sweep, "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert (said["hit"], said["grazes"], said["proof"]) == (1, True, None)
    assert said["first"][0] <= 0.5 <= said["first"][1]
    assert main(["classify", *sweep]) == 0
    assert "none in rational numbers: the surfaces touch only at an irrational time" in capsys.readouterr().out


def test_sweep_whose_proof_does_not_hold_ends_with_6(capsys, monkeypatch):
    monkeypatch.setattr("hypcheck.answer.check_passage", lambda *_: False)
    assert main(["classify", *words((1.0, 2.0, 1.0, 1.0, 2.0, -1.0, 0.0, 2.0, 1.0, 0.0))]) == 6
    assert "does not hold; please report this" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("end", "sentence"),
    [(("1", "2", "nan"), "--end: z1 is 'nan'; it must be finite"), (("1", "x", "2"), "--end: y1 is 'x'")],
)
def test_wrong_end_is_refused_with_its_name(capsys, end, sentence):
    sizes = ["--alpha", "1", "--gamma", "2", "--b", "1", "--d", "1", "--center", "4", "0", "0"]
    assert main(["classify", *sizes, "--end", *end]) == 2
    assert sentence in capsys.readouterr().err


def table_of(cases):
    names = SEVEN + END + (AXIS if len(cases[0]["row"]) > 10 else ())
    return [dict(zip(names, case["row"], strict=True)) | {"id": case["id"]} for case in cases]


def require_answers(found, cases):
    for row, case in zip(found, cases, strict=True):
        assert (row["id"], int(row["hit"])) == (case["id"], int(case["hit"]))
        assert row["label"] == ("contact" if case["hit"] else "clear")
        if case["hit"]:
            lower, upper = case["first"]
            assert lower <= float(row["first_upper"])
            assert float(row["first_lower"]) <= upper
        else:
            assert row["first_lower"] in (None, "")


@pytest.mark.parametrize("tilted", [False, True])
def test_tables_with_an_end_are_answered_about_the_sweep(tmp_path, tilted):
    cases = [case for case in CASES[::3] if (len(case["row"]) > 10) == tilted]
    rows, source = table_of(cases), tmp_path / "in.csv"
    with source.open("w", newline="") as file:
        writer = csv.DictWriter(file, list(reversed(rows[0])))
        writer.writeheader()
        writer.writerows(rows)
    assert main(["classify", "--input", str(source), "--output", str(tmp_path / "out.csv")]) == 0
    with (tmp_path / "out.csv").open(newline="") as file:
        require_answers(list(csv.DictReader(file)), cases)
    source = tmp_path / "in.jsonl"
    source.write_text("".join(json.dumps(row) + "\n" for row in rows))
    assert main(["classify", "--input", str(source), "--output", str(tmp_path / "out.jsonl")]) == 0
    require_answers([json.loads(line) for line in (tmp_path / "out.jsonl").read_text().splitlines()], cases)
    assert main(["classify", "--input", str(source), "--output", str(tmp_path / "out.npy")]) == 0
    hits = np.load(tmp_path / "out.npy")
    assert (hits.dtype, hits.tolist()) == (np.int8, [int(case["hit"]) for case in cases])


def test_invalid_sweep_of_a_table_is_named_or_flagged(tmp_path, capsys):
    row = dict.fromkeys((*SEVEN, *END), 1.0)
    source, target = tmp_path / "in.jsonl", tmp_path / "out.jsonl"
    source.write_text(json.dumps(row) + "\n" + json.dumps(row | {"d": -1.0}) + "\n")
    assert main(["classify", "--input", str(source), "--output", str(target)]) == 2
    assert "row 2 (line 2): d is -1.0; a semi-axis must be greater than 0" in capsys.readouterr().err
    assert main(["classify", "--input", str(source), "--output", str(target), "--on-invalid", "flag"]) == 0
    flagged = json.loads(target.read_text().splitlines()[1])
    assert (flagged["hit"], flagged["label"], flagged["first_lower"]) == (127, "refused", None)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"y1": 1.0}, "keys x1, z1 are missing; the end of a sweep needs x1, y1, z1, in any order"),
        ({"Solid": 1}, "key solid is missing; 'Solid' must be written solid"),
        ({"z_max": 1.0, "z_min": 1.0}, "z_min is 1.0 and z_max is 1.0; z_min must be less than z_max"),
    ],
)
def test_part_of_an_end_and_wrong_heights_are_refused(tmp_path, capsys, change, sentence):
    source = tmp_path / "in.jsonl"
    source.write_text(json.dumps(dict.fromkeys(SEVEN, 1.0) | change) + "\n")
    assert main(["classify", "--input", str(source), "--output", str(tmp_path / "out.jsonl")]) == 2
    assert sentence in capsys.readouterr().err
    assert not (tmp_path / "out.jsonl").exists()


@pytest.mark.parametrize("count", [1, 20_000])
def test_json_lines_have_an_end_in_all_rows_or_in_none(tmp_path, capsys, count):
    still = dict.fromkeys(SEVEN, 1.0)
    moving = still | dict.fromkeys(END, math.nan) | dict.fromkeys(END, 1.0)
    source = tmp_path / "in.jsonl"
    for first, other, said in ((still, moving, "an end"), (moving, still, "no end")):
        rows = [first] * (count if first is still else 1)
        source.write_text("".join(json.dumps(row) + "\n" for row in [*rows, other]))
        assert main(["classify", "--input", str(source), "--output", str(tmp_path / "out.jsonl")]) == 2
        assert f"row {len(rows) + 1} (line {len(rows) + 1}): {said} x1, y1, z1, unlike the first row" in (
            capsys.readouterr().err
        )
