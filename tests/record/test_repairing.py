"""`hypcheck record`: check reports the condition of a file, and repair saves its good lines."""

from __future__ import annotations

import pytest

from hypcheck.cli.main import main
from hypcheck.record import read
from hypcheck.record.lines import DriftLine
from tests.record.test_reading import HEADER
from tests.support.records import resealed

LINES = [
    {**HEADER, "schema": "1.2.0"},
    {"type": "drift", "sentence": "one"},
    {"type": "drift", "sentence": "two"},
    {"type": "footer", "lines": 4, "exit_code": 6, "seconds": 0.5},
]


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "record.jsonl"
    path.write_bytes(resealed(LINES))
    return path


def asked(capsys, *words):
    code = main(["record", *map(str, words)])
    told = capsys.readouterr()
    assert told.err.count("\n") <= 1
    return code, told.out + told.err


def test_record_check_of_a_complete_record_ends_0(path, capsys):
    code, text = asked(capsys, "check", path)
    assert code == 0
    assert (
        f"4 good lines, {path.stat().st_size} bytes, with their checksums; it is complete, of a run that ended with 6"
        in text
    )


@pytest.mark.parametrize("cut", [1, 100])
def test_record_check_of_a_cut_record_ends_1(path, capsys, cut):
    path.write_bytes(path.read_bytes()[:-cut])
    code, text = asked(capsys, "check", path)
    assert code == 1
    assert "bytes (1 line) from byte" in text


def test_record_repair_counts_a_single_lost_byte(path, capsys, tmp_path):
    size = path.stat().st_size
    path.write_bytes(path.read_bytes() + b"\n")
    code, text = asked(capsys, "repair", path, "--out", tmp_path / "saved.jsonl")
    assert code == 0
    assert f"; 1 byte (1 line) from byte {size} on is lost" in text


def test_record_check_of_a_record_without_a_footer_ends_1(path, capsys):
    path.write_bytes(b"".join(path.read_bytes().splitlines(keepends=True)[:-1]))
    code, text = asked(capsys, "check", path)
    assert code == 1
    assert "3 good lines" in text
    assert "it has no footer" in text


def test_a_damaged_record_is_refused_and_repaired_up_to_the_damage(path, capsys, tmp_path):
    data = path.read_bytes()
    path.write_bytes(data.replace(b"two", b"twt"))
    start = data.index(b'{"type": "drift", "sentence": "two"')
    code, text = asked(capsys, "check", path)
    assert code == 2
    assert f"is damaged in line 3, at byte {start}: its checksum is" in text
    saved = tmp_path / "saved.jsonl"
    code, text = asked(capsys, "repair", path, "--out", saved)
    assert code == 0
    assert f"2 good lines, {start} bytes" in text
    assert f"{len(data) - start} bytes (2 lines) from byte {start} on are lost" in text
    assert "its checksum is" in text
    assert saved.read_bytes() == data[:start]
    assert read(saved).footer is None
    assert read(saved).lines == (DriftLine(sentence="one"),)


def test_repair_of_a_cut_record_drops_its_half_line(path, capsys, tmp_path):
    data = path.read_bytes()
    path.write_bytes(data[:-1])
    saved = tmp_path / "saved.jsonl"
    assert asked(capsys, "repair", path, "--out", saved)[0] == 0
    assert saved.read_bytes() == b"".join(data.splitlines(keepends=True)[:-1])


def test_repair_of_a_complete_record_copies_it(path, capsys, tmp_path):
    code, text = asked(capsys, "repair", path, "--out", tmp_path / "saved.jsonl")
    assert code == 0
    assert "it is complete" in text
    assert (tmp_path / "saved.jsonl").read_bytes() == path.read_bytes()


def test_repair_of_a_record_with_a_damaged_header_writes_nothing(path, capsys, tmp_path):
    path.write_bytes(path.read_bytes().replace(b"header", b"heades"))
    code, text = asked(capsys, "repair", path, "--out", tmp_path / "saved.jsonl")
    assert code == 2
    assert "is damaged in line 1, at byte 0" in text
    assert sorted(tmp_path.iterdir()) == [path]


def test_repair_refuses_to_replace_the_record_itself(path, capsys):
    data = path.read_bytes()
    code, text = asked(capsys, "repair", path, "--out", path)
    assert code == 2
    assert "is the record itself; name another file" in text
    assert path.read_bytes() == data
