"""The one version: where it is written, and how it is raised everywhere at once."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import click

NUMBER = r"(?:0|[1-9]\d*)\.(?:0|[1-9]\d*)\.(?:0|[1-9]\d*)"
PRINTED = "hypcheck/kernel/core/hypcheck.h"
"""The generator prints it: a checksum of its own text, the version in it, names a macro."""

PLACES = {
    "hypcheck/version.py": rf'(VERSION = ")({NUMBER})"',
    "CITATION.cff": rf"(\nversion: )({NUMBER})\n",
    PRINTED: rf'(#define HYPCHECK_VERSION ")({NUMBER})"',
}
"""The files that say it. Manifests of Rust and JavaScript say 0.0.0; their archives get it from hypcheck/version.py."""

SYMBOLS = "packages/c/symbols.map"
"""Its node is named after the major version."""


def _found(root: Path, name: str) -> re.Match[str]:
    found = re.search(PLACES[name], (root / name).read_text(encoding="utf-8"))
    if found is None:
        raise click.ClickException(f"{name} says no version")
    return found


def versions(root: Path) -> dict[str, str]:
    """What each file says; of the symbol table the major version alone."""
    said = {name: _found(root, name)[2] for name in PLACES}
    node = re.search(r"^HYPCHECK_(\d+) {", (root / SYMBOLS).read_text(encoding="utf-8"), re.MULTILINE)
    return said | {SYMBOLS: node[1] if node else ""}


def raise_to(root: Path, version: str) -> None:
    """Write the version into all files. Raises ClickException for what is no version, or is not above today's."""
    if not re.fullmatch(NUMBER, version):
        raise click.ClickException(f"{version!r} is not a version; it must be three numbers, as 1.0.0 is")
    today = versions(root)["hypcheck/version.py"]
    if _numbers(version) <= _numbers(today):
        raise click.ClickException(f"{version} is not above {today}; a version that was used is not used again")
    for name in PLACES.keys() - {PRINTED}:
        found, text = _found(root, name), (root / name).read_text(encoding="utf-8")
        (root / name).write_text(text[: found.start(2)] + version + text[found.end(2) :], encoding="utf-8")
    subprocess.run([sys.executable, "-m", "hypcheck.kernel.core.generate"], cwd=root, check=True)
    table = (root / SYMBOLS).read_text(encoding="utf-8")
    node = f"HYPCHECK_{version.partition('.')[0]} {{"
    (root / SYMBOLS).write_text(re.sub(r"^HYPCHECK_\d+ {", node, table, flags=re.MULTILINE), encoding="utf-8")


def _numbers(version: str) -> tuple[int, ...]:
    return tuple(map(int, version.split(".")))
