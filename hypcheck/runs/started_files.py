"""The files that a SPEC starts besides the files that it names, as far as they are known before anything is run.

These are the files in the words of a command (also of `sh -c './prog --fast'`), the modules beside a Python file that
it imports, and the libraries that an ELF program or library needs and finds by its own search path. Nothing is imported
or run to find them. The key `not_hashed` of the record's header names what cannot be known.
"""

from __future__ import annotations

import ast
import os
import shlex
import shutil
import struct
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import hypcheck
from hypcheck.implementations.spec import Spec, is_file, parse_spec

_PACKAGE = Path(hypcheck.__file__).resolve().parent

_PYTHON = (".py", ".pyw")

MOST_FILES = 2000
"""The most files of a SPEC that are hashed; further files are not."""

_DYNAMIC = frozenset(
    {"__import__", "import_module", "exec", "run_path", "run_module", "spec_from_file_location", "CDLL"}
)
"""Functions that load what a look at the source does not tell."""


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
    """The files of a SPEC that exist, with what they load. Raises InputError if the text is not a SPEC."""
    spec, files = parse_spec(text), StartedFiles()
    if spec.kind == "library":
        files.add(spec.words[0], ())
    elif spec.kind == "python":
        _add_function(spec, files)
    elif spec.kind == "command":
        _add_command(spec, files)
    return files


def _add_function(spec: Spec, files: StartedFiles) -> None:
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
    """The parts of a word that may be a file: the word, its words in shell syntax, values after =, parts of a path."""
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
    """Whether a file begins with #!."""
    with suppress(OSError), open(path, "rb") as file:
        return file.read(2) == b"#!"
    return False


def _python_path() -> list[str]:
    return [folder for folder in os.environ.get("PYTHONPATH", "").split(os.pathsep) if folder]


def _imported(node: ast.AST, path: str) -> Iterator[str]:
    """The names of modules that a statement may import: relative ones as paths from the file's folder."""
    if isinstance(node, ast.Import):
        yield from (alias.name for alias in node.names)
    elif isinstance(node, ast.ImportFrom):
        stem = node.module or ""
        if node.level:
            folder = os.path.join(os.path.dirname(path), *[os.pardir] * (node.level - 1))
            stem = os.path.normpath(os.path.join(folder, *stem.split("."))) + os.sep
            yield stem
            yield from (os.path.join(stem, alias.name) for alias in node.names)
            return
        yield stem
        yield from (f"{stem}.{alias.name}" for alias in node.names)


def _modules(name: str, folders: Sequence[str]) -> Iterator[str]:
    """The files of a module and of the packages around it, in the first of the folders that has any of them."""
    if os.sep in name:
        yield from _existing(name.rstrip(os.sep))
        return
    parts = [part for part in name.split(".") if part]
    for folder in folders:
        paths = [path for depth in range(1, len(parts) + 1) for path in _existing(os.path.join(folder, *parts[:depth]))]
        if paths:
            yield from paths
            return


def _existing(stem: str) -> Iterator[str]:
    """The files of the module with that path, without hypcheck's own files, whose hashes the record has."""
    for path in (f"{stem}.py", os.path.join(stem, "__init__.py"), *_extensions(stem)):
        if os.path.isfile(path) and _PACKAGE not in Path(path).resolve().parents:
            yield path


def _extensions(stem: str) -> list[str]:
    folder, name = os.path.split(stem)
    with suppress(OSError):
        entries = sorted(os.listdir(folder or "."))
        names = (entry for entry in entries if entry.startswith(f"{name}.") and entry.endswith((".so", ".pyd")))
        return [os.path.join(folder, entry) for entry in names]
    return []


def _name_of(function: ast.expr) -> str:
    return function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")


_LARGEST = 1 << 30
_LOADED, _DYNAMIC_SEGMENT = 1, 2
_NEEDED, _STRINGS, _RPATH, _RUNPATH = 1, 5, 15, 29


def _needed(path: str) -> list[str]:
    """The libraries that an ELF file needs, from the folders that it or LD_LIBRARY_PATH names; no system libraries."""
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
    """The texts of the dynamic section by tag: needed libraries and search paths. Raises struct.error or ValueError."""
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
