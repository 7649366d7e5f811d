"""The files of a project that is to be gated: templates of one language, filled in."""

from __future__ import annotations

import re
import shlex
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files

from hypcheck.scaffold.languages import Language

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
