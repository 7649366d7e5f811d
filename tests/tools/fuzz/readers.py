"""All readers of foreign data, as functions of bytes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from random import Random

from tests.tools.fuzz import faulty, files, seeds, sessions, words


@dataclass(frozen=True, slots=True)
class Reader:
    """What is read, by what, from which real input on, and how many of a thousand inputs are for it.

    `finish` makes of a mutated input what gets past a first check, now and then. One may take `seconds` of a processor.
    """

    read: Callable[[bytes], object]
    seeds: Callable[[], tuple[bytes, ...]]
    share: int
    finish: Callable[[bytes, Random], bytes] = lambda data, _: data
    seconds: float = 1.0


READERS = {
    "vectors": Reader(files.vectors, seeds.case_files, 60),
    "refusals": Reader(files.refusals, seeds.refusal_files, 40),
    "proofs": Reader(files.proofs, seeds.proved_files, 15),
    "record": Reader(files.record, seeds.records, 80, files.with_checksums),
    "repair": Reader(files.repaired, seeds.records, 30, files.with_checksums),
    "reports": Reader(files.reports, seeds.report_records, 14, files.with_checksums),
    "page": Reader(files.page, seeds.report_records, 14, files.with_checksums),
    "plots": Reader(files.plots, seeds.report_records, 2, files.with_checksums, seconds=10.0),
    "scene": Reader(files.scene, seeds.scenes, 70),
    "plan": Reader(files.plan, seeds.scenes, 10),
    "known-failures": Reader(files.known_failures, lambda: (seeds.KNOWN_FAILURES,), 60),
    "settings": Reader(files.settings, lambda: (seeds.SETTINGS,), 60),
    "description": Reader(words.description, lambda: seeds.DESCRIPTIONS, 60),
    "domain": Reader(words.domain, lambda: seeds.DOMAINS, 40),
    "command": Reader(sessions.command, lambda: seeds.COMMANDS, 80),
    "worker": Reader(sessions.worker, lambda: seeds.WORKERS, 60),
    "csv": Reader(files.table("csv"), lambda: seeds.TABLE_FILES["csv"], 60),
    "jsonl": Reader(files.table("jsonl"), lambda: seeds.TABLE_FILES["jsonl"], 60),
    "npy": Reader(files.table("npy"), lambda: seeds.TABLE_FILES["npy"], 60),
    "number": Reader(words.number, lambda: seeds.NUMBERS, 40),
    "spec": Reader(words.spec, lambda: seeds.SPECS, 40),
    "case": Reader(words.case, lambda: seeds.CASES, 25),
    "arguments": Reader(words.arguments, lambda: seeds.ARGUMENTS, 20),
}
assert sum(reader.share for reader in READERS.values()) == 1000

FAULTY = {
    read.__name__.replace("_", " "): Reader(read, lambda: (b"1",), 1)
    for read in (
        *(faulty.raises, faulty.speaks_in_colours, faulty.loops, faulty.sleeps, faulty.takes_a_gigabyte),
        *(faulty.keeps, faulty.dies),
    )
}
"""Readers that must be found out."""
