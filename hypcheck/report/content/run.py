"""The run itself: when, on what machine, with what versions and options."""

from __future__ import annotations

import json
from collections.abc import Iterator

from hypcheck.record import Record
from hypcheck.report.content.blocks import Code, Section, bullets
from hypcheck.report.text import counted, figure


def sections(record: Record) -> Iterator[Section]:
    """The section; every record has it."""
    header, machine = record.header, record.header["machine"]
    versions = {"hypcheck": header["hypcheck"], "Python": header["python"], **header["versions"]}
    seconds = f", took {figure(record.footer['seconds'])} s" if record.footer else ""
    processor = f"{machine['processor']}, {machine['architecture']}, {machine['system']}"
    cores = counted(machine["cores"], "core") if machine["cores"] else "cores unknown"
    items = (
        f"Started {header['started']}{seconds}.",
        f"Machine: {processor}, {cores}.",
        f"Versions: {', '.join(f'{name} {version}' for name, version in versions.items())}.",
        ("Options: ", Code(json.dumps(header["options"], ensure_ascii=False)), "."),
        "A case id, family/version/seed/index, names a generated case for ever.",
    )
    yield Section("The run", (bullets(items),))
