"""The files of a project under test: the languages that `hypcheck init` supports, and their templates, filled in.

Paths are relative to the folder that init writes into, where commands are also run. Each language has a folder of its
own there, so a project can have several.
"""

from __future__ import annotations

import re
import shlex
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files
from types import MappingProxyType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable


@dataclass(frozen=True, slots=True)
class Language:
    """How an adapter is made in one language.

    files: the templates in the language's folder; `predicate` is the one that holds the stub.
    build: the command line that builds the adapter.
    spec: the SPEC that verify is given after the build.
    products: the files that the build leaves behind.
    """

    name: str
    files: tuple[str, ...]
    predicate: str
    build: str
    spec: str
    products: tuple[str, ...]

    @property
    def folder(self) -> str:
        """The folder of the adapter."""
        return f"hypcheck-{self.name}"


# -ffp-contract=off: otherwise a×b + c may round once instead of twice, and answers depend on the machine.
# GOWORK=off, and [workspace] in Cargo.toml: the adapter does not belong to a workspace in a folder above.
# -buildvcs=false: Go would ask git about the folder, and fail if git does not trust it.
_LISTED = (
    Language(
        name="c",
        files=("predicate.c", "adapter.c", "predicate.h"),
        predicate="predicate.c",
        build="cc -std=c11 -O2 -ffp-contract=off -o hypcheck-c/adapter hypcheck-c/adapter.c hypcheck-c/predicate.c -lm",
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
"""The languages by the names of `--language`."""


SCENES = "forest-type-1,forest-type-2"
"""Families on which the stub is right: the scenes of the paper's Table 2."""

SWEEPS_THROUGH = "way-tunnelling"
"""The family on which the stub for sweeps is right: the centre goes through the wall."""

STUBS = ("position", "passage")
"""Questions for which there is a stub; that for positions is asked whether they are exterior."""

LONGEST_NAME = 64

_IGNORED = "gitignore"
_PLACE = re.compile(r"@([A-Z]+)@")
_MARK = re.compile(rf"@({'|'.join(STUBS)}|end)@\n")


@dataclass(frozen=True, slots=True)
class Project:
    """A project to write: the language of its adapter, the name of its implementation, and one of STUBS."""

    language: Language
    name: str = ""
    stub: str = "position"

    @property
    def build(self) -> str:
        """The command line that builds the adapter."""
        return self.language.build

    @property
    def right_on(self) -> str:
        """The families on which the stub is right."""
        return SWEEPS_THROUGH if self.stub == "passage" else SCENES

    @property
    def verify(self) -> str:
        """The command line that gates the implementation."""
        return f"hypcheck verify {shlex.quote(self.language.spec)}"

    @property
    def commands(self) -> tuple[str, str, str]:
        """The commands to type next: build, verify where the stub is right, verify everywhere."""
        return self.build, f"{self.verify} --families {self.right_on}", self.verify

    @property
    def emit(self) -> str:
        """The command line that writes a right predicate in the place of the stub; empty where there is none."""
        from hypcheck.kernel.emission.dialects import DIALECTS  # noqa: PLC0415 - only what is printed last needs it

        if self.stub != "position" or self.language.name not in DIALECTS:
            return ""
        return f"hypcheck emit --method exact --language {self.language.name} --output {self.predicate}"

    @property
    def predicate(self) -> str:
        """The file that holds the stub."""
        return f"{self.language.folder}/{self.language.predicate}"

    def files(self) -> dict[str, str]:
        """The texts of the language's folder by path, relative to the project; the stub first."""
        language = self.language
        written = {f"{language.folder}/{name}": self.filled(language.name, name) for name in language.files}
        if language.products:
            written[f"{language.folder}/.gitignore"] = self.filled("common", _IGNORED)
        return written

    def filled(self, folder: str, name: str) -> str:
        """A template with the values of @NAME@ and the like; that of the stub if it has one of its own."""
        own = f"{folder}-{self.stub}"
        return filled(own if template(own, name).is_file() else folder, name, self._values, self.stub)

    @property
    def _values(self) -> Mapping[str, str]:
        return {
            "NAME": self.name,
            "LANGUAGE": self.language.name,
            "FOLDER": self.language.folder,
            "BUILD": self.build,
            "SPEC": self.language.spec,
            "VERIFY": self.verify,
            "PREDICATE": self.predicate,
            "PRODUCTS": "\n".join(self.language.products),
        }


def filled(folder: str, name: str, values: Mapping[str, str], stub: str = STUBS[0]) -> str:
    """The text of a template for a stub, with these values for its places.

    Lines after @position@ or @passage@, to the next of these or to @end@, are for that stub alone.
    """
    wanted, kept = True, []
    for line in template(folder, name).read_text(encoding="utf-8").splitlines(keepends=True):
        mark = _MARK.fullmatch(line)
        if mark is None and wanted:
            kept.append(line)
        elif mark is not None:
            wanted = mark[1] in (stub, "end")
    return _PLACE.sub(lambda place: values[place[1]], "".join(kept))


def template(folder: str, name: str) -> Traversable:
    """The file of a template, which may not exist."""
    return files("hypcheck.scaffold").joinpath("templates", folder, *name.split("/"))


def safe_name(text: str) -> str:
    """The name in letters, digits and . _ - only, at most LONGEST_NAME of them; empty if nothing is left.

    It is written into JSON within string literals of all languages, so only characters without a meaning there pass.
    """
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()
    return re.sub(r"[^A-Za-z0-9._]+", "-", plain).strip("-._")[:LONGEST_NAME].rstrip("-._")
