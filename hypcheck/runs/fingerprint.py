"""Fingerprints (SHA-256) of the files under test and of hypcheck's own code; files that the workers of a cluster lack.

The SPEC of a command names the program, if it is a path, and the words that are files on this machine. A program on the
PATH is not sent: each worker uses its own. A Python module is not sent either, but must have the same content
everywhere.

Two machines may have the same version of hypcheck but other files, if it is installed from a repository. Code under
test runs as the same user as hypcheck: it could overwrite the judge, or itself, during a run.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import struct
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from importlib.machinery import PathFinder
from importlib.util import cache_from_source
from pathlib import Path

import hypcheck
from hypcheck.errors import InputError, system_reason
from hypcheck.implementations.spec import is_file, parse_spec
from hypcheck.record import Recorder
from hypcheck.record.lines import DriftLine
from hypcheck.runs.started_files import started_files
from hypcheck.vectors.frozen import folder

_BLOCK_BYTES = 1 << 20


def fingerprints(specs: Iterable[str], *others: Path | None) -> dict[str, str]:
    """The sha256 of the files that SPECs name or start, and of other files, by path, as far as they exist."""
    named = [path for spec in specs for path in (*(file.path for file in files_of(spec)), *_started(spec))]
    paths = [*named, *(path for path in others if path is not None)]
    return {str(path): sha256(path) for path in dict.fromkeys(paths)}


def _started(spec: str) -> list[Path]:
    return [Path(path) for path in started_files(spec).paths]


def not_hashed(specs: Iterable[str]) -> list[str]:
    """The files that SPECs start and that only running them would show, in words without a full stop; once each."""
    return list(dict.fromkeys(sentence for spec in specs for sentence in started_files(spec).missing))


@dataclass(frozen=True, slots=True)
class NamedFile:
    """An existing file that word `word` of a SPEC names, by its path or (`searched`) by a name that is searched for."""

    word: int
    path: Path
    searched: bool


def files_of(text: str) -> Iterator[NamedFile]:
    """The files of a SPEC: a library, a Python file or module, or a command with those of its words that are files.

    Nothing is imported or run to find them. Raises InputError if the text is not a SPEC.
    """
    spec = parse_spec(text)
    if spec.kind == "builtin":
        return
    for word, name in enumerate(spec.words if spec.kind == "command" else spec.words[:1]):
        module = spec.kind == "python" and not is_file(name)
        program = spec.kind == "command" and word == 0 and os.sep not in name
        path = _module_file(name) if module else shutil.which(name) if program else name
        if path is not None and os.path.isfile(path):
            yield NamedFile(word, Path(path), module or program)


def sha256(path: Path) -> str:
    """The sha256 of a file's content, in hexadecimal; if it cannot be read, or is a pipe or device, the reason."""
    digest = hashlib.sha256()
    try:
        if path.exists() and not path.is_file():  # a pipe may block for ever
            return "is not a regular file"
        file = path.open("rb")
    except OSError as error:
        return system_reason(error)
    with file:
        while block := file.read(_BLOCK_BYTES):
            digest.update(block)
    return digest.hexdigest()


def _module_file(name: str) -> str | None:
    """The file of a module, found as the worker finds it: from the working directory first."""
    places: list[str] | None = [os.getcwd(), *sys.path]
    origin = None
    for depth in range(1, name.count(".") + 2):
        spec = PathFinder.find_spec(".".join(name.split(".")[:depth]), places)
        if spec is None:
            return None
        origin, places = spec.origin, list(spec.submodule_search_locations or ())
    return origin


@dataclass(frozen=True, slots=True)
class ShippedFile:
    """A file that word `word` of a SPEC names: its absolute path where the run began, its content, its permissions."""

    word: int
    path: str
    content: bytes
    mode: int

    @property
    def sha256(self) -> str:
        """The sha256 of the content, in hexadecimal."""
        return hashlib.sha256(self.content).hexdigest()


def files_to_ship(text: str) -> tuple[ShippedFile, ...]:
    """The files that a SPEC names by their paths. Raises InputError if one cannot be read."""
    files = []
    for named in files_of(text):
        if named.searched:
            continue
        path = named.path.absolute()
        try:
            files.append(ShippedFile(named.word, str(path), path.read_bytes(), path.stat().st_mode & 0o777))
        except OSError as error:
            raise InputError(f"{path} cannot be sent to a cluster: {system_reason(error)}") from None
    return tuple(files)


def spec_on_worker(text: str, files: tuple[ShippedFile, ...], worker: str, folder: Path) -> str:
    """The SPEC as a worker can open it: files that the worker lacks are written into the folder.

    Raises InputError if a file on the worker has different content.
    """
    spec = parse_spec(text)
    words = list(spec.words)
    for file in files:
        words[file.word] = _path_on_worker(file, worker, folder)
    if spec.kind == "command":
        return f"command:{json.dumps(words)}"
    return f"{spec.kind}:{':'.join(words)}" if files else text


