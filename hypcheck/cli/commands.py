"""The commands by name, imported when called; their completion by the shell; exit codes and error messages.

How the program ends: one table from errors to exit code and message.

A closed pipe ends quietly with 141, as a program that the system stops for it would: a reader that left early must not
turn a failure into a pass, nor a run into an error of ours.

Groups of commands: what they say of a command that is missing or unknown, and of which command an error is.

The commands by name. A command's module is imported when the command is asked for, and its work when it runs.

Completion by the shell: the script that makes it ask, and the answer when it asks.

The shell starts `hypcheck` with the variable COMPLETE set for every press of the key, so commands are loaded as for
--help: without numpy. The protocol and the scripts are click's.
"""

from __future__ import annotations

import errno
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

import click
from click.shell_completion import CompletionItem, ShellComplete, get_completion_class

from hypcheck.cli import COMPLETE
from hypcheck.errors import Exit, HypcheckError, InputError, Terminated, limit_reached, system_reason
from hypcheck.messages import sentence, suggestion
from hypcheck.version import VERSION


@dataclass(frozen=True, slots=True)
class Ending:
    """A status and the lines for standard error, none where it ends quietly."""

    code: int
    lines: tuple[str, ...] = ()


def ending_of(error: BaseException) -> Ending:
    """How the program ends that `error` reached: by the first row of the table that fits."""
    for kind, ending in _ENDINGS:
        if isinstance(error, kind):
            return ending(error)
    return _internal(error)


def _expected(error: BaseException) -> Ending:
    code = error.exit_code if isinstance(error, HypcheckError) else Exit.INTERNAL
    return Ending(code, (f"hypcheck: error: {sentence(error)}",))


def _usage(error: BaseException) -> Ending:
    message = sentence(_message_of(error)).rstrip(".")
    context = error.ctx if isinstance(error, click.UsageError) else None
    command = context.command_path if context else "hypcheck"
    return Ending(
        Exit.USAGE,
        (
            f"hypcheck: error: {message[:1].lower()}{message[1:]}",
            f"hypcheck: '{command} --help' tells what is possible",
        ),
    )


def _message_of(error: BaseException) -> str:
    if isinstance(error, click.NoSuchOption):
        meant = suggestion(error.option_name, error.possibilities or (), most=1)
        return f"there is no option {error.option_name!r}" + f"; {meant}" * meant.startswith("did you mean")
    context = error.ctx if isinstance(error, click.UsageError) else None
    if context is not None and isinstance(context.command, click.Group) and str(error) == "Missing command.":
        return f"missing command; there are {', '.join(context.command.list_commands(context))}"
    return error.format_message() if isinstance(error, click.ClickException) else str(error)


def _system(error: BaseException) -> Ending:
    if isinstance(error, OSError) and error.errno in _FULL_OR_BROKEN:
        return Ending(Exit.USAGE, (f"hypcheck: error: cannot write: {sentence(system_reason(error))}",))
    limit = limit_reached(error)
    return _internal(error) if limit is None else _expected(limit)


_FULL_OR_BROKEN = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EROFS)


def _internal(error: BaseException) -> Ending:
    what = sentence(f"{type(error).__name__}: {error}".rstrip(": "))
    ask = "this is a fault of hypcheck; please report it, with what `hypcheck --debug` and the same arguments print"
    return Ending(Exit.INTERNAL, (f"hypcheck: internal error: {what}", f"hypcheck: {ask}"))


_ENDINGS: tuple[tuple[type[BaseException], Callable[[BaseException], Ending]], ...] = (
    (HypcheckError, _expected),
    (click.ClickException, _usage),
    (KeyboardInterrupt, lambda _: Ending(Exit.INTERRUPTED, ("hypcheck: interrupted",))),
    (click.Abort, lambda _: Ending(Exit.INTERRUPTED, ("hypcheck: interrupted",))),
    (Terminated, lambda _: Ending(Exit.TERMINATED, ("hypcheck: terminated",))),
    (BrokenPipeError, lambda _: Ending(Exit.CLOSED_PIPE)),
    (OSError, _system),
)


