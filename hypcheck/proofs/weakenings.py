"""Weakened statements made by a program: constants, comparisons, guards and answers of every stage, each changed.

They are changes of statements and definitions alone, never of a proof. Coq is to refuse each, or explained.toml says
why the changed statement holds too. A refusal says that the proof as written does not go through, not that the
statement is false.
"""

from __future__ import annotations

import random
import re
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from hypcheck import toml

Change = tuple[str, str]
"""The changed text, and what was changed."""


@dataclass(frozen=True, slots=True)
class Place:
    """The texts of a file that a pattern finds, the kinds of changes made in them, and the stage that they are of.

    Coq need read no further than `until`: what proves that the changed text is enough stands before it.
    """

    stage: str
    file: str
    pattern: str
    kinds: tuple[Callable[[str], Iterator[Change]], ...]
    until: str = ""


def constants(text: str) -> Iterator[Change]:
    """Every whole number one less and one more."""
    for found in _outside_remarks(r"(?<![\w.'])\d+(?![\w'])", text):
        for by in (-1, 1):
            yield _with(text, found, str(int(found[0]) + by)), f"{found[0]} {by:+d}"


def comparisons(text: str) -> Iterator[Change]:
    """Every comparison strict where it is not, and the other way round; what is certain only not excluded."""
    for found in _outside_remarks(r"(?<=\s)<=?(?=\s)", text):
        new = {"<": "<=", "<=": "<"}[found[0]]
        yield _with(text, found, new), f"{new} for {found[0]}"
    for found in _outside_remarks(r"certainly_(positive|negative) (\w+|\([^()]*(?:\([^()]*\)[^()]*)*\))", text):
        weak = f"(0 <= {found[2]})" if found[1] == "positive" else f"({found[2]} <= 0)"
        yield _with(text, found, weak), f"{weak} for certainly_{found[1]}"


def guards(text: str) -> Iterator[Change]:
    """Every hypothesis of a line left out."""
    head, _, body = text.partition(" : ")
    parts = [""]
    for word in re.split(r"\s*(->)\s*", body):
        within = parts[-1].count("(") > parts[-1].count(")")
        if word == "->" and not within:
            parts.append("")
        else:
            parts[-1] += " -> " if word == "->" else word
    for place, part in enumerate(parts[:-1]):
        rest = " -> ".join(parts[:place] + parts[place + 1 :])
        yield f"{head} : {rest}", f"without {' '.join(part.split())}"


def answers(text: str) -> Iterator[Change]:
    """Every answer and every sign of a table another one."""
    for words in (("Exterior", "Contact", "Interior"), ("Lt", "Eq", "Gt")):
        for found in _outside_remarks(rf"\b(?:{'|'.join(words)})\b", text):
            for new in words:
                if new != found[0]:
                    yield _with(text, found, new), f"{new} for {found[0]}"


def bounds(text: str) -> Iterator[Change]:
    """Every bound of the header one unit less."""
    for found in _outside_remarks(r'said "\w+"', text):
        yield _with(text, found, f"({found[0]} - 1)"), f"{found[0]} less 1"


def conditions(text: str) -> Iterator[Change]:
    """Every condition of a checker left out, every strict one weak, every refusal an acceptance."""
    for start, stop in _conjuncts(text):
        condition = " ".join(text[start:stop].split())
        yield f"{text[:start]}true{text[stop:]}", f"without {condition}"
    for found in _outside_remarks(r"\bless\b(?!_)", text):
        yield _with(text, found, "Qle_bool"), "Qle_bool for less"
    for found in _outside_remarks(r"\bfalse\b", text):
        yield _with(text, found, "true"), "true for false"


_BOUNDARY = r"&&|\|\||[()|]|:=|=>|\.$|\b(?:match|let|in|end|then|else)\b"


def _conjuncts(text: str) -> Iterator[tuple[int, int]]:
    """Where the parts of each `... && ... && ...` begin and end."""
    tokens = list(_outside_remarks(_BOUNDARY, text))
    for place, before in enumerate(tokens):
        if before[0] in {")", "end", "match"}:
            continue
        depth = 0
        for after in tokens[place + 1 :]:
            if depth == 0 and after[0] not in {"(", "match", "let"}:
                part = text[before.end() : after.start()]
                if "&&" in {before[0], after[0]}:
                    yield after.start() - len(part.lstrip()), before.end() + len(part.rstrip())
                break
            depth += {"(": 1, "match": 1, ")": -1, "end": -1}.get(after[0], 0)


