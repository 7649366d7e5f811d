"""A record is read back as it was written, also in an older or newer version; other files are refused."""

from __future__ import annotations

import json
import math
import tracemalloc

import numpy as np
import pytest
from msgspec import UNSET, ValidationError

from hypcheck.errors import InputError
from hypcheck.geometry.rows import PAIRS, SWEEPS, with_axis, with_heights
from hypcheck.record import SCHEMA, Record, Recorder, integrity, read
from hypcheck.record.fields import FARTHEST, Histogram, decoded, numbers_of, row_of
from hypcheck.record.lines import DriftLine, FooterLine, GroupLine, HeaderLine, ImplementationLine
from hypcheck.record.measurements import AccuracyLine, BoundingLine, StabilityLine
from hypcheck.record.progress import Tally
from hypcheck.record.reader import FILE, GROWING, file_and_newer, interrupted_in, recorded_cases
from tests.support.records import GrowingText, resealed, unanswered_case

HEADER = {
    "type": "header",
    "schema": SCHEMA,
    "hypcheck": "0.1.0",
    "started": "2026-01-02T03:04:05+00:00",
    "python": "3.11.7",
    "versions": {"numpy": "2.0.0"},
    "machine": {"system": "Linux", "architecture": "x86_64", "processor": "one", "cores": None},
    "options": {},
}
FOOTER = {"type": "footer", "lines": 3, "exit_code": 0, "seconds": 0.5}
SETTING = {"sizes": [1, 2, 3, 4], "x": ["-inf", 3.5], "y": None, "z": None}
DESCRIPTION = {
    "name": "mine",
    "version": "",
    "language": "C",
    "precision": "float64",
    "question": "position",
    "domain": {"regimes": ["a>=1"], "ratio": None, "magnitude": None},
    "refuses": False,
    "binary": True,
    "time": False,
}
SAMPLE = {
    "type": "implementation",
    "spec": "command:./mine",
    "name": "mine",
    "started": True,
    "declared": DESCRIPTION,
    "used": DESCRIPTION,
    "restarts": 0,
    "again": {"asked": 3, "within": 0, "beyond": 0},
    "broke_protocol_throughout": False,
    "troubles": [],
}
"""A line about an implementation, with everything that an exact reading must bring back."""


def written(path, close=True):
    stream = GrowingText()
    recorder = Recorder(stream, {"seed": 3})
    domain = {"regimes": [], "ratio": [0.1, math.inf], "magnitude": None, "settings": [SETTING]}
    recorder.add(decoded({**SAMPLE, "used": {**SAMPLE["used"], "domain": domain}}, ImplementationLine))
    record = recorder.close(0) if close else None
    path.write_text(stream.text, encoding="utf-8")
    return record


def test_a_line_with_a_lone_surrogate_in_the_name_of_a_field_is_refused():
    with pytest.raises(ValidationError, match="a lone surrogate"):
        decoded({**SAMPLE, "\ud800": 1}, ImplementationLine)


@pytest.mark.parametrize(
    ("field", "value"),
    [("octaves", {"half": {}}), ("size_bins", [[0, 0, 1, 2]]), ("place_bins", [[0, FARTHEST + 1, 1, 1]])],
)
def test_record_line_with_impossible_bins_is_refused_and_one_with_the_farthest_bin_is_read(field, value):
    """Of a group as of the progress of a family."""
    counts = {"counts": {}, "mistakes": {}, "octaves": {}, "place_bins": [], "size_bins": [[-FARTHEST, FARTHEST, 1, 1]]}
    names = {"method": "m", "title": "m", "exact": False, "question": "position", "precision": "float64", "family": "f"}
    for kind, line in (
        (GroupLine, {"type": "group", **names, "asked": 1, "worst": [], **counts}),
        (Tally, {"asked": 1, "dangerous": 0, "worst": [], "faults": [], **counts}),
    ):
        decoded(line, kind)
        with pytest.raises(ValidationError, match=field):
            decoded({**line, field: value}, kind)