class CommandGroup(click.Group):
    """A group that asks for one of its commands in a sentence, where click would print the whole help as an error."""

    def __init__(self, *given: Any, **named: Any) -> None:  # noqa: ANN401 - click's
        super().__init__(*given, **{**named, "no_args_is_help": False})

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """As click does, with a better word about a command that is not there. Raises click.UsageError.

        While a shell completes a line, an unknown command has no completions and is no error.
        """
        name, known = args[0], self.list_commands(ctx)
        if name in known or name.startswith("-") or ctx.resilient_parsing:
            return super().resolve_command(ctx, args)
        raise click.UsageError(f"there is no command {name!r}; {suggestion(name, known, most=1)}", ctx)


COMMANDS = {
    "classify": "hypcheck.cli.classify:classify",
    "verify": "hypcheck.cli.verify:verify",
    "bench": "hypcheck.cli.bench:bench",
    "cases": "hypcheck.cli.cases:cases",
    "hunt": "hypcheck.cli.hunt:hunt",
    "minimise": "hypcheck.cli.hunt:minimise",
    "replay": "hypcheck.cli.hunt:replay",
    "derive": "hypcheck.cli.paper:derive",
    "report": "hypcheck.cli.record:report",
    "record": "hypcheck.cli.record:record_",
    "plan": "hypcheck.cli.scene:plan",
    "emit": "hypcheck.cli.scene:emit",
    "simulate": "hypcheck.cli.paper:simulate",
    "init": "hypcheck.cli.setup:init",
    "info": "hypcheck.cli.setup:info",
    "completion": "hypcheck.cli.commands:completion",
}
"""Name → module:attribute of the click command."""

_WORDS = f"{__name__}.words"
"""Where a context keeps what stands behind the command: who asks for help gets it, whatever the settings are."""


class LazyGroup(CommandGroup):
    """A group whose commands are those of COMMANDS."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002 - click's signature
        """The names, in the order in which they are of use to a newcomer."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:  # noqa: ARG002
        """The command of that name, or None."""
        if cmd_name not in COMMANDS:
            return None
        module, _, attribute = COMMANDS[cmd_name].partition(":")
        command = getattr(import_module(module), attribute)
        if not isinstance(command, click.Command):
            raise TypeError(f"{COMMANDS[cmd_name]} is no click command")
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """As every group, keeping the words behind the command."""
        ctx.meta[_WORDS] = args[1:]
        return super().resolve_command(ctx, args)


@click.group(
    cls=LazyGroup,
    epilog="Exit codes: " + "; ".join(f"{code:d} {code.meaning}" for code in Exit) + ".",
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
@click.version_option(VERSION, message="%(prog)s %(version)s")
@click.option("--debug", is_flag=True, expose_value=False, help="Show the traceback of an error (before the command).")
@click.option("--no-settings", is_flag=True, help="Leave hypcheck.toml aside (before the command).")
@click.pass_context
def hypcheck(context: click.Context, /, no_settings: bool) -> None:
    """Where a spheroid stands to a circular hyperboloid of one sheet: exact answers, proofs, and a judge of others."""
    if no_settings or any(name in context.meta.get(_WORDS, ()) for name in context.help_option_names):
        return
    from hypcheck.cli.settings import COMMANDS as SETTING
    from hypcheck.cli.settings import FILE, read_settings

    found = read_settings(Path(FILE)) if context.invoked_subcommand in SETTING else None
    if found is not None:
        context.obj, context.default_map = found, found.default_map


def context_of(words: Iterable[str]) -> click.Context:
    """A context of the command that these words name, to tell whose an option is."""
    context = click.Context(hypcheck, info_name="hypcheck")
    for word in words:
        group = context.command
        if isinstance(group, CommandGroup) and (command := group.get_command(context, word)) is not None:
            context = click.Context(command, parent=context, info_name=word)
    return context


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
    # DROPPED

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
