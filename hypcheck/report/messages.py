"""Texts that every report uses: numbers, lists, rows, settings, declarations, and the commands that show a case."""

from __future__ import annotations

import math
import shlex
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from msgspec import UNSET, UnsetType

from hypcheck.errors import InputError
from hypcheck.geometry.pair import ENDS, HEIGHTS, SIZES
from hypcheck.geometry.rows import PAIRS, Layout
from hypcheck.implementations import domain
from hypcheck.implementations.session import Limits
from hypcheck.isolation.launch import MODES
from hypcheck.messages import counted
from hypcheck.record import Record, lines
from hypcheck.record.fields import layout_of, numbers_of
from hypcheck.record.reader import recorded_cases
from hypcheck.runs.judge import DEFAULT_TOLERANCE
from hypcheck.vectors.border_lines import NEAREST_OCTAVE, SEARCHED


def as_sentence(fact: str) -> str:
    """Make a sentence of a fact: it begins with a capital letter and ends with a full stop."""
    return f"{fact[:1].upper()}{fact[1:]}."


def listed(items: Sequence[str], last: str = "and") -> str:
    """Join the items as in a sentence: "a, b and c"; `last` is the word before the last item."""
    return f" {last} ".join(part for part in (", ".join(items[:-1]), *items[-1:]) if part)


def figure(value: float) -> str:
    """Return a measured value to three digits: 0, 0.8, 12.3, 4,820, 3.1e7, ∞."""
    if math.isinf(value):
        return "∞"
    if value == 0:
        return "0"
    if 1e-3 <= abs(value) < 999.5:
        return f"{value:.3g}"
    if 999.5 <= abs(value) < 1e6:
        return f"{float(f'{value:.3g}'):,.0f}"
    mantissa, _, exponent = f"{value:.1e}".partition("e")
    return f"{mantissa}e{int(exponent)}"


def with_interval(value: float, interval: Sequence[float] | None) -> str:
    """Return a value with the ends of its interval, if it has one: "1.2 (1.1 to 1.3)"."""
    return figure(value) if interval is None else f"{figure(value)} ({' to '.join(map(figure, interval))})"


def pace(ratio: float, other: str = "", interval: tuple[float, float] | None = None) -> str:
    """Return a ratio of times in words: "24 times as fast as NAME", "takes 3 times as long as NAME (2 to 4)".

    Without a name, "24 times as fast". `interval` holds the ends of the ratio's interval.
    """
    named = f" as {other}" if other else ""
    if ratio == 1:
        return f"as fast{named}"
    if 0 < ratio < 1:
        words = f"{figure(1 / ratio)} times as fast{named}"
        ends = [1 / end if end else math.inf for end in reversed(interval or ())]
    else:
        words, ends = f"takes {figure(ratio)} times as long{named}", [*(interval or ())]
    return f"{words} ({' to '.join(map(figure, ends))})" if ends else words


def from_hex(row: Sequence[str]) -> tuple[float, ...]:
    """Return the numbers of a row as a record keeps it. Raises InputError if one is beyond float64."""
    try:
        return tuple(float.fromhex(value) for value in row)
    except OverflowError:
        raise InputError(f"the record has a number that is too large for float64 in the row {', '.join(row)}") from None


def short_row(row: Sequence[float]) -> str:
    """Return a row to six digits: "alpha 2, gamma 17.8, b 0.25, d 0.15, centre (3, 0, 0)".

    The axis and the heights follow if it has them.
    """
    _, axis, heights = PAIRS.split(row)
    numbers = [*zip(SIZES, row, strict=False), *zip(HEIGHTS, heights, strict=False)]
    words = [f"{name} {value:.6g}" for name, value in numbers]
    vectors = (("centre", row[4:7]), ("axis", axis))
    places = [f"{name} ({', '.join(f'{value:.6g}' for value in vector)})" for name, vector in vectors if vector]
    return ", ".join([*words[: len(SIZES)], *places, *words[len(SIZES) :]])


def classify_command(row: Sequence[float], layout: Layout = PAIRS) -> str:
    """Return the command that decides a row exactly and proves it; its decimals read back as the same float64."""
    others, axis, heights = layout.split(row)
    options = [*zip(SIZES, ((value,) for value in others), strict=False), ("center", others[4:7])]
    options += [("end", others[7:]), ("axis", axis)]
    ends = [(name.replace("_", "-"), (end,)) for name, end in zip(ENDS, heights, strict=False) if math.isfinite(end)]
    words = [f"--{name} {' '.join(map(repr, values))}" for name, values in (*options, *ends) if values]
    return " ".join(["hypcheck classify", *words, *(["--solid"] if ends and heights[2] else [])])