@pytest.mark.parametrize(
    ("kind", "field", "impossible"),
    [(AccuracyLine, "octaves", [-3, 1, 2]), (BoundingLine, "overlap", [1.0, 1, 2, None])],
)
def test_a_benchmark_line_with_more_wrong_answers_than_cases_is_refused(kind, field, impossible):
    counts = dict.fromkeys(("asked", "wrong", "false_clear", "false_contact", "wrong_side", "abstained"), 0)
    of = {"method": "m", "workload": "near", "reliable_above": 1.0, "worst": []} if field == "octaves" else {}
    of |= {"shape": "sphere", "workload": "near"} if field == "overlap" else {}
    line = {"type": "accuracy" if field == "octaves" else "bounding", **counts, **of, field: []}
    decoded(line, kind)
    with pytest.raises(ValidationError, match=field):
        decoded({**line, field: [impossible]}, kind)


def test_each_line_class_has_the_type_that_the_record_names():
    header, drift = decoded(HEADER, HeaderLine), DriftLine(sentence="it moved")
    assert (header.type, drift.type, FooterLine(lines=2, exit_code=0, seconds=0.0).type) == (
        "header",
        "drift",
        "footer",
    )
    assert decoded({**SAMPLE}, ImplementationLine).type == "implementation"


def test_recorded_cases_are_numbered_from_1_with_the_worst_of_a_group_before_its_faults():
    counts = {"counts": {}, "mistakes": {}, "octaves": {}, "place_bins": [], "size_bins": []}
    names = {"method": "m", "title": "m", "exact": False, "question": "position", "precision": "float64", "family": "f"}
    fault = {"case": "f-1", "row": [(1.0).hex()] * 7, "status": "crash", "reason": "it left"}
    group = decoded({"type": "group", **names, "asked": 2, "worst": [], "faults": [fault, fault], **counts}, GroupLine)
    record = Record(decoded(HEADER, HeaderLine), (group,), None)
    assert [each.number for each in recorded_cases(record)] == [1, 2]


@pytest.fixture
def path(tmp_path):
    return tmp_path / "record.jsonl"


def test_the_error_about_a_wrong_line_names_its_number_in_the_file_and_its_type(path):
    path.write_bytes(resealed([HEADER, SAMPLE, {**SAMPLE, "restarts": -1}, {**FOOTER, "lines": 4}]))
    with pytest.raises(InputError, match="line 3, implementation: restarts is -1; it must be "):
        read(path)


def test_a_record_is_read_back_as_it_was_written(path):
    record = written(path)
    assert read(path) == record
    domain = read(path).of(ImplementationLine)[0].used.domain
    assert (domain.ratio, domain.settings[0].x) == ((0.1, math.inf), (-math.inf, 3.5))
    assert '"ratio": [0.1, "inf"]' in path.read_text(encoding="utf-8")


def test_a_record_without_a_footer_is_truncated(path):
    written(path, close=False)
    assert read(path).footer is None
    assert len(read(path).lines) == 1


def test_windows_line_ends_do_not_change_a_record(path):
    record = written(path)
    path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    assert read(path) == record


def test_lone_surrogates_and_control_characters_in_a_record_are_read_back(path):
    stream = GrowingText()
    recorder = Recorder(stream, {})
    recorder.add(DriftLine(sentence="a lone surrogate \udc80, a line \u2028 and \x00"))
    path.write_text(stream.text, encoding="utf-8")
    assert read(path).of(DriftLine)[0].sentence == "a lone surrogate \udc80, a line \u2028 and \x00"


OLDER = '{"type": "header", "schema": "%s"}\n{"type": "group", "n": 1}\n{"type": "footer", "lines": 3}\n'


@pytest.mark.parametrize("version", ["1.0.0", "1.1.0"])
def test_record_of_an_older_schema_is_read_without_checksums(path, version):
    lines = [{**HEADER, "schema": version}, {"type": "drift", "sentence": "odd"}, FOOTER]
    path.write_text("".join(f"{json.dumps(line)}\n" for line in lines), encoding="utf-8")
    record = read(path)
    assert (record.header.schema, record.header.files, record.header.settings) == (version, UNSET, UNSET)
    assert record.lines == (DriftLine(sentence="odd"),)
    assert record.footer == FooterLine(lines=3, exit_code=0, seconds=0.5)


def test_progress_line_written_by_the_first_versions_of_schema_1_3_is_read(path):
    """They had another name for faults, no count of hangs and no sha256 of the program."""
    nothing = {"tallies": {}, "open": [], "again": SAMPLE["again"], "outcomes": [], "excusing": [], "named": []}
    state = {"done": 3, "left": {"restarts": 2, "lone": 9, "over": ""}, "total": nothing}
    line = {"type": "progress", "number": 0, "declared": DESCRIPTION, "cases": 5, "state": state}
    path.write_bytes(resealed([{**HEADER, "schema": "1.3.0"}, line]))
    (progress,) = read(path).lines
    assert (progress.state.done, progress.state.left.restarts, progress.program) == (3, 2, None)


