"""`hypcheck emit`: a kernel that contains only what a scene needs, in one of five languages."""

from __future__ import annotations

import click

LANGUAGES = ("c", "cpp", "rust", "javascript", "python")

_HELP = """Write a kernel that contains only what a scene needs: small, readable, without dependencies.

SCENE is a file (docs/scenes.md) or a shipped scene. Its sizes and constant heights are folded in, and only its question
is answered; `hypcheck plan` tells what is left out and why. The head of the kernel says what is proved of it.

\b
hypcheck emit --scene tower --language c --output kernel.c
hypcheck emit --scene forest.toml --language rust --precision float32 --output kernel.rs
cc -O3 -fPIC -shared kernel.c -lm -o kernel.so && hypcheck verify library:./kernel.so

C, C++ and Rust have the names and the signature that `verify library:` takes; the Python file is for
`python:kernel.py:classify`; the JavaScript module takes the place of predicate.mjs in the adapter of
`hypcheck init --language javascript`.

Kernels that are linked into one program, or beside hypcheck.h, need different names: with `--prefix tower` the
functions are tower_classify, tower_classify_scene and tower_describe (C, C++, Rust). `verify library:` asks for the
default names.
"""


@click.command(help=_HELP, short_help="Write a kernel that contains only what a scene needs.")
@click.option("--scene", required=True, metavar="SCENE", help="A scene file, or the name of a shipped scene.")
@click.option("--language", required=True, type=click.Choice(LANGUAGES), help="What the kernel is written in.")
@click.option("--precision", default="float64", show_default=True, metavar="FORMAT", help="float32 or float64.")
@click.option("--question", metavar="WHAT", help="position, exterior, interior or contact.  [default: the scene's]")
@click.option(
    "--prefix", default="hypcheck", show_default=True, metavar="NAME", help="What the kernel's functions begin with."
)
@click.option(
    "--output", default="-", show_default=True, metavar="FILE", help="Where to write it; - is standard output."
)
@click.option(
    "--proof", metavar="FILE", help="Write a proof of the discriminant's bound too, for Coq (docs/proofs.md)."
)
def emit(
    scene: str, language: str, precision: str, question: str | None, prefix: str, output: str, proof: str | None
) -> None:
    """Plan, and write."""
    from hypcheck.cli.plan import planned
    from hypcheck.kernel.emission.kernel import PREFIX, emitted, require_prefix
    from hypcheck.kernel.emission.proof import proof_of
    from hypcheck.tables.streams import writing

    require_prefix(prefix, language)
    plan = planned(scene, precision, question)
    command = ["hypcheck", "emit", "--scene", scene, "--language", language]
    command += [] if precision == "float64" else ["--precision", precision]
    command += [] if question is None else ["--question", question]
    command += [] if prefix == PREFIX else ["--prefix", prefix]
    text = emitted(plan, language, command, prefix)
    proved = None if proof is None else proof_of(plan)
    with writing(output) as stream:
        stream.write(text.encode("utf-8"))
    if proof is not None and proved is not None:
        with writing(proof) as stream:
            stream.write(proved.encode("utf-8"))
