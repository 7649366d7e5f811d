"""`hypcheck cases`: what it prints, writes and loads, and its messages about wrong arguments."""

from __future__ import annotations

import csv
import io
import json
import subprocess
import sys

import numpy as np
import pytest

from hypcheck.cli.main import main
from hypcheck.vectors import frozen as vectors
from hypcheck.vectors.cases import read_cases
from hypcheck.vectors.checking import faults_of
from hypcheck.vectors.families import FAMILIES
from tests.support.corpus import files


def printed(capsys, *arguments, code=0):
    assert main(["cases", *arguments]) == code
    found = capsys.readouterr()
    assert found.err == ""
    return found.out


def refused(capsys, *arguments):
    assert main(["cases", *arguments]) == 2
    found = capsys.readouterr()
    assert found.out == ""
    return found.err


def test_cases_list_names_every_family_with_its_count(capsys):
    lines = printed(capsys, "list").splitlines()
    counts = {line.split()[0]: int(line.split()[1]) for line in lines}
    assert counts.pop("together") == sum(counts.values())
    assert counts == {name: len(file["cases"]) for name, file in files().items()}
    assert all(vectors.head_of(name).title in line for line in lines for name in FAMILIES if line.split()[0] == name)
    extreme = sum(name.startswith("extreme") for name in counts)
    assert sum("extreme: taken when asked for" in line for line in lines) == extreme


def test_cases_show_explains_a_family_and_its_flags(capsys):
    text = " ".join(printed(capsys, "show", "ring").split())
    head = vectors.head_of("ring")
    for part in (head.title, head.source, head.purpose, head.game, head.drone, "ring-0000 to ring-0239"):
        assert part in text
    assert "positions 240 exterior" in text
    assert "flag ring, 240 times: clear, though the discriminant is 0" in text
    assert "96, invalid-0000 to invalid-0095, all to be refused" in printed(capsys, "show", "invalid")


def test_cases_show_prints_a_case_with_its_proof(capsys):
    lines = printed(capsys, "show", "ring-0007").splitlines()
    case = vectors.load("ring").cases[7]
    assert lines[0] == "ring-0007"
    assert lines[1].split() == ["alpha", repr(case.row[0]), "0x1.cp+2"]
    text = " ".join(" ".join(lines).split())
    assert "position exterior kind exterior-ring: " in text
    assert f"clearance {case.clearance!r} spheroid radii" in text
    assert "proof λ = 1/8 lies in (0, B) and g(λ) = " in text
    touching = printed(capsys, "show", "tangent-0000")
    assert "position    contact, tangent" in touching
    assert "is a double root of g" in touching
    crossing = " ".join(printed(capsys, "show", "osculation-0000").split())
    assert "two points of the spheroid (s ≤ 1) lie on different sides of the hyperboloid" in crossing
    assert "lies on the hyperboloid (h = 0)" in printed(capsys, "show", "on-surface-0000")
    assert printed(capsys, "show", "invalid-0003").splitlines()[1].endswith("at fault")


def test_cases_show_json_prints_a_case_or_a_family_as_its_file_has_it(capsys):
    for name, text in (("ring-0007", "ring"), ("invalid-0003", "invalid")):
        line = printed(capsys, "show", name, "--json")
        assert line.rstrip("\n") in vectors.path_of(text).read_text(encoding="utf-8")
        assert json.loads(line)["id"] == name
    assert printed(capsys, "show", "axis", "--json") == vectors.path_of("axis").read_text(encoding="utf-8")


def test_cases_show_prints_a_generated_case_like_a_frozen_one(capsys):
    frozen = printed(capsys, "show", "waist-0011").splitlines()
    generated = printed(capsys, "show", "waist/1/1/11").splitlines()
    assert generated[0] == "waist/1/1/11"
    assert generated[1:] == frozen[1:]
    far = json.loads(printed(capsys, "show", "waist/1/5/1030", "--json"))
    assert far["row"] == FAMILIES["waist"].rows(5, 1031)[1030].tolist()


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("ring-9999", "the last one is ring-0239"),
        ("invalid-9999", "the last one is invalid-0095"),
        ("rnig", "did you mean ring"),
        ("rnig-0001", "did you mean ring"),
        ("ring-1", "the last one is"),
        ("zzzz", "there are forest-type-1"),
        ("ring/1/0", "not a case id"),
        ("rnig/1/0/1", "did you mean ring"),
        ("", "there are"),
    ],
)
def test_showing_an_unknown_case_names_the_existing_ones(capsys, name, hint):
    message = refused(capsys, "show", name)
    assert message.startswith("hypcheck: error: ")
    assert hint in message


def test_cases_generate_json_writes_a_vector_file_with_right_labels(capsys, tmp_path):
    path = tmp_path / "mine.json"
    assert printed(capsys, "generate", "small-integers", "--seed", "9", "--count", "40", "--output", str(path)) == ""
    file = read_cases(str(path))
    assert [case.id for case in file.cases] == [f"small-integers/2/9/{index}" for index in range(40)]
    assert np.array_equal(file.rows, FAMILIES["small-integers"].rows(9, 40))
    assert file.head.made_by == "hypcheck cases generate small-integers --seed 9 --count 40"
    assert faults_of(file) == []
    assert printed(capsys, "generate", "small-integers", "--seed", "9", "--count", "40") == path.read_text(
        encoding="utf-8"
    )


