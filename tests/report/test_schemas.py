"""The published schemas fit the lines of samples and of real runs, and refuse damaged ones."""

from __future__ import annotations

import json
from dataclasses import fields, replace
from importlib import resources

import pytest

from hypcheck.bench.timing import measure
from hypcheck.derivation.printed_equations import EquationCheck
from hypcheck.derivation.proofs import Proof
from hypcheck.errors import RunOutcome
from hypcheck.record import SCHEMA as RECORD_SCHEMA
from hypcheck.record import Recorder, measurements, plain, read
from hypcheck.record.fields import as_json
from hypcheck.record.reader import LINES
from hypcheck.report import summary
from hypcheck.runs import self_check
from hypcheck.runs.findings import SelfCheckPlan
from hypcheck.runs.self_check import TimedMethod, timing_line
from hypcheck.vectors.families import FAMILIES
from tests.report import bench_lines, record_samples
from tests.support.records import GrowingText, violations
from tests.tools.published_schemas import PUBLISHED, text


def schema(name):
    return json.loads(resources.files("hypcheck.report").joinpath("schemas", name).read_text(encoding="utf-8"))


RECORD = schema(f"record-{RECORD_SCHEMA}.json")
SUMMARY = schema(f"summary-{summary.SCHEMA}.json")


OF_A_BENCHMARK = {
    kind.__struct_config__.tag
    for kind in vars(measurements).values()
    if isinstance(kind, type) and kind in LINES.values()
}
"""Lines that `hypcheck bench` writes, since schema 1.1.0."""


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


def test_every_line_of_the_sample_record_fits_its_schema():
    text, _ = record_samples.text_and_record()
    kinds = set()
    for line in lines_of(text):
        assert violations(line, RECORD, closed=True) == []
        kinds.add(line["type"])
    assert kinds == set(LINES) - {"cause", "drift", "implementation", "progress"} - OF_A_BENCHMARK


@pytest.mark.slow
def test_every_line_of_a_benchmark_fits_its_schema():
    found = [as_json(line) for line in bench_lines.bench_record().lines]
    for line in found:
        assert violations(line, RECORD, closed=True) == []
    assert {line["type"] for line in found} == OF_A_BENCHMARK - {"refused", "unmeasured"}


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
    for stage in self_check.stages(plan, recorder, outcome):
        if stage.title not in ("derivation", "timing"):
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
    contender = TimedMethod("sum", "a sum", lambda part: part[:, 0].astype("int8"), 8)
    (timing,) = measure([contender.entry(rows)], 2, shortest_s=1e-6)
    line = json.loads(json.dumps(as_json(timing_line(contender, timing))))
    assert violations(line, RECORD, closed=True) == []


def truncated_early():
    """What is left of a run that was interrupted at once."""
    return replace(record_samples.record([], exit_code=None), lines=())


@pytest.mark.parametrize("record", [record_samples.record(), record_samples.record(exit_code=None), truncated_early()])
def test_summaries_of_samples_fit_their_schema(record):
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
