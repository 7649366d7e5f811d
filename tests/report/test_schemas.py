"""The published schemas fit the lines of samples and of real runs, and refuse damaged ones."""

from __future__ import annotations

import json
from dataclasses import fields, replace
from importlib import resources

import pytest

from hypcheck.derivation.printed_equations import EquationCheck
from hypcheck.derivation.proofs import Proof
from hypcheck.errors import RunOutcome
from hypcheck.implementations.method import Method
from hypcheck.record import SCHEMA as RECORD_SCHEMA
from hypcheck.record import Recorder, plain, read
from hypcheck.record.fields import as_json
from hypcheck.record.reader import LINES
from hypcheck.report import summary
from hypcheck.runs import self_check
from hypcheck.runs.findings import SelfCheckPlan
from hypcheck.runs.self_check import timing_entry, timing_line
from hypcheck.runs.timing import measure
from hypcheck.vectors.families import FAMILIES
from tests.report import bench_lines, record_samples
from tests.support.records import GrowingText, violations
from tests.tools.goldens import FOLDER, RUNS
from tests.tools.published_schemas import PUBLISHED, text


def schema(name):
    return json.loads(resources.files("hypcheck.report").joinpath("schemas", name).read_text(encoding="utf-8"))


RECORD = schema(f"record-{RECORD_SCHEMA}.json")
SUMMARY = schema(f"summary-{summary.SCHEMA}.json")


def lines_of(text):
    """The lines of a record without their checksums, of which each must have one."""
    for written in text.splitlines():
        line = json.loads(written)
        assert violations(line, RECORD) == []
        assert list(line)[-1] == "crc32"
        del line["crc32"]
        yield line


def of_summary(record):
    return json.loads(summary.render(record))


@pytest.mark.parametrize("file", PUBLISHED, ids=lambda file: file.name)
def test_published_schema_equals_the_one_generated_from_the_classes(file):
    assert file.read_text(encoding="utf-8") == text(PUBLISHED[file]()), "make schemas writes it anew"


@pytest.mark.parametrize("run", RUNS)
def test_every_line_and_the_summary_of_a_recorded_run_fit_their_schemas(run):
    for line in lines_of((FOLDER / run / "record.jsonl").read_text(encoding="utf-8")):
        assert violations(line, RECORD, closed=True) == []
    assert violations(of_summary(read(FOLDER / run)), SUMMARY, closed=True) == []


def test_recorded_runs_have_every_type_of_line_that_a_finished_record_can_have():
    recorded = [line for run in RUNS for line in (FOLDER / run / "record.jsonl").read_text("utf-8").splitlines()]
    assert {json.loads(line)["type"] for line in recorded} == set(LINES) - {"progress"}


@pytest.mark.slow
@pytest.mark.parametrize("version", ["1.0.0", "1.2.0"])
def test_a_line_that_fits_an_older_schema_fits_this_one(version):
    older = schema(f"record-{version}.json")
    kinds = {each["$ref"].removeprefix("#/$defs/") for each in older["oneOf"]} - {"implementation"}
    assert len(kinds) > 10
    for kind in kinds:
        before, now = older["$defs"][kind], RECORD["$defs"][kind]
        assert set(now["required"]) <= set(before["required"])
        assert set(before["properties"]) <= set(now["properties"])
    for line in [*record_samples.lines(), *bench_lines.lines()]:
        if line["type"] in kinds:
            assert violations(plain(line), older) == violations(plain(line), RECORD) == []


def test_record_line_of_an_implementation_that_did_not_start_has_only_its_error():
    line = {"type": "implementation", "spec": "command:x", "name": "x", "started": False, "trouble": "none"}
    assert violations(line, RECORD, closed=True) == []
    assert violations({**line, "started": True}, RECORD["$defs"]["implementation"] | {"$defs": RECORD["$defs"]})


