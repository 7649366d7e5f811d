"""Whether the file of a record is whole, and what of it can be saved where it is not."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from hypcheck.errors import InputError
from hypcheck.record.scanning import DamagedError, Scan
from hypcheck.tables.streams import Reader, reading, same_file, writing

_BLOCK = 1 << 20


@dataclass(frozen=True, slots=True)
class Condition:
    """What is in a file: its good lines and their bytes, what is lost behind them, and why (empty: it is cut off)."""

    schema: str
    sealed: bool
    lines: int
    size: int
    exit_code: object
    """As the footer has it, None without one."""

    complete: bool
    lost_bytes: int
    lost_lines: int
    why: str = ""


def check(path: Path) -> Condition:
    """The condition of a file that is whole, or cut off. Raises DamagedError and InputError as Scan does."""
    with reading(str(path)) as reader:
        scan = Scan(reader)
        for _ in scan:
            pass
        return _condition(scan, reader, "")


def repair(path: Path, target: Path) -> Condition:
    """Write everything up to the last good line to `target`, and say what was lost.

    Raises InputError where not even the header is good, and where the two are one file.
    """
    if same_file(str(path), str(target)):
        raise InputError(
            f"--out {target} is the record itself; name another file, so that what is lost can be looked at"
        )
    with reading(str(path)) as reader, writing(str(target)) as writer:
        scan, why = Scan(reader), ""
        try:
            for _ in scan:
                writer.write(scan.written)
        except DamagedError as error:
            if not scan.lines:
                raise
            why = str(error)
        return _condition(scan, reader, why)


def _condition(scan: Scan, reader: Reader, why: str) -> Condition:
    """The condition once the scan has ended; what it did not read is counted."""
    last = scan.written
    size, ends = len(last), last.count(b"\n")
    while block := reader.read(_BLOCK):
        size, ends, last = size + len(block), ends + block.count(b"\n"), block
    return Condition(
        schema=scan.header["schema"],
        sealed=scan.sealed,
        lines=scan.lines,
        size=scan.end,
        exit_code=scan.footer and scan.footer.get("exit_code"),
        complete=scan.footer is not None,
        lost_bytes=size,
        lost_lines=ends + (last != b"" and not last.endswith(b"\n")),
        why=why,
    )
