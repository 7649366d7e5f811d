"""Builds the packages of other languages: `python -m packages [LANGUAGE ...] --out FOLDER`.

Each is one archive, named after the language and the version of `hypcheck/version.py`. The same tree gives the same
bytes on every machine: entries are sorted, belong to nobody, and have one date.
"""

from __future__ import annotations

import gzip
import io
import tarfile
from collections.abc import Mapping
from pathlib import Path

import click

from hypcheck.version import VERSION

ROOT = Path(__file__).resolve().parents[1]
HEADER = ROOT / "hypcheck" / "kernel" / "core" / "hypcheck.h"
DATE = 315532800  # 1 January 1980, the earliest that a zip file can hold, in seconds


def c_files() -> dict[str, Path]:
    """The files of the package for C and C++, by their names in it: the folder packages/c, the header, the licence."""
    folder = ROOT / "packages" / "c"
    own = {path.relative_to(folder).as_posix(): path for path in folder.rglob("*") if path.is_file()}
    return own | {"hypcheck.h": HEADER, "LICENSE": ROOT / "LICENSE"}


def archive(name: str, files: Mapping[str, Path]) -> bytes:
    """A gzipped tar of the files, below a folder of the name."""
    tar = io.BytesIO()
    with tarfile.open(fileobj=tar, mode="w", format=tarfile.USTAR_FORMAT) as target:
        for path in sorted(files):
            content = files[path].read_bytes()
            entry = tarfile.TarInfo(f"{name}/{path}")
            entry.size, entry.mtime, entry.mode = len(content), DATE, 0o644
            target.addfile(entry, io.BytesIO(content))
    packed = io.BytesIO()
    with gzip.GzipFile(fileobj=packed, mode="wb", filename="", mtime=DATE) as target:
        target.write(tar.getvalue())
    return packed.getvalue()


LANGUAGES = {"c": c_files}


@click.command()
@click.argument("languages", nargs=-1, type=click.Choice(sorted(LANGUAGES)))
@click.option("--out", type=click.Path(file_okay=False, path_type=Path), default=Path("dist"), show_default=True)
def main(languages: tuple[str, ...], out: Path) -> None:
    """Build the packages of these languages, or of all."""
    out.mkdir(parents=True, exist_ok=True)
    for language in languages or sorted(LANGUAGES):
        name = f"hypcheck-{language}-{VERSION}"
        target = out / f"{name}.tar.gz"
        target.write_bytes(archive(name, LANGUAGES[language]()))
        click.echo(target)


if __name__ == "__main__":
    main()
