"""What shells complete in the place of a value: families, cases, methods, scenes, causes and engines, not files.

Each function gives the names that may stand for a word that is not finished. They load their tables when a shell asks.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

import click
from click.shell_completion import CompletionItem

if TYPE_CHECKING:
    from hypcheck.bench.plan import BenchPlan

Known = Callable[[click.Context, str], Iterable[str]]

NOTHING = "nothing"
"""The type of an item that stands for no completion, and no file either: shells' scripts leave out unknown types."""


class Names(click.ParamType[str]):
    """A text of which shells complete the known names; what reads it says what is wrong with others.

    many: names separated by commas, of which the last is completed. files: if no name begins so, files are completed.
    """

    name = "text"

    def __init__(self, known: Known, *, many: bool = False, files: bool = False) -> None:
        self.known = known
        self.many = many
        self.files = files

    def shell_complete(
        self,
        ctx: click.Context,
        param: click.Parameter,  # noqa: ARG002 - click's signature
        incomplete: str,
    ) -> list[CompletionItem]:
        """The names that begin so, with those before the last comma; none of them twice."""
        before, comma, last = incomplete.rpartition(",") if self.many else ("", "", incomplete)
        names = [name for name in dict.fromkeys(self.known(ctx, last)) if name.startswith(last)]
        items = [CompletionItem(f"{before}{comma}{name}") for name in names if name not in before.split(",")]
        return items or ([] if self.files else [CompletionItem("", type=NOTHING)])


def families(ctx: click.Context, begun: str) -> Iterable[str]:  # noqa: ARG001 - a Known
    """Families of all questions, and the pattern for the extreme ones."""
    from hypcheck.vectors.families import ALL, EXTREME

    return (*ALL, EXTREME)


def frozen_families(ctx: click.Context, begun: str) -> Iterable[str]:  # noqa: ARG001 - a Known
    """Families of frozen vectors, and the files of invalid rows."""
    from hypcheck.vectors.frozen import ALL_NAMES

    return ALL_NAMES


def cases(ctx: click.Context, begun: str) -> Iterable[str]:  # noqa: ARG001 - a Known
    """Ids of frozen cases of the family that the word begins with; before that, what ids of families begin with."""
    from hypcheck.vectors.frozen import ALL_NAMES, load

    several = [name for name in ALL_NAMES if name.startswith(begun)]
    for name in ALL_NAMES:
        if begun.startswith(f"{name}-") or several == [name]:
            yield from load(name).ids
        elif name in several:
            yield f"{name}-"


def families_and_cases(ctx: click.Context, begun: str) -> Iterable[str]:
    """Families of frozen vectors, and their cases."""
    yield from frozen_families(ctx, begun)
    yield from cases(ctx, begun)


SPECS = ("python:", "library:", "command:")
"""What is before the name of a file in a SPEC."""


def specs(ctx: click.Context, begun: str) -> Iterable[str]:  # noqa: ARG001 - a Known
    """The built-in methods, and how other SPECs begin."""
    if not begun.startswith(SPECS):
        from hypcheck.implementations.builtin import builtin_methods, passage_mesh_methods, passage_methods

        known = (*builtin_methods(), *passage_methods(), *passage_mesh_methods())
        yield from (f"builtin:{name}" for name in known)
        yield from SPECS


def bench_methods(ctx: click.Context, begun: str) -> Iterable[str]:  # noqa: ARG001 - a Known
    """The methods that the command compares with the options given so far."""
    from hypcheck.bench.contenders import contenders

    return contenders(_bench_plan(ctx))


def workloads(ctx: click.Context, begun: str) -> Iterable[str]:  # noqa: ARG001 - a Known
    """The workloads of the command with the options given so far."""
    from hypcheck.bench.workloads import workloads_of

    return workloads_of(_bench_plan(ctx))


def _bench_plan(ctx: click.Context) -> BenchPlan:
    from hypcheck.bench.plan import PASSAGE, BenchPlan

    if ctx.params.get("question") == PASSAGE:
        return BenchPlan(question=PASSAGE)
    return BenchPlan(tilted=bool(ctx.params.get("tilted")))


def pair_methods(ctx: click.Context, begun: str) -> Iterable[str]:  # noqa: ARG001 - a Known
    """The methods of code for one pair."""
    from hypcheck.kernel.emission.pair import METHODS

    return METHODS


def scenes(ctx: click.Context, begun: str) -> Iterable[str]:  # noqa: ARG001 - a Known
    """The shipped scenes."""
    from hypcheck.scene.reading import shipped_scenes

    return shipped_scenes()


def causes(ctx: click.Context, begun: str) -> Iterable[str]:  # noqa: ARG001 - a Known
    """Ids of causes of wrong answers."""
    from hypcheck.runs.explain import BY_ID

    return BY_ID


def engines(ctx: click.Context, begun: str) -> Iterable[str]:  # noqa: ARG001 - a Known
    """The collision engines."""
    from hypcheck.engines.engine import ENGINES

    return ENGINES


FAMILIES = Names(families, many=True)
SPEC = Names(specs, files=True)
CASE = Names(cases)
SCENE = Names(scenes, files=True)
ENGINE = Names(engines)
