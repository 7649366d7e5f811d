"""The frozen files: enough cases, small, fresh, fitting their schema, and usable without this project."""

from __future__ import annotations

import copy
import csv
import json
import re
import runpy
import shutil
import struct
import subprocess
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from hypcheck.geometry.pair import Position
from hypcheck.geometry.rows import invalid
from hypcheck.tables.streams import open_input
from hypcheck.vectors import cancellation, freezing
from hypcheck.vectors import frozen as vectors
from hypcheck.vectors.cases import cases_text
from hypcheck.vectors.coincidences import RUNGS
from hypcheck.vectors.double_roots import ULPS
from hypcheck.vectors.families import ALL, FAMILIES, WORST_CANCELLATION
from hypcheck.vectors.format import SCHEMA, described
from hypcheck.vectors.labels import DEFEATED
from tests.support.records import violations

FOLDER = vectors.folder()
FULLY_COMPARED = ("ring", "tangent", "float16-exact", "coefficient-zero", "extreme-subnormal")


def text_of(name):
    return vectors.path_of(name).read_bytes().decode("utf-8")


def bits(rows):
    return [struct.pack(f"<{len(row)}d", *row) for row in rows.tolist()]


def schema(name, version=SCHEMA):
    """A published schema, without the two keywords that the small validator knows by another name."""

    def opened(part):
        if isinstance(part, dict):
            return {key: opened(value) for key, value in part.items() if value is not False}
        return [opened(value) for value in part] if isinstance(part, list) else part

    return opened(json.loads((FOLDER / "schema" / f"{name}-{version}.json").read_text(encoding="utf-8")))


def test_cases_folder_has_one_file_for_each_family_and_no_other():
    found = {path.stem for path in FOLDER.glob("*.json")}
    families = {name for name, family in ALL.items() if family.frozen}
    invalid_rows = {
        "invalid",
        "tilted-invalid",
        "way-invalid",
        "tilted-way-invalid",
        "ended-invalid",
        "ended-way-invalid",
    }
    assert found == set(vectors.ALL_NAMES) == families | invalid_rows | {"worst-cancellation"}


def test_there_are_at_least_7000_pairs_and_all_files_have_at_most_10_3_megabytes():
    # They were 9,990,000 bytes before there were ways beside ends; each wheel has them.
    rows = {row for name in (*vectors.NAMES, *vectors.TILTED_NAMES) for row in bits(vectors.load(name).rows)}
    assert len(rows) >= 7000
    assert sum(path.stat().st_size for path in FOLDER.rglob("*") if path.is_file()) <= 10_300_000


def test_frozen_families_have_60_to_500_cases_and_all_positions_are_common():
    counts = {name: len(vectors.load(name).cases) for name in vectors.NAMES}
    assert min(counts.values()) >= 60
    assert max(counts.values()) <= 500
    positions = Counter(case.position for name in vectors.NAMES for case in vectors.load(name).cases)
    assert min(positions.values()) >= 0.15 * sum(positions.values())


EARLIER = {"small-integers": 240}
"""Rows of earlier generator versions, with which the file of a family begins: they keep their ids for ever."""


def test_the_tests_have_rows_of_earlier_versions_for_every_family_with_a_version_above_1():
    assert set(EARLIER) == {name for name, family in FAMILIES.items() if family.version > 1}


@pytest.mark.parametrize("name", [name for name, family in FAMILIES.items() if family.frozen])
def test_rows_of_a_frozen_file_are_the_first_rows_of_its_family_without_duplicates(name):
    file = vectors.load(name)
    wanted = list(dict.fromkeys(bits(freezing.planned(name))))
    rows = bits(file.rows)
    earlier = rows[: EARLIER.get(name, 0)]
    assert rows == earlier + [row for row in wanted if row not in set(earlier)]
    assert len(set(rows)) == len(rows)
    assert [case.id for case in file.cases] == [f"{name}-{number:04d}" for number in range(len(rows))]
    assert file.head == described(name, f"hypcheck cases freeze {name}", FAMILIES[name])


@pytest.mark.parametrize("name", FULLY_COMPARED)
def test_frozen_files_equal_those_that_freezing_without_earlier_files_makes(name):
    assert cases_text(freezing.frozen(name)) == text_of(name)


def test_frozen_invalid_rows_equal_those_that_freezing_makes():
    assert cases_text(freezing.frozen_invalid_rows("invalid")) == text_of("invalid")


@pytest.mark.parametrize("name", vectors.NAMES)
def test_a_frozen_file_is_written_back_to_the_same_bytes(name):
    assert cases_text(vectors.load(name)) == text_of(name)


def test_repeated_searches_find_the_frozen_rows_of_worst_cancellation():
    """Two of the searches made anew, one in each float format; the rows stand in the file in the order of searches."""
    known = bits(vectors.load(WORST_CANCELLATION).rows)
    for wanted in (
        ("table-2", "float32", False, "ring-neighbourhood", 0),
        ("local-maximum", "float64", False, "axis", 1),
    ):
        search = cancellation.CancellationSearch(*wanted)
        assert search in cancellation.searches()
        found = cancellation.worst_row(search)
        assert found is not None
        assert struct.pack("<7d", *found.row) in known


