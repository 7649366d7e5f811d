"""`hypcheck hunt` and `hypcheck minimise`: options, output and exit codes."""

from __future__ import annotations

import pytest

from hypcheck.cli.main import main
from hypcheck.errors import Exit
from hypcheck.vectors.cases import read_cases
from hypcheck.vectors.checking import faults_of
from tests.runs.faulty import cannot_say_above, contact_everywhere


def told(capsys, *arguments):
    code = main(list(arguments))
    output, errors = capsys.readouterr()
    return code, output, errors


@pytest.mark.thorough
def test_hunt_prints_the_worst_answer_first_with_commands_to_continue(capsys):
    code, output, _ = told(capsys, "hunt", "builtin:table-2-float64", "--queries", "3000", "--show", "2")
    assert code == Exit.WRONG
    lines = output.splitlines()
    assert lines[0].startswith("table-2-float64 (exterior, float64): 3,000 rows asked in ")
    assert "z = 0 and Δ = 0 (the ring)" in output
    assert [line[:2] for line in lines if line[1:2] == "."] == ["1.", "2."]
    assert "more kinds" in output
    row = next(line for line in lines if line.startswith("   row")).split()[1]
    hexes = next(line for line in lines if line.startswith("   hex")).split()[1]
    assert [float(text) for text in row.split(",")] == [float.fromhex(text) for text in hexes.split(",")]
    simplify = next(line for line in lines if line.startswith("   simplify")).split()[1:]
    assert simplify == ["hypcheck", "minimise", "builtin:table-2-float64", row]
    code, output, _ = told(capsys, *simplify[1:])
    assert code == Exit.HELD
    assert "the right answer: exterior" in output
    assert "proof " in output
    replay = next(line for line in lines if line.startswith("   replay")).split()[1:]
    assert replay == ["hypcheck", "replay", row, "builtin:table-2-float64"]
    assert told(capsys, *replay[1:])[0] == Exit.WRONG


@pytest.mark.thorough
def test_hunt_options_replace_what_the_implementation_declares(capsys):
    arguments = ("hunt", "builtin:procedure-1-float64", "--queries", "2600")
    everywhere = told(capsys, *arguments, "--regimes", "any", "--tolerance", "9")[1]
    assert "c² < a" in everywhere
    again = next(line for line in everywhere.splitlines() if line.startswith("   simplify")).split()[2:]
    assert again[-4:] == ["--regimes", "any", "--tolerance", "9.0"]
    assert told(capsys, *again)[0] == Exit.HELD
    replay = next(line for line in everywhere.splitlines() if line.startswith("   replay")).split()[2:]
    assert replay[-2:] == ["--tolerance", "9.0"]
    assert told(capsys, *replay)[0] == Exit.WRONG
    assert "c² < a" not in told(capsys, *arguments, "--domain", '{"regimes": ["c2>=a"]}')[1]
    _, output, _ = told(capsys, *arguments, "--precision", "float32", "--tolerance", "1e6")
    assert "(exterior, float32)" in output
    assert "1e+06 u" in output


def test_hunt_prints_the_number_of_answers_cannot_say(capsys, built_in):
    code, output, _ = told(capsys, "hunt", built_in(cannot_say_above), "--queries", "300")
    abstained = [line for line in output.splitlines() if line.endswith(' "cannot say"')]
    assert code == Exit.HELD
    assert len(abstained) == 1
    assert abstained[0].split()[1] == "answers"
    assert 0 < int(abstained[0].split()[0]) < 300


def test_hunt_shows_the_row_that_ends_the_implementation_and_no_row_that_was_not_tested(capsys):
    dies = "python:tests.runs.replay.faulty:dies"
    code, output, _ = told(capsys, "hunt", dies, "--queries", "40", "--restarts", "0")
    assert code == Exit.WRONG
    assert "crash: 1 row; the first: it ended by itself with exit status 3\n   row " in output
    last = "not-run: 39 rows; the first: not asked: no restart is allowed; the last process: it ended by itself"
    assert output.splitlines()[-1].startswith(last)


def test_minimising_a_row_that_is_not_valid_is_refused(capsys):
    code, output, errors = told(capsys, "minimise", "builtin:fast", "invalid-0003")
    assert (code, output) == (2, "")
    assert errors == "hypcheck: error: invalid-0003: alpha is -0.0; a semi-axis must be greater than 0\n"


def test_a_hunt_whose_rows_could_not_be_kept_is_refused_before_it_begins(capsys, tmp_path):
    path = tmp_path / "nowhere" / "ours.json"
    code, output, errors = told(capsys, "hunt", "builtin:fast", "--queries", "40", "--out", str(path))
    assert (code, output) == (2, "")
    assert errors.endswith(f"hypcheck: error: cannot write {path}: there is no folder {path.parent}\n")


def test_rows_that_a_hunt_found_are_added_to_a_vector_file(capsys, built_in, tmp_path):
    path = str(tmp_path / "ours.json")
    hunt = ("hunt", built_in(contact_everywhere), "--queries")
    _, output, _ = told(capsys, *hunt, "40", "--out", path)
    before = read_cases(path)
    kinds = int(next(line for line in output.splitlines() if line.startswith("kinds of wrong")).split()[4].strip(","))
    assert len(before.cases) == kinds > 1
    assert faults_of(before) == []
    _, output, _ = told(capsys, *hunt, "40", "--out", path)
    assert "0 rows added" in output
    assert read_cases(path).cases == before.cases
    told(capsys, *hunt, "40", "--seed", "2", "--out", path)
    after = read_cases(path)
    assert after.cases[: len(before.cases)] == before.cases
    assert len(after.cases) > len(before.cases)
    assert after.head == before.head
