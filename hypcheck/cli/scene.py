"""`hypcheck plan` and `hypcheck emit`: what a scene needs, and a kernel that contains only that."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import click

from hypcheck.cli import completing
from hypcheck.messages import printable

if TYPE_CHECKING:
    from collections.abc import Iterator

    from hypcheck.kernel.specialise.plan import ScenePlan
    from hypcheck.scene.model import SceneModel


_PLAN_HELP = """Show which computations SCENE needs, which are left out, why that is allowed, and what it saves.

SCENE is a file (docs/scenes.md) or a shipped scene; `hypcheck emit` writes the kernel that the plan describes.

\b
hypcheck plan tower
hypcheck plan forest.toml --precision float32 --json
hypcheck plan tower --measure
"""


@click.command(help=_PLAN_HELP, short_help="Show what a scene needs, and what can be left out.")
@click.argument("scene", metavar="SCENE", type=completing.SCENE)
@click.option("--precision", default="float64", show_default=True, metavar="FORMAT", help="float32 or float64.")
@click.option("--question", metavar="WHAT", help="position, exterior, interior or contact.  [default: the scene's]")
@click.option("--measure", is_flag=True, help="Compile the kernel, and time it beside Table 2 as printed.")
@click.option("--json", "as_json", is_flag=True, help="One JSON object.")
def plan(scene: str, precision: str, question: str | None, measure: bool, as_json: bool) -> None:
    """Plan, and print the plan."""
    import json

    from hypcheck.kernel.emission.plan_text import plan_as_json, plan_lines

    plan = planned(scene, precision, question)
    times = list(_measured(plan)) if measure else []
    if as_json:
        measured = {"measured": times} if measure else {}
        click.echo(json.dumps(plan_as_json(plan) | measured))
        return
    for text in plan_lines(plan):
        click.echo(printable(text))
    for place, took in enumerate(times, start=1):
        click.echo(printable(f"{place}. {took['says']}"))


def planned(scene: str, precision: str, question: str | None) -> ScenePlan:
    """The plan for a scene file or a shipped scene. Raises InputError."""
    from hypcheck.kernel.specialise.plan import plan_of

    return plan_of(asked_scene(scene, question), precision)


def asked_scene(scene: str, question: str | None) -> SceneModel:
    """A scene file or a shipped scene, with another question where one is given. Raises InputError."""
    from dataclasses import replace

    from hypcheck.errors import InputError
    from hypcheck.scene.model import QUESTIONS
    from hypcheck.scene.reading import read_scene

    model = read_scene(scene)
    if question is not None:
        if question not in QUESTIONS:
            raise InputError(f"the question is {question!r}; it must be one of {', '.join(QUESTIONS)}")
        model = replace(model, question=question)
    return model


def _measured(plan: ScenePlan) -> Iterator[dict[str, Any]]:
    """The saving of each setting. Raises UnavailableError if there is no C compiler."""
    from pathlib import Path
    from tempfile import TemporaryDirectory

    from hypcheck.bench.scene import kernel_savings

    with TemporaryDirectory(prefix="hypcheck-plan-") as folder:
        yield from kernel_savings(plan, Path(folder))


LANGUAGES = ("c", "cpp", "rust", "javascript", "python")

_EMIT_HELP = """Generate source code: a kernel with only what a scene needs, or a method for one pair of any sizes.

With --method exact the file answers every float64 row rightly: floats where a proved bound allows, whole numbers for
the rest, without dependencies. With --method certified it has only the floats, and answers 2 if they cannot decide; so
do dual and local-maximum, which prove the answer by a concave function instead of the discriminant. With tilted the
spheroid has an axis; clearance also gives bounds of its clearance; passage says whether it has contact on a straight
sweep, and gives a time before which it has none.

SCENE is a file (docs/scenes.md) or a shipped scene. Its sizes and constant heights are folded in, and only its question
is answered; `hypcheck plan` shows what is left out and why. The first comment of the kernel states the proved bounds.

\b
hypcheck emit --scene tower --language c --output kernel.c
hypcheck emit --scene forest.toml --language rust --precision float32 --output kernel.rs
cc -O3 -fPIC -shared kernel.c -lm -o kernel.so && hypcheck verify library:./kernel.so
hypcheck emit --method exact --language c --output pair.c

C, C++ and Rust have the names and the signature that `verify library:` expects; the Python file is for
`python:kernel.py:classify`; the JavaScript module takes the place of predicate.mjs in the adapter of
`hypcheck init --language javascript`.

With --sweeps the file says whether a straight motion of the mover has contact in the whole scene, and gives a time
before which it has none.

With --whole the kernel also has the hyperboloids' places and heights and the mover's parts, in tables of any length,
and one more function: hypcheck_whole(n, x, y, z, heading, answers), in JavaScript and Python whole(x, y, z, heading),
which answers the scene's question for the mover's centre in the scene's coordinates.