def error_text(case: lines.WrongAnswer) -> str:
    """Return the error of an answer, in the unit of the tolerance: "wrong by 12 u", "wrong at any distance".

    For a wrong time, it names the answered time, the first contact, and the distance between them in radii of the
    spheroid along the sweep.
    """
    if case.time is UNSET or case.first is UNSET:
        if case.backward_error >= 1:
            return "wrong at any distance"
        return f"wrong by {figure(case.backward_error_u)} u"
    radii = figure(case.backward_error)
    return f"at {case.time!r}, but the first contact is at {case.first[0]!r}, {radii} radii of the sweep from there"


def settings_facts(settings: lines.SettingsPart | UnsetType | None) -> Iterator[str]:
    """Yield one sentence without a full stop about the settings: their file, and options that weaken the gate.

    Yields nothing if there is no settings file and every deciding option is as strict as its default.
    """
    if not settings:
        return
    parts = [f"settings are those of {settings.file}"] if settings.file else []
    weakened = settings.weakened
    if weakened:
        named = (f"{option.option} {option.value}, not {option.default} ({option.source})" for option in weakened)
        parts.append(f"weaker than the default: {'; '.join(named)}")
    yield "; ".join(parts)


def implementation_claims(
    line: lines.ImplementationLine,
    rows: Mapping[str, int] = MappingProxyType({}),
    *,
    left_out: bool = True,
) -> Iterator[str]:
    """Yield sentences without a full stop about what an implementation declares and how it was tested.

    `rows` counts rows that were not tested, by reason. `left_out`: with the sentence about what was not tested.
    """
    declared, used = line.declared, line.used
    changed = [name for name in ("question", "precision", "domain") if getattr(declared, name) != getattr(used, name)]
    yield f"declares {description_text(declared)}"
    if changed:
        yield f"judged as {listed([_declared_value(used, name) for name in changed])}, as the options say"
    yield from how_tested(line, rows, left_out=left_out)


def how_tested(line: lines.ImplementationLine, rows: Mapping[str, int], *, left_out: bool = True) -> Iterator[str]:
    """Yield sentences without a full stop: what was not tested, the evenness of the cases, what was asked again."""
    not_asked = [text for text in (families_not_asked(line), rows_not_asked(rows)) if text]
    if not_asked and left_out:
        yield f"not asked: {'; '.join(not_asked)}"
    yield from _spread(line)
    again, restarts = line.retest, line.restarts
    other = again.within + again.beyond
    repetition = f"asked again about {counted(again.asked, 'case')}, {other:,} answered otherwise"
    beyond = f" ({again.beyond:,} beyond the tolerance)"
    repeated = f"{repetition}{beyond}" if again.asked else "nothing to ask again: no answer was judged"
    yield f"{repeated}; {counted(restarts, 'restart')}"


def _spread(line: lines.ImplementationLine) -> Iterator[str]:
    """Yield sentences about the width of a fault that the run could miss, and about the tested coincidences."""
    for family, slices in (line.slices or {}).items():
        if family in SEARCHED:
            yield from _searched(slices, tilted="axis" in SEARCHED[family].groups)
            continue
        where = f"near contact of {'tilted' if family.startswith('tilted') else 'upright'} spheroids"
        names = listed(slices.coordinates, "or")
        yield (
            f"{where}, every slice of {_percent(slices.one)} of {names} was asked "
            f"3 times or more, every slice of {_percent(slices.two)} in two of them at least once"
        )
    if line.crossed:
        met, all_ = (sum(pair[place] for pair in line.crossed.values()) for place in (0, 1))
        yield f"coincidences, three together: {met:,} of {all_:,} that are possible were asked"


def _searched(slices: lines.SlicesPart, *, tilted: bool) -> Iterator[str]:
    """Yield the sentence about the evenness of a directed search over all distances from contact."""
    yield (
        f"a directed search followed {'tilted' if tilted else 'upright'} spheroids from clear to contact, to where its "
        f"answers change; from {2.0**NEAREST_OCTAVE:.1g} of their size off contact to all of it, every slice of "
        f"{_percent(slices.one)} of the octaves was asked 3 times or more on each side of contact"
    )


def _percent(share: float) -> str:
    """Return a share in per cent, rounded up to two digits: a statement about a slice holds for wider slices too."""
    digits = 1 - math.floor(math.log10(100 * share)) if share else 2
    return f"{math.ceil(100 * share * 10**digits) / 10**digits:.{max(0, digits)}f} %"


def rows_not_asked(counts: Mapping[str, int]) -> str:
    """Return the rows that were not tested, by reason: "120 rows not zero or normal in its precision"; "" if none."""
    return listed(
        [f"{counted(counts[reason], 'row')} {text}" for reason, text in domain.ROWS.items() if counts.get(reason)]
    )


