"""The files of a project that is to be gated: templates of one language and those that all share, filled in."""

from __future__ import annotations

import re
import shlex
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files

from hypcheck.scaffold.languages import Language

SCENES = "forest-type-1,forest-type-2"
"""Families on which the stub is right: the paper's scenes for its Table 2."""

_COMMON = {"hypcheck.toml": "hypcheck.toml", "workflow.yml": ".github/workflows/hypcheck.yml"}
_IGNORED = "gitignore"
_PLACE = re.compile(r"@([A-Z]+)@")


@dataclass(frozen=True, slots=True)
class Project:
    """What is to be written: the adapter's language, the implementation's name, what CI installs (as pip reads it)."""

    language: Language
    name: str
    requirement: str

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
        """Texts by path, relative to the folder of the project; the stub's first."""
        language = self.language
        written = {f"{language.folder}/{name}": self._filled(language.name, name) for name in language.files}
        if language.products:
            written[f"{language.folder}/.gitignore"] = self._filled("common", _IGNORED)
        return written | {path: self._filled("common", name) for name, path in _COMMON.items()}

    def _filled(self, folder: str, name: str) -> str:
        template = files("hypcheck.scaffold").joinpath("templates", folder, *name.split("/"))
        return _PLACE.sub(lambda place: self._values[place[1]], template.read_text(encoding="utf-8"))

    @property
    def _values(self) -> Mapping[str, str]:
        """What stands for @NAME@ and the like in templates."""
        return {
            "NAME": self.name,
            "BUILD": self.language.build,
            "SPEC": self.language.spec,
            "VERIFY": self.verify,
            "PREDICATE": self.predicate,
            "PRODUCTS": "\n".join(self.language.products),
            "REQUIREMENT": shlex.quote(self.requirement),
        }
