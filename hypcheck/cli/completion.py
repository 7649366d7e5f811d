"""Completion by the shell: the script that makes it ask, and the answer when it asks.

The shell starts `hypcheck` with the variable COMPLETE set for every press of the key, so commands are loaded as for
--help: without numpy. The protocol and the scripts are click's.
"""

from __future__ import annotations

import click
from click.shell_completion import CompletionItem, ShellComplete, get_completion_class

from hypcheck.cli import COMPLETE
from hypcheck.errors import InputError

SHELLS = ("bash", "zsh", "fish")


@click.command(short_help="Print the script that completes commands and options in bash, zsh or fish.")
@click.argument("shell", metavar="SHELL", type=click.Choice(SHELLS))
def completion(shell: str) -> None:
    """Print the script that completes commands, options and their values in SHELL: bash, zsh or fish.

    \b
    bash 4.4 or later, in ~/.bashrc:
        eval "$(hypcheck completion bash)"
    zsh, in ~/.zshrc, after compinit:
        eval "$(hypcheck completion zsh)"
    fish, once:
        hypcheck completion fish > ~/.config/fish/completions/hypcheck.fish

    The script calls the hypcheck that is first on PATH. Open a new shell afterwards.
    """  # noqa: D301 - the \b is click's: what follows it is not to be filled
    click.echo(_completing(shell).source())


def answer(instruction: str) -> None:
    """Print what the variable COMPLETE asks for: a shell's script, or completions. Raises InputError."""
    shell, _, wanted = instruction.partition("_")
    if shell not in SHELLS or wanted not in {"source", "complete"}:
        known = ", ".join(f"{name}_source" for name in SHELLS)
        raise InputError(f"{COMPLETE} is {instruction!r}; it must be one of {known}, or not set")
    completing = _completing(shell)
    try:
        click.echo(completing.source() if wanted == "source" else _completions(completing))
    except KeyError as error:
        raise InputError(f"{COMPLETE} is {instruction!r}, but {error.args[0]} is not set; the shell sets it") from None
    except ValueError:  # of COMP_CWORD
        raise InputError(f"{COMPLETE} is {instruction!r}, but COMP_CWORD is no number; the shell sets it") from None


def _completing(shell: str) -> ShellComplete:
    from hypcheck.cli.commands import hypcheck

    kind = get_completion_class(shell)
    if kind is None:
        raise InputError(f"the installed version of click has no completion for {shell}")
    return kind(hypcheck, {}, "hypcheck", COMPLETE)


def _completions(completing: ShellComplete) -> str:
    """What fits the unfinished word; where nothing is known to, the shell is told to offer files."""
    words, unfinished = completing.get_completion_args()
    found = completing.get_completions(words, unfinished)
    if not found and not unfinished.startswith("-"):
        found = [CompletionItem(unfinished, type="file")]
    return "\n".join(map(completing.format_completion, found))
