"""Files: the output appears whole or not at all, and no other file changes."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from hypcheck.cli.main import main
from hypcheck.geometry.pair import COLUMNS
from hypcheck.tables import streams

HEADER = ",".join(COLUMNS)
GOOD = "1,2,1,1,2.5,0,0"
ANSWER = f"{HEADER},position,label,tangent,clearance\n{GOOD},1,exterior,false,0.5\n"


@pytest.fixture
def source(tmp_path):
    path = tmp_path / "in.csv"
    path.write_text(f"{HEADER}\n{GOOD}\n")
    return path


def classify(source: object, target: object, *more: str) -> int:
    return main(["classify", "--input", str(source), "--output", str(target), *more])


@pytest.mark.parametrize("kind", ["csv", "npy"])
def test_classify_leaves_an_old_output_unchanged_if_a_row_is_bad(kind, tmp_path, source, capsys):
    source.write_text(f"{HEADER}\n" + f"{GOOD}\n" * 20_000 + "1,2,1,1,x,0,0\n")
    target = tmp_path / f"out.{kind}"
    target.write_text("old output")
    assert classify(source, target) == 2
    assert sorted(os.listdir(tmp_path)) == ["in.csv", target.name]
    assert target.read_text() == "old output"


def test_classify_writes_no_output_and_ends_with_6_if_oracles_disagree(tmp_path, source, monkeypatch, capsys):
    from hypcheck.truth import float_filter

    right = float_filter.filtered
    monkeypatch.setattr(float_filter, "filtered", lambda rows: -right(rows))
    assert classify(source, tmp_path / "out.csv") == 6
    assert os.listdir(tmp_path) == ["in.csv"]
    assert "two oracles disagree about alpha 1.0, gamma 2.0" in capsys.readouterr().err


def test_tangency_that_only_one_oracle_finds_is_a_disagreement(tmp_path, source, monkeypatch, capsys):
    from hypcheck.truth import nearest

    right = nearest.clearances

    def wrong(rows):
        found = right(rows)
        found.clearance[:] = 0.0
        return found

    monkeypatch.setattr(nearest, "clearances", wrong)
    assert classify(source, tmp_path / "out.csv") == 6
    assert os.listdir(tmp_path) == ["in.csv"]


def test_new_output_file_has_the_default_permissions(tmp_path, source):
    before = os.umask(0o027)
    try:
        assert classify(source, tmp_path / "out.csv") == 0
        (tmp_path / "any").touch()
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "out.csv").stat().st_mode) == stat.S_IMODE((tmp_path / "any").stat().st_mode)


def test_replaced_output_file_keeps_its_permissions(tmp_path, source):
    target = tmp_path / "out.csv"
    target.write_text("old")
    target.chmod(0o604)
    assert classify(source, target) == 0
    assert (target.read_text(), stat.S_IMODE(target.stat().st_mode)) == (ANSWER, 0o604)


def test_an_output_that_is_a_link_is_written_at_its_target(tmp_path, source):
    (tmp_path / "far").mkdir()
    (tmp_path / "link.csv").symlink_to(tmp_path / "far" / "out.csv")
    for _ in range(2):  # first it dangles, then it does not
        assert classify(source, tmp_path / "link.csv") == 0
        assert (tmp_path / "link.csv").is_symlink()
        assert (tmp_path / "far" / "out.csv").read_text() == ANSWER


def test_an_output_that_names_the_input_is_refused(tmp_path, source, capsys):
    (tmp_path / "soft.csv").symlink_to(source)
    os.link(source, tmp_path / "hard.csv")
    for target in (source, tmp_path / "soft.csv", tmp_path / "hard.csv", tmp_path / "." / "in.csv"):
        assert classify(source, target) == 2
        assert "is the input itself" in capsys.readouterr().err
    assert source.read_text() == f"{HEADER}\n{GOOD}\n"


def test_an_output_that_is_a_pipe_is_written_directly(tmp_path, source):
    """A pipe stands for every device: a failure would destroy a real one."""
    pipe = tmp_path / "pipe.csv"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    try:
        assert classify(source, pipe) == 0
        assert os.read(reader, 1000).decode() == ANSWER
    finally:
        os.close(reader)
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    assert sorted(os.listdir(tmp_path)) == ["in.csv", "pipe.csv"]


def refused(capsys: pytest.CaptureFixture[str], source: object, target: object, *more: str) -> str:
    assert classify(source, target, *more) == 2
    errors = capsys.readouterr().err
    assert errors.count("\n") == 1
    return errors.removeprefix("hypcheck: error: ").removesuffix("\n")


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a device that is always full")
def test_an_output_on_a_full_disk_is_named_with_the_reason_and_nothing_is_left(tmp_path, source, capsys, small_files):
    assert refused(capsys, source, "/dev/full", "--format", "csv") == "cannot write /dev/full: no space left on device"
    out = tmp_path / "out.csv"
    small_files(0)
    said = refused(capsys, source, out)
    small_files(None)
    assert said == f"cannot write {out}: file too large"
    assert sorted(os.listdir(tmp_path)) == ["in.csv"]


def test_table_that_cannot_be_opened_is_refused_with_the_reason(tmp_path, source, capsys, monkeypatch):
    out = tmp_path / "out.csv"
    assert refused(capsys, tmp_path / "no.csv", out) == f"cannot read {tmp_path / 'no.csv'}: no such file or directory"
    (tmp_path / "d.csv").mkdir()
    assert refused(capsys, tmp_path / "d.csv", out) == f"cannot read {tmp_path / 'd.csv'}: is a directory"
    assert refused(capsys, source, tmp_path / "d.csv") == f"cannot write {tmp_path / 'd.csv'}: it is a folder"
    away = tmp_path / "no" / "out.csv"
    assert refused(capsys, source, away) == f"cannot write {away}: no such file or directory"
    below = source / "out.csv"
    assert refused(capsys, source, below) == f"cannot write {below}: not a directory"
    no_name = refused(capsys, source, "a\0b.csv")  # in the words of each Python
    assert no_name.startswith("cannot write a\\x00b.csv: ")
    assert "embedded null" in no_name
    assert refused(capsys, f"{'n' * 300}.csv", out).endswith(": file name too long")
    assert sorted(os.listdir(tmp_path)) == ["d.csv", "in.csv"]


def test_classify_leaves_files_alone_that_it_may_not_read_or_write(tmp_path, source, capsys, monkeypatch):
    """The rights are taken away by a stand-in for the system, since a superuser may do everything."""
    target = tmp_path / "out.csv"
    target.write_text("old")
    with monkeypatch.context() as patch:
        patch.setattr(streams.os, "access", lambda path, _: Path(path) != target)
        assert refused(capsys, source, target) == f"cannot write {target}: permission denied"
    assert target.read_text() == "old"

    def forbidden(path, *_):
        raise PermissionError(13, "Permission denied", path)

    with monkeypatch.context() as patch:
        patch.setattr("builtins.open", forbidden)
        assert refused(capsys, source, target) == f"cannot read {source}: permission denied"
    with monkeypatch.context() as patch:
        patch.setattr(streams.os, "open", forbidden)
        assert (
            refused(capsys, source, tmp_path / "new.csv") == f"cannot write {tmp_path / 'new.csv'}: permission denied"
        )
    with monkeypatch.context() as patch:
        patch.setattr(streams.os, "replace", forbidden)
        assert refused(capsys, source, target) == f"cannot write {target}: permission denied"
    assert sorted(os.listdir(tmp_path)) == ["in.csv", "out.csv"]


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="a superuser may read and write everything")
def test_files_without_permission_are_refused_naming_the_reason(tmp_path, source, capsys):
    source.chmod(0)
    assert refused(capsys, source, tmp_path / "out.csv") == f"cannot read {source}: permission denied"
    source.chmod(0o600)
    tmp_path.chmod(0o500)
    assert refused(capsys, source, tmp_path / "out.csv").endswith("out.csv: permission denied")
    tmp_path.chmod(0o700)


@pytest.mark.parametrize(
    ("source", "target", "more", "sentence"),
    [
        (
            "in",
            "out.csv",
            [],
            "--input in: its name must end in .csv, .jsonl or .npy, or --format must name one of them",
        ),
        ("-", "out.csv", [], "--input -: its name must end in .csv, .jsonl or .npy, or --format must name one of them"),
        (
            "in.csv",
            "out.txt",
            [],
            "--output out.txt: its name must end in .csv, .jsonl or .npy, or --format must name one of them",
        ),
        ("in.csv", "out.jsonl", [], "csv cannot become jsonl, "),
        ("in.jsonl", "-", ["--format", "csv"], "jsonl cannot become csv, "),
        (
            "in.csv",
            "out.csv",
            ["--format", "npy"],
            "--format npy contradicts the names in.csv and out.csv; leave it out",
        ),
    ],
)
def test_classify_refuses_table_formats_that_are_unclear_or_do_not_match(source, target, more, sentence, capsys):
    assert refused(capsys, source, target, *more).startswith(sentence)


def test_option_format_sets_the_format_of_a_file_name_without_an_ending(tmp_path, source):
    source.rename(tmp_path / "in")
    assert classify(tmp_path / "in", tmp_path / "out", "--format", "csv") == 0
    assert (tmp_path / "out").read_text() == ANSWER
    assert classify(tmp_path / "in", tmp_path / "out.npy", "--format", "csv") == 0
    assert np.load(tmp_path / "out.npy").tolist() == [1]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no named pipes")
@pytest.mark.parametrize(
    "words", [("cases", "check"), ("report",), ("record", "check"), ("record", "repair", "--out", "new")], ids=" ".join
)
def test_a_pipe_that_nobody_writes_to_is_refused_where_a_file_is_read(monkeypatch, tmp_path, capsys, words):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(streams, "PIPE_S", 0.1)  # ten seconds a command are long for a test
    os.mkfifo(tmp_path / "pipe")
    assert main([*words, str(tmp_path / "pipe")]) == 2
    said = capsys.readouterr().err
    assert "it is a pipe, and nothing was written to it within" in said
    assert len(said.splitlines()) == 1


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no named pipes")
def test_a_record_is_read_from_a_pipe_that_a_program_writes_to(tmp_path, capfd):
    os.mkfifo(tmp_path / "pipe")
    record = Path(__file__).parents[2] / "reports" / "reference" / "bench" / "record.jsonl"
    copy = "import shutil, sys; shutil.copyfileobj(open(sys.argv[1], 'rb'), open(sys.argv[2], 'wb'))"
    with subprocess.Popen([sys.executable, "-c", copy, str(record), str(tmp_path / "pipe")]):
        assert main(["record", "check", str(tmp_path / "pipe")]) == 0
