"""Our own files, told by their content: what a chunk comes to depends on, besides the implementation.

Two machines may have hypcheck of one version and yet not the same files, where it is installed from a repository. And
what is under test runs as the same user as we do: it could write over the judge, or over itself, while it is judged.
"""

from __future__ import annotations

import hashlib
import os
import struct
from collections.abc import Iterator, Mapping
from contextlib import suppress
from functools import lru_cache
from importlib.util import cache_from_source
from pathlib import Path

import hypcheck
from hypcheck.casebook.vectors import folder
from hypcheck.gate.fingerprint import sha256
from hypcheck.record import Recorder
from hypcheck.record.lines import Drift

_PACKAGE = Path(hypcheck.__file__).parent
MOST_NAMED = 5
"""Files that changed during a run which are named; whoever checks out another commit changes hundreds."""

_HEADER = 16
"""Bytes of the header of compiled Python: four of its version, four flags, then time and size of its source."""


@lru_cache
def own_sha256() -> str:
    """Of our modules and the frozen vectors, with their names, as they were when this was first asked."""
    told = hashlib.sha256()
    for place, pattern in ((_PACKAGE, "**/*.py"), (folder(), "*.json")):
        for path in sorted(place.glob(pattern)):
            told.update(f"{path.relative_to(place).as_posix()} {_sha256(_content(str(path)))}\n".encode())
    return told.hexdigest()


class Unchanged:
    """The files of a run at its beginning, to be compared with those at its end: ours and those under test.

    `tested` are the sha256 of those under test, by path.
    """

    def __init__(self, tested: Mapping[str, str]) -> None:
        self._tested = dict(tested)
        self.program = own_sha256()
        self._ours = _own_files()

    def record_changes(self, recorder: Recorder) -> list[str]:
        """Sentences about files that are not as they were, ours first; the record gets them as lines that fail it."""
        found = list(self._changes())
        if len(found) > MOST_NAMED:
            found[MOST_NAMED:] = [f"{len(found) - MOST_NAMED} more files were changed"]
        for sentence in found:
            recorder.add(Drift(sentence=sentence))
        return found

    def _changes(self) -> Iterator[str]:
        now = _own_files()
        for path in sorted({*self._ours, *now}):
            before, after = self._ours.get(path), now.get(path)
            if before != after and not _is_compiled(path, before, after):
                yield f"hypcheck's own file {path} was {_what(before, after)} while an implementation was asked"
        for name, before in self._tested.items():
            after = sha256(Path(name)) if os.path.exists(name) else None
            if before != after:
                yield f"{name}, which is under test, was {_what(before, after)} while it was asked"


def _what(before: str | None, after: str | None) -> str:
    return "added" if before is None else "removed" if after is None else "changed"


def _is_compiled(path: str, before: str | None, after: str | None) -> bool:
    """Whether Python may have compiled a module then that it had not loaded before, or somebody removed its caches."""
    return path.endswith(".pyc") and (before is None or after is None)


def _own_files() -> dict[str, str]:
    """The sha256 of everything in the package and of the frozen vectors, by path.

    Of compiled Python, only where Python would load it without a look at its source, so that nothing need change it.
    """
    found = {}
    for top, folders, names in os.walk(_PACKAGE):
        folders[:] = [name for name in folders if name != "__pycache__"]
        for path in (os.path.join(top, name) for name in names):
            found[path] = _sha256(_content(path))
            compiled = cache_from_source(path) if path.endswith(".py") else ""
            if compiled and os.path.exists(compiled):
                content, state = _content(compiled), os.stat(path)
                if content[4:_HEADER] == struct.pack("<3I", 0, int(state.st_mtime) % 2**32, state.st_size % 2**32):
                    found[compiled] = _sha256(content)
    return found | {str(path): _sha256(_content(str(path))) for path in folder().glob("*.json")}


def _content(path: str) -> bytes:
    """Of a file that is small; nothing where it may not be read, or was removed at this very moment."""
    with suppress(OSError), open(path, "rb", buffering=0) as file:  # a buffer would take longer than the small files
        return file.read()
    return b""


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
