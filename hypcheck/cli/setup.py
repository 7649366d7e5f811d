"""`hypcheck init` and `hypcheck info`: the files of a project under test, and the parts of this installation."""

from __future__ import annotations

import os
import shlex
from collections.abc import Collection
from pathlib import Path
from typing import Any

import click

from hypcheck.errors import InputError
from hypcheck.messages import printable
from hypcheck.scaffold.project import LANGUAGES, STUBS, Project

_DEFAULT_NAME = "predicate"
"""The name if neither --name nor the folder gives one."""


@click.command(short_help="Write an adapter around a stub, its build line, settings and a CI workflow.")
@click.option("--language", type=click.Choice(list(LANGUAGES)), required=True)
@click.option(
    "--directory",
    type=click.Path(path_type=Path),
    default=Path(),
    help="The repository's root; by default the working directory.",
)
@click.option(
    "--question",
    "stub",
    type=click.Choice(STUBS),
    default=STUBS[0],
    show_default=True,
    help="What the stub answers: the position of a spheroid, or whether it meets contact on a sweep.",
)
@click.option("--name", help="The name of the implementation in reports; by default that of the directory.")
@click.option(
    "--from",
    "source",
    metavar="REQUIREMENT",
    help="What the workflow installs, pinned: a git URL (https, ssh, file), a wheel or sdist, or NAME==VERSION.",
)
@click.option("--force", is_flag=True, help="Replace existing files.")
def init(language: str, directory: Path, stub: str, name: str | None, source: str | None, *, force: bool) -> None:
    """Write the files that gate your implementation: an adapter around a stub, hypcheck.toml, a CI workflow.

    \b
    hypcheck init --language c --directory engine
    hypcheck init --language rust --from https://HOST/OWNER/hypcheck.git@COMMIT
    hypcheck init --language go --from ./vendor/hypcheck-VERSION.whl

    The adapter has a folder of its own and needs no dependencies. The stub is the paper's Table 2, right in the paper's
    scenes and wrong elsewhere: replace it with a call of your predicate. docs/protocol.md says how the adapter speaks.
    With --question passage it answers about sweeps, and the stub takes the spheroid for its centre.

    A second language in the same directory is added to hypcheck.toml and to the workflow, which then gate both.

    Without --from the workflow fails in its step `Install hypcheck`, which says what to write there: hypcheck is in no
    known package index, and anyone may take a free name. A branch or tag of a git URL is pinned to its commit.
    """  # noqa: D301 - \b tells click not to fill what follows
    from hypcheck.scaffold.project import IGNORED, shared_files, write_all
    from hypcheck.scaffold.requirement import pinned, requirement

    wanted = pinned(requirement(source, directory)) if source is not None else None
    project = Project(LANGUAGES[language], _named(name, directory), stub)
    shared, notes = shared_files(directory, project, wanted, force=force)
    added = {path for path in shared if os.path.exists(directory / path) and (path == IGNORED or not force)}
    texts = project.files() | shared
    write_all(directory, texts, force=force, replaced=added)
    for path in texts:
        click.echo(printable(f"{directory / path}{_remark(path, project, added)}"))
    for sentence in (*notes, *(wanted.says if wanted is not None else ())):
        click.echo(printable(sentence))
    _print_next(project, directory)


def _remark(path: str, project: Project, added: Collection[str]) -> str:
    """Return the words behind the path of a written file."""
    if path == project.predicate:
        return "   the stub: replace it"
    return "   existed: added to" if path in added else ""


def _print_next(project: Project, directory: Path) -> None:
    """Print the commands to type next."""
    click.echo(f"\nType next{'' if directory == Path() else f', in {printable(shlex.quote(str(directory)))}'}:\n")
    for command in project.commands:
        click.echo(printable(f"    {command}"))
    where = "where only the body touches, not its centre," if project.stub == "passage" else "on the ring for example,"
    click.echo(f"\nThe second passes. The third fails, {where} until {project.predicate} is yours.")
    if project.emit:
        click.echo(f"Code that is right for every row comes from:\n\n    {project.emit}")


