"""`hypcheck init`: options into a project's files, written; then what to type next."""

from __future__ import annotations

import os
import shlex
from collections.abc import Collection
from pathlib import Path

import click

from hypcheck.errors import InputError
from hypcheck.scaffold.languages import LANGUAGES
from hypcheck.scaffold.project import Project
from hypcheck.visible import printable

_NAMELESS = "predicate"
"""The name where neither --name nor the folder has one."""


@click.command(short_help="Write an adapter around a stub, its build line, settings and a CI workflow.")
@click.option("--language", type=click.Choice(list(LANGUAGES)), required=True)
@click.option(
    "--directory",
    type=click.Path(path_type=Path),
    default=Path(),
    help="The repository's root; by default the working directory.",
)
@click.option("--name", help="What reports call the implementation; by default as the directory.")
@click.option(
    "--from",
    "source",
    metavar="REQUIREMENT",
    help="What the workflow installs, pinned: a git URL (https, ssh, file), a wheel or sdist, or NAME==VERSION.",
)
@click.option("--force", is_flag=True, help="Replace files that are there.")
def init(language: str, directory: Path, name: str | None, source: str | None, *, force: bool) -> None:
    """Write what gates an implementation of your own: an adapter around a stub, hypcheck.toml, a CI workflow.

    \b
    hypcheck init --language c --directory engine
    hypcheck init --language rust --from https://example.org/hypcheck.git@v1.2.0
    hypcheck init --language go --from ./vendor/hypcheck-1.2.0-py3-none-any.whl

    The adapter has a folder of its own and needs no dependencies. The stub is the paper's Table 2, right in the paper's
    scenes and wrong elsewhere: replace it with a call of your predicate. docs/protocol.md says how the adapter speaks.

    A second language in the same directory is added to hypcheck.toml and to the workflow, which then gate both.

    Without --from the workflow fails in its step `Install hypcheck`, which says what to write there: no package index
    is known to have hypcheck, and anyone may take a free name. A branch or tag of a git URL is pinned to its commit.
    """  # noqa: D301 - the \b is click's: what follows it is not to be filled
    from hypcheck.scaffold.requirement import pinned, requirement
    from hypcheck.scaffold.shared import IGNORED, shared_files
    from hypcheck.scaffold.writing import write_all

    wanted = pinned(requirement(source, directory)) if source is not None else None
    project = Project(LANGUAGES[language], _named(name, directory))
    shared, told = shared_files(directory, project, wanted, force=force)
    added = {path for path in shared if os.path.exists(directory / path) and (path == IGNORED or not force)}
    texts = project.files() | shared
    write_all(directory, texts, force=force, replaced=added)
    for path in texts:
        click.echo(printable(f"{directory / path}{_remark(path, project, added)}"))
    for sentence in (*told, *(wanted.says if wanted is not None else ())):
        click.echo(printable(sentence))
    _say_next(project, directory)


def _remark(path: str, project: Project, added: Collection[str]) -> str:
    if path == project.predicate:
        return "   the stub: replace it"
    return "   was there: added to" if path in added else ""


def _say_next(project: Project, directory: Path) -> None:
    click.echo(f"\nType next{'' if directory == Path() else f', in {printable(shlex.quote(str(directory)))}'}:\n")
    for command in project.commands:
        click.echo(printable(f"    {command}"))
    click.echo(f"\nThe second passes. The third fails, on the ring for one, until {project.predicate} is yours.")


def _named(name: str | None, directory: Path) -> str:
    from hypcheck.scaffold.project import safe_name

    if name is None:
        return safe_name(os.path.basename(os.path.abspath(directory))) or _NAMELESS
    safe = safe_name(name)
    if not safe:
        raise InputError(f"--name is {name!r}; it must have a letter or a digit of ASCII")
    if safe != name:
        click.echo(f"the name {name!r} is written as {safe}")
    return safe
