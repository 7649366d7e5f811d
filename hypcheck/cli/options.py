"""Options that several commands have: the reading of their values, and their completions in a shell.

Whole numbers are written in digits, or large ones as 1e9, 2.5e6 or 1_000_000. Names of families, cases, methods,
scenes, causes and engines are completed, files otherwise: a function gives the names that may stand for a word that is
not finished, and loads their table when a shell asks.
"""

from __future__ import annotations

import math
import os
import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click
from click.shell_completion import CompletionItem

from hypcheck.errors import InputError
from hypcheck.messages import escaped
from hypcheck.tables import STREAM
from hypcheck.tables.numbers import is_number, shown

if TYPE_CHECKING:
    from hypcheck.bench.plan import BenchPlan
    from hypcheck.implementations.session import Limits
    from hypcheck.record.lines import IsolationPart

Known = Callable[[click.Context, str], Iterable[str]]
"""A function from the context of a command, and the beginning of a word, to the names that may complete the word."""

NOTHING = "nothing"
"""The type of an item that completes nothing, not even files: the shells' scripts ignore unknown types."""


class Names(click.ParamType[str]):
    """A text for which shells complete the known names. The option's reader refuses other texts.

    many: names separated by commas, of which the last is completed. files: if no name begins so, files are completed.
    """

    name = "text"

    def __init__(self, known: Known, *, many: bool = False, files: bool = False) -> None:
        self.known = known
        self.many = many
        self.files = files

    def convert(self, value: str, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """Return the text; a list without a name is refused, because it would mean the same as no list."""
        if self.many and not names_in(value):
            self.fail(f"{shown(value)} must be names, separated by commas.", param, ctx)
        return value

    def shell_complete(
        self,
        ctx: click.Context,
        param: click.Parameter,  # noqa: ARG002 - click's signature
        incomplete: str,
    ) -> list[CompletionItem]:
        """Return the names that complete the last word, once each, after the names before the last comma."""
        before, comma, last = incomplete.rpartition(",") if self.many else ("", "", incomplete)
        names = [name for name in dict.fromkeys(self.known(ctx, last)) if name.startswith(last)]
        items = [CompletionItem(f"{before}{comma}{name}") for name in names if name not in before.split(",")]
        return items or ([] if self.files else [CompletionItem("", type=NOTHING)])


def families(ctx: click.Context, begun: str) -> Iterable[str]:  # noqa: ARG001 - a Known
    """Return the families of all questions, and the pattern for the extreme ones."""
    from hypcheck.vectors.families import ALL, EXTREME

    return (*ALL, EXTREME)


def frozen_families(ctx: click.Context, begun: str) -> Iterable[str]:  # noqa: ARG001 - a Known
    """Return the families of frozen vectors, and the files of invalid rows."""
    from hypcheck.vectors.frozen import ALL_NAMES

    return ALL_NAMES


def cases(ctx: click.Context, begun: str) -> Iterable[str]:  # noqa: ARG001 - a Known
    """Yield completions of a case id: families first, then the frozen cases of the family in the word."""
    from hypcheck.vectors.frozen import ALL_NAMES, load

    several = [name for name in ALL_NAMES if name.startswith(begun)]
    for name in ALL_NAMES:
        if begun.startswith(f"{name}-") or several == [name]:
            yield from load(name).ids
        elif name in several:
            yield f"{name}-"


def families_and_cases(ctx: click.Context, begun: str) -> Iterable[str]:
    """Yield the families of frozen vectors, and their cases."""
    yield from frozen_families(ctx, begun)
    yield from cases(ctx, begun)


SPECS = ("python:", "library:", "command:")
"""The beginnings of SPECs with a file; the name of the file follows."""


def specs(ctx: click.Context, begun: str) -> Iterable[str]:  # noqa: ARG001 - a Known
    """Yield the built-in methods, and the beginnings of other SPECs."""
    if not begun.startswith(SPECS):
        from hypcheck.implementations.builtin import names

        yield from (f"builtin:{name}" for name in names())
        yield from SPECS


def bench_methods(ctx: click.Context, begun: str) -> Iterable[str]:  # noqa: ARG001 - a Known
    """Return the methods that the command compares with the options given so far."""
    from hypcheck.bench.contenders import contenders

    return contenders(_bench_plan(ctx))


def workloads(ctx: click.Context, begun: str) -> Iterable[str]:  # noqa: ARG001 - a Known
    """Return the workloads of the command with the options given so far."""
    from hypcheck.bench.workloads import workloads_of

    return workloads_of(_bench_plan(ctx))


def _bench_plan(ctx: click.Context) -> BenchPlan:
    """Return a plan of `hypcheck bench` with the question and the kind of spheroids given so far."""
    from hypcheck.bench.plan import PASSAGE, BenchPlan

    if ctx.params.get("question") == PASSAGE:
        return BenchPlan(question=PASSAGE)
    return BenchPlan(tilted=bool(ctx.params.get("tilted")))


def pair_methods(ctx: click.Context, begun: str) -> Iterable[str]:  # noqa: ARG001 - a Known
    """Return the methods of code for one pair."""
    from hypcheck.kernel.emission.pair import METHODS

    return METHODS


def scenes(ctx: click.Context, begun: str) -> Iterable[str]:  # noqa: ARG001 - a Known
    """Return the shipped scenes."""
    from hypcheck.scene.reading import shipped_scenes

    return shipped_scenes()


def causes(ctx: click.Context, begun: str) -> Iterable[str]:  # noqa: ARG001 - a Known
    """Return the ids of causes of wrong answers."""
    from hypcheck.runs.explain import BY_ID

    return BY_ID


def engines(ctx: click.Context, begun: str) -> Iterable[str]:  # noqa: ARG001 - a Known
    """Return the collision engines."""
    from hypcheck.engines.engine import ENGINES

    return ENGINES


FAMILIES = Names(families, many=True)
SPEC = Names(specs, files=True)
CASE = Names(cases)
SCENE = Names(scenes, files=True)
ENGINE = Names(engines)


Command = TypeVar("Command", bound=Callable[..., Any])

LARGEST_SEED = 2**63 - 1

LARGEST_COUNT = 10**15
"""The largest number of rows that an option takes: more than any run can finish."""

MOST_PROCESSES = 1024
"""The largest number of processes that an option takes: more would only compete for processors and memory."""

_INTEGER = re.compile(r"\d{1,20}(_\d{1,20}){0,9}(\.\d{1,20})?([eE]\+?\d{1,2})?", re.ASCII)
"""The form of a whole number. Digits are few and the exponent is small, because 1e99999999 would take all memory."""


class IntegerOption(click.types.IntParamType):
    """A whole number from `least` to `greatest`."""

    def __init__(self, least: int, greatest: int = LARGEST_COUNT) -> None:
        self.least = least
        self.greatest = greatest

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> int:  # noqa: ANN401 - click's
        """Read the number. Raises click.BadParameter."""
        number = integer_of(str(value))
        if number is None or not self.least <= number <= self.greatest:
            self.fail(f"{shown(str(value))} must be {integer_wanted(self.least, self.greatest)}.", param, ctx)
        return number


def integer_of(text: str) -> int | None:
    """Return the whole number that a text writes, exactly; None if it writes none."""
    from fractions import Fraction

    if not _INTEGER.fullmatch(text):
        return None
    number = Fraction(text.replace("_", ""))
    return number.numerator if number.denominator == 1 else None


def integer_wanted(least: int, greatest: int) -> str:
    """Return the requirement for a whole number, as the end of a sentence."""
    digits = str(greatest)
    power = len(digits) > 6 and not digits[1:].strip("0") and digits[0] == "1"
    return f"a whole number, at least {least} and at most {f'1e{len(digits) - 1}' if power else digits}"


class FreshOption(IntegerOption):
    """The seed of fresh rows, "auto" or "off"; the value is a text."""

    def __init__(self) -> None:
        super().__init__(0, LARGEST_SEED)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:  # noqa: ANN401 - click's
        """Check the text, and return it. Raises click.BadParameter."""
        return value if value in ("auto", "off") else str(super().convert(value, param, ctx))


class NumberOption(click.types.FloatParamType):
    """A finite number from `least` to `greatest`; greater than `least` if that is `excluded`."""

    def __init__(self, least: float, greatest: float = math.inf, *, excluded: bool = False) -> None:
        self.least = least
        self.greatest = greatest
        self.excluded = excluded

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:  # noqa: ANN401 - click's
        """Read the number. Raises click.BadParameter."""
        number = float(value) if is_number(str(value)) else math.nan
        above = self.least < number if self.excluded else self.least <= number
        if not (math.isfinite(number) and above and number <= self.greatest):
            wanted = f"a number, {'greater than' if self.excluded else 'at least'} {self.least:g}"
            wanted += "" if math.isinf(self.greatest) else f" and at most {self.greatest:g}"
            self.fail(f"{shown(str(value))} must be {wanted}.", param, ctx)
        return number


class OutputPath(click.Path):
    """A path to write to: not empty, and "-" only if that means standard output (`stream`)."""

    def __init__(self, *, stream: bool = False) -> None:
        super().__init__(path_type=Path)
        self.stream = stream

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Path:  # noqa: ANN401 - click's
        """Check the path, and return it. Raises click.BadParameter."""
        text = os.fspath(value)
        if not text or (text == STREAM and not self.stream):
            self.fail(f"{text!r} names neither a file nor a folder.", param, ctx)
        return Path(text)


_SUFFIXES = {"K": 10, "M": 20, "G": 30, "T": 40}

_SECONDS = NumberOption(0, excluded=True)

ISOLATE = click.option(
    "--isolate",
    type=click.Choice(["auto", "on", "off"]),
    help="Isolate the implementation as far as the system allows; on: run it only if that works.  [default: auto]",
)
PASS_ENV = click.option(
    "--pass-env", metavar="NAMES", help="Environment variables that the isolated implementation sees."
)
SEE = click.option(
    "--see",
    metavar="PATH",
    multiple=True,
    help="A further file or folder that the isolated implementation sees; may be given often.",
)

SEED = click.option(
    "--seed", type=IntegerOption(0, LARGEST_SEED), default=1, show_default=True, help="Seed of the random numbers."
)
FORMAT = click.option(
    "--format",
    "form",
    type=click.Choice(["text", "json"]),
    default="text",
    show_default=True,
    help="The format of the output.",
)
QUESTION = click.option(
    "--question", metavar="WHAT", help="position, exterior, interior, contact or passage.  [default: as declared]"
)
PRECISION = click.option(
    "--precision", metavar="FORMAT", help="The precision whose unit roundoff is u.  [default: as declared]"
)
DOMAIN = click.option(
    "--domain", metavar="JSON", help="The domain where it must be right, as JSON.  [default: as declared]"
)
TOLERANCE = click.option(
    "--tolerance", type=NumberOption(0), default=8.0, show_default=True, help="Backward error that passes, in u."
)


def workers(wanted: str) -> Callable[[Command], Command]:
    """Return the option --workers of a command; `wanted` is its help."""
    return click.option("--workers", type=IntegerOption(1, MOST_PROCESSES), help=wanted)


def with_options(*options: Callable[[Command], Command]) -> Callable[[Command], Command]:
    """Return a decorator of commands that adds these options in their order."""

    def add(command: Command) -> Command:
        for option in reversed(options):
            command = option(command)
        return command

    return add


with_limits = with_options(
    click.option(
        "--startup-timeout",
        type=_SECONDS,
        default=30.0,
        show_default=True,
        help="Time limit for its start, in seconds.",
    ),
    click.option(
        "--timeout", type=_SECONDS, default=10.0, show_default=True, help="Time limit without progress, in seconds."
    ),
    click.option(
        "--restarts",
        type=IntegerOption(0),
        default=20,
        show_default=True,
        help="Most restarts after crashes and hangs.",
    ),
    click.option(
        "--memory", metavar="BYTES", default="4G", show_default=True, help="Memory limit of all its processes together."
    ),
    ISOLATE,
    PASS_ENV,
    SEE,
)
"""A decorator that gives a command the options that limit an implementation's processes; `limits_of` reads them."""

LIMITS = ("startup_timeout", "timeout", "restarts", "memory", "isolate", "pass_env", "see")
"""The parameters of limits_of that are options."""


def limits_of(
    *,
    startup_timeout: float,
    timeout: float,
    restarts: int,
    memory: str,
    isolate: str | None,
    pass_env: str | None,
    see: Sequence[str] = (),
    out: Path | None = None,
) -> Limits:
    """Return the limits that these options set; an isolated implementation does not see `out`. Raises InputError."""
    from hypcheck.implementations.session import Limits

    return isolated(Limits(startup_timeout, timeout, restarts, bytes_of(memory)), isolate, pass_env, see, out)


def isolated(limits: Limits, isolate: str | None, pass_env: str | None, see: Sequence[str], out: Path | None) -> Limits:
    """Return the limits, with the isolation that these options set. Raises InputError."""
    from dataclasses import replace

    from hypcheck.isolation.launch import Isolation, usual_mode

    for path in see:
        if not os.path.exists(path):
            raise InputError(f"--see is {path!r}, which is not there; it must be a file or folder")
    hidden = () if out is None else (os.path.abspath(out),)
    seen = tuple(map(os.path.abspath, see))
    return replace(limits, isolation=Isolation(isolate or usual_mode(), hidden, names_in(pass_env), seen))


def seen_text(limits: Limits) -> str:
    """Return the files that --see shows an isolated implementation, as the end of a sentence; empty without --see."""
    return f"; --see shows it {', '.join(map(escaped, limits.isolation.seen))}" if limits.isolation.seen else ""


def isolation_of(specs: Iterable[str], limits: Limits) -> IsolationPart | None:
    """Return the isolation of these implementations in the form of the record; None if all are built in.

    Raises NotIsolatedError if --isolate is on, and the system cannot isolate them.
    """
    from hypcheck.record.lines import IsolationPart

    if all(spec.startswith("builtin:") for spec in specs):
        return None
    means = limits.isolation.means
    return IsolationPart(mode=limits.isolation.mode, means=list(means.names), missing=list(means.missing))


def print_isolation(spec: str, limits: Limits) -> None:
    """Print to standard error how the implementation is isolated, unless it is built in. Raises NotIsolatedError."""
    from hypcheck.isolation.launch import isolation_text

    isolation = isolation_of((spec,), limits)
    if isolation is not None:
        text = isolation_text(isolation.means, isolation.missing)
        click.echo(f"hypcheck: {escaped(spec)} is {escaped(text)}{seen_text(limits)}", err=True)


def names_in(text: str | None) -> tuple[str, ...]:
    """Return the names in a list separated by commas; none for None."""
    return tuple(name.strip() for name in (text or "").split(",") if name.strip())


def bytes_of(text: str) -> int:
    """Return a size such as 4G, 512M or 1000000 in bytes. Raises InputError."""
    known = text[-1:].upper() in _SUFFIXES
    number, exponent = (text[:-1], _SUFFIXES[text[-1].upper()]) if known else (text, 0)
    size = float(number) * 2**exponent if is_number(number) else math.inf
    if math.isinf(size):
        raise InputError(f"--memory is {text!r}; it must be a size such as 512M or 4G")
    return int(size)
