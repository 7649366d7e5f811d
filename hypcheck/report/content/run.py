"""The run itself: when, on what machine, with what versions and options."""

from __future__ import annotations

import json
from collections.abc import Iterator

from hypcheck.record import Record
from hypcheck.report.claims import settings_facts
from hypcheck.report.content.blocks import Code, Section, Strong, bullets
from hypcheck.report.text import counted, figure


def settings(record: Record) -> Iterator[Section]:
    """The settings file of the run and what weakens its gate; none where every option is as strict as its default."""
    found = list(settings_facts(record.header.settings))
    if found:
        items = [Strong(f"{fact[:1].upper()}{fact[1:]}.") for fact in found]
        yield Section("Settings", (bullets(items),))


def sections(record: Record) -> Iterator[Section]:
    """The section; every record has it."""
    header, machine = record.header, record.header.machine
    versions = {"hypcheck": header.hypcheck, "Python": header.python, **header.versions}
    seconds = f", took {figure(record.footer.seconds)} s" if record.footer else ""
    processor = f"{machine.processor}, {machine.architecture}, {machine.system}"
    cores = counted(machine.cores, "core") if machine.cores else "cores unknown"
    items = (
        f"Started {header.started}{seconds}.",
        f"Machine: {processor}, {cores}.",
        f"Versions: {', '.join(f'{name} {version}' for name, version in versions.items())}.",
        ("Options: ", Code(json.dumps(header.options, ensure_ascii=False)), "."),
        "A case id, family/version/seed/index, names a generated case for ever.",
    )
    yield Section("The run", (bullets(items),))