def test_cases_generate_csv_and_npy_write_the_rows_without_labels(tmp_path, capsysbinary):
    wanted = FAMILIES["symmetric-images"].rows(1, 20)
    table = tmp_path / "rows.csv"
    assert main(["cases", "generate", "symmetric-images", "--count", "20", "--output", str(table)]) == 0
    lines = table.read_text(encoding="utf-8").splitlines()
    assert lines[0] == "id,alpha,gamma,b,d,x,y,z"
    assert [line.split(",")[0] for line in lines[1:]] == [f"symmetric-images/1/1/{index}" for index in range(20)]
    rows = np.asarray([[float(cell) for cell in line.split(",")[1:]] for line in lines[1:]])
    assert rows.tobytes() == wanted.tobytes()
    assert main(["cases", "generate", "symmetric-images", "--count", "20", "--format", "npy"]) == 0
    data = capsysbinary.readouterr().out
    assert np.load(io.BytesIO(data)).tobytes() == wanted.tobytes()
    array = tmp_path / "rows.npy"
    assert main(["cases", "generate", "symmetric-images", "--count", "20", "--output", str(array)]) == 0
    assert array.read_bytes() == data


def test_classify_reads_the_csv_that_cases_generate_writes(capsys, tmp_path):
    rows, answers = tmp_path / "rows.csv", tmp_path / "answers.csv"
    printed(capsys, "generate", "ring", "--count", "10", "--output", str(rows))
    assert main(["classify", "--input", str(rows), "--output", str(answers)]) == 0
    assert {line.split(",")[8] for line in answers.read_text(encoding="utf-8").splitlines()[1:]} == {"1"}


def test_rows_of_a_family_for_given_sizes_are_generated_checked_and_classified(capsys, tmp_path):
    name, written = "razor@2,17.8,0.25,0.15,z=-17.8:17.8", "razor@2.0,17.8,0.25,0.15,z=-17.8:17.8"
    vectors, table, answers = (tmp_path / each for each in ("r.json", "r.csv", "answers.csv"))
    printed(capsys, "generate", name, "--count", "3", "--output", str(vectors))
    assert printed(capsys, "check", str(vectors)) == "3 cases checked, none with a wrong label\n"
    printed(capsys, "generate", name, "--count", "3", "--output", str(table))
    assert main(["classify", "--input", str(table), "--output", str(answers)]) == 0
    read = list(csv.DictReader(answers.read_text(encoding="utf-8").splitlines()))
    assert [each["id"] for each in read] == [f"{written}/1/1/{index}" for index in range(3)]
    assert {float(each["gamma"]) for each in read} == {17.8}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["rnig"], "did you mean ring"),
        (["razor@2,17.8,0.25"], "is not a family of fixed sizes"),
        (["ring*"], "is a pattern; name one family"),
        (["extreme"], "is a pattern"),
        (["worst-cancellation"], "there is no family"),
        (["ring", "--count", "0"], "--count"),
        (["ring", "--seed", "-1"], "--seed"),
        (["ring", "--output", "rows.txt"], "must end in .json, .csv or .npy"),
        (["ring", "--format", "xml"], "--format"),
        (["ring", "--output", "no/such/folder/rows.csv"], "cannot write"),
    ],
)
def test_cases_generate_refuses_invalid_arguments(capsys, arguments, message):
    assert message in refused(capsys, "generate", *arguments)


@pytest.mark.parametrize("name", ["invalid", "tilted-way-invalid"])
def test_freezing_invalid_rows_again_changes_nothing(name, capsys, tmp_path):
    text = vectors.path_of(name).read_text(encoding="utf-8")
    (tmp_path / f"{name}.json").write_text(text, encoding="utf-8")
    printed(capsys, "freeze", name, "--into", str(tmp_path))
    assert (tmp_path / f"{name}.json").read_text(encoding="utf-8") == text


def test_freeze_prints_the_names_of_the_files_that_it_wrote(capsys, tmp_path):
    lines = printed(capsys, "freeze", "invalid", "tower-body", "--into", str(tmp_path)).splitlines()
    assert lines == [str(tmp_path / "invalid.json"), str(tmp_path / "tower-body.json")]
    for name in ("invalid", "tower-body"):
        assert (tmp_path / f"{name}.json").read_bytes() == vectors.path_of(name).read_bytes()
    assert "is not a folder" in refused(capsys, "freeze", "--into", str(tmp_path / "nowhere"))
    assert "no frozen vectors 'rnig'" in refused(capsys, "freeze", "rnig", "--into", str(tmp_path))


LIGHT = (["--help"], ["list", "--help"], ["check", "--help"])
NUMPY_ALONE = (["list"], ["show", "ring-0007"], ["show", "invalid"], ["generate", "ring", "--format", "csv"])


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("arguments", "allowed"),
    [*((arguments, set()) for arguments in LIGHT), *((arguments, {"numpy"}) for arguments in NUMPY_ALONE)],
)
def test_showing_cases_loads_no_library_that_it_does_not_use(arguments, allowed):
    names = ("numpy", "sympy", "mpmath", "fcl", "matplotlib", "jinja2")
    program = (
        "import json, sys; from hypcheck.cli.main import main; "
        f"assert main(['cases', *{arguments!r}]) == 0; "
        f"print(json.dumps([name for name in {names!r} if name in sys.modules]), file=sys.stderr)"
    )
    ran = subprocess.run([sys.executable, "-c", program], capture_output=True, check=True)
    assert set(json.loads(ran.stderr.splitlines()[-1])) <= allowed
