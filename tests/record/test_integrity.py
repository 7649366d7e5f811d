"""Every damage to the bytes of a record is detected, and a cut is never taken for an end."""

from __future__ import annotations

import io
import zlib
from fractions import Fraction
from itertools import combinations

import pytest

from hypcheck.errors import InputError
from hypcheck.record.integrity import DamagedError, RecordScan, check, repair, sealed
from hypcheck.tables.streams import Reader
from tests.support.records import resealed

LINES = [
    {"type": "header", "schema": "1.2.0"},
    {"type": "drift", "sentence": 'α "\\'},
    {"type": "drift", "sentence": "again"},
    {"type": "footer", "lines": 4, "exit_code": 0},
]


@pytest.fixture
def data():
    return resealed(LINES)


def outcome(data):
    """The result of reading it (refused, truncated, whole), and the lines that were read."""
    scan = RecordScan(Reader(io.BytesIO(data), "it"))
    try:
        lines = list(scan)
    except InputError:
        return "refused", []
    return ("whole" if scan.footer else "truncated"), lines


def test_unchanged_record_is_read_as_complete(data):
    assert outcome(data) == ("whole", LINES)


@pytest.mark.thorough
def test_a_record_with_one_changed_byte_is_refused_except_at_the_last_line_end(data):
    for place, byte in enumerate(data):
        for other in range(256):
            if other == byte:
                continue
            found, lines = outcome(data[:place] + bytes([other]) + data[place + 1 :])
            if place < len(data) - 1:
                assert found == "refused", (place, other)
            else:
                assert (found, lines) == ("truncated", LINES[:-1])


def test_a_record_cut_at_any_byte_is_read_up_to_its_last_whole_line(data):
    for length in range(len(data)):
        whole = data.count(b"\n", 0, length)
        assert outcome(data[:length]) == (("truncated", LINES[:whole]) if whole else ("refused", []))


@pytest.mark.thorough
def test_a_record_with_a_byte_lost_or_added_is_refused_except_for_cuts_and_windows_line_ends(data):
    for place in range(len(data)):
        found, lines = outcome(data[:place] + data[place + 1 :])
        assert found == "refused" or (place == len(data) - 1 and (found, lines) == ("truncated", LINES[:-1]))
        for added in range(256):
            changed = data[:place] + bytes([added]) + data[place:]
            harmless = added == ord("\r") and data[place : place + 1] == b"\n"
            found, lines = outcome(changed)
            assert found == "refused" or (harmless and (found, lines) == ("whole", LINES)), (place, added)


def test_a_record_with_a_line_lost_doubled_or_moved_is_refused(data):
    lines = data.splitlines(keepends=True)
    for place in range(len(lines) - 1):
        assert outcome(b"".join(lines[:place] + lines[place + 1 :]))[0] == "refused"
    for place in range(len(lines)):
        assert outcome(b"".join([*lines[: place + 1], *lines[place:]]))[0] == "refused"
    for first, second in combinations(range(len(lines)), 2):
        moved = list(lines)
        moved[first], moved[second] = moved[second], moved[first]
        assert outcome(b"".join(moved))[0] == "refused"


def test_a_line_from_another_record_is_refused_at_the_same_place(data):
    others = resealed([{"type": "header", "schema": "1.2.0", "seed": 2}, *LINES[1:]]).splitlines(keepends=True)
    lines = data.splitlines(keepends=True)
    for place in range(1, len(lines)):
        assert outcome(b"".join([*lines[:place], *others[place:]]))[0] == "refused"


def test_a_record_cannot_lose_its_checksums_by_calling_itself_older(data):
    assert outcome(data.replace(b"1.2.0", b"1.0.0"))[0] == "refused"


def test_damaged_record_is_refused_naming_the_line_and_byte(data):
    start = data.index(b"\n") + 1
    with pytest.raises(DamagedError, match=f"^it is damaged in line 2, at byte {start}: its checksum is") as caught:
        list(RecordScan(Reader(io.BytesIO(data.replace(b"\\\\", b"/\\")), "it")))
    assert caught.value.at == start


