"""What became of every mutant: a page about the whole, and two tables of data for each mutant and family."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from itertools import groupby

from hypcheck.report.markdown import code_span, escape_text, table_lines
from hypcheck.vectors import frozen
from hypcheck.vectors.families import TILTED_FAMILIES
from tests.tools.mutants.collection import Mutant, imported, sentence
from tests.tools.mutants.gating import Result

COMMAND = "make mutants"
RULINGS, REJECTIONS = "rulings.csv", "rejections.csv"
"""The files of data beside the page."""

NAMED = 3
"""Families that a ruling names; rejections.csv has them all."""

SWEEPS = ("passages", "ended", "ended_sweeps")
"""Modules about sweeps and ends, which have families of their own: few, and named in the rulings."""

HEAD = ("implementation", "what it does", "options", "must be", "was", "cases", "families", "most of them in")
REJECTIONS_HEAD = ("implementation", "family", "cases")


def paragraph_lines(*sentences: str) -> list[str]:
    """A paragraph and an empty line."""
    return [" ".join(sentences), ""]


def render(results: Sequence[Result]) -> str:
    """The page."""
    wrong = _wrong(results)
    lines = [
        "# Can the gate fail?",
        "",
        *paragraph_lines(
            f"Made by `{COMMAND}`, which gates each implementation through `hypcheck verify` and ends with 1 where one",
            "is not judged as it must be. Each is a function of a few lines in",
            "[this folder](.). `python -m tests.tools.mutants signs.c0` gates one",
            "alone, as does `hypcheck verify python:tests.tools.mutants.signs:c0`; where a module imports hypcheck,",
            "which an isolated program does not see, with `--isolate off`.",
        ),
        *paragraph_lines(
            "Most wrong ones are made of a formula in whole numbers that is right everywhere, with one piece replaced:",
            "what rejects them has seen that piece. Options are those that the claim needs (a precision, a question, a",
            "domain) and those that ask for more than the default options do; without the latter the implementation",
            "passes, which is tried as well.",
        ),
        *paragraph_lines(
            "More must be asked where the default options cannot see it, whatever the cases are: errors of a few units",
            "(`--tolerance 0`), lengths beyond the ordinary ranges (`--families extreme`), what begins with the",
            "hundred-thousandth row of a process (`--count`), rows known by heart beforehand (`--seed`), changes",
            "within the tolerance (`--deterministic`), and mistakes so rare that it is a matter of luck whether one is",
            "met.",
        ),
        *paragraph_lines(f"**{_tally(results)}**"),
    ]
    lines += [
        *paragraph_lines(
            f"[{RULINGS}]({RULINGS}) has each implementation: what it does, its options, what it must be and was, in",
            "how many cases and families it failed, and in which most.",
            f"[{REJECTIONS}]({REJECTIONS}) has the cases of each family that failed: wrong, abstained or",
            "nondeterministic.",
        ),
        *_by_module(results),
        *_by_family(wrong),
    ]
    return "\n".join(lines).rstrip() + "\n"


def rulings(results: Sequence[Result]) -> str:
    """rulings.csv: a line for each mutant."""
    return csv_text(HEAD, map(_row, results))


def rejections(results: Sequence[Result]) -> str:
    """rejections.csv: a line for each wrong mutant and family of positions that rejects it."""
    return csv_text(
        REJECTIONS_HEAD,
        (
            (result.mutant.name, family, str(result.ruling.killed_by[family]))
            for result in _wrong(results)
            for family in _families()
            if family in result.ruling.killed_by
        ),
    )


def csv_text(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table as CSV."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(head)
    writer.writerows(rows)
    return stream.getvalue()


def stable_cells(mutant: Mutant) -> tuple[str, ...]:
    """The first cells of a mutant's ruling, which do not depend on any run."""
    expectation = mutant.expectation
    options = " ".join(_quoted(word) for word in (*expectation.claim, *expectation.asked))
    return mutant.name, mutant.sentence, options, must_be(mutant)


def must_be(mutant: Mutant) -> str:
    """The verdict that the gate must come to, in words."""
    expectation = mutant.expectation
    if expectation.right:
        return "passed"
    if not expectation.asked or expectation.luck:
        return "rejected"
    without = [word for word in expectation.asked if word.startswith("--")]
    return f"rejected; passed without {' and '.join(without)}"


def _was(result: Result) -> str:
    without = f"; {result.without.verdict} without" if result.without else ""
    said = f"{result.ruling.verdict}{without}"
    return said if result.as_expected else f"{said} ✗"


def _row(result: Result) -> list[str]:
    killed_by = result.ruling.killed_by
    most = sorted(killed_by, key=lambda family: -killed_by[family])
    named = ", ".join(f"{family} {killed_by[family]}" for family in most[:NAMED])
    counts = [str(sum(killed_by.values())), str(len(killed_by))] if killed_by else ["", ""]
    return [*stable_cells(result.mutant), _was(result), *counts, named]


def _wrong(results: Sequence[Result]) -> list[Result]:
    """The wrong implementations that answer questions about positions."""
    return [result for result in results if not result.mutant.expectation.right and result.mutant.module not in SWEEPS]


def _by_module(results: Sequence[Result]) -> list[str]:
    """The modules: what is wrong in each, and how many implementations were rejected and passed."""
    rows = []
    for module, group in groupby(results, key=lambda result: result.mutant.module):
        verdicts = [result.ruling.verdict for result in group]
        about = escape_text(sentence(imported(module)).partition(". ")[0].rstrip(".") + ".")
        rows.append(
            [f"[{module}]({module}.py)", about, *(str(verdicts.count(word)) for word in ("rejected", "passed"))]
        )
    head = ("module", "what its implementations get wrong", "rejected", "passed")
    return ["## By module", "", *table_lines(head, rows, numbers=(2, 3))]


def _quoted(word: str) -> str:
    return f"'{word}'" if set(word) & set(' "{*') else word


def _tally(results: Sequence[Result]) -> str:
    held = [result for result in results if result.as_expected]
    right = sum(result.mutant.expectation.right for result in held)
    said = f"{len(held) - right} wrong implementations were rejected and {right} right ones passed"
    amiss = [result.mutant.name for result in results if not result.as_expected]
    return f"{said}; not as they must: {', '.join(map(code_span, amiss))}." if amiss else f"{said}, all as they must."


def _families() -> list[str]:
    return [*dict.fromkeys((*frozen.NAMES, *TILTED_FAMILIES, "invalid", "tilted-invalid"))]


def _by_family(wrong: Sequence[Result]) -> list[str]:
    """How many mutants each family rejects, and which no other does."""
    rows = []
    for number, family in enumerate(_families(), start=1):
        hits = [result for result in wrong if family in result.ruling.killed_by]
        alone = [code_span(result.mutant.name) for result in hits if len(result.ruling.killed_by) == 1]
        rows.append([str(number), family, str(len(hits)), ", ".join(alone)])
    intro = "How many wrong implementations each family of positions rejects, and which are rejected by it alone."
    head = ("number", "family", "rejects", "rejects alone")
    return ["## By family", "", *paragraph_lines(intro), *table_lines(head, rows, numbers=(0, 2))]