def families_not_asked(line: lines.ImplementationLine, reasons: Collection[str] = domain.FAMILIES) -> str:
    """Return the families that were not tested, by reason: "5 families left out by --families"; "" if none."""
    left_out = {reason: (line.not_asked or {}).get(reason) for reason in reasons}
    return listed(
        [
            f"{counted(len(families), 'family', 'families')} {domain.FAMILIES[reason]}"
            for reason, families in left_out.items()
            if families
        ]
    )


def description_text(description: lines.DescriptionPart) -> str:
    """Return a description in words: question, precision, domain and the rest."""
    parts = [_declared_value(description, name) for name in ("question", "precision", "domain")]
    parts += [text for text in (description.language, description.version) if text]
    if description.refuses:
        parts.append("refuses invalid rows")
    if description.tilt:
        parts.append("takes tilted spheroids")
    if description.heights:
        parts.append("takes hyperboloids that end")
    if description.times:
        parts.append("gives times of first contact")
    return ", ".join(parts)


def _declared_value(description: lines.DescriptionPart, name: str) -> str:
    """Return the question, the precision or the domain of a description in words."""
    return domain_text(description.domain) if name == "domain" else str(getattr(description, name))


_SIZES_NAMED = 4


def domain_text(value: lines.DomainPart) -> str:
    """Return a domain in words: "every regime, ratios 0.001 to 1,000, magnitudes not declared"."""
    regimes = listed(value.regimes) if value.regimes else "every regime"
    ranges = [f"ratios {_range(value.ratio)}", f"magnitudes {_range(value.magnitude)}"]
    settings = value.settings or ()
    sizes = [f"({', '.join(f'{size:.6g}' for size in setting.sizes)})" for setting in settings]
    if len(sizes) > _SIZES_NAMED:
        sizes = [*sizes[:_SIZES_NAMED], f"{len(sizes) - _SIZES_NAMED:,} more"]
    only = [f"only α, γ, b, d = {listed(sizes, 'or')}"] if sizes else []
    return ", ".join([regimes, *only, *ranges])


def _range(limits: tuple[float, float] | None) -> str:
    """Return the least and the greatest in words; "not declared" for None."""
    return "not declared" if limits is None else " to ".join(figure(limit) for limit in limits)


_LIMITS = ("startup_timeout", "timeout", "memory")


@dataclass(frozen=True)
class Replays:
    """The commands that show the cases of one record.

    numbers: the number of each case, by its id(). options: the options of `hypcheck replay` that give the run's
    judgement.
    """

    numbers: Mapping[int, int]
    options: tuple[str, ...]

    @classmethod
    def of(cls, record: Record) -> Replays:
        """Collect the commands for the cases of a record."""
        numbers = {id(numbered.case): numbered.number for numbered in recorded_cases(record)}
        return cls(numbers, tuple(_options(record.header.options)))

    def place(self, case: lines.WrongAnswer | lines.FaultPart) -> str:
        """Return the case as `hypcheck replay` reads it in the record's folder: record.jsonl:7."""
        return f"record.jsonl:{self.numbers[id(case)]}"

    def command(self, group: lines.GroupLine, case: lines.WrongAnswer | lines.FaultPart) -> str:
        """Return the command that shows a case: a replay if the implementation is gated, else an exact decision."""
        if not group.tested:
            return classify_command(from_hex(numbers_of(case)), layout_of(case))
        return self.of_case(case.case, str(group.spec))

    def of_case(self, case: str, spec: str) -> str:
        """Return the command that replays a case of an implementation."""
        return shlex.join(["hypcheck", "replay", case, spec, *self.options])


def tolerance_of(options: Mapping[str, Any]) -> float | None:
    """Return the tolerance of a run in units u; None if its options have no number for it."""
    tolerance = options.get("tolerance")
    return float(tolerance) if isinstance(tolerance, (int, float)) else None


def _options(options: Mapping[str, Any]) -> list[str]:
    """Return the run's options that differ from their defaults and change what a replay shows."""
    words = [f"--{name}={options[name]}" for name in ("precision", "question") if options.get(name) is not None]
    tolerance = tolerance_of(options)
    if tolerance is not None and tolerance != DEFAULT_TOLERANCE:
        words.append(f"--tolerance={tolerance:g}")
    limits, usual = options.get("limits"), Limits()
    limits = limits if isinstance(limits, dict) else {}
    unusual = [name for name in _LIMITS if name in limits and limits[name] != getattr(usual, name)]
    return words + [f"--{name.replace('_', '-')}={limits[name]}" for name in unusual] + [*_isolation(limits)]


def _isolation(limits: Mapping[str, Any]) -> Iterator[str]:
    """Yield the options about what an implementation can see, as far as they differ from their defaults."""
    if limits.get("isolate", MODES[0]) != MODES[0]:
        yield f"--isolate={limits['isolate']}"
    if limits.get("pass_env"):
        yield f"--pass-env={','.join(limits['pass_env'])}"
    yield from (f"--see={path}" for path in limits.get("see") or ())
