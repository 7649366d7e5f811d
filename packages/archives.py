"""Archives of C, JavaScript and Rust: what is in each, and a tar whose bytes depend on that alone.

Each is named after the language and the version of `hypcheck/version.py`. The same tree gives the same bytes on every
machine: entries are sorted, belong to nobody, and have one date.
"""

from __future__ import annotations

import base64
import gzip
import io
import re
import shutil
import subprocess
import tarfile
import tempfile
from collections.abc import Callable, Collection, Mapping
from pathlib import Path

import click

from hypcheck.version import VERSION

ROOT = Path(__file__).resolve().parents[1]
HEADER = ROOT / "hypcheck" / "kernel" / "core" / "hypcheck.h"
MADE = {"target", "Cargo.lock", "node_modules", "__pycache__"}
"""What other tools leave in the folders of packages."""

SOURCE = "wasm/hypcheck.c"
WEBASSEMBLY = (
    "--target=wasm32", "-std=gnu99", "-O2", "-mbulk-memory", "-ffreestanding", "-fbuiltin", "-nostdlib",
    f"-I{ROOT / 'packages' / 'javascript' / 'wasm'}", f"-I{HEADER.parent}",
    "-Wl,--no-entry", "-Wl,--strip-all", "-Wl,-z,stack-size=1048576",
)  # fmt: skip
"""How clang compiles the source; a megabyte of stack is ten times what the header needs."""

DATE = 315532800
"""Of every entry, in seconds: 1 January 1980, the earliest that a zip file can hold."""


def _files(language: str, header: str | None) -> dict[str, bytes]:
    """The files of a package, by their names in it: its folder, with the version filled in, the header, the licence."""
    folder = ROOT / "packages" / language
    paths = (path.relative_to(folder) for path in folder.rglob("*") if path.is_file())
    own = {path.as_posix(): (folder / path).read_bytes() for path in paths if not MADE.intersection(path.parts)}
    own |= {name: _versioned(own[name]) for name in ("Cargo.toml", "package.json") if name in own}
    own["LICENSE"] = (ROOT / "LICENSE").read_bytes()
    return own if header is None else own | {header: HEADER.read_bytes()}


def _versioned(manifest: bytes) -> bytes:
    """The manifest with the version of hypcheck in place of 0.0.0."""
    if manifest.count(b'"0.0.0"') != 1:
        raise click.ClickException("a manifest must say the version 0.0.0 once, which is replaced")
    return manifest.replace(b'"0.0.0"', f'"{VERSION}"'.encode())


def _javascript() -> dict[str, bytes]:
    """The package for JavaScript, with the header as WebAssembly, in text that everything loads alike."""
    files = {name: content for name, content in _files("javascript", None).items() if not name.startswith("wasm/")}
    return files | {"wasm.mjs": b'export const base64 = "%s";\n' % base64.b64encode(_webassembly())}


def _webassembly() -> bytes:
    clang, linker = shutil.which("clang"), shutil.which("wasm-ld")
    if clang is None or linker is None:
        raise click.ClickException("the package for JavaScript needs clang and wasm-ld (Debian: clang, lld)")
    symbols = re.findall(r"^ {8}(\w+);$", (ROOT / "packages" / "c" / "symbols.map").read_text("utf-8"), re.MULTILINE)
    exports = [f"-Wl,--export={symbol}" for symbol in (*symbols, "__heap_base")]
    with tempfile.TemporaryDirectory() as folder:
        command = [clang, *WEBASSEMBLY, *exports, "-o", "hypcheck.wasm", str(ROOT / "packages" / "javascript" / SOURCE)]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)  # noqa: S603
        if done.returncode:
            raise click.ClickException(f"clang cannot make WebAssembly of {SOURCE}: {done.stderr.strip()}")
        return (Path(folder) / "hypcheck.wasm").read_bytes()


def archive(name: str, files: Mapping[str, bytes], programs: Collection[str] = ()) -> bytes:
    """A gzipped tar of the files, below a folder of the name; `programs` are those that may be executed."""
    tar = io.BytesIO()
    with tarfile.open(fileobj=tar, mode="w", format=tarfile.USTAR_FORMAT) as target:
        for path in sorted(files):
            content = files[path]
            entry = tarfile.TarInfo(f"{name}/{path}")
            entry.size, entry.mtime, entry.mode = len(content), DATE, 0o755 if path in programs else 0o644
            target.addfile(entry, io.BytesIO(content))
    packed = io.BytesIO()
    with gzip.GzipFile(fileobj=packed, mode="wb", filename="", mtime=DATE) as target:
        target.write(tar.getvalue())
    return packed.getvalue()


LANGUAGES: dict[str, Callable[[], dict[str, bytes]]] = {
    "c": lambda: _files("c", "hypcheck.h"),
    "javascript": _javascript,
    "rust": lambda: _files("rust", "src/hypcheck.h"),
}


def build(language: str, out: Path) -> list[Path]:
    """The archive of a language, written into the folder."""
    name = f"hypcheck-{language}-{VERSION}"
    target = out / f"{name}.tar.gz"
    target.write_bytes(archive(name, LANGUAGES[language]()))
    return [target]