def test_a_record_of_a_newer_minor_version_is_read_without_its_additions(path):
    drift = {"type": "drift", "sentence": "odd", "new": {"n": [1]}}
    lines = [{**HEADER, "schema": "1.99.0", "new": [1]}, {"type": "novelty", "n": 1e300}, drift]
    path.write_bytes(resealed([*lines, {**FOOTER, "lines": 4}]))
    record = read(path)
    assert record.header.schema == "1.99.0"
    assert record.lines == (DriftLine(sentence="odd"),)
    assert record.footer is not None


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is empty; a record begins with a header"),
        ('{"type": "head', "is cut off within its first line; nothing of it can be used"),
        ("alpha,gamma", "is not a record: it has no whole line"),
        ("alpha,gamma\n", "is not a record: its first line is not a header .it is not valid JSON at character 1"),
        ("[1]\n", "its first line is not a header .it is not an object with a type"),
        ('{"type": "group"}\n', "its first line is not a header with a schema such as 1.0.0"),
        ('{"type": "header", "schema": 1}\n', "its first line is not a header with a schema such as 1.0.0"),
        ('{"type": "header", "schema": "1.x"}\n', "its first line is not a header with a schema such as 1.0.0"),
        (OLDER % "9.0.0", "has schema 9.0.0; this program reads 1.x"),
        (OLDER % "1.2.0", "is damaged in line 1, at byte 0: it has no checksum at its end"),
        (OLDER % "1.0.0" + "{", "is damaged in line 4, at byte 95: it comes after the footer"),
        (OLDER % "1.0.0" + "{}\n", "in line 4, at byte 95: it is not an object with a type"),
        (OLDER % "1.0.0" + '{"type": "x"}\n', "in line 4, at byte 95: it comes after the footer"),
        (
            (OLDER % "1.0.0").replace("3", "4"),
            "in line 3, at byte 64: it is a footer that counts 4 lines, but it is line 3",
        ),
        (
            (OLDER % "1.0.0").replace('"n"', "n"),
            "in line 2, at byte 38: it is not valid JSON at character 19: expecting property",
        ),
        ((OLDER % "1.0.0").replace("1}", "NaN}"), "in line 2, at byte 38: NaN is not a number of JSON"),
        ((OLDER % "1.0.0").replace("1}", "1e999}"), "in line 2, at byte 38: 1e999 is too large for float64"),
        (
            (OLDER % "1.0.0").replace("1}", f"{'9' * 5000}}}"),
            "in line 2, at byte 38: 999999.*… is too large for float64",
        ),
        ((OLDER % "1.0.0").replace("1}", f"{'[' * 99999}}}"), "in line 2, at byte 38: it is nested too deeply"),
        ((OLDER % "1.0.0").replace("group", "header"), "in line 2, at byte 38: it is a second header"),
    ],
)
def test_a_file_that_is_not_a_record_is_refused_naming_the_byte(path, text, message):
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=message):
        read(path)


def test_binary_data_and_missing_files_are_refused(path, tmp_path):
    path.write_bytes((OLDER % "1.0.0").encode().replace(b"group", b"gr\xffup"))
    with pytest.raises(InputError, match="in line 2, at byte 38: its byte 12 is not UTF-8"):
        read(path)
    with pytest.raises(InputError, match=r"cannot read .*: no such file"):
        read(tmp_path / "none.jsonl")
    path.unlink()
    with pytest.raises(InputError, match=r"cannot read .*record\.jsonl: no such file"):
        read(tmp_path)


@pytest.mark.parametrize("beginning", [b"", (OLDER % "1.0.0")[:38].encode()])
def test_a_line_of_a_gigabyte_is_refused_without_being_loaded(path, beginning):
    with path.open("wb") as file:
        file.write(beginning)
        file.truncate(1 << 30)
    tracemalloc.start()
    with pytest.raises(InputError, match=f"it is longer than {integrity.LONGEST} bytes"):
        read(path)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 5 * integrity.LONGEST


def test_every_line_is_strict_json_with_its_checksum_last(path):
    written(path)

    def refuse(constant):
        raise AssertionError(constant)

    for line in path.read_text(encoding="utf-8").splitlines():
        assert list(json.loads(line, parse_constant=refuse))[-1] == "crc32"