def test_some_formula_is_wrong_on_every_row_of_worst_cancellation_and_all_rows_are_in_the_default_domain():
    file = vectors.load(WORST_CANCELLATION)
    defeats = {f"{formula}-{precision}" for formula, precision in DEFEATED}
    for case in file.cases:
        assert defeats & set(case.flags)
        assert "extreme" not in case.flags
    found = {flag for case in file.cases for flag in case.flags if flag in defeats}
    assert found == defeats
    # What is known of the formulas by other means: Table 2 sees the ring from far away, and the local maximum loses
    # three quarters of its digits next to the axis.
    for flag, family_error in (("table-2-float64", 0.9), ("table-2-float32", 0.9), ("local-maximum-float64", 1e-9)):
        errors = [min(flip.upper for flip in case.flips.values()) for case in file.cases if flag in case.flags]
        assert max(errors) > family_error


@pytest.mark.parametrize("name", [*vectors.NAMES, "invalid"])
def test_every_frozen_file_fits_its_schema(name):
    document = json.loads(text_of(name))
    wanted = schema("refusals" if name == "invalid" else "vectors")
    assert violations(document, wanted, closed=True) == []


def test_schema_of_vectors_refuses_each_malformed_document():
    document = json.loads(text_of("ring"))
    document["cases"] = document["cases"][:2]
    wanted = schema("vectors")
    assert violations(document, wanted, closed=True) == []
    for change in (
        lambda found: found.update(schema="2.0.0"),
        lambda found: found.pop("flags"),
        lambda found: found.update(author="me"),
        lambda found: found["family"].pop("purpose"),
        lambda found: found["cases"][0].pop("hex"),
        lambda found: found["cases"][0].update(note="x"),
        lambda found: found["cases"][0]["row"].pop(),
        lambda found: found["cases"][0]["hex"].__setitem__(0, "1.0"),
        lambda found: found["cases"][0].update(position=2),
        lambda found: found["cases"][0].update(kind="touching"),
        lambda found: found["cases"][0]["flips"].pop("contact"),
        lambda found: found["cases"][0].update(certificate={"multiplier": "0.5"}),
        lambda found: found["cases"][0].update(certificate={"multiplier": "1", "double_root": "1"}),
        lambda found: found["cases"][0].update(id="ring 7"),
    ):
        changed = copy.deepcopy(document)
        change(changed)
        assert violations(changed, wanted, closed=True) != []


def test_each_case_of_a_frozen_file_is_on_a_line_of_its_own():
    for name in vectors.ALL_NAMES:
        lines = text_of(name).splitlines()
        begin = lines.index('"cases": [') + 1
        assert lines[-1] == "]}"
        assert all(re.match(rf'\{{"id":"{name}-[0-9]{{4}}",', line) for line in lines[begin:-1])
        assert f'"count": {len(lines) - begin - 1},' in lines


def test_arrays_of_frozen_rows_hold_the_cases_of_a_file_in_order():
    frozen = vectors.load("small-integers")
    file = vectors.load("small-integers")
    assert frozen.rows.shape == (len(file.cases), 7)
    assert frozen.rows.dtype == np.float64
    assert frozen.positions.dtype == np.int8
    assert frozen.ids[3] == file.cases[3].id
    assert tuple(frozen.rows[3].tolist()) == file.cases[3].row
    assert frozen.positions.tolist() == [int(case.position) for case in file.cases]


def test_each_ladder_of_the_family_tangent_ladder_has_all_rungs_and_changes_its_answer_once():
    cases = vectors.load("tangent-ladder").cases
    sides = set()
    for start in range(0, len(cases), RUNGS):
        ladder = cases[start : start + RUNGS]
        up, down = ladder[::2], ladder[1::2]
        assert len(up) == len(down) == ULPS + 1
        moved = [place for place in range(7) if up[0].row[place] != down[0].row[place]]
        assert len(moved) == 1
        column = np.asarray([[case.row[moved[0]] for case in side] for side in (up, down)]).view(np.int64)
        assert ((column[0] - column[1]) == 2 * 2 ** np.arange(ULPS + 1)).all()
        answers = [{case.position for case in side} for side in (up, down)]
        assert sorted(map(len, answers)) == [1, 1]
        assert Position.CONTACT in answers[0] | answers[1]
        assert len(answers[0] | answers[1]) == 2
        sides |= answers[0] | answers[1]
    assert sides == set(Position)


def test_frozen_invalid_rows_include_a_single_invalid_value_in_each_column_and_every_kind_of_nan():
    file = vectors.load("invalid")
    assert invalid(file.rows).all()
    alone = Counter(case.columns for case in file.cases if len(case.columns) == 1)
    assert {columns[0] for columns in alone} == {"alpha", "gamma", "b", "d", "x", "y", "z"}
    words = {word for case in file.cases for word in case.bits}
    for special in (0, 1 << 63, 0x7FF0 << 48, 0xFFF0 << 48, 0x7FF8 << 48, 0xFFF8 << 48, (0x7FF0 << 48) + 1):
        assert special in words
    assert len({case.bits for case in file.cases}) == len(file.cases)
    assert file.rows.view(np.uint64).tolist() == [list(case.bits) for case in file.cases]