def _outside_remarks(pattern: str, text: str) -> Iterator[re.Match[str]]:
    hidden = re.sub(r"\(\*.*?\*\)", lambda remark: " " * len(remark[0]), text, flags=re.DOTALL)
    return re.finditer(pattern, hidden)


def _with(text: str, found: re.Match[str], new: str) -> str:
    return text[: found.start()] + new + text[found.end() :]


PLACES = (
    Place("1 to 5", "Stages", r"^\| \w+[^|]*? : .*?(?=^\||^\(\*|\.$)", (constants, comparisons, guards)),
    Place("1", "HalfPlanes", r"^Definition (?:beyond|within)_[KM] .*?\.$", (constants,)),
    Place("1", "StageOne", r"^Definition (?:beyond|within) .*?\.$", (constants,), "(** ** **What the C answers"),
    Place("2", "Kernel", r"^Theorem error_of_\w+ .*?\.$", (constants,)),
    Place("2", "RunningBound", r"4 \* unit \* slack; .*?\] 0\.$", (constants,)),
    Place("2", "StageTwoAnswers", r"^\| says_\w+ : .*?(?=^\||\.$)", (comparisons, guards)),
    Place("2", "StageTwoRuns", r"^Definition (?:lost|constants) .*?\.$", (constants,)),
    Place("2", "StageTwoRuns", r"^Theorem \w+_is_right : .*?\.$", (guards,)),
    Place("3", "FixedRuns", r"^Theorem header_covers_\w+ .*?\.$", (bounds,)),
    Place("3", "StageThree", r"^Definition fixed_answer .*?end\.$", (answers,)),
    Place("4", "StageFour", r"^Definition (?:lengths|\w+_inputs) .*?\.$", (constants,), "(** ** What the"),
    Place("4", "Tangency", r"^Definition (?:n2_of|n1_of|tangency_equations) .*?\.$", (constants,)),
    Place("ends", "Ends", r"^Definition (?!larger|covered|curve|piece)\w+ .*?\.$", (comparisons,)),
    Place("ends", "Ends", r"^Theorem (?:open|solid)_\w+_by_\w+ .*?\.$", (guards,)),
    Place("ends", "EndsChecker", r"^(?:Definition|Fixpoint) (?:valid|q|check|on)_\w+ .*?\.$", (constants, conditions)),
    *(
        Place("checker", file, r"^(?:Definition|Fixpoint) (?:valid|q|check|are|inside)\w* .*?\.$", (conditions,))
        for file in ("Checker", "LeaningChecker", "RowChecker")
    ),
    Place("5", "Positions", r"^Definition exact_answer .*?end\.$", (answers,)),
)


@dataclass(frozen=True, slots=True)
class Made:
    """A weakened statement: its stage and file, the text that stands there once, the new one, what was changed."""

    stage: str
    file: str
    old: str
    new: str
    allows: str
    until: str


def made(source: Callable[[str], str]) -> list[Made]:
    """All of them, in the order of the stages; `source` gives the text of a file. No two are called alike."""
    found: list[Made] = []
    often: Counter[tuple[str, str]] = Counter()
    for place in PLACES:
        for text in re.finditer(place.pattern, source(place.file), re.MULTILINE | re.DOTALL):
            for new, what in (change for kind in place.kinds for change in kind(text[0])):
                called = f"{_name_of(text[0])}: {what}"
                often[place.file, called] += 1
                if often[place.file, called] > 1:
                    called += f", place {often[place.file, called]}"
                found.append(Made(place.stage, place.file, text[0], new, called, place.until))
    return found


def reasons() -> dict[tuple[str, str], str]:
    """Why a changed statement that Coq accepts holds too, by file and what was changed: what explained.toml says."""
    name = "explained.toml"
    table = toml.parsed((Path(__file__).parent / name).read_text(encoding="utf-8"), name)
    return {(each["file"], change): each["reason"] for each in table["explained"] for change in each["changes"]}


def _name_of(text: str) -> str:
    return text.partition(" :")[0].partition(":=")[0].strip("| \n")


def sample(all_made: list[Made], count: int, seed: int) -> list[Made]:
    """So many of them from the files that Coq compiles within two seconds, drawn by the seed."""
    files = {"Stages", "StageTwoAnswers", "HalfPlanes", "Positions", "EndsChecker"}
    quick = [each for each in all_made if each.file in files]
    return random.Random(seed).sample(quick, min(count, len(quick)))  # noqa: S311 - no secret
