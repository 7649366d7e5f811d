"""Archives of the packages for other languages, and commands on what is in them."""

from __future__ import annotations

import subprocess
import sys
import tarfile
from pathlib import Path

from hypcheck.version import VERSION

ROOT = Path(__file__).resolve().parents[2]


def quietly(*command, **options):
    """What a command that must succeed prints."""
    done = subprocess.run([*map(str, command)], capture_output=True, text=True, check=False, **options)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def packed(folder, name):
    """The archive of a language, built into the folder."""
    quietly(sys.executable, "-m", "packages", "build", name, "--out", folder, cwd=ROOT)
    return folder / f"hypcheck-{name}-{VERSION}.tar.gz"


def unpacked_archive(archive):
    """The folder that an archive holds, beside it."""
    with tarfile.open(archive) as files:
        files.extractall(archive.parent)  # noqa: S202
    return archive.parent / archive.name.removesuffix(".tar.gz")


def gate(folder, spec, *options):
    """What `hypcheck verify SPEC` says in this folder."""
    return quietly(sys.executable, "-m", "hypcheck", "verify", spec, *options, "--out", "report", cwd=folder)