def readme():
    return (FOLDER / "README.md").read_text(encoding="utf-8")


def block(language):
    """The README's one example in a language."""
    found = re.findall(rf"```{language}\n(.*?)```", readme(), re.DOTALL)
    assert len(found) == 1
    return found[0]


def test_table_of_families_has_a_line_for_each_family_that_agrees_with_its_file():
    files = {name: vectors.load(name) for name in vectors.ALL_NAMES}
    rows = [[name, str(len(file.cases)), file.head.title, file.head.purpose] for name, file in files.items()]
    with (FOLDER / "families.csv").open(encoding="utf-8", newline="") as table:
        assert list(csv.reader(table)) == [["family", "cases", "what", "trap"], *rows]
    assert f"lists the {len(files)} families" in readme()
    assert (FOLDER / "LICENSE").read_text(encoding="utf-8").startswith("CC0 1.0 Universal")


@pytest.mark.skipif(shutil.which("node") is None, reason="node is not installed")
@pytest.mark.parametrize(("answer", "name", "code"), [(0, "tangent", 0), (0, "ring", 1), (1, "ring", 0)])
def test_javascript_example_of_the_cases_readme_runs_and_finds_wrong_answers(tmp_path, answer, name, code):
    (tmp_path / "check.mjs").write_text(block("javascript"), encoding="utf-8")
    (tmp_path / "mine.mjs").write_text(f"export const classify = (...row) => {answer};\n", encoding="utf-8")
    command = ["node", "check.mjs", str(vectors.path_of(name))]
    ran = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (ran.returncode, ran.stderr) == (code, "")
    assert len(ran.stdout.splitlines()) == (len(vectors.load(name).cases) if code else 0)


@pytest.mark.skipif(shutil.which("cc") is None or shutil.which("sed") is None, reason="no C compiler or sed")
@pytest.mark.parametrize("name", ["ring", "extreme-subnormal", "symmetric-images"])
def test_c_example_of_the_cases_readme_compiles_and_reads_every_number_to_the_bit(tmp_path, name):
    shutil.copy(vectors.path_of(name), tmp_path / "ring.json")
    (tmp_path / "check.c").write_text(block("c"), encoding="utf-8")
    printing = "#include <stdio.h>\nint classify(const double row[7]) {\n  fwrite(row, 8, 7, stdout);\n  return 9;\n}\n"
    (tmp_path / "mine.c").write_text(printing, encoding="utf-8")
    for command in (
        ["sh", "-c", block("sh")],
        ["cc", "-std=c99", "-Wall", "-Werror", "check.c", "mine.c", "-o", "check"],
    ):
        subprocess.run(command, cwd=tmp_path, check=True)
    ran = subprocess.run([str(tmp_path / "check")], capture_output=True, check=False)
    assert ran.returncode == 1
    frozen = vectors.load(name)
    wanted = b"".join(row + f"{case}\n".encode() for case, row in zip(frozen.ids, bits(frozen.rows), strict=True))
    assert ran.stdout == wanted


def test_frozen_files_are_installed_with_the_package(tmp_path, monkeypatch):
    """What setup.py adds to a build: the same bytes, the vectors packed, inside the package; and in an sdist."""
    setuptools = pytest.importorskip("setuptools")
    root = Path(__file__).parents[3]
    monkeypatch.chdir(root)
    given = {}
    monkeypatch.setattr(setuptools, "setup", lambda **options: given.update(options))
    runpy.run_path(str(root / "setup.py"))
    command = given["cmdclass"]["build_py"](
        setuptools.Distribution({"packages": ["hypcheck"], "script_name": "setup.py"})
    )
    command.build_lib = str(tmp_path)
    command.ensure_finalized()
    command.run()
    installed = tmp_path / "hypcheck" / "cases"
    files = {path.relative_to(FOLDER) for path in FOLDER.rglob("*") if path.is_file()}
    packed = {Path(f"{path}.xz") if path.match("*.json") and len(path.parts) == 1 else path for path in files}
    assert {path.relative_to(installed) for path in installed.rglob("*") if path.is_file()} == packed
    for path in packed:
        with open_input(str(installed / path)) as file:
            assert file.read() == (FOLDER / str(path).removesuffix(".xz")).read_bytes()
    assert {str(Path("cases", path)) for path in files} <= set(command.get_source_files())
    assert {str(installed / path) for path in packed} <= set(command.get_outputs())


def test_cases_folder_inside_an_installed_package_is_used_first(tmp_path, monkeypatch):
    package = tmp_path / "site" / "hypcheck"
    (package / "casebook").mkdir(parents=True)
    monkeypatch.setattr(vectors, "__file__", str(package / "casebook" / "vectors.py"))
    assert vectors.folder() == tmp_path / "site" / "cases"
    (package / "cases").mkdir()
    assert vectors.folder() == package / "cases"
