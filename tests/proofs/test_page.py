"""docs/proofs.md and docs/proofs/steps.csv: theorems that they name are proved, and the page agrees with the table."""

from __future__ import annotations

import csv
import re
from collections import Counter
from pathlib import Path

from hypcheck.proofs import build

DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGE = (DOCS / "proofs.md").read_text(encoding="utf-8")
STEPS = list(csv.DictReader((DOCS / "proofs" / "steps.csv").read_text(encoding="utf-8").splitlines()))
NAMED = re.compile(r"`([A-Z]\w+)\.(?!v`)(\w+)`")
"""A theorem as the page names it, `File.theorem`."""


def theorems(step):
    """The theorems of a step as pairs of a file and a name."""
    return [tuple(name.split(".")) for name in step["theorems"].split("; ") if name]


def section(heading):
    """The part of the page below a heading."""
    return PAGE.partition(f"\n## {heading}\n")[2].partition("\n## ")[0]


def rows_of(text):
    """The rows of the tables in a text of Markdown, without their headings."""
    lines = [line for line in text.splitlines() if line.startswith("| ")]
    return [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines if "| ---" not in line][1:]


def test_each_theorem_of_the_table_is_proved_in_its_file():
    named = [theorem for step in STEPS for theorem in theorems(step)]
    assert len(named) > 200
    assert [theorem for theorem in named if not build.proves(*theorem)] == []


def test_exactly_the_steps_that_count_as_proved_have_theorems():
    assert {step["how"] for step in STEPS if theorems(step)} == {"proved", "proved false"}
    assert [step["step"] for step in STEPS if step["how"].startswith("proved") and not theorems(step)] == []


def test_the_page_counts_the_steps_of_each_part_by_how_they_are_known():
    counted = Counter((step["part"], step["how"]) for step in STEPS)
    text = section("Every step from points to the binary")
    heading = next(line for line in text.splitlines() if line.startswith("| part"))
    hows = [cell.strip() for cell in heading.split("|")[2:-1]]
    shown = {
        (part, how): int(cell or 0) for part, *cells in rows_of(text) for how, cell in zip(hows, cells, strict=True)
    }
    assert Counter(shown) == counted
    assert f"a table of the {len(STEPS)} steps" in text


def test_the_page_lists_every_step_without_a_theorem_and_why_it_is_believed():
    def as_on_page(text):
        return re.sub(r"docs/([\w-]+\.md)", r"[\1](\1)", text)

    unproved = [step for step in STEPS if step["how"] not in {"proved", "proved false", "checked"}]
    listed = [[as_on_page(step["step"]), step["how"], as_on_page(step["remark"])] for step in unproved]
    assert rows_of(section("Steps without a theorem")) == listed


def test_the_page_names_a_theorem_of_every_main_result():
    named = set(NAMED.findall(section("Main results")))
    main = [theorems(step) for step in STEPS if step["main result"]]
    assert len(rows_of(section("Main results"))) == len(main) == 15
    assert [of_step for of_step in main if not named.intersection(of_step)] == []


def test_every_theorem_on_the_page_is_in_the_table():
    axiom = tuple(build.OF_FLOCQ.split("."))
    assert set(NAMED.findall(PAGE)) - {axiom} <= {theorem for step in STEPS for theorem in theorems(step)}


def test_every_coq_file_that_page_and_table_name_exists():
    named = re.findall(r"`([A-Z]\w+)\.v`", PAGE + "".join(step["remark"] for step in STEPS))
    assert len(named) > 20
    assert {name for name in named if name not in build.FILES} == set()


def test_the_page_lists_the_axioms_and_the_files_that_assume_the_excluded_middle():
    text = section("What is assumed")
    assert sorted(re.findall(r"^    (\S+)$", text, re.MULTILINE)) == sorted(build.AXIOMS)
    assert set(re.findall(r"`(\w+)\.v`", text)) == set(build.ON_FLOCQ)
