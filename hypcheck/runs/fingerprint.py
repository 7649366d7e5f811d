"""The files of a run and their fingerprints (SHA-256): those that a SPEC names or starts, and hypcheck's own.

A SPEC names a library, a Python file or module, or the words of a command that are files. It starts further files:
those in the shell syntax of a word (`sh -c './prog --fast'`), the modules beside a Python file that it imports, and the
libraries that an ELF file needs and finds by its own search path. Nothing is imported or run to find them. The key
`not_hashed` of the record's header names what cannot be known.

Two machines may have the same version of hypcheck but other files, if it is installed from a repository. Code under
test runs as the same user as hypcheck: it could overwrite the judge, or itself, during a run.
"""

from __future__ import annotations

import ast
import hashlib
import os
import shlex
import shutil
import struct
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import lru_cache
from importlib.machinery import PathFinder
from importlib.util import cache_from_source
from pathlib import Path

import hypcheck
from hypcheck.errors import system_reason
from hypcheck.implementations.spec import Spec, is_file, parse_spec
from hypcheck.record import Recorder
from hypcheck.record.lines import DriftLine
from hypcheck.vectors.frozen import folder


def fingerprints(specs: Iterable[str], *others: Path | None) -> dict[str, str]:
    """Return the sha256 of the files that SPECs name or start, and of other files, by path, as far as they exist."""
    paths: list[Path] = []
    for spec in specs:
        paths += [*(file.path for file in files_of(spec)), *map(Path, started_files(spec).paths)]
    paths += [path for path in others if path is not None]
    return {str(path): sha256(path) for path in dict.fromkeys(paths)}


def not_hashed(specs: Iterable[str]) -> list[str]:
    """Return a phrase for each file that SPECs start but that is not known unless they run; each phrase once."""
    return list(dict.fromkeys(sentence for spec in specs for sentence in started_files(spec).missing))


_BLOCK_BYTES = 1 << 20


def sha256(path: Path) -> str:
    """Return the sha256 of a file in hexadecimal; the reason instead if it cannot be read or is a pipe or device."""
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


@dataclass(frozen=True, slots=True)
class NamedFile:
    """An existing file that word `word` of a SPEC names, by its path or (`searched`) by a name that is searched for."""

    word: int
    path: Path
    searched: bool


