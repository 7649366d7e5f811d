"""The commands by name, loaded when called; their completion by the shell; exit codes and error messages.

One table maps each error to its exit code and message. A closed pipe ends quietly with 141, as the system would end the
program: a reader that stops early must not turn a failure into a pass, nor a run into an internal error. For completion
the shell starts `hypcheck` at every press of the key with the variable COMPLETE set, so commands load as for --help,
without numpy, and options.py what has the names of one value. The protocol and the scripts are click's.
"""

from __future__ import annotations

import errno
import re
import sys
from collections.abc import Callable, Iterable, Sequence
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
    """The end of the program: the exit code, and lines for standard error."""

    code: int
    lines: tuple[str, ...] = ()


def ending_of(error: BaseException) -> Ending:
    """Return the end of the program after `error`: the first row of the table that fits."""
    for kind, ending in _ENDINGS:
        if isinstance(error, kind):
            return ending(error)
    return _internal(error)


def _expected(error: BaseException) -> Ending:
    """Return the end of the program after an error of hypcheck: its exit code and its sentence."""
    code = error.exit_code if isinstance(error, HypcheckError) else Exit.INTERNAL
    return Ending(code, (f"hypcheck: error: {sentence(error)}",))


def _usage(error: BaseException) -> Ending:
    """Return the end of the program after wrong usage: the message, and the command for help."""
    message = sentence(_message_of(error)).rstrip(".")
    context = error.ctx if isinstance(error, click.UsageError) else None
    command = context.command_path if context else "hypcheck"
    return Ending(
        Exit.USAGE,
        (
            f"hypcheck: error: {message[:1].lower()}{message[1:]}",
            f"hypcheck: '{command} --help' shows what is possible",
        ),
    )


def _message_of(error: BaseException) -> str:
    """Return the message of click's error, with a suggestion if a name is not known."""
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
    """A group whose message about a missing command is one sentence; click prints the whole help."""

    def __init__(self, *arguments: Any, **named: Any) -> None:  # noqa: ANN401 - click's
        super().__init__(*arguments, **{**named, "no_args_is_help": False})

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command as click does, but suggest a name for an unknown one. Raises click.UsageError.

        While a shell completes a line, an unknown command has no completions and is no error.
        """
        name, known = args[0], self.list_commands(ctx)
        if name in known or name.startswith("-") or ctx.resilient_parsing:
            return super().resolve_command(ctx, args)
        raise click.UsageError(f"there is no command {name!r}; {suggestion(name, known, most=1)}", ctx)


GROUPS = {
    "Use": {
        "classify": "hypcheck.cli.classify:classify",
        "plan": "hypcheck.cli.scene:plan",
        "emit": "hypcheck.cli.scene:emit",
        "flight": "hypcheck.cli.scene:flight",
        "show": "hypcheck.cli.scene:show",
    },
    "Test": {
        "init": "hypcheck.cli.setup:init",
        "verify": "hypcheck.cli.verify:verify",
        "replay": "hypcheck.cli.hunt:replay",
        "explain": "hypcheck.cli.hunt:explain",
        "hunt": "hypcheck.cli.hunt:hunt",
        "minimise": "hypcheck.cli.hunt:minimise",
        "bench": "hypcheck.cli.bench:bench",
        "engines": "hypcheck.cli.engines:engines",
        "cases": "hypcheck.cli.cases:cases",
        "report": "hypcheck.cli.record:report",
        "record": "hypcheck.cli.record:record_",
    },
    "Understand": {
        "derive": "hypcheck.cli.paper:derive",
        "simulate": "hypcheck.cli.paper:simulate",
        "info": "hypcheck.cli.setup:info",
        "completion": "hypcheck.cli.commands:completion",
    },
}
"""The commands by what they are for: name → module:attribute of the click command."""

COMMANDS = {name: place for group in GROUPS.values() for name, place in group.items()}

OF_POSIX = ("verify", "replay", "hunt", "minimise", "bench", "engines", "simulate")
"""The commands that start programs or workers and watch them. They do not run on Windows; the others do."""

_WORDS = f"{__name__}.words"
"""The key of the words after the command in a context's meta: --help among them works with bad settings too."""


