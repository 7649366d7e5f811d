"""The files that `hypcheck init` writes: each language's, filled in from its templates, and those that all share.

Paths are relative to the folder that init writes into, where commands are also run. Each language has a folder of its
own there, so a project can have several. Settings, workflow and .gitignore are shared: the first `init` writes them. A
later one, for another language, adds what it needs and changes nothing else, so that both are gated. If nothing can be
added to a file, it is refused, or a note says so. All files are written or none, and existing files are replaced only
on demand.
"""

from __future__ import annotations

import json
import os
import re
import shlex
import textwrap
import unicodedata
from collections.abc import Collection, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from hypcheck import toml
from hypcheck.errors import InputError
from hypcheck.messages import counted
from hypcheck.scaffold.requirement import Requirement
from hypcheck.tables.streams import made_folder, replace_output

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable


@dataclass(frozen=True, slots=True)
class Language:
    """The data for making an adapter in one language, as languages.toml has it."""

    name: str
    files: tuple[str, ...]
    build: str
    spec: str
    products: tuple[str, ...]

    @property
    def folder(self) -> str:
        """The folder of the adapter."""
        return f"hypcheck-{self.name}"

    @property
    def predicate(self) -> str:
        """The template that holds the stub."""
        return self.files[0]


LANGUAGES: Mapping[str, Language] = MappingProxyType(
    {
        name: Language(name, tuple(entry["files"]), entry["build"], entry["spec"], tuple(entry["products"]))
        for name, entry in toml.shipped("hypcheck.scaffold", "languages.toml").items()
    }
)
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
    """A project to write: the language of its adapter, the name of its implementation, and `stub`, one of STUBS."""

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
        from hypcheck.kernel.emission import dialects  # noqa: PLC0415 - only what is printed last needs it

        if self.stub != "position" or self.language.name not in dialects.LANGUAGES:
            return ""
        return f"hypcheck emit --method exact --language {self.language.name} --output {self.predicate}"

    @property
    def predicate(self) -> str:
        """The file that holds the stub."""
        return f"{self.language.folder}/{self.language.predicate}"

    def files(self) -> dict[str, str]:
        """Make the texts of the language's folder by path, relative to the project; the stub comes first."""
        language = self.language
        written = {f"{language.folder}/{name}": self.filled(language.name, name) for name in language.files}
        if language.products:
            written[f"{language.folder}/.gitignore"] = self.filled("common", _IGNORED)
        return written

    def filled(self, folder: str, name: str) -> str:
        """Fill in a template's marks such as @NAME@; if the stub has a template of its own, it takes that one."""
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
    """Return the text of a template for a stub, with these values in place of marks such as @NAME@.

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
    """Return the file of a template, which may not exist."""
    return files("hypcheck.scaffold").joinpath("templates", folder, *name.split("/"))


def safe_name(text: str) -> str:
    """Reduce a name to letters, digits and . _ -, at most LONGEST_NAME of them; empty if nothing is left.

    It is written into JSON within string literals of all languages, so only characters without a meaning there pass.
    """
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()
    return re.sub(r"[^A-Za-z0-9._]+", "-", plain).strip("-._")[:LONGEST_NAME].rstrip("-._")


SETTINGS = "hypcheck.toml"
WORKFLOW = ".github/workflows/hypcheck.yml"
IGNORED = ".gitignore"

_SPECS = re.compile(r"^specs[ \t]*=[ \t]*\[(?P<listed>.*|(?:.*\n)+?)\](?=[ \t]*(?:#.*)?$)", re.MULTILINE)
"""Matches the list `specs` on one line, or one whose closing bracket begins a line."""
_KEEP_STEP = re.compile(r"^ *- name: Keep the report *$", re.MULTILINE)
"""The step of a workflow before which init adds the steps of a language."""
_WIDTH = 108


def shared_files(
    root: Path, project: Project, wanted: Requirement | None, *, force: bool
) -> tuple[dict[str, str], list[str]]:
    """Make the texts of files to write or change, by path, and notes about what could not be added.

    With `force`, settings and workflow are written again for all languages that have a folder there. Raises InputError
    if nothing can be added to an existing file.
    """
    before = {path: _text(root / path) for path in (IGNORED, *(() if force else (SETTINGS, WORKFLOW)))}
    others = [other for other in LANGUAGES.values() if other != project.language and (root / other.folder).is_dir()]
    notes: list[str] = []
    settings = before.get(SETTINGS) or filled("common", "hypcheck.toml", {})
    workflow = before.get(WORKFLOW) or filled("common", "workflow.yml", {"INSTALL": _install(None)})
    for written in (*(map(Project, others) if force else ()), project):
        settings = _with_spec(settings, written, root / SETTINGS, notes)
        workflow = _with_steps(workflow, written, root / WORKFLOW)
    workflow = _with_install(workflow, wanted, root / WORKFLOW, notes)
    after = {SETTINGS: settings, WORKFLOW: workflow, IGNORED: _with_ignored(before[IGNORED] or "")}
    return {path: text for path, text in after.items() if text != before.get(path)}, notes


def _text(path: Path) -> str | None:
    """Return the text of a file; None if there is none."""
    return toml.text_of(str(path)) if path.exists() else None


def _with_spec(text: str, project: Project, path: Path, notes: list[str]) -> str:
    """Add the SPEC to `specs` of the settings; if it cannot be added, return them unchanged and add a note."""
    try:
        content = toml.parsed(text, str(path))
    except InputError as error:
        raise _taken(path, str(error).removeprefix(f"{path}: it ").removeprefix(f"{path}: ")) from None
    spec = project.language.spec
    specs = content.get("specs", [])
    if isinstance(specs, list) and spec in specs:
        return text
    after = _listed(text, project) if "specs" in content else f"specs = [{json.dumps(spec)}]\n\n{text}"
    try:
        if toml.parsed(after, str(path)) == {**content, "specs": [*specs, spec]}:
            return after
    except (InputError, TypeError):  # TypeError: specs is no list
        pass
    notes.append(f"{path} was not changed: add {json.dumps(spec)} to its specs, or `hypcheck verify` leaves it out")
    return text


def _listed(text: str, project: Project) -> str:
    """Add the SPEC at the end of the list `specs`, on a line below a comment with its build command."""

    def longer(match: re.Match[str]) -> str:
        listed = match["listed"].rstrip()
        comma = "," if listed and not listed.endswith(",") else ""
        spec = json.dumps(project.language.spec)
        return f"specs = [{listed}{comma}\n    # Made by: {project.build}\n    {spec},\n]"

    return _SPECS.sub(longer, text, count=1)


def _with_steps(text: str, project: Project, path: Path) -> str:
    """Add the steps of the language to the workflow, before the step that keeps the reports. Raises InputError."""
    steps = project.filled("common", "steps.yml")
    if steps in text:
        return text
    places = list(_KEEP_STEP.finditer(text))
    if len(places) != 1:
        raise _taken(path, "has no step `Keep the report`, before which init adds steps")
    return f"{text[: places[0].start()]}{steps}{text[places[0].start() :]}"


def _with_install(text: str, wanted: Requirement | None, path: Path, notes: list[str]) -> str:
    """Put a step that installs `wanted` in the place of the step that fails because no package was named.

    Add a note where the user has to edit the file.
    """
    nothing = _install(None)
    if wanted is None:
        if nothing in text:
            notes.append(f"nothing to install was named: edit the step `Install hypcheck` in {path}")
        return text
    if shlex.quote(wanted.text) in text:
        return text
    after = text.replace(nothing, _install(wanted))
    if after == text:
        notes.append(f"{path} still installs something other than --from: edit its first step to change it")
    return after


def _install(wanted: Requirement | None) -> str:
    """Return the step that installs `wanted`, or the one that fails because nothing was named."""
    if wanted is None:
        return filled("common", "install-nothing.yml", {}).rstrip("\n")
    about = [
        line
        for sentence in wanted.says
        for line in textwrap.wrap(f"{sentence[:1].upper()}{sentence[1:]}.", _WIDTH, break_long_words=False)
    ]
    values = {"REQUIREMENT": shlex.quote(wanted.text), "SAYS": "\n".join(f"        # {line}" for line in about)}
    return "\n".join(line for line in filled("common", "install.yml", values).splitlines() if line)


def _with_ignored(text: str) -> str:
    """Add to the .gitignore the files that runs write."""
    title, *wanted = filled("common", "ignored", {}).splitlines()
    there = {line.strip().strip("/") for line in text.splitlines()}
    missing = [line for line in wanted if line.strip("/") not in there]
    return "\n".join([*text.splitlines(), title, *missing, ""]) if missing else text


def _taken(path: Path, reason: str) -> InputError:
    """Make the error that nothing can be added to an existing file."""
    return InputError(
        f"{path} exists; nothing was written; --force replaces it, as nothing can be added to it: it {reason}"
    )


def write_all(root: Path, texts: Mapping[str, str], *, force: bool, replaced: Collection[str] = ()) -> None:
    """Write each text to its path below `root`, which is made if needed.

    Existing files are replaced only with `force`, or if their path is in `replaced`. All texts are on the disk before
    the first one takes its place, and an error leaves nothing new behind. Raises InputError naming a path that is in
    the way, or that the system refuses.
    """
    targets = {root / path: text for path, text in texts.items()}
    there = [root / path for path in texts if os.path.lexists(root / path) and path not in replaced]
    _refuse(there, force=force)
    with ExitStack() as stack:
        for target in targets:
            stack.enter_context(made_folder(target.parent))
            stack.enter_context(_new(target))
        for target, text in targets.items():
            writer = stack.enter_context(replace_output(str(target)))
            writer.write(text.encode())
            writer.flush(to_disk=True)


def _refuse(there: list[Path], *, force: bool) -> None:
    """Raise InputError if one of these existing paths may not be replaced."""
    for path in there:
        if path.exists() and not path.is_file():
            raise InputError(f"{path} is in the way; it must be a file, or not exist")
    if there and not force:
        more = len(there) - 1
        others = f", and {counted(more, 'other file')} that init writes" if more else ""
        raise InputError(f"{there[0]} exists{others}; nothing was written; --force replaces existing files")


@contextmanager
def _new(path: Path) -> Iterator[None]:
    """Remove a new file after an error within the block."""
    there = os.path.lexists(path)
    try:
        yield
    except BaseException:
        if not there:
            path.unlink(missing_ok=True)
        raise