def _named(name: str | None, directory: Path) -> str:
    """Return the name of the implementation: that of --name, or of the directory. Raises InputError if it is bad."""
    from hypcheck.scaffold.project import safe_name

    if name is None:
        return safe_name(os.path.basename(os.path.abspath(directory))) or _DEFAULT_NAME
    safe = safe_name(name)
    if not safe:
        raise InputError(f"--name is {name!r}; it must have a letter or a digit of ASCII")
    if safe != name:
        click.echo(f"the name {name!r} is written as {safe}")
    return safe


LIBRARIES = ("numpy", "sympy", "mpmath", "python-fcl", "click", "matplotlib", "jinja2", "distributed", "coal")


@click.command(short_help="Show versions, the kernel in use and why, and the oracles.")
@click.option("--json", "as_json", is_flag=True, help="One JSON object.")
def info(as_json: bool) -> None:
    """Show the parts of this installation: versions, the kernel in use and the reason for it, the oracles.

    HYPCHECK_KERNEL=compiled or numpy forces a kernel, HYPCHECK_LEVEL its instruction set, HYPCHECK_THREADS the number
    of threads it may use.
    """
    import json

    facts = installation()
    click.echo(json.dumps(facts) if as_json else "\n".join(_lines(facts)))


def installation() -> dict[str, Any]:
    """Return everything that info shows, as the object of --json."""
    import platform
    import sys

    from hypcheck.implementations.meshes import COAL, FCL
    from hypcheck.kernel.choice import choice, most_threads
    from hypcheck.kernel.core import HEADER
    from hypcheck.record.writer import library_version
    from hypcheck.runs.oracles import ORACLES
    from hypcheck.version import VERSION

    chosen = choice()
    threads = most_threads() if chosen.kernel == "compiled" else 1
    return {
        "hypcheck": VERSION,
        "python": platform.python_version(),
        "executable": sys.executable,
        "system": f"{platform.system()} {platform.machine()}",
        "versions": {name: library_version(name) for name in LIBRARIES},
        "kernel": {"name": chosen.kernel, "level": chosen.level, "reason": chosen.reason, "threads": threads},
        "header": str(HEADER),
        "oracles": {name: _availability_of(oracle.available()) for name, oracle in ORACLES.items()},
        "engines": {engine.title: _availability_of(engine.trouble()) for engine in (FCL, COAL)},
    }


def _availability_of(reason: str | None) -> dict[str, Any]:
    """Return whether a part is available, and the reason if it is not, for JSON."""
    return {"available": reason is None, "reason": reason}


def _lines(facts: dict[str, Any]) -> list[str]:
    """Return the lines about the installation."""
    kernel = facts["kernel"]
    level = f", {kernel['level']}" if kernel["level"] else ""
    present = [f"{name} {text}" for name, text in facts["versions"].items() if text]
    absent = [name for name, text in facts["versions"].items() if not text]
    threads = f"{kernel['threads']} thread{'s' if kernel['threads'] > 1 else ''}"
    return [
        f"hypcheck   {facts['hypcheck']}, Python {facts['python']} on {facts['system']}",
        f"libraries  {', '.join(present)}" + (f"; not installed: {', '.join(absent)}" if absent else ""),
        f"kernel     {kernel['name']}{level}, up to {threads}: {kernel['reason']}",
        f"C header   {facts['header']}",
        *_availability("oracles", facts["oracles"]),
        *_availability("engines", facts["engines"]),
    ]


def _availability(title: str, parts: dict[str, dict[str, Any]]) -> list[str]:
    """Return the lines about parts that may be missing."""
    lines = [
        f"{name}: {'available' if part['available'] else 'not available: ' + part['reason']}"
        for name, part in parts.items()
    ]
    return [f"{title if place == 0 else '':11}{line}" for place, line in enumerate(lines)]
