"""The files that a SPEC names, as bytes: found where a worker of a cluster runs, or put there; never another file.

Of a command these are the program, where it is given as a path, and the words that name files here; a program that is
looked for on the PATH is each worker's own. A Python module is not sent, but must be the same.
"""

from __future__ import annotations

import hashlib
import json
import os
from dataclasses import dataclass
from pathlib import Path

from hypcheck.errors import InputError, system_reason
from hypcheck.gate.fingerprint import files_of, sha256
from hypcheck.methods.spec import is_file, parse_spec


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
