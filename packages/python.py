"""The sdist, the wheel of this machine, and the wheel without compiled parts, which every machine can use.

All are built from the files that git tracks, and the same files give the same bytes: dates are those of archives.py,
modes are two, and nobody owns anything.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

import click

from packages.archives import DATE, ROOT, archive

KINDS = {"sdist": {}, "wheel": {}, "pure": {"HYPCHECK_PURE": "1"}}
"""What is built, each with the variables that setup.py reads."""


def _copy_tracked(tree: Path) -> None:
    """The tracked files, with the two modes that git knows."""
    git = shutil.which("git") or "git"
    done = subprocess.run([git, "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=False)  # noqa: S603
    if done.returncode:
        raise click.ClickException("the packages for Python are built in a clone, from the files that git tracks")
    for name in done.stdout.split("\0"):
        if name and (ROOT / name).exists():
            target = tree / name
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / name, target)
            target.chmod(0o755 if os.access(ROOT / name, os.X_OK) else 0o644)


def _repacked(sdist: Path) -> bytes:
    """The sdist with sorted entries of one date; setuptools writes the times of files, and gzip that of its making."""
    with tarfile.open(sdist) as source:
        members = [member for member in source.getmembers() if member.isfile()]
        files = {member.name.partition("/")[2]: source.extractfile(member).read() for member in members}  # type: ignore[union-attr]
    programs = {member.name.partition("/")[2] for member in members if member.mode & 0o100}
    return archive(sdist.name.removesuffix(".tar.gz"), files, programs)


def build(kind: str, out: Path) -> list[Path]:
    """The sdist or a wheel, written into the folder, by what is installed: no package index is asked."""
    environment = os.environ | {"SOURCE_DATE_EPOCH": str(DATE)} | KINDS[kind]
    with tempfile.TemporaryDirectory() as folder:
        tree, made = Path(folder, "tree"), Path(folder, "made")
        _copy_tracked(tree)
        form = "--sdist" if kind == "sdist" else "--wheel"
        command = [sys.executable, "-m", "build", "--no-isolation", form, "--outdir", str(made), str(tree)]
        done = subprocess.run(command, env=environment, umask=0o022, capture_output=True, text=True, check=False)  # noqa: S603
        if done.returncode:
            raise click.ClickException(f"the {kind} cannot be built: {(done.stdout + done.stderr)[-2000:]}")
        (archive_made,) = made.iterdir()
        target = out / archive_made.name
        target.write_bytes(_repacked(archive_made) if kind == "sdist" else archive_made.read_bytes())
    return [target]