def files_of(text: str) -> Iterator[NamedFile]:
    """Yield the files that the words of a SPEC name: a library, a Python file or module, the words of a command.

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


def _module_file(name: str) -> str | None:
    """Return the file of a module, found as the worker finds it: from the working directory first."""
    places: list[str] | None = [os.getcwd(), *sys.path]
    origin = None
    for depth in range(1, name.count(".") + 2):
        spec = PathFinder.find_spec(".".join(name.split(".")[:depth]), places)
        if spec is None:
            return None
        origin, places = spec.origin, list(spec.submodule_search_locations or ())
    return origin


_PACKAGE = Path(hypcheck.__file__).parent


_PYTHON = (".py", ".pyw")


MOST_FILES = 2000
"""The most files of a SPEC that are hashed; further files are not."""


_DYNAMIC = frozenset(
    {"__import__", "import_module", "exec", "run_path", "run_module", "spec_from_file_location", "CDLL"}
)
"""Functions that load files whose names the source does not show."""


@dataclass
class StartedFiles:
    """The files in the order in which they were found, and sentences without a full stop about missing files."""

    paths: dict[str, None] = field(default_factory=dict)
    missing: dict[str, None] = field(default_factory=dict)

    def add(self, path: str, folders: Sequence[str]) -> None:
        """Add a file and what it loads; Python looks for modules in these folders."""
        if path in self.paths or not os.path.isfile(path):
            return
        if len(self.paths) >= MOST_FILES:
            self.missing[f"what is beyond {MOST_FILES:,} files"] = None
            return
        self.paths[path] = None
        with suppress(OSError):
            if path.endswith(_PYTHON):
                self._add_imports(path, folders)
            elif Path(path).stat().st_size:
                for needed in _needed(path):
                    self.add(needed, folders)

    def _add_imports(self, path: str, folders: Sequence[str]) -> None:
        try:
            tree = ast.parse(Path(path).read_bytes())
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            self.missing[f"what {path} imports, as it cannot be parsed"] = None
            return
        for node in ast.walk(tree):
            for name in _imported(node, path):
                for module in _modules(name, folders):
                    self.add(module, folders)
            if isinstance(node, ast.Call) and _name_of(node.func) in _DYNAMIC:
                self.missing[f"what {path} loads as it runs ({_name_of(node.func)})"] = None


def started_files(text: str) -> StartedFiles:
    """Return the files of a SPEC that exist, with what they load. Raises InputError if the text is not a SPEC."""
    spec, files = parse_spec(text), StartedFiles()
    if spec.kind == "library":
        files.add(spec.words[0], ())
    elif spec.kind == "python":
        _add_function(spec, files)
    elif spec.kind == "command":
        _add_command(spec, files)
    return files


def _add_function(spec: Spec, files: StartedFiles) -> None:
    """Add the files of the Python file or module that the SPEC names."""
    target = spec.words[0]
    if is_file(target):
        files.add(target, [os.path.dirname(target), *_python_path()])
        return
    folders = [os.getcwd(), *_python_path()]
    for path in _modules(target, folders):
        files.add(path, folders)


def _add_command(spec: Spec, files: StartedFiles) -> None:
    """Add the files in the words. Other files that a program from the PATH reads are not known, except for Python."""
    program = spec.words[0]
    known = program if os.sep in program else shutil.which(program)
    python = os.path.basename(program).startswith("python")
    if known is not None:
        files.add(known, [os.path.dirname(known), *_python_path()])
    for before, word in zip(spec.words, spec.words[1:], strict=False):
        if python and before == "-m":
            folders = [os.getcwd(), *_python_path()]
            for path in (*_modules(word, folders), *_modules(f"{word}.__main__", folders)):
                files.add(path, folders)
            continue
        for token in _tokens(word, first_is_program=before == "-c"):
            if os.path.isdir(token) and token not in (".", ".."):
                files.missing[f"the folder {token}"] = None
            files.add(token, [os.path.dirname(token), *_python_path()])
    interpreter = len(spec.words) > 1 and os.sep not in program
    script = known is not None and not known.endswith(_PYTHON) and _is_script(known)
    if not python and (interpreter or script):
        files.missing[f"what {program} loads besides"] = None


def _tokens(word: str, *, first_is_program: bool) -> Iterator[str]:
    """Yield the parts of a word that may name a file.

    They are the word itself, or its words in shell syntax, values after "=", and the parts of a list of paths.
    """
    if os.path.exists(word):
        yield word
        return
    try:
        words = shlex.split(word)
    except ValueError:
        words = word.split()
    for place, token in enumerate(words):
        program = shutil.which(token) if first_is_program and not place and os.sep not in token else None
        if program is not None:
            yield program
        for part in token.rpartition("=")[2].split(os.pathsep):
            if part and (os.path.isfile(part) or os.path.isdir(part)):
                yield part


def _is_script(path: str) -> bool:
    """Return whether a file begins with #!."""
    with suppress(OSError), open(path, "rb") as file:
        return file.read(2) == b"#!"
    return False


def _python_path() -> list[str]:
    """Return the folders in PYTHONPATH."""
    return [folder for folder in os.environ.get("PYTHONPATH", "").split(os.pathsep) if folder]


def _imported(node: ast.AST, path: str) -> Iterator[str]:
    """Yield the names of modules that a statement may import: relative ones as paths from the file's folder."""
    if isinstance(node, ast.Import):
        yield from (alias.name for alias in node.names)
    elif isinstance(node, ast.ImportFrom):
        stem = node.module or ""
        if node.level:
            parent = os.path.join(os.path.dirname(path), *[os.pardir] * (node.level - 1))
            stem = os.path.normpath(os.path.join(parent, *stem.split("."))) + os.sep
            yield stem
            yield from (os.path.join(stem, alias.name) for alias in node.names)
            return
        yield stem
        yield from (f"{stem}.{alias.name}" for alias in node.names)


def _modules(name: str, folders: Sequence[str]) -> Iterator[str]:
    """Yield the files of a module, or of a path, and of the packages that hold it, in the first folder that has any."""
    if os.sep in name:
        yield from _existing(name.rstrip(os.sep))
        return
    parts = [part for part in name.split(".") if part]
    for top in folders:
        paths = [path for depth in range(1, len(parts) + 1) for path in _existing(os.path.join(top, *parts[:depth]))]
        if paths:
            yield from paths
            return


def _existing(stem: str) -> Iterator[str]:
    """Yield the files of the module with that path, without hypcheck's own files, whose hashes the record has."""
    for path in (f"{stem}.py", os.path.join(stem, "__init__.py"), *_extensions(stem)):
        if os.path.isfile(path) and _PACKAGE.resolve() not in Path(path).resolve().parents:
            yield path


def _extensions(stem: str) -> list[str]:
    """Return the paths of compiled modules (.so, .pyd) with this path without its ending."""
    parent, name = os.path.split(stem)
    with suppress(OSError):
        entries = sorted(os.listdir(parent or "."))
        names = (entry for entry in entries if entry.startswith(f"{name}.") and entry.endswith((".so", ".pyd")))
        return [os.path.join(parent, entry) for entry in names]
    return []


def _name_of(function: ast.expr) -> str:
    """Return the last name of a called function; "" if it has none."""
    return function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")


