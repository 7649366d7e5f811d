"""The commands by name. A command's module is imported when the command is asked for, and its work when it runs."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module
from pathlib import Path

import click

from hypcheck.cli.groups import Group
from hypcheck.errors import Exit
from hypcheck.version import VERSION

COMMANDS = {
    "classify": "hypcheck.cli.classify:classify",
    "verify": "hypcheck.cli.verify:verify",
    "bench": "hypcheck.cli.bench:bench",
    "cases": "hypcheck.cli.cases:cases",
    "hunt": "hypcheck.cli.hunt:hunt",
    "minimise": "hypcheck.cli.minimise:minimise",
    "replay": "hypcheck.cli.replay:replay",
    "derive": "hypcheck.cli.derive:derive",
    "report": "hypcheck.cli.report:report",
    "record": "hypcheck.cli.record:record_",
    "plan": "hypcheck.cli.plan:plan",
    "emit": "hypcheck.cli.emit:emit",
    "simulate": "hypcheck.cli.simulate:simulate",
    "init": "hypcheck.cli.init:init",
    "info": "hypcheck.cli.info:info",
    "completion": "hypcheck.cli.completion:completion",
}
"""Name → module:attribute of the click command."""

_WORDS = f"{__name__}.words"
"""Where a context keeps what stands behind the command: who asks for help gets it, whatever the settings are."""


class LazyGroup(Group):
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
        if isinstance(group, Group) and (command := group.get_command(context, word)) is not None:
            context = click.Context(command, parent=context, info_name=word)
    return context
