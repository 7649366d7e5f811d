"""The files that all languages of a repository share (settings, workflow, .gitignore), and all files written together.

The first `init` writes the shared files. A later one, for another language, adds what it needs and changes nothing
else, so that both are gated. If nothing can be added to a file, it is refused, or a note says so. All files are written
or none, and existing files are replaced only on demand.
"""

from __future__ import annotations

import json
import os
import re
import shlex
import textwrap
from collections.abc import Collection, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path

from hypcheck import toml
from hypcheck.errors import InputError
from hypcheck.messages import counted
from hypcheck.scaffold.project import LANGUAGES, Project, filled
from hypcheck.scaffold.requirement import Requirement
from hypcheck.tables.streams import made_folder, replace_output

SETTINGS = "hypcheck.toml"
WORKFLOW = ".github/workflows/hypcheck.yml"
IGNORED = ".gitignore"

_SPECS = re.compile(r"^specs[ \t]*=[ \t]*\[(?P<listed>.*|(?:.*\n)+?)\](?=[ \t]*(?:#.*)?$)", re.MULTILINE)
"""A list on one line, or one whose closing bracket begins a line."""
_KEEP_STEP = re.compile(r"^ *- name: Keep the report *$", re.MULTILINE)
"""The step of a workflow before which init adds the steps of a language."""
_WIDTH = 108


def shared_files(
    root: Path, project: Project, wanted: Requirement | None, *, force: bool
) -> tuple[dict[str, str], list[str]]:
    """The texts to write or change, by path, and notes about what could not be added.

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
    return toml.text_of(str(path)) if path.exists() else None


def _with_spec(text: str, project: Project, path: Path, notes: list[str]) -> str:
    """The settings with the SPEC added to `specs`; unchanged, with a note, if it cannot be added."""
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
    """The text with the SPEC at the end of its list, on a line below a comment with its build command."""

    def longer(match: re.Match[str]) -> str:
        listed = match["listed"].rstrip()
        comma = "," if listed and not listed.endswith(",") else ""
        spec = json.dumps(project.language.spec)
        return f"specs = [{listed}{comma}\n    # Made by: {project.build}\n    {spec},\n]"

    return _SPECS.sub(longer, text, count=1)


def _with_steps(text: str, project: Project, path: Path) -> str:
    """The workflow with the steps of the language before the step that keeps the reports."""
    steps = project.filled("common", "steps.yml")
    if steps in text:
        return text
    places = list(_KEEP_STEP.finditer(text))
    if len(places) != 1:
        raise _taken(path, "has no step `Keep the report`, before which init adds steps")
    return f"{text[: places[0].start()]}{steps}{text[places[0].start() :]}"


def _with_install(text: str, wanted: Requirement | None, path: Path, notes: list[str]) -> str:
    """The workflow with a step that installs `wanted`, in place of the step that fails because nothing was named."""
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
    """The .gitignore with the files that runs write."""
    title, *wanted = filled("common", "ignored", {}).splitlines()
    there = {line.strip().strip("/") for line in text.splitlines()}
    missing = [line for line in wanted if line.strip("/") not in there]
    return "\n".join([*text.splitlines(), title, *missing, ""]) if missing else text


def _taken(path: Path, reason: str) -> InputError:
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