@pytest.fixture(scope="module")
def really_recorded():
    """A small run of the oracles, the formulas, the methods and the map, without the slow derivation and timing."""
    plan = SelfCheckPlan(("ring", "tower-body"), count=6, roots=8, meshes=8, exact_formulas=6, workers=1)
    stream = GrowingText()
    recorder, outcome = Recorder(stream, self_check.options(plan)), RunOutcome()
    for stage in self_check.SelfCheck(plan, recorder, outcome, derive=lambda: ((), ())).stages():
        if stage.title != "timing":
            stage.run(lambda steps: None)
    recorder.close(outcome.exit_code)
    return stream.text


@pytest.mark.slow
def test_the_record_of_a_run_fits_its_schema(really_recorded):
    lines = list(lines_of(really_recorded))
    assert {"header", "oracle", "finding", "group", "map", "footer"} <= {line["type"] for line in lines}
    for line in lines:
        assert violations(line, RECORD, closed=True) == []


def test_the_summary_of_a_run_fits_its_schema(really_recorded, tmp_path):
    path = tmp_path / "record.jsonl"
    path.write_text(really_recorded, encoding="utf-8")
    assert violations(of_summary(read(path)), SUMMARY, closed=True) == []


@pytest.mark.parametrize(("kind", "type_"), [("equation", EquationCheck), ("proof", Proof)])
def test_record_lines_of_the_derivation_have_the_fields_of_their_classes(kind, type_):
    assert set(RECORD["$defs"][kind]["required"]) == {field.name for field in fields(type_)} | {"type"}


def test_a_timing_line_has_the_fields_of_a_timing():
    rows = FAMILIES["tower-body"].rows(1, 8)
    contender = Method("sum", "a sum", lambda part: part[:, 0].astype("int8"))
    (timing,) = measure([timing_entry(contender, rows)], 2, shortest_s=1e-6)
    line = json.loads(json.dumps(as_json(timing_line(contender, timing))))
    assert violations(line, RECORD, closed=True) == []


def truncated_early():
    """What is left of a run that was interrupted at once."""
    return replace(record_samples.record([], exit_code=None), lines=())


@pytest.mark.parametrize("record", [record_samples.record(exit_code=None), truncated_early()])
def test_summary_of_an_interrupted_run_fits_its_schema(record):
    assert violations(of_summary(record), SUMMARY, closed=True) == []


@pytest.mark.parametrize(
    "spoil",
    [
        lambda found: found.pop("oracles"),
        lambda found: found.update(exit_code="0"),
        lambda found: found.update(schema="2.0.0"),
        lambda found: found.update(passed=None),
        lambda found: found["oracles"]["exact"].update(asked=-1),
        lambda found: found["oracles"]["exact"]["stages"].update(proved="20"),
        lambda found: found["equations"].pop("misprint"),
        lambda found: found["implementations"][0].update(worst_backward_error_u="∞"),
        lambda found: found["implementations"][0]["families"]["ring"].pop("wrong"),
        lambda found: found["implementations"][0]["statuses"].update(right=0.5),
        lambda found: found["timings"][0].update(median_ns=None),
        lambda found: found.update(surprise=1),
    ],
)
def test_summary_with_a_wrong_value_does_not_fit_its_schema(spoil):
    found = of_summary(record_samples.record())
    spoil(found)
    assert violations(found, SUMMARY, closed=True)


@pytest.mark.parametrize(
    ("kind", "field", "value"),
    [
        ("oracle", "undecided", -1),
        ("oracle", "asked", True),
        ("finding", "first_row", ["0x1p+0"] * 6),
        ("finding", "first_row", ["1.0"] * 7),
        ("finding", "reason", 3),
        ("group", "question", "where"),
        ("map", "lines", ["exterior"]),
        ("timing", "samples_ns", []),
        ("proof", "type", "theorem"),
        ("proof", "crc32", 7),
        ("proof", "crc32", "0123456G"),
    ],
)
def test_record_line_with_a_wrong_value_does_not_fit_its_schema(kind, field, value):
    line = next(line for line in record_samples.lines() if line["type"] == kind)
    assert violations({**line, field: value}, RECORD)