class LazyGroup(CommandGroup):
    """A group whose commands are those of COMMANDS."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002 - click's signature
        """Return the names, group by group."""
        return list(COMMANDS)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the commands, each group under its heading."""
        widest = max(map(len, COMMANDS))
        for title, names in GROUPS.items():
            commands = [(name, self.get_command(ctx, name)) for name in names]
            limit = formatter.width - 6 - widest
            rows = [
                (f"{name:{widest}}", command.get_short_help_str(limit))
                for name, command in commands
                if command is not None
            ]
            with formatter.section(title):
                formatter.write_dl(rows)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:  # noqa: ARG002
        """Return the command of that name, or None."""
        if cmd_name not in COMMANDS:
            return None
        module, _, attribute = COMMANDS[cmd_name].partition(":")
        command: click.Command = getattr(import_module(module), attribute)
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command as every group does; keep the words after it."""
        ctx.meta[_WORDS] = args[1:]
        return super().resolve_command(ctx, args)


@click.group(
    cls=LazyGroup,
    epilog="Exit codes: " + "; ".join(f"{code:d} {code.meaning}" for code in Exit) + ".",
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
@click.version_option(VERSION, message="%(prog)s %(version)s")
@click.option("--debug", is_flag=True, expose_value=False, help="Show the traceback of an error (before the command).")
@click.option("--no-settings", is_flag=True, help="Ignore hypcheck.toml (before the command).")
@click.pass_context
def hypcheck(context: click.Context, /, no_settings: bool) -> None:
    """The position of a spheroid relative to a hyperboloid of one sheet: exact answers, proofs, tests of programs."""
    if no_settings or any(name in context.meta.get(_WORDS, ()) for name in context.help_option_names):
        return
    if sys.platform == "win32" and context.invoked_subcommand in OF_POSIX:
        others = ", ".join(name for name in COMMANDS if name not in OF_POSIX)
        raise InputError(
            f"'hypcheck {context.invoked_subcommand}' starts programs and watches them, which it can do on Linux and"
            f" macOS only; on Windows use {others}"
        )
    from hypcheck.cli import settings

    if context.invoked_subcommand in settings.COMMANDS:
        values = settings.read_settings(Path(settings.FILE))
        if values is not None:
            context.obj, context.default_map = values, values.default_map


def context_of(words: Iterable[str]) -> click.Context:
    """Return a context of the command that these words name, for the message about a wrong option."""
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
    """  # noqa: D301 - \b tells click not to fill what follows
    click.echo(_script(shell))


def answer_shell(instruction: str) -> None:
    """Print what the variable COMPLETE asks for: the script of a shell, or completions. Raises InputError."""
    shell, _, wanted = instruction.partition("_")
    if shell not in SHELLS or wanted not in {"source", "complete"}:
        known = ", ".join(f"{name}_source" for name in SHELLS)
        raise InputError(f"{COMPLETE} is {instruction!r}; it must be one of {known}, or not set")
    completing = _completing(shell)
    try:
        click.echo(_script(shell) if wanted == "source" else _completions(completing))
    except KeyError as error:
        raise InputError(f"{COMPLETE} is {instruction!r}, but {error.args[0]} is not set; the shell sets it") from None
    except ValueError:  # of COMP_CWORD
        raise InputError(f"{COMPLETE} is {instruction!r}, but COMP_CWORD is not a number; the shell sets it") from None


def _completing(shell: str) -> ShellComplete:
    """Return click's completion for a shell. Raises InputError if it has none."""
    kind = get_completion_class(shell)
    if kind is None:
        raise InputError(f"the installed version of click has no completion for {shell}")
    return kind(hypcheck, {}, "hypcheck", COMPLETE)


def _script(shell: str) -> str:
    """Return the shell's script. That of click cuts fish's values off at their first comma."""
    return _completing(shell).source().replace('string split ","', 'string split --max 1 ","')


def _completions(completing: ShellComplete) -> str:
    """Return the completions of the unfinished word in the form of the shell. Without any, the shell offers files."""
    words, part = completing.get_completion_args()
    *words, unfinished = _unsplit([*words, part]) if completing.name == "bash" else [*words, part]
    completions = completing.get_completions(words, unfinished)
    if not completions and not unfinished.startswith("-"):
        return completing.format_completion(CompletionItem(part, type="file"))
    option, equals, _ = unfinished.rpartition("=") if unfinished.startswith("--") else ("", "", "")
    kept = unfinished if _SEPARATORS.fullmatch(part) else unfinished.removesuffix(part)  # the shell replaces the part
    for item in (item for item in completions if item.value):
        item.value = f"{option}{equals}{item.value}".removeprefix(kept)
    return "\n".join(map(completing.format_completion, completions))


_SEPARATORS = re.compile("[:=]+")


def _unsplit(words: Sequence[str]) -> list[str]:
    """Join words that bash has split at : and = (builtin:fast comes as three); return those of the command line."""
    whole: list[str] = []
    open_ = False
    for word in words:
        separates = _SEPARATORS.fullmatch(word) is not None
        if whole and (separates or open_):
            whole[-1] += word
        else:
            whole.append(word)
        open_ = separates
    return whole
