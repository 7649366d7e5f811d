"""Run every attack with each kind of isolation of this system, and print a table; ends with 1 if one got through."""

from __future__ import annotations

import re
import sys
import tempfile
from pathlib import Path

import click

from tests.tools.hostile.running import command_fate
from tests.tools.hostile.table import ATTACKS, KINDS, is_here


def main() -> int:
    """Print a line for each attack; returns the exit code."""
    through = 0
    for kind, means in KINDS.items():
        if not is_here(kind):
            click.echo(f"\n{kind}: not on this system")
            continue
        click.echo(f"\n{kind}\n")
        for attack in ATTACKS:
            wanted = attack.by_kind()[kind]
            if wanted is None:
                click.echo(f"  not stopped {attack.what}")
                continue
            with tempfile.TemporaryDirectory(prefix="hypcheck-hostile-") as folder:
                fate = command_fate(attack.name, means, Path(folder))
            held = fate.outcome is attack.outcome and re.search(wanted, fate.told) and not fate.damage
            through += not held
            verdict = "contained" if held else "GOT THROUGH"
            click.echo(f"  {verdict:11} {attack.what:45} {fate.outcome.label:9} {fate.told}")
    return int(through > 0)


if __name__ == "__main__":
    sys.exit(main())