def _path_on_worker(file: ShippedFile, worker: str, folder: Path) -> str:
    path = Path(file.path)
    if not path.is_file():
        place = folder / str(file.word) / os.path.basename(file.path)
        place.parent.mkdir()
        place.write_bytes(file.content)
        place.chmod(file.mode)
        return str(place)
    require_same_sha256(file.path, file.sha256, sha256(path), worker)
    return file.path


def require_same_sha256(what: str, here: str, there: str, worker: str) -> None:
    """Raise InputError naming the worker if the two hashes differ."""
    if here != there:
        raise InputError(f"{what} is another file on worker {worker}: sha256 {there} there, and {here} here")


def module_sha256(text: str) -> str:
    """The sha256 of the file of a SPEC's Python module, as it is found here; empty if the SPEC names no module."""
    spec = parse_spec(text)
    if spec.kind != "python" or is_file(spec.words[0]):
        return ""
    return next((sha256(file.path) for file in files_of(text)), "(not found)")


_PACKAGE = Path(hypcheck.__file__).parent
MAX_FILES_NAMED = 5
"""The most changed files that a message names; a checkout of another commit changes hundreds."""

_HEADER = 16
"""Bytes of the header of compiled Python: version, flags, and time and size of the source, four bytes each."""


@lru_cache
def code_fingerprint() -> str:
    """The fingerprint of the names and contents of hypcheck's modules and frozen vectors, taken at the first call."""
    digest = hashlib.sha256()
    for place, pattern in ((_PACKAGE, "**/*.py"), (folder(), "*.json*")):
        for path in sorted(place.glob(pattern)):
            digest.update(f"{path.relative_to(place).as_posix()} {_sha256_of_bytes(_content_of(str(path)))}\n".encode())
    return digest.hexdigest()


class FileSnapshot:
    """The files of a run at its start, to be compared with those at its end: hypcheck's own, and those under test.

    `tested` holds the sha256 of the files under test, by path.
    """

    def __init__(self, tested: Mapping[str, str]) -> None:
        self._tested = dict(tested)
        self.program = code_fingerprint()
        self._ours = _own_files()

    def record_changes(self, recorder: Recorder) -> list[str]:
        """Sentences about files that changed, hypcheck's own first; the record gets them as lines that fail the run."""
        changes = list(self._changes())
        if len(changes) > MAX_FILES_NAMED:
            changes[MAX_FILES_NAMED:] = [f"{len(changes) - MAX_FILES_NAMED} more files were changed"]
        for sentence in changes:
            recorder.add(DriftLine(sentence=sentence))
        return changes

    def _changes(self) -> Iterator[str]:
        now = _own_files()
        for path in sorted({*self._ours, *now}):
            before, after = self._ours.get(path), now.get(path)
            if before != after and not _is_compiled(path, before, after):
                yield f"hypcheck's own file {path} was {_change_of(before, after)} while an implementation was asked"
        for name, before in self._tested.items():
            after = sha256(Path(name)) if os.path.exists(name) else None
            if before != after:
                yield f"{name}, which is under test, was {_change_of(before, after)} while it was asked"


def _change_of(before: str | None, after: str | None) -> str:
    return "added" if before is None else "removed" if after is None else "changed"


def _is_compiled(path: str, before: str | None, after: str | None) -> bool:
    """Whether a change may be a module that Python compiled during the run, or a cache that somebody removed."""
    return path.endswith(".pyc") and (before is None or after is None)


def _own_files() -> dict[str, str]:
    """The sha256 of every file of the package and of the frozen vectors, by path.

    Compiled Python counts only if Python would load it without checking its source.
    """
    hashes = {}
    for top, folders, names in os.walk(_PACKAGE):
        folders[:] = [name for name in folders if name != "__pycache__"]
        for path in (os.path.join(top, name) for name in names):
            hashes[path] = _sha256_of_bytes(_content_of(path))
            compiled = cache_from_source(path) if path.endswith(".py") else ""
            if compiled and os.path.exists(compiled):
                content, state = _content_of(compiled), os.stat(path)
                if content[4:_HEADER] == struct.pack("<3I", 0, int(state.st_mtime) % 2**32, state.st_size % 2**32):
                    hashes[compiled] = _sha256_of_bytes(content)
    return hashes | {str(path): _sha256_of_bytes(_content_of(str(path))) for path in folder().glob("*.json*")}


def _content_of(path: str) -> bytes:
    """The content of a small file; empty if it cannot be read, or was removed meanwhile."""
    with suppress(OSError), open(path, "rb", buffering=0) as file:  # faster without a buffer
        return file.read()
    return b""


def _sha256_of_bytes(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
