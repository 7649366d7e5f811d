"""Reports about implementations under test; the record and the summary fit their schemas."""

from __future__ import annotations

import json
import shlex

import pytest

from hypcheck.cli.main import main
from hypcheck.record import read
from hypcheck.record.fields import as_json
from hypcheck.record.lines import GroupLine, ImplementationLine
from hypcheck.record.reader import line_of
from hypcheck.report import junit, markdown, summary
from hypcheck.report.messages import implementation_claims
from hypcheck.report.model import implementations, under_test
from hypcheck.report.terminal import summary_lines
from hypcheck.report.verdict import failures
from hypcheck.runs.replay import case_of
from tests.report.test_schemas import RECORD, SUMMARY
from tests.support.records import violations
from tests.support.without_drawing import draw_nothing

pytestmark = pytest.mark.usefixtures("text_reports")

CALLS_US = ("--isolate", "off")
"""For functions that call hypcheck, which an isolated one does not see."""

SPECS = (
    "builtin:fast",
    "builtin:table-2-float64",
    "python:tests.runs.faulty:dies_on_the_axis",
    "python:tests.runs.refusing:does_not",
    "command:/nowhere/at/all 'a b'",
)


@pytest.fixture(scope="module")
def out(tmp_path_factory):
    """A small run: one passes, one is wrong, one crashes, one answers bad rows, and one is not there."""
    folder = tmp_path_factory.mktemp("gate")
    words = ["--families", "ring,axis,tower-body", "--count", "3", "--precision", "float32", "--tolerance", "4"]
    with pytest.MonkeyPatch.context() as patch:
        draw_nothing(patch)
        assert main(["verify", *SPECS, *words, "--restarts", "4", "--out", str(folder)]) == 5
    return folder


@pytest.fixture(scope="module")
def record(out):
    return read(out / "record.jsonl")


def test_record_of_verify_fits_its_schema(out):
    record = read(out / "record.jsonl")
    lines = [as_json(line) for line in (record.header, *record.lines, record.footer)]
    assert {"header", "group", "cause", "implementation", "footer"} == {line["type"] for line in lines}
    for line in lines:
        assert violations(line, RECORD, closed=True) == []
    faults = {fault["status"] for line in lines if line["type"] == "group" for fault in line["faults"]}
    assert {"crash", "wrong"} <= faults
    started = [line["started"] for line in lines if line["type"] == "implementation"]
    assert started == [True, True, True, True, False]


@pytest.mark.parametrize(
    "spoil",
    [
        lambda line: line.pop("spec"),
        lambda line: line.update(started="yes"),
        lambda line: line["declared"].pop("domain"),
        lambda line: line["used"].update(precision="float8"),
        lambda line: line["again"].update(within=-1),
        lambda line: line.update(surprise=1),
    ],
)
def test_record_line_with_a_wrong_value_does_not_fit_the_schema(record, spoil):
    line = as_json(record.of(ImplementationLine)[0])
    assert violations(line, RECORD, closed=True) == []
    spoil(line)
    assert violations(line, RECORD, closed=True)


def test_summary_of_verify_fits_its_schema_and_shows_declared_and_used_settings(record):
    found = json.loads(summary.render(record))
    assert violations(found, SUMMARY, closed=True) == []
    table_2 = next(each for each in found["implementations"] if each["name"] == "table-2-float64")
    assert (table_2["declared"]["precision"], table_2["judged_as"]["precision"]) == ("float64", "float32")
    assert table_2["asked_again"]["asked"] > 0


def test_reports_show_declared_and_used_settings_of_each_implementation(record):
    text = markdown.render(record).decode()
    section = text.partition("## Implementations under test")[2].partition("\n## ")[0]
    rows = [line for line in section.splitlines() if line.startswith("|") and "float" in line]
    assert ["float64" in line for line in rows] == [True, False] * 4
    assert "was not started" in section
    lines = summary_lines(record, [])
    assert "table-2-float64: judged as float32, as the options say" in lines
    assert any(line.startswith("table-2-float64: declares exterior, float64, c2>=a,") for line in lines)


def test_two_implementations_with_the_same_name_are_distinguished_in_reports(tmp_path):
    specs = [f"python:{folder}/same.py:classify" for folder in (tmp_path / "a", tmp_path / "b")]
    for spec, answer in zip(specs, ("0", "hypcheck.classify(rows)"), strict=True):
        path = spec.partition(":")[2].rpartition(":")[0]
        (tmp_path / path).parent.mkdir()
        text = f"def classify(rows):\n    return {answer} + 0 * rows[:, 0].astype(int)\n"
        (tmp_path / path).write_text(f"import hypcheck\n{text}", encoding="utf-8")
    assert (
        main(["verify", *specs, "--families", "tower-body", "--count", "3", "--out", str(tmp_path / "out"), *CALLS_US])
        == 1
    )
    made = read(tmp_path / "out" / "record.jsonl")
    found = implementations(made)
    assert [each.name for each in found] == [f"same.py:classify ({spec})" for spec in specs]
    assert [each.spec for each in found] == specs
    assert [each.statuses.get("wrong", 0) > 0 for each in found] == [True, False]
    assert {each.name for each in failures(made)} == {found[0].name}
    assert [each.name for each in under_test(made)] == [each.name for each in found]


