"""What must hold of archives before they are published: sizes, licences, what they are made of, and one version."""

from __future__ import annotations

import hashlib
import json
import subprocess
import sys
import tarfile
import zipfile
from collections.abc import Iterator
from pathlib import Path

from hypcheck.version import VERSION
from packages import sbom
from packages.archives import ROOT

LARGEST_WHEEL = 5_000_000
"""Bytes."""

LICENCES = ("LICENSE", "cases/LICENSE", "hypcheck/pictures/three/LICENSE")
"""Of a package for Python; all others hold the first alone."""


def archives(dist: Path) -> list[Path]:
    """The archives in a folder, in the order of their names."""
    return sorted(path for path in dist.glob("hypcheck-*") if path.name.endswith((".whl", ".tar.gz")))


def _contents(archive: Path) -> dict[str, bytes]:
    if archive.suffix == ".whl":
        with zipfile.ZipFile(archive) as files:
            return {name: files.read(name) for name in files.namelist()}
    with tarfile.open(archive) as tar:
        return {member.name: tar.extractfile(member).read() for member in tar if member.isfile()}  # type: ignore[union-attr]


def _faults_of(archive: Path) -> Iterator[str]:
    if sbom.version_of(archive) != VERSION:
        yield f"is of version {sbom.version_of(archive)}; the tree is of {VERSION}"
    if archive.suffix == ".whl" and archive.stat().st_size > LARGEST_WHEEL:
        yield f"has {archive.stat().st_size:,} bytes; a wheel has {LARGEST_WHEEL:,} at most"
    held = set(_contents(archive).values())
    wanted = LICENCES if sbom.ecosystem_of(archive) == "pypi" else LICENCES[:1]
    for name in wanted:
        if (ROOT / name).read_bytes() not in held:
            yield f"lacks the text of {name}"
    beside = archive.with_name(archive.name + sbom.SUFFIX)
    if not beside.is_file():
        yield f"has no {beside.name} beside it, which says what it is made of"
        return
    (said,) = json.loads(beside.read_text(encoding="utf-8"))["metadata"]["component"]["hashes"]
    if said["content"] != hashlib.sha256(archive.read_bytes()).hexdigest():
        yield f"is not the archive that {beside.name} describes"


def faults(dist: Path) -> list[str]:
    """A sentence for each fault of the archives in the folder; none: they may be published."""
    found = archives(dist)
    if not found:
        return [f"{dist} has no archives; `python -m packages build` makes them"]
    wrong = [f"{archive.name} {fault}" for archive in found for fault in _faults_of(archive)]
    python = [str(archive) for archive in found if sbom.ecosystem_of(archive) == "pypi"]
    if python:
        command = [sys.executable, "-m", "twine", "check", "--strict", *python]
        done = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603
        wrong += [f"twine: {done.stdout}{done.stderr}"] if done.returncode else []
    return wrong
