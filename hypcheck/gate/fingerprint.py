"""The files that a SPEC names, told by their content: whether an implementation is still the one that was asked."""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from importlib.machinery import PathFinder
from pathlib import Path

from hypcheck.errors import system_reason
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
