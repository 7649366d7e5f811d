"""Files: the output appears whole or not at all, and no other file changes."""

from __future__ import annotations

import lzma
import os
import stat
import sys
from pathlib import Path

import pytest

from hypcheck.cli.main import main
from hypcheck.geometry.pair import COLUMNS
from hypcheck.tables import streams
from tests.report import record_samples
from tests.support.inside import float_filter, nearest_rows

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


def test_a_path_that_the_system_cannot_have_is_refused_with_the_reason(source, capsys):
    nul = f"{source}\0.csv"
    for verb, words in (("read", (nul, f"{source}.npy")), ("write", (source, nul))):
        assert classify(*words) == 2
        assert f"cannot {verb} {source}" in (error := capsys.readouterr().err)
        assert error.endswith(": embedded null byte\n")


def test_a_compressed_file_is_read_as_its_decompressed_content(tmp_path, capsys):
    plain, packed = tmp_path / "record.jsonl", tmp_path / "record.jsonl.xz"
    plain.write_text(record_samples.text_and_record()[0], encoding="utf-8")
    packed.write_bytes(lzma.compress(plain.read_bytes()))
    assert main(["record", "check", str(packed)]) == main(["record", "check", str(plain)]) == 0
    first, second = capsys.readouterr().out.splitlines()
    assert first == second.replace(str(plain), str(packed))


def test_a_compressed_table_is_answered_as_its_decompressed_content(source, tmp_path):
    packed, target = tmp_path / "in.csv.xz", tmp_path / "out.csv"
    packed.write_bytes(lzma.compress(source.read_bytes()))
    assert classify(packed, target, "--format", "csv") == 0
    assert target.read_text(encoding="utf-8") == ANSWER


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (b"{}", "cannot read {}: input format not supported by decoder"),
        (lzma.compress(b"{}")[:-1], "cannot read {}: it is cut off, or holds more than 1 MiB"),
        (lzma.compress(bytes((1 << 20) + 1)), "cannot read {}: it is cut off, or holds more than 1 MiB"),
    ],
    ids=["not packed", "cut off", "too large"],
)
def test_a_packed_file_that_cannot_be_unpacked_is_refused_with_the_reason(tmp_path, capsys, monkeypatch, data, says):
    packed = tmp_path / "cases.json.xz"
    packed.write_bytes(data)
    monkeypatch.setattr(streams, "UNPACKED", 1 << 20)
    assert main(["cases", "check", str(packed)]) == 2
    assert capsys.readouterr().err == f"hypcheck: error: {says.format(packed)}\n"


def test_an_xz_file_is_refused_with_the_reason_if_python_has_no_lzma(tmp_path, capsys, monkeypatch):
    packed = tmp_path / "cases.json.xz"
    packed.write_bytes(lzma.compress(b"{}"))
    monkeypatch.setitem(sys.modules, "lzma", None)
    assert main(["cases", "check", str(packed)]) == 2
    assert capsys.readouterr().err == f"hypcheck: error: cannot read {packed}: this Python was built without lzma\n"


@pytest.mark.parametrize("kind", ["csv", "npy"])
def test_classify_leaves_an_old_output_unchanged_if_a_row_is_bad(kind, tmp_path, source, capsys):
    source.write_text(f"{HEADER}\n" + f"{GOOD}\n" * 20_000 + "1,2,1,1,x,0,0\n")
    target = tmp_path / f"out.{kind}"
    target.write_text("old output")
    assert classify(source, target) == 2
    assert sorted(os.listdir(tmp_path)) == ["in.csv", target.name]
    assert target.read_text() == "old output"


def test_classify_writes_no_output_and_ends_with_6_if_oracles_disagree(tmp_path, source, monkeypatch, capsys):

    right = float_filter.filtered
    monkeypatch.setattr(float_filter, "filtered", lambda rows: -right(rows))
    assert classify(source, tmp_path / "out.csv") == 6
    assert os.listdir(tmp_path) == ["in.csv"]
    assert "two oracles disagree about alpha 1.0, gamma 2.0" in capsys.readouterr().err


def test_tangency_that_only_one_oracle_finds_is_a_disagreement(tmp_path, source, monkeypatch, capsys):

    right = nearest_rows.clearances

    def wrong(rows):
        found = right(rows)
        found.clearance[:] = 0.0
        return found

    monkeypatch.setattr(nearest_rows, "clearances", wrong)
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


def test_classify_does_not_change_a_file_that_it_may_not_write(tmp_path, source, capsys, monkeypatch):
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
