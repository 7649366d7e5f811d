"""The files that a SPEC names, told by their content: whether an implementation is still the one that was asked."""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
from collections.abc import Iterable, Iterator
from importlib.machinery import PathFinder
from pathlib import Path

from hypcheck.methods.spec import is_file, parse_spec

_BLOCK = 1 << 20


def fingerprints(specs: Iterable[str], *others: Path | None) -> dict[str, str]:
    """The sha256 of the files that SPECs name, and of other files, by path; of those that are there."""
    paths = [*(path for spec in specs for path in files_of(spec)), *(path for path in others if path is not None)]
    return {str(path): sha256(path) for path in paths}


def files_of(spec: str) -> list[Path]:
    """The files that are there: a library, a Python file or module, a command and those of its words that are files.

    Nothing is imported or run to find them. Raises InputError where the SPEC is none.
    """
    parsed = parse_spec(spec)
    if parsed.kind == "builtin":
        return []
    if parsed.kind == "command":
        program = shutil.which(parsed.words[0])
        found: Iterator[str | None] = iter([program, *parsed.words[1:]])
    elif parsed.kind == "python" and not is_file(parsed.words[0]):
        found = iter([_module(parsed.words[0])])
    else:
        found = iter(parsed.words[:1])
    return [Path(each) for each in found if each is not None and os.path.isfile(each)]


def sha256(path: Path) -> str:
    """Of a file's content, in hexadecimal; of one that may be run but not read, why not."""
    digest = hashlib.sha256()
    try:
        file = path.open("rb")
    except OSError as error:
        return (error.strerror or str(error)).lower()
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
