"""The files that a SPEC names: told by their content, and sent to workers of a cluster that have them not.

Of a command these are the program, where it is given as a path, and the words that name files here; a program that is
looked for on the PATH is each worker's own. A Python module is not sent, but must be the same.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from importlib.machinery import PathFinder
from pathlib import Path

from hypcheck.errors import InputError, system_reason
from hypcheck.methods.spec import is_file, parse_spec

_BLOCK = 1 << 20


def fingerprints(specs: Iterable[str], *others: Path | None) -> dict[str, str]:
    """The sha256 of the files that SPECs name, and of other files, by path; of those that are there."""
    named = [each.path for spec in specs for each in files_of(spec)]
    paths = [*named, *(path for path in others if path is not None)]
    return {str(path): sha256(path) for path in paths}


@dataclass(frozen=True, slots=True)
class Named:
    """A file that is there, which word `word` of a SPEC names by its path, or by what is `searched` for."""

    word: int
    path: Path
    searched: bool


def files_of(text: str) -> Iterator[Named]:
    """The files of a SPEC: a library, a Python file or module, a command and those of its words that are files.

    Nothing is imported or run to find them. Raises InputError where the SPEC is none.
    """
    spec = parse_spec(text)
    if spec.kind == "builtin":
        return
    for word, name in enumerate(spec.words if spec.kind == "command" else spec.words[:1]):
        module = spec.kind == "python" and not is_file(name)
        program = spec.kind == "command" and word == 0 and os.sep not in name
        found = _module(name) if module else shutil.which(name) if program else name
        if found is not None and os.path.isfile(found):
            yield Named(word, Path(found), module or program)


def sha256(path: Path) -> str:
    """Of a file's content, in hexadecimal; of one that may be run but not read, or is a pipe or device, why not."""
    digest = hashlib.sha256()
    try:
        if path.exists() and not path.is_file():  # to be read it may be waited for without end
            return "is no regular file"
        file = path.open("rb")
    except OSError as error:
        return system_reason(error)
    with file:
        while block := file.read(_BLOCK):
            digest.update(block)
    return digest.hexdigest()


def _module(name: str) -> str | None:
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
class Shipped:
    """A file that word `word` of a SPEC names: its absolute path where the run began, its content, its permissions."""

    word: int
    path: str
    content: bytes
    mode: int

    @property
    def sha256(self) -> str:
        """Of the content, in hexadecimal."""
        return hashlib.sha256(self.content).hexdigest()


def files_to_ship(text: str) -> tuple[Shipped, ...]:
    """The files that a SPEC names by their paths. Raises InputError where one cannot be read."""
    found = []
    for named in files_of(text):
        if named.searched:
            continue
        path = named.path.absolute()
        try:
            found.append(Shipped(named.word, str(path), path.read_bytes(), path.stat().st_mode & 0o777))
        except OSError as error:
            raise InputError(f"{path} cannot be sent to a cluster: {system_reason(error)}") from None
    return tuple(found)


def spec_there(text: str, files: tuple[Shipped, ...], worker: str, folder: Path) -> str:
    """The SPEC as a worker can open it: a file that is not where it was when the run began is put into the folder.

    Raises InputError where the file there is another one.
    """
    spec = parse_spec(text)
    words = list(spec.words)
    for file in files:
        words[file.word] = _found_or_put(file, worker, folder)
    if spec.kind == "command":
        return f"command:{json.dumps(words)}"
    return f"{spec.kind}:{':'.join(words)}" if files else text


def _found_or_put(file: Shipped, worker: str, folder: Path) -> str:
    path = Path(file.path)
    if not path.is_file():
        place = folder / str(file.word) / os.path.basename(file.path)
        place.parent.mkdir()
        place.write_bytes(file.content)
        place.chmod(file.mode)
        return str(place)
    require_same(file.path, file.sha256, sha256(path), worker)
    return file.path


def require_same(what: str, here: str, there: str, worker: str) -> None:
    """Raise InputError where two hashes differ."""
    if here != there:
        raise InputError(f"{what} is another file on worker {worker}: sha256 {there} there, and {here} here")


def module_sha256(text: str) -> str:
    """Of the file of a SPEC's Python module, as it is found here; empty where the SPEC names none."""
    spec = parse_spec(text)
    if spec.kind != "python" or is_file(spec.words[0]):
        return ""
    return next((sha256(each.path) for each in files_of(text)), "(not found)")