def test_every_failing_family_has_a_command_that_shows_it(record):
    failing = {(line.spec, line.family) for line in record.of(GroupLine) if line.failing}
    replayed = [each for each in failures(record) if each.replay]
    assert {each.kind for each in replayed} >= {"wrong", "crash"}
    assert {(shlex.split(each.replay)[3], each.group) for each in replayed} == failing
    for each in replayed:
        words = shlex.split(each.replay)
        assert words[:2] == ["hypcheck", "replay"]
        assert words[2] == each.case
        assert words[3] in SPECS
        assert words[4:] == ["--precision=float32", "--tolerance=4"]
        assert case_of(words[2]).name == each.case
    text = markdown.render(record).decode()
    xml = junit.render(record).decode()
    for each in replayed:
        assert f"`{each.replay}`" in text
        assert f"replay: {each.replay}" in xml


def test_replay_command_isolates_as_the_run_did(tmp_path, capsys):
    seen = tmp_path / "data.txt"
    seen.touch()
    options = ["--isolate=off", "--pass-env=HOME,LANG", f"--see={seen}"]
    words = ["verify", "builtin:table-2-float64", "--families", "ring", "--count", "3", "--out", str(tmp_path / "out")]
    assert main([*words, *options]) == 1
    replays = [each.replay for each in failures(read(tmp_path / "out" / "record.jsonl"))]
    assert [shlex.split(replay)[4:] for replay in replays] == [options]
    capsys.readouterr()
    assert main(shlex.split(replays[0])[1:]) == 1


def test_replay_command_of_a_failure_reproduces_the_failure(record, capsys):
    wrong = next(each for each in failures(record) if each.kind == "wrong" and each.name == "table-2-float64")
    assert main([*shlex.split(wrong.replay)[1:], "--json"]) == 1
    found = json.loads(capsys.readouterr().out)
    assert found["status"] == "wrong"
    crash = next(each for each in failures(record) if each.kind == "crash")
    assert main([*shlex.split(crash.replay)[1:], "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["status"] == "crash"


def test_number_of_a_failure_in_a_report_leads_to_its_case(out, record):
    for each in failures(record):
        if each.place:
            assert case_of(f"{out}/{each.place}").name == each.case


def test_replay_command_quotes_the_spec_as_it_was_written(tmp_path):
    (tmp_path / "two  words.py").write_text("def classify(rows):\n    return [0] * len(rows)\n", encoding="utf-8")
    spec = f"python:{tmp_path}/two  words.py:classify"
    assert main(["verify", spec, "--families", "tower-body", "--count", "2", "--out", str(tmp_path / "out")]) == 1
    (failure, *_) = failures(read(tmp_path / "out" / "record.jsonl"))
    assert shlex.split(failure.replay)[3] == spec


def test_reports_do_not_show_an_excused_case_as_the_wrong_one(tmp_path):
    """The worst error of the family is known; what fails the run is another, smaller one."""
    out, listed = tmp_path / "out", tmp_path / "known.toml"
    words = ["verify", "builtin:table-2-float64", "--families", "ring", "--count", "0", "--out", str(out)]
    assert main(words) == 1
    (group,) = read(out / "record.jsonl").of(GroupLine)
    worst = [case.case for case in group.worst]
    entries = [f'[[known_failure]]\ncase = "{case}"\nreason = "known"\n' for case in worst]
    listed.write_text("".join(entries), encoding="utf-8")
    assert main([*words, "--known-failures", str(listed)]) == 1
    (group,) = read(out / "record.jsonl").of(GroupLine)
    assert group.counts["excused"] == len(worst)
    (failure,) = failures(read(out / "record.jsonl"))
    assert failure.case not in worst


def test_reports_name_the_fixed_sizes_of_a_domain_and_the_record_fits_its_schema(record):
    line = as_json(record.of(ImplementationLine)[0])
    line["used"]["domain"]["settings"] = [{"sizes": [2.0, 17.8, 0.25, 0.15], "x": None, "y": [-1, "inf"], "z": [0, 0]}]
    assert violations(line, RECORD, closed=True) == []
    assert any("only α, γ, b, d = (2, 17.8, 0.25, 0.15), " in claim for claim in implementation_claims(line_of(line)))