Kernels that are linked into one program, or beside hypcheck.h, need different names: with `--prefix tower` the
functions are tower_classify, tower_classify_scene and tower_describe (C, C++, Rust). `verify library:` asks for the
default names.
"""


@click.command(help=_EMIT_HELP, short_help="Generate source code for a scene, or for one pair.")
@click.option(
    "--method",
    metavar="METHOD",
    type=completing.Names(completing.pair_methods),
    help="Of one pair, without a scene: exact, certified, dual, local-maximum, tilted, clearance or passage.",
)
@click.option("--scene", metavar="SCENE", type=completing.SCENE, help="A scene file, or the name of a shipped scene.")
@click.option("--language", required=True, type=click.Choice(LANGUAGES), help="The language of the kernel.")
@click.option("--precision", default="float64", show_default=True, metavar="FORMAT", help="float32 or float64.")
@click.option("--question", metavar="WHAT", help="position, exterior, interior or contact.  [default: the scene's]")
@click.option("--whole", is_flag=True, help="The whole scene: places, heights and parts too, of any number of trees.")
@click.option("--sweeps", is_flag=True, help="The whole scene, asked about straight motions of the mover.")
@click.option("--prefix", default="hypcheck", show_default=True, metavar="NAME", help="Prefix of the function names.")
@click.option(
    "--output", default="-", show_default=True, metavar="FILE", help="The file to write; - is standard output."
)
@click.option(
    "--proof", metavar="FILE", help="Also write a proof of the discriminant's bound, for Coq (docs/proofs.md)."
)
@click.pass_context
def emit(
    context: click.Context,
    /,
    method: str | None,
    scene: str | None,
    language: str,
    precision: str,
    question: str | None,
    whole: bool,
    sweeps: bool,
    prefix: str,
    output: str,
    proof: str | None,
) -> None:
    """Write the kernel of a scene, or the code for one pair."""
    from hypcheck.errors import InputError
    from hypcheck.kernel.emission.kernel import require_prefix
    from hypcheck.kernel.emission.pair import emitted_pair, emitted_scene, needs_routine
    from hypcheck.kernel.printing.coq import proof_of
    from hypcheck.tables.streams import write_files

    command, proved = _command(context), None
    if method is not None:
        scenes = {"--scene": scene, "--question": question, "--proof": proof}
        extra = [name for name, value in scenes.items() if value is not None]
        extra += [] if precision == "float64" else ["--precision"]
        extra += [option for option, is_given in (("--whole", whole), ("--sweeps", sweeps)) if is_given]
        if extra:
            raise InputError(f"{extra[0]} is for a scene; --method {method} is for one pair of any sizes, without it")
        text = emitted_pair(method, language, command, prefix)
    elif scene is None:
        raise InputError("emit needs --scene SCENE, or --method exact for one pair of any sizes")
    else:
        require_prefix(prefix, language)
        asked = asked_scene(scene, question)
        if sweeps or (whole and needs_routine(asked)):
            _require_routine(sweeps, whole, question, proof, precision)
            text = emitted_scene(asked, language, command, prefix, sweep=sweeps)
        else:
            plan, text = _kernel(asked, language, precision, command, prefix, whole=whole)
            proved = None if proof is None else proof_of(plan)
    if proof is not None and os.path.realpath(proof) == os.path.realpath(output):
        raise InputError(f"--proof {proof} is --output too; name another file")
    proofs = {} if proof is None or proved is None else {proof: proved.encode()}
    write_files({output: text.encode(), **proofs})


def _require_routine(sweeps: bool, whole: bool, question: str | None, proof: str | None, precision: str) -> None:
    """Raise InputError unless code that a routine answers is asked for what it has."""
    from hypcheck.errors import InputError

    if sweeps and whole:
        raise InputError("--whole is about positions, --sweeps about straight motions; give one of them")
    if sweeps and question is not None:
        raise InputError("--question is about positions; --sweeps asks for contact on a straight motion")
    if proof is not None:
        raise InputError("--proof is for kernels of pairs, and of whole scenes in which nothing is tilted")
    if precision != "float64":
        raise InputError(f"no kernel is made in {precision}: sweeps, and scenes with something tilted, need float64")


def _command(context: click.Context) -> list[str]:
    """The command that writes the same code: what was given and is not the default, but for the files to write."""
    command = ["hypcheck", "emit"]
    for option in context.command.params:
        value = context.params[str(option.name)]
        if option.name not in ("output", "proof") and value not in (None, False, option.default):
            command += [option.opts[0]] if value is True else [option.opts[0], value]
    return command


def _kernel(
    asked: SceneModel, language: str, precision: str, command: list[str], prefix: str, *, whole: bool
) -> tuple[ScenePlan, str]:
    """The plan of a scene, or of the whole scene, and its kernel."""
    if whole:
        from hypcheck.kernel.emission.whole import whole as whole_text
        from hypcheck.kernel.emission.whole import whole_plan

        plan = whole_plan(asked, precision)
        return plan, whole_text(asked, plan, language, command, prefix)
    from hypcheck.kernel.emission.kernel import emitted
    from hypcheck.kernel.specialise.plan import plan_of

    plan = plan_of(asked, precision)
    return plan, emitted(plan, language, command, prefix)
