"""What a plan of a run refuses, whoever makes it, and small texts and numbers at their limits."""

from __future__ import annotations

import math
import os
import py_compile
from fractions import Fraction
from pathlib import Path

import pytest

from hypcheck.cli.main import main
from hypcheck.errors import InputError
from hypcheck.runs import fingerprint
from hypcheck.runs.fingerprint import MAX_FILES_NAMED, FileSnapshot, sha256
from hypcheck.runs.hunt_surfaces import _ratio
from hypcheck.runs.intermediates import relative_error
from hypcheck.runs.known_failures import read_known_failures
from hypcheck.runs.plan import ConformancePlan, check_cluster_address
from hypcheck.runs.replay_results import _change, answer_said


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"specs": ()}, "no implementation is given"),
        ({"fail_on": "all"}, "--fail-on is 'all'; it must be one of wrong, false-clear"),
        ({"max_abstained": -1}, "--max-abstained is -1; it must be 0 or more"),
        ({"cluster": "nowhere"}, "--cluster is 'nowhere'; it must be that of a dask.distributed scheduler"),
        ({"cluster": "local:2", "workers": 2}, "a cluster has workers of its own"),
    ],
)
def test_a_plan_with_impossible_options_is_refused(changes, message):
    with pytest.raises(InputError, match=message):
        ConformancePlan(**{"specs": ("builtin:fast",), **changes})
    ConformancePlan(specs=("builtin:fast",))


@pytest.mark.parametrize("address", ["tcp://10.0.0.1:8786", "tls://host:1", "host:65535", "local:3"])
def test_plan_accepts_addresses_of_clusters(address):
    check_cluster_address(address)


@pytest.mark.parametrize(
    "address", ["", "host", "tcp://host", "host:65536", "local:", "local:x", "http://host:80", "a b:1"]
)
def test_plan_refuses_texts_that_are_no_cluster_addresses(address):
    with pytest.raises(InputError, match="--cluster is "):
        check_cluster_address(address)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('known_failure = ["ring"]', "it must be a table with"),
        ("[[known_failure]]\ncase = 7\nreason = 'it is so'", "case is 7; it must be a text"),
    ],
)
def test_a_file_of_known_failures_with_other_values_is_refused(tmp_path, text, message):
    path = tmp_path / "known-failures.toml"
    path.write_text(text)
    with pytest.raises(InputError, match=message):
        read_known_failures(path)


def test_a_file_of_known_failures_may_name_a_generated_case(tmp_path):
    path = tmp_path / "known-failures.toml"
    path.write_text('[[known_failure]]\ncase = "ring/1/42/7"\nreason = "it is so"\n')
    assert [(entry.case, entry.family) for entry in read_known_failures(path)] == [("ring/1/42/7", None)]
    path.write_text('[[known_failure]]\ncase = "ring/1/42"\nreason = "it is so"\n')
    with pytest.raises(InputError, match="ring/1/42"):
        read_known_failures(path)


def test_families_of_hyperboloids_that_end_are_refused_together_where_the_implementation_takes_none(tmp_path, capsys):
    options = ("--families", "ended-r*", "--count", "0", "--out", str(tmp_path / "out"))
    assert main(["verify", "builtin:table-2-float64", *options]) == 2
    refusal = "ended-r*: these are families of hyperboloids that end, and table-2-float64 takes none; "
    assert f'{refusal}its description must say "takes": ["heights"]' in capsys.readouterr().err


def test_a_file_of_known_failures_that_is_missing_is_named(tmp_path):
    with pytest.raises(InputError, match=r"cannot read .*none\.toml: no such file or directory"):
        read_known_failures(tmp_path / "none.toml")


def test_a_file_that_cannot_be_read_has_the_reason_in_the_place_of_a_digest(tmp_path):
    (tmp_path / "file").write_bytes(b"abc")
    assert sha256(tmp_path / "file").startswith("ba7816bf8f01cfea414140de5dae2223")
    assert sha256(tmp_path / "none") == "no such file or directory"
    os.mkfifo(tmp_path / "pipe")
    assert sha256(tmp_path / "pipe") == "is not a regular file"


def test_changed_files_of_hypcheck_and_of_the_implementation_are_named_and_many_are_counted(monkeypatch, tmp_path):
    tested = tmp_path / "tested.py"
    tested.write_text("new")
    ours = {f"hypcheck/{number}.py": "old" for number in range(MAX_FILES_NAMED + 1)}
    monkeypatch.setattr(fingerprint, "_own_files", lambda: dict(ours))
    snapshot = FileSnapshot({str(tested): "of the old", str(tmp_path / "gone.py"): "of what is gone"})
    ours.update(dict.fromkeys(list(ours)[2:], "new"))
    del ours["hypcheck/0.py"]
    ours["hypcheck/added.py"] = "new"

    class Recorder(list):
        add = list.append

    recorder = Recorder()
    told = snapshot.record_changes(recorder)
    assert told == [line.sentence for line in recorder]
    assert len(told) == MAX_FILES_NAMED + 1
    every = list(snapshot._changes())
    assert told[-1] == f"{len(every) - MAX_FILES_NAMED} more files were changed"
    assert any("hypcheck/0.py was removed while" in each for each in every)
    assert any("hypcheck/added.py was added while" in each for each in every)
    assert f"{tested}, which is under test, was changed while it was asked" in every
    assert f"{tmp_path / 'gone.py'}, which is under test, was removed while it was asked" in every


def test_a_package_file_that_is_written_added_or_removed_is_reported_whatever_its_time_and_length(
    monkeypatch, tmp_path
):
    own_files = fingerprint._own_files.__wrapped__
    monkeypatch.setattr(fingerprint, "_PACKAGE", tmp_path / "package")
    monkeypatch.setattr(fingerprint, "folder", lambda: tmp_path / "cases")
    monkeypatch.setattr(fingerprint, "_own_files", own_files)
    judge, lines, ring, new = (
        tmp_path / name for name in ("package/runs/judge.py", "package/lines.py", "cases/ring.json", "package/new.so")
    )
    for path in (judge, lines, ring):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("a = 1")
    compiled = Path(py_compile.compile(str(judge)))
    snapshot = FileSnapshot({})
    assert list(snapshot._changes()) == []
    for path in (judge, ring, compiled):
        times, content = path.stat(), path.read_bytes()
        path.write_bytes(content[:-1] + bytes([content[-1] ^ 1]))
        os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))
    lines.unlink()
    new.write_text("")
    said = {(judge, "changed"), (ring, "changed"), (compiled, "changed"), (lines, "removed"), (new, "added")}
    told = "hypcheck's own file {} was {} while an implementation was asked"
    assert set(snapshot._changes()) == {told.format(*each) for each in said}


def test_ratios_and_errors_beyond_float64_are_infinite_or_the_smallest_number():
    assert _ratio(-(10**400), 1) == math.inf
    assert _ratio(-3, 2) == 1.5
    assert relative_error(Fraction(10) ** 400, Fraction(1)) == math.inf
    assert relative_error(1 + Fraction(1, 10**400), Fraction(1)) == math.ulp(0.0)


def test_relative_changes_and_answers_are_described_in_words():
    assert _change(math.inf) == "by no relative change up to 1"
    assert _change((0.25, math.inf)) == "by no relative change up to 1, and not if by 0.25 or less"
    assert answer_said(2, "position") == "2, cannot say"
    assert answer_said(127, "position") == "127, refused"
    assert answer_said(0, "exterior") == "0, not exterior"
