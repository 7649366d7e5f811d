"""Groups of commands: what they say of a command that is missing or unknown, and of which command an error is."""

from __future__ import annotations

from typing import Any

import click

from hypcheck.suggesting import advice


class Group(click.Group):
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
        raise click.UsageError(f"there is no command {name!r}; {advice(name, known, most=1)}", ctx)
