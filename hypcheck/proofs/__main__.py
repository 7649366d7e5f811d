"""`python -m hypcheck.proofs`: prove everything, or with --soundness what the checker's soundness rests on.

Where KERNELs are given, files of `hypcheck emit --proof`, Coq checks those alone, by the proofs compiled before.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

import click

from hypcheck.errors import HypcheckError
from hypcheck.proofs import build, weakenings
from hypcheck.proofs.build import CONTROL, Weakened, accepted, changed_decisions, changed_functions, weakened

OF_DECISIONS = 20
"""So many changes of functions that decide, and of long integers, are tried by --every: each takes Coq long."""


@click.command(help=__doc__)
@click.argument("kernels", nargs=-1, type=click.Path(path_type=Path), metavar="[KERNEL]...")
@click.option("--soundness", is_flag=True, help="The checker's soundness alone.")
@click.option("--weakened", "count", type=click.IntRange(0), default=4, help="Weakened statements to try of each list.")
@click.option("--every", is_flag=True, help="Try every weakened statement: half an hour.")
@click.option("--into", "built", type=click.Path(path_type=Path), default=build.BUILT, help="The build folder.")
def main(kernels: tuple[Path, ...], soundness: bool, count: int, every: bool, built: Path) -> None:
    """Prove, and say each thing that was proved. Ends with 1 where a proof fails, 2 where programs are missing."""
    try:
        build.demand_tools()
        for path in kernels:
            click.echo(f"{path}: the bound is proved, {build.check_kernel(path, built):.1f} s")
        if kernels:
            return
        names = (*build.SOUNDNESS, "ExtractedChecker") if soundness else build.FILES
        _prove(names, built)
        if not soundness:
            click.echo(f"{build.refuse_changes(2, built)} changes of the printed C are refused")
        changes = [change for change in weakened() if change.file in names]
        _refuse(changes, len(changes) if every else count, built)
        if not soundness:
            words, decisions, integers = changed_functions(), changed_decisions(), build.changed_integers()
            for found, which, some in (
                (words, "of words", len(words) if every else count),
                (decisions, "that decide", OF_DECISIONS if every else min(1, count)),
                (integers, "of long integers", OF_DECISIONS if every else min(1, count)),
            ):
                tried = _tried(found, some, built)
                click.echo(
                    f"{len(found)} changes of the header's functions {which}; {tried} are tried: all are refused"
                )
            _refuse_made(count, every=every, built=built)
        build.build_checker(built)
        sys.exit(build.run_checker(build.frozen_files(), built))
    except HypcheckError as error:
        click.echo(f"proofs: error: {error}", err=True)
        sys.exit(error.exit_code)


def _prove(names: tuple[str, ...], built: Path) -> None:
    done = []
    for name in names:
        file = build.compile_file(name, built)
        done.append(file)
        click.echo(f"{name + '.v':20} {file.statements:3} statements {file.lines:4} lines {file.seconds:6.1f} s")
    others, floats = build.demand_known_axioms(names, built)
    statements, lines = sum(file.statements for file in done), sum(file.lines for file in done)
    click.echo(f"{statements} statements in {lines} lines are proved. They assume, of the real numbers:")
    for axiom in sorted(others | floats):
        click.echo(f"    {axiom}" + " (Flocq alone)" * (axiom == build.OF_FLOCQ))
    if "Stages" in names:
        for group, which, axioms in ((build.OF_STAGES, "without", others), (build.OF_RUNS, "on", floats)):
            among = f"all {which} Flocq, {', '.join(group)} among them"
            click.echo(f"Print Assumptions of {among}: {', '.join(sorted(axioms))}")


def _refuse(changes: list[Weakened], count: int, built: Path) -> None:
    if not accepted(CONTROL, built):
        raise build.ProofError(
            f"Coq refuses {CONTROL.file}.v in the folder in which it must refuse weakened statements"
        )
    tried = _tried(changes, count, built)
    click.echo(f"{len(changes)} weakened statements are written by hand; {tried} are tried: all are refused")


def _tried(changes: Sequence[Weakened], count: int, built: Path) -> int:
    tried = changes[:: max(1, len(changes) // max(1, count))][:count]
    for change in tried:
        if accepted(change, built):
            raise build.ProofError(f"Coq accepts {change.file}.v, weakened to allow {change.allows}")
    return len(tried)


def _refuse_made(count: int, *, every: bool, built: Path) -> None:
    changes, why = weakenings.made(build.source), weakenings.reasons()
    tried = changes if every else weakenings.sample(changes, count, seed=45)
    explained = [change for change in tried if accepted(change, built)]
    for change in explained:
        if (change.file, change.allows) not in why:
            raise build.ProofError(f"Coq accepts {change.file}.v with {change.allows}, and no reason is given for that")
    click.echo(
        f"{len(changes)} weakened statements are made by a program; {len(tried)} are tried: "
        f"{len(tried) - len(explained)} are refused, {len(explained)} hold too, for a reason that is given"
    )


if __name__ == "__main__":
    main()