@pytest.mark.parametrize("layout", [PAIRS, SWEEPS], ids=["position", "sweep"])
def test_a_case_of_a_record_has_the_numbers_of_its_row_in_their_order(layout):
    row = [1.0, 2.0, 0.5, 0.25, 3.0, -4.0, 5.5, 7.0, 8.0, 9.0][: len(layout.upright)]
    for wider in (with_axis, with_heights, lambda rows, _: rows):
        numbers = wider(np.array([row]), layout)[0].tolist()
        case = unanswered_case(0, "a/1/1/0", numbers, "crash", "it ended", layout)
        assert len(case.row) == 7
        assert (row_of(case), len(numbers_of(case))) == (tuple(numbers), len(numbers))


def test_histograms_are_equal_if_their_tables_are_equal():
    first, other = (Histogram(np.array([[0, 1, cases, 0]])) for cases in (5, 6))
    assert first == Histogram(first.table.copy())
    assert first != other
    assert first != first.as_lists()


def test_the_record_of_a_killed_run_is_resumed_and_is_mentioned_if_an_older_record_is_read(tmp_path):
    growing = tmp_path / GROWING
    growing.touch()
    assert interrupted_in(tmp_path) == growing
    with pytest.raises(InputError, match=r"is not there; .* is of a newer run"):
        file_and_newer(tmp_path)
    (tmp_path / FILE).touch()
    file, sentence = file_and_newer(tmp_path)
    assert file == tmp_path / FILE
    assert sentence.startswith(f"{growing} is of a newer run")
    assert file_and_newer(tmp_path / "other.jsonl") == (tmp_path / "other.jsonl", "")
    growing.unlink()
    assert interrupted_in(tmp_path) == file
    assert file_and_newer(tmp_path) == (file, "")
    with pytest.raises(InputError, match="is standard input"):
        interrupted_in(type(tmp_path)("-"))


def test_the_error_about_a_line_that_lacks_a_field_names_the_field(path):
    broken = {name: value for name, value in HEADER.items() if name != "started"}
    path.write_bytes(resealed([broken, {**FOOTER, "lines": 2}]))
    with pytest.raises(InputError, match="line 1, header: it lacks started"):
        read(path)


@pytest.mark.parametrize("error", [True, "large", None])
def test_a_line_of_a_benchmark_with_a_distance_that_is_not_a_number_is_refused(error):
    counts = dict.fromkeys(("asked", "wrong", "false_clear", "false_contact", "wrong_side", "abstained"), 0)
    line = {"type": "accuracy", **counts, "method": "m", "workload": "near", "octaves": [], "worst": []}
    decoded({**line, "reliable_above": "inf"}, AccuracyLine)
    with pytest.raises(ValidationError, match=r'Expected `float` or "inf" - at `\$\.reliable_above`'):
        decoded({**line, "reliable_above": error}, AccuracyLine)


def test_a_line_of_a_benchmark_with_a_bin_farther_than_the_farthest_is_refused():
    counts = dict.fromkeys(("asked", "wrong", "false_clear", "false_contact", "wrong_side", "abstained"), 0)
    accuracy = {"type": "accuracy", **counts, "method": "m", "workload": "near", "reliable_above": 1.0, "worst": []}
    decoded({**accuracy, "octaves": [[FARTHEST, 1, 1]]}, AccuracyLine)
    with pytest.raises(ValidationError, match="octaves"):
        decoded({**accuracy, "octaves": [[FARTHEST + 1, 1, 1]]}, AccuracyLine)
    stability = {"type": "stability", "method": "m", "precision": "float64"}
    decoded({**stability, "bins": [[0, FARTHEST, 1, 1]]}, StabilityLine)
    for impossible in ([0, FARTHEST + 1, 1, 1], [0, 0, 1, 2]):
        with pytest.raises(ValidationError, match="bins"):
            decoded({**stability, "bins": [impossible]}, StabilityLine)


def test_the_number_of_skipped_cases_of_a_group_is_0_if_the_line_has_no_count():
    counts = {"mistakes": {}, "octaves": {}, "place_bins": [], "size_bins": [], "worst": []}
    names = {"method": "m", "title": "m", "exact": False, "question": "position", "precision": "float64", "family": "f"}
    for counted in ({}, {"skipped": 2}):
        group = decoded({"type": "group", **names, "asked": 2, "counts": counted, **counts}, GroupLine)
        assert group.skipped == sum(counted.values())
