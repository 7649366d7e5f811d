"""What befalls the folder of a run: a removed record is not lost, a link is not followed, a full disk is named."""

from __future__ import annotations

import contextlib
import os
import shutil
import stat

import pytest
from msgspec import structs

from hypcheck.cli.running import recording
from hypcheck.errors import InputError, SystemLimitError
from hypcheck.record import read
from hypcheck.record.fields import Histogram, as_json, decoded
from hypcheck.record.lines import DescriptionPart, DriftLine, Retest
from hypcheck.record.progress import ProgressLine, SavedAllowance, SavedResult, SavedState, Tally
from hypcheck.record.reader import FILE, GROWING
from hypcheck.record.writer import GrowingFile
from tests.record.test_reading import DESCRIPTION

ONE = Tally(
    asked=1,
    counts={},
    mistakes={},
    dangerous=0,
    octaves={},
    size_bins=Histogram(),
    place_bins=Histogram(),
    worst=[],
    faults=[],
)
RESULT = SavedResult(
    tallies={"ring": ONE}, pending=[], retest=Retest(asked=0, within=0, beyond=0), outcomes=[], excusing=[], named=[]
)
BEGUN = SavedState(done=1, left=SavedAllowance(restarts=0), total=RESULT)
PROGRESS = ProgressLine(number=0, declared=decoded(DESCRIPTION, DescriptionPart), cases=1, state=BEGUN)


@pytest.mark.parametrize("end", [None, KeyboardInterrupt, SystemLimitError("no memory")])
@pytest.mark.parametrize("gone", ["folder", "file", "another"])
def test_a_record_that_is_removed_during_its_run_is_written_again(tmp_path, gone, end):
    out = tmp_path / "out"

    def removes():
        if gone == "folder":
            shutil.rmtree(out)
        else:
            (out / GROWING).unlink()
        if gone == "another":
            (out / GROWING).write_text("of another run")
        if end:
            raise end

    with contextlib.suppress(KeyboardInterrupt, SystemLimitError), recording(out, {}) as running:
        running.recorder.add(DriftLine(sentence="before"))
        removes()
    assert not (out / GROWING).exists()
    record = read(out / FILE)
    assert [line.sentence for line in record.lines] == ["before"]
    assert bool(record.footer) is (end is None)


@pytest.mark.parametrize("keeps", [True, False])
def test_a_run_whose_folder_was_replaced_by_a_file_ends_with_an_error_that_names_it(tmp_path, keeps):
    out = tmp_path / "out"

    def run():
        with recording(out, {}) as running:
            shutil.rmtree(out)
            out.write_text("a file")
            if keeps:
                running.recorder.keep(PROGRESS)

    with pytest.raises(InputError, match="out is not a folder any more; it was replaced or removed during the run"):
        run()
    assert out.read_text() == "a file"


def test_growing_file_shows_added_bytes_and_is_replaced_only_after_the_new_content_is_synced(tmp_path, monkeypatch):
    path, synced = tmp_path / "file", []
    monkeypatch.setattr(os, "fsync", lambda number: synced.append((os.fstat(number).st_size, path.read_bytes())))
    path.write_bytes(b"before")
    with GrowingFile(path) as file:
        file.renew(b"first")
        file.write(b", second")
        assert path.read_bytes() == b"first, second"
        assert (file.is_there, path.unlink(), file.is_there) == (True, None, False)
    assert synced == [(len(b"first"), b"before")]


def test_progress_begins_a_record_only_if_something_was_tested(tmp_path):
    nothing = structs.replace(PROGRESS, state=structs.replace(BEGUN, total=structs.replace(RESULT, tallies={})))
    with recording(tmp_path, {}) as running:
        there = []
        for progress in (nothing, PROGRESS):
            running.recorder.keep(progress)
            there.append((tmp_path / GROWING).exists())
    assert there == [False, True]


@pytest.mark.parametrize("how", ["keep", "add"])
def test_a_run_on_a_full_disk_ends_with_an_error_about_its_record_and_keeps_the_lines_so_far(
    tmp_path, small_files, how
):
    def run():
        with recording(tmp_path, {}) as running:
            assert not running.recorder.goes_on
            running.recorder.keep(PROGRESS)
            assert running.recorder.goes_on
            small_files((tmp_path / GROWING).stat().st_size + 9)
            if how == "add":
                running.recorder.add(DriftLine(sentence="r"))
            running.recorder.keep(structs.replace(PROGRESS, cases=10**12))

    with pytest.raises(InputError, match=f"cannot write {tmp_path / GROWING}: file too large"):
        run()
    small_files(None)
    assert as_json(read(tmp_path / FILE).lines[0]) == as_json(PROGRESS)


def test_symbolic_links_in_the_folder_of_a_run_are_replaced_and_not_followed(tmp_path):
    """A pipe without a reader is replaced as well, and not waited for."""
    out, precious = tmp_path / "out", tmp_path / "precious"
    out.mkdir()
    precious.write_text("precious")
    for name in (GROWING, f"{GROWING}.new", FILE, "summary.json", "report.md"):
        (out / name).symlink_to(precious)
    os.mkfifo(out / "junit.xml")

    with recording(out, {}) as running:
        running.recorder.keep(PROGRESS)
        (out / f"{GROWING}.new").symlink_to(precious)  # again, before the record is renewed once more
    assert precious.read_text() == "precious"
    assert not [path.name for path in out.iterdir() if not stat.S_ISREG(path.lstat().st_mode)]
    assert read(out / FILE).footer