def test_checksum_of_a_record_line_covers_all_earlier_bytes_except_checksums_and_line_ends(data):
    check = 0
    for line in data.splitlines():
        body, _, end = line.rpartition(b', "crc32": ')
        check = zlib.crc32(body, check)
        assert end == b'"%08x"}' % check


@pytest.mark.parametrize("line", [b"[1]", b'"header"', b"3", b'{"type": 3}', b'{"types": "header"}'])
def test_a_first_line_that_is_not_an_object_with_a_type_is_refused(line):
    with pytest.raises(InputError, match="it is not an object with a type"):
        list(RecordScan(Reader(io.BytesIO(line + b"\n"), "it")))


def test_a_later_line_without_a_type_is_refused():
    with pytest.raises(InputError, match="it is not an object with a type"):
        list(RecordScan(Reader(io.BytesIO(resealed([LINES[0], {"types": "drift"}, *LINES[2:]])), "it")))


def test_a_line_is_written_in_utf_8_and_a_number_that_json_cannot_hold_is_refused():
    assert "α".encode() in sealed(LINES[1], 0)[0]
    for number in (float("nan"), float("inf")):
        with pytest.raises(ValueError, match="not JSON compliant"):
            sealed({"type": "drift", "sentence": number}, 0)


@pytest.mark.parametrize("number", ["1e999", "-1e999", "1" + "0" * 400])
def test_a_number_that_is_too_large_for_float64_is_refused(number):
    line = b'{"type": "header", "schema": "1.0.0", "seed": %s}\n' % number.encode()
    with pytest.raises(InputError, match="is too large for float64"):
        list(RecordScan(Reader(io.BytesIO(line), "it")))


@pytest.mark.parametrize("number", ["1e300", "-2.5e+100", "0.12345678901234567890123"])
def test_a_number_with_many_digits_or_a_large_exponent_is_read_as_the_nearest_float64(number):
    line = b'{"type": "header", "schema": "1.0.0", "seed": %s}\n' % number.encode()
    assert next(iter(RecordScan(Reader(io.BytesIO(line), "it"))))["seed"] == float(Fraction(number))


def test_a_large_integer_that_float64_holds_is_read_as_it_is():
    line = b'{"type": "header", "schema": "1.0.0", "seed": %d}\n' % 10**300
    assert next(iter(RecordScan(Reader(io.BytesIO(line), "it"))))["seed"] == 10**300


def test_a_line_may_be_as_long_as_the_longest_and_no_longer(data):
    longest = max(map(len, data.splitlines(keepends=True)))
    assert list(RecordScan(Reader(io.BytesIO(data), "it"), longest - 1)) == LINES  # and its end
    with pytest.raises(InputError, match=f"it is longer than {longest - 2} bytes"):
        list(RecordScan(Reader(io.BytesIO(data), "it"), longest - 2))


def test_a_record_with_other_line_ends_is_read_as_it_was_written(data):
    assert outcome(data.replace(b"\n", b"\r\n")) == ("whole", LINES)


def test_a_cut_last_line_and_every_line_after_a_damaged_one_count_as_lost(data, tmp_path):
    record = tmp_path / "record.jsonl"
    record.write_bytes(data[:-5])
    found = check(record)
    assert (found.lines, found.lost_lines, found.size + found.lost_bytes) == (3, 1, len(data) - 5)
    record.write_bytes(data.replace(b"again", b"AGAIN")[:-5])
    found = repair(record, tmp_path / "good.jsonl")
    assert (found.lines, found.lost_lines, found.complete) == (2, 2, False)
    assert "damaged" in found.why or "checksum" in found.why
    assert (tmp_path / "good.jsonl").read_bytes() == resealed(LINES[:2])


def test_all_bytes_after_a_damaged_line_count_as_lost_even_megabytes(data, tmp_path):
    """More than what is read at a time."""
    record, more = tmp_path / "record.jsonl", b"x" * (1 << 21) + b"\n"
    record.write_bytes(data.replace(b"again", b"AGAIN") + more)
    found = repair(record, tmp_path / "good.jsonl")
    assert found.size + found.lost_bytes == len(data) + len(more)
    assert (found.lines, found.lost_lines) == (2, 3)
