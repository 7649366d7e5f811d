"""The table of what became of every mutant, in Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

from hypcheck.geometry.rows import PAIRS
from hypcheck.report.markdown import code_span, escape_text, table_lines
from hypcheck.vectors import frozen
from hypcheck.vectors.families import TILTED_FAMILIES
from hypcheck.vectors.invalid_rows import INVALID_NAMES
from tests.tools.mutants.collection import Mutant, imported, sentence
from tests.tools.mutants.gating import Result

COMMAND = "make mutants"
NAMED = 3
"""Families that a row of the first tables names; the last table has them all."""

SWEEPS = ("passages", "ended", "ended_sweeps")
"""Modules about sweeps and ends, which have families of their own: few, and named in the module's table."""

HEAD = ("implementation", "what it does", "options", "must be", "was", "cases", "families", "most of them in")


def paragraph_lines(*sentences: str) -> list[str]:
    """A paragraph and an empty line."""
    return [" ".join(sentences), ""]


def render(results: Sequence[Result]) -> str:
    """The page."""
    wrong = [result for result in results if not result.mutant.expectation.right and result.mutant.module not in SWEEPS]
    lines = [
        "# Can the gate fail?",
        "",
        *paragraph_lines(
            f"Made by `{COMMAND}`, which gates each implementation below through `hypcheck verify` and ends with 1",
            "where one is not judged as it must be. Each is a function of a few lines in",
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
    for module, group in groupby(results, key=lambda result: result.mutant.module):
        lines += [
            f"## {module}",
            "",
            *paragraph_lines(escape_text(sentence(imported(module)).partition(". ")[0].rstrip(".") + ".")),
        ]
        lines += table_lines(HEAD, [_row(result) for result in group], numbers=(5, 6))
    return "\n".join([*lines, *_by_family(wrong), *_matrix(wrong)]).rstrip() + "\n"


def stable_cells(mutant: Mutant) -> tuple[str, ...]:
    """The first cells of a mutant's row, which do not depend on any run."""
    expectation = mutant.expectation
    options = code_span(" ".join(_quoted(word) for word in (*expectation.claim, *expectation.asked)))
    return code_span(mutant.name), escape_text(mutant.sentence), options, must_be(mutant)


def must_be(mutant: Mutant) -> str:
    """The verdict that the gate must come to, in words."""
    expectation = mutant.expectation
    if expectation.right:
        return "passed"
    if not expectation.asked or expectation.luck:
        return "rejected"
    without = [word for word in expectation.asked if word.startswith("--")]
    return f"rejected; passed without {' and '.join(map(code_span, without))}"


def _was(result: Result) -> str:
    without = f"; {result.without.verdict} without" if result.without else ""
    said = f"{result.ruling.verdict}{without}"
    return said if result.as_expected else f"**{said}** ✗"


def _row(result: Result) -> list[str]:
    killed_by = result.ruling.killed_by
    most = sorted(killed_by, key=lambda family: -killed_by[family])
    named = ", ".join(f"{family} {killed_by[family]}" for family in most[:NAMED])
    counts = [f"{sum(killed_by.values()):,}", str(len(killed_by))] if killed_by else ["", ""]
    return [*stable_cells(result.mutant), _was(result), *counts, named]


def _quoted(word: str) -> str:
    return f"'{word}'" if set(word) & set(' "{*') else word


def _tally(results: Sequence[Result]) -> str:
    held = [result for result in results if result.as_expected]
    right = sum(result.mutant.expectation.right for result in held)
    said = f"{len(held) - right} wrong implementations were rejected and {right} right ones passed"
    amiss = [result.mutant.name for result in results if not result.as_expected]
    return f"{said}; not as they must: {', '.join(map(code_span, amiss))}." if amiss else f"{said}, all as they must."


def _families() -> list[str]:
    return [*dict.fromkeys((*frozen.NAMES, *TILTED_FAMILIES, *INVALID_NAMES[PAIRS]))]


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


def _matrix(wrong: Sequence[Result]) -> list[str]:
    """The cases that each family rejected each mutant by."""
    families = _families()
    rows = [
        [code_span(result.mutant.name), *(str(result.ruling.killed_by.get(family, "")) for family in families)]
        for result in wrong
    ]
    head = ["implementation", *map(str, range(1, len(families) + 1))]
    intro = "Cases of each family, by its number above, that failed: wrong, abstained or nondeterministic."
    return [
        "## Which family rejects which",
        "",
        *paragraph_lines(intro),
        *table_lines(head, rows, numbers=range(1, len(head))),
    ]