_LARGEST = 1 << 30


_LOADED, _DYNAMIC_SEGMENT = 1, 2


_NEEDED, _STRINGS, _RPATH, _RUNPATH = 1, 5, 15, 29


def _needed(path: str) -> list[str]:
    """Return the libraries that an ELF file needs, found in the folders that it or LD_LIBRARY_PATH names.

    Libraries of the system are left out.
    """
    size = os.path.getsize(path)
    with open(path, "rb") as file:
        head = file.read(64)
        if head[:4] != b"\x7fELF" or len(head) < 64 or size > _LARGEST:
            return []
        content = head + file.read()
    try:
        tags = _dynamic_strings(content)
    except (struct.error, ValueError):
        return []
    origin = os.path.dirname(path) or "."
    searched = [path for kind in (_RPATH, _RUNPATH) for text in tags.get(kind, ()) for path in text.split(":")]
    folders = [folder.replace("${ORIGIN}", origin).replace("$ORIGIN", origin) for folder in searched if folder]
    folders += [folder for folder in os.environ.get("LD_LIBRARY_PATH", "").split(":") if folder]
    libraries = []
    for name in tags.get(_NEEDED, ()):
        places = [name] if "/" in name else [os.path.join(folder, name) for folder in folders]
        libraries += [os.path.normpath(place) for place in places if os.path.isfile(place)][:1]
    return libraries


def _dynamic_strings(content: bytes) -> dict[int, list[str]]:
    """Return the texts of the dynamic section by tag: needed libraries and search paths.

    Raises struct.error or ValueError.
    """
    wide, order = content[4] == 2, "<" if content[5] == 1 else ">"
    offset, entry, number = (
        struct.unpack_from(f"{order}Q", content, 32)[0] if wide else struct.unpack_from(f"{order}I", content, 28)[0],
        *struct.unpack_from(f"{order}HH", content, 54 if wide else 42),
    )
    layout = f"{order}IIQQQQ" if wide else f"{order}IIIIII"
    segments = []  # kind, offset in the file, address, bytes
    for place in range(number):
        values = struct.unpack_from(layout, content, offset + place * entry)
        segments.append((values[0], values[2], values[3], values[5]) if wide else (*values[:3], values[4]))
    pairs = []
    for kind, start, _, length in segments:
        if kind == _DYNAMIC_SEGMENT:
            end = start + length - length % (16 if wide else 8)
            pairs = list(struct.iter_unpack(f"{order}QQ" if wide else f"{order}II", content[start:end]))
    address = next((value for tag, value in pairs if tag == _STRINGS), 0)
    loaded = [(start, at, length) for kind, start, at, length in segments if kind == _LOADED]
    table = next((address - at + start for start, at, length in loaded if at <= address < at + length), None)
    if table is None:
        return {}
    texts: dict[int, list[str]] = {}
    for tag, value in pairs:
        if tag in (_NEEDED, _RPATH, _RUNPATH):
            end = content.index(b"\0", table + value)
            texts.setdefault(tag, []).append(os.fsdecode(content[table + value : end]))
    return texts


MAX_FILES_NAMED = 5
"""The most changed files that a message names; a checkout of another commit changes hundreds."""


_HEADER = 16
"""Bytes of the header of compiled Python: version, flags, and time and size of the source, four bytes each."""


@lru_cache
def code_fingerprint() -> str:
    """Return the sha256 of the names and contents of hypcheck's modules and frozen vectors.

    It is computed at the first call in a process.
    """
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
        """Record a line for each file that changed, and return their sentences, those of hypcheck's own files first.

        Each line fails the run. After MAX_FILES_NAMED files one line has the number of the others.
        """
        changes = list(self._changes())
        if len(changes) > MAX_FILES_NAMED:
            changes[MAX_FILES_NAMED:] = [f"{len(changes) - MAX_FILES_NAMED} more files were changed"]
        for sentence in changes:
            recorder.add(DriftLine(sentence=sentence))
        return changes

    def _changes(self) -> Iterator[str]:
        """Yield a sentence for each file that changed since the start."""
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
    """Return the verb for the change of a file: "added", "removed" or "changed"."""
    return "added" if before is None else "removed" if after is None else "changed"


def _is_compiled(path: str, before: str | None, after: str | None) -> bool:
    """Return whether a change may be a module that Python compiled during the run, or a cache that somebody removed."""
    return path.endswith(".pyc") and (before is None or after is None)


def _own_files() -> dict[str, str]:
    """Return the sha256 of every file of the package and of the frozen vectors, by path.

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
    """Return the content of a small file; empty if it cannot be read, or was removed meanwhile."""
    with suppress(OSError), open(path, "rb", buffering=0) as file:  # faster without a buffer
        return file.read()
    return b""


def _sha256_of_bytes(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
