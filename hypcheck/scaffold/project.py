"""The files of a project under test: the languages that `hypcheck init` knows, and their templates, filled in.

The languages that `hypcheck init` knows: the files of each adapter, and the commands that go with it.

Paths are relative to the folder that init writes into, where commands are also run. Each language has a folder of its
own there, so that a project can have several.

The files of a project that is to be gated: templates of one language, filled in.
"""

from __future__ import annotations

import re
import shlex
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files
from types import MappingProxyType


@dataclass(frozen=True, slots=True)
class Language:
    """How an adapter is made in one language.

    `files` are the templates in the language's folder, `predicate` the one of them that holds the stub. `build` is one
    command line, and `spec` is what verify is given once that has run; `products` are what building leaves behind.
    """

    name: str
    files: tuple[str, ...]
    predicate: str
    build: str
    spec: str
    products: tuple[str, ...]

    @property
    def folder(self) -> str:
        """Where the adapter is written."""
        return f"hypcheck-{self.name}"


# -ffp-contract=off: else a×b + c may round once instead of twice, and the stub answers otherwise on other machines.
# GOWORK=off, as [workspace] in Cargo.toml: the adapter is no part of a workspace in a folder above.
# -buildvcs=false: Go would ask git about the folder, and fail where git does not trust it.
_LISTED = (
    Language(
        name="c",
        files=("predicate.c", "adapter.c", "predicate.h"),
        predicate="predicate.c",
        build="cc -std=c11 -O2 -ffp-contract=off -o hypcheck-c/adapter hypcheck-c/adapter.c hypcheck-c/predicate.c",
        spec="command:hypcheck-c/adapter",
        products=("/adapter", "/predicate.so"),
    ),
    Language(
        name="cpp",
        files=("predicate.cpp", "adapter.cpp", "predicate.hpp"),
        predicate="predicate.cpp",
        build="c++ -std=c++17 -O2 -ffp-contract=off "
        "-o hypcheck-cpp/adapter hypcheck-cpp/adapter.cpp hypcheck-cpp/predicate.cpp",
        spec="command:hypcheck-cpp/adapter",
        products=("/adapter", "/predicate.so"),
    ),
    Language(
        name="rust",
        files=("src/predicate.rs", "src/main.rs", "Cargo.toml"),
        predicate="src/predicate.rs",
        build="cargo build --release --offline "
        "--manifest-path hypcheck-rust/Cargo.toml --target-dir hypcheck-rust/target",
        spec="command:hypcheck-rust/target/release/hypcheck-adapter",
        products=("/target/",),
    ),
    Language(
        name="go",
        files=("predicate.go", "main.go", "go.mod"),
        predicate="predicate.go",
        build="env GOWORK=off go build -C hypcheck-go -buildvcs=false -o adapter .",
        spec="command:hypcheck-go/adapter",
        products=("/adapter",),
    ),
    Language(
        name="java",
        files=("Predicate.java", "Adapter.java"),
        predicate="Predicate.java",
        build="javac -d hypcheck-java/classes hypcheck-java/Adapter.java hypcheck-java/Predicate.java",
        spec="command:java -XX:+UseSerialGC -cp hypcheck-java/classes Adapter",
        products=("/classes/",),
    ),
    Language(
        name="javascript",
        files=("predicate.mjs", "adapter.mjs"),
        predicate="predicate.mjs",
        build="node --check hypcheck-javascript/adapter.mjs",
        spec="command:node hypcheck-javascript/adapter.mjs",
        products=(),
    ),
    Language(
        name="python",
        files=("predicate.py",),
        predicate="predicate.py",
        build="python3 -m py_compile hypcheck-python/predicate.py",
        spec="python:hypcheck-python/predicate.py:classify",
        products=("__pycache__/",),
    ),
)

LANGUAGES: Mapping[str, Language] = MappingProxyType({language.name: language for language in _LISTED})
"""By name, as `--language` has it."""


SCENES = "forest-type-1,forest-type-2"
"""Families on which the stub is right: the paper's scenes for its Table 2."""

LONGEST_NAME = 64

_IGNORED = "gitignore"
_PLACE = re.compile(r"@([A-Z]+)@")


@dataclass(frozen=True, slots=True)
class Project:
    """What is to be written: the adapter's language, and the implementation's name."""

    language: Language
    name: str = ""

    @property
    def verify(self) -> str:
        """The command line that gates it."""
        return f"hypcheck verify {shlex.quote(self.language.spec)}"

    @property
    def commands(self) -> tuple[str, str, str]:
        """What to type next: build, verify where the stub is right, verify everywhere."""
        return self.language.build, f"{self.verify} --families {SCENES}", self.verify

    @property
    def predicate(self) -> str:
        """The file that holds the stub."""
        return f"{self.language.folder}/{self.language.predicate}"

    def files(self) -> dict[str, str]:
        """Texts of the language's own folder by path, relative to the folder of the project; the stub's first."""
        language = self.language
        written = {f"{language.folder}/{name}": self.filled(language.name, name) for name in language.files}
        if language.products:
            written[f"{language.folder}/.gitignore"] = self.filled("common", _IGNORED)
        return written

    def filled(self, folder: str, name: str) -> str:
        """A template with what stands for @NAME@ and the like."""
        return filled(folder, name, self._values)

    @property
    def _values(self) -> Mapping[str, str]:
        return {
            "NAME": self.name,
            "LANGUAGE": self.language.name,
            "FOLDER": self.language.folder,
            "BUILD": self.language.build,
            "SPEC": self.language.spec,
            "VERIFY": self.verify,
            "PREDICATE": self.predicate,
            "PRODUCTS": "\n".join(self.language.products),
        }


def filled(folder: str, name: str, values: Mapping[str, str]) -> str:
    """The text of a template, with the values of its places."""
    template = files("hypcheck.scaffold").joinpath("templates", folder, *name.split("/"))
    return _PLACE.sub(lambda place: values[place[1]], template.read_text(encoding="utf-8"))


def safe_name(text: str) -> str:
    """The name in letters, digits and . _ - alone, at most LONGEST_NAME of them; empty where nothing is left.

    It ends up in JSON within five languages' string literals, so only characters that mean nothing there pass.
    """
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()
    return re.sub(r"[^A-Za-z0-9._]+", "-", plain).strip("-._")[:LONGEST_NAME].rstrip("-._")
