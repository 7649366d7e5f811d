"""`hypcheck init`: options into a project's files, written; then what to type next."""

from __future__ import annotations

import os
import shlex
from pathlib import Path
from typing import TYPE_CHECKING

import click

from hypcheck.errors import InputError
from hypcheck.scaffold.languages import LANGUAGES
from hypcheck.version import VERSION

if TYPE_CHECKING:
    from hypcheck.scaffold.project import Project

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
    metavar="VERSION|GIT-URL",
    default=VERSION,
    show_default=True,
    help="The hypcheck that the workflow installs; a URL is pinned by @TAG or @COMMIT at its end.",
)
@click.option("--force", is_flag=True, help="Replace files that are there.")
def init(language: str, directory: Path, name: str | None, source: str, *, force: bool) -> None:
    """Write what gates an implementation of your own: an adapter around a stub, hypcheck.toml, a CI workflow.

    \b
    hypcheck init --language c --directory engine
    hypcheck init --language rust --from https://example.org/hypcheck.git@v1.2.0

    The adapter has a folder of its own and needs no dependencies. The stub is the paper's Table 2, right in the paper's
    scenes and wrong elsewhere: replace it with a call of your predicate. docs/protocol.md says how the adapter speaks.
    """  # noqa: D301 - the \b is click's: what follows it is not to be filled
    from hypcheck.scaffold.project import Project
    from hypcheck.scaffold.wording import requirement
    from hypcheck.scaffold.writing import write_all

    wanted = requirement(source)
    project = Project(LANGUAGES[language], _named(name, directory), wanted.text)
    texts = project.files()
    write_all(directory, texts, force=force)
    for path in texts:
        click.echo(f"{directory / path}{'   the stub: replace it' if path == project.predicate else ''}")
    if not wanted.pinned:
        click.echo(f"the workflow installs what {source} holds on the day; an @TAG or @COMMIT at its end pins that")
    _say_next(project, directory)


def _say_next(project: Project, directory: Path) -> None:
    click.echo(f"\nType next{'' if directory == Path() else f', in {shlex.quote(str(directory))}'}:\n")
    for command in project.commands:
        click.echo(f"    {command}")
    click.echo(f"\nThe second passes. The third fails, on the ring for one, until {project.predicate} is yours.")


def _named(name: str | None, directory: Path) -> str:
    from hypcheck.scaffold.wording import safe_name

    if name is None:
        return safe_name(os.path.basename(os.path.abspath(directory))) or _NAMELESS
    safe = safe_name(name)
    if not safe:
        raise InputError(f"--name is {name!r}; it must have a letter or a digit of ASCII")
    if safe != name:
        click.echo(f"the name {name!r} is written as {safe}")
    return safe
