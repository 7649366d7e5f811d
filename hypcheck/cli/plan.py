"""`hypcheck plan`: what a scene needs, what it does without, why, and what that saves."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from hypcheck.visible import printable

if TYPE_CHECKING:
    from collections.abc import Iterator

    from hypcheck.bench.scene import Saved
    from hypcheck.kernel.specialise.plan import Plan

_HELP = """Tell what SCENE needs of the mathematics, what is left out, why that is allowed, and what it saves.

SCENE is a file (docs/scenes.md) or a shipped scene; `hypcheck emit` writes the kernel that the plan describes.

\b
hypcheck plan tower
hypcheck plan forest.toml --precision float32 --json
hypcheck plan tower --measure
"""


@click.command(help=_HELP, short_help="Tell what a scene needs, and what can be left out.")
@click.argument("scene")
@click.option("--precision", default="float64", show_default=True, metavar="FORMAT", help="float32 or float64.")
@click.option("--question", metavar="WHAT", help="position, exterior, interior or contact.  [default: the scene's]")
@click.option("--measure", is_flag=True, help="Compile the kernel, and time it beside Table 2 as printed.")
@click.option("--json", "as_json", is_flag=True, help="One JSON object.")
def plan(scene: str, precision: str, question: str | None, measure: bool, as_json: bool) -> None:
    """Plan, and tell."""
    import json

    from hypcheck.kernel.emission.telling import plan_as_json, plan_lines

    found = planned(scene, precision, question)
    times = list(_measured(found)) if measure else []
    if as_json:
        from hypcheck.bench.scene import line

        told = plan_as_json(found)
        click.echo(json.dumps({**told, "measured": [line(each) for each in times]} if measure else told))
        return
    for text in plan_lines(found):
        click.echo(printable(text))
    for place, each in enumerate(times, start=1):
        click.echo(printable(f"{place}. {each.says}"))


def planned(scene: str, precision: str, question: str | None) -> Plan:
    """The plan for a scene by its name; raises InputError."""
    from dataclasses import replace

    from hypcheck.errors import InputError
    from hypcheck.kernel.specialise.plan import plan_of
    from hypcheck.scene.model import QUESTIONS
    from hypcheck.scene.reading import read_scene

    found = read_scene(scene)
    if question is not None:
        if question not in QUESTIONS:
            raise InputError(f"the question is {question!r}; it must be one of {', '.join(QUESTIONS)}")
        found = replace(found, question=question)
    return plan_of(found, precision)


def _measured(found: Plan) -> Iterator[Saved]:
    """What each setting saves; raises UnavailableError where there is no C compiler."""
    from pathlib import Path
    from tempfile import TemporaryDirectory

    from hypcheck.bench.scene import saved

    with TemporaryDirectory(prefix="hypcheck-plan-") as folder:
        yield from saved(found, Path(folder))
