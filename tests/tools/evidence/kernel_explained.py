"""Mutants of the kernel that no row tells: told by what is proved of programs and constants, or explained.

`explained_kernel_mutants.json` is a list of rules. Each has a reason, functions as a regular expression, and the
changes that it explains: each a text `before → after` as it stands in the header, of one comparison or of all that is
changed. "<>" stands for every comparison that becomes strict or no longer is, and "*" for every change.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path

from hypcheck.derivation.program import Program
from tests.kernel.constant_proofs import PROOFS
from tests.kernel.program_rules import SIGNS, wrong_limits
from tests.support.inside import CERTIFIED, TILTED
from tests.tools.evidence.c_sites import Mutant

TABLE = Path(__file__).with_name("explained_kernel_mutants.json")

PROGRAMS = {"hc_certified": CERTIFIED, "hc_tilted": TILTED}
"""The programs that functions are printed from, and that have rules for all signs and limits."""

STRICTER = {"<": "<=", "<=": "<", ">": ">=", ">=": ">"}
"""What a comparison becomes that answers otherwise at equality alone."""

_JOINED = re.compile(r" (&&|\|\|) ")
_MACRO = re.compile(r"HC_(GT|LT|GE|LE|AND|OR)\((\w+), (?:HC_SET\((\d+)\.0\)|(\w+))\)")


@dataclass(frozen=True)
class Rule:
    """Why mutants of some functions are no gap."""

    reason: str
    functions: str
    changes: tuple[str, ...]

    def explains(self, mutant: Mutant) -> bool:
        """Whether this mutant is one of them."""
        if not re.fullmatch(self.functions, mutant.function):
            return False
        texts = {f"{mutant.before} → {mutant.after}", " → ".join(changed(mutant))}
        return bool(texts & {*self.changes}) or "*" in self.changes or ("<>" in self.changes and at_equality(mutant))


def rules() -> list[Rule]:
    """The table."""
    found = json.loads(TABLE.read_text(encoding="utf-8"))
    return [Rule(each["reason"], each["functions"], tuple(each["changes"])) for each in found]


def reason(mutant: Mutant, table: Iterable[Rule]) -> str | None:
    """Why a mutant is no gap; None where nobody has said."""
    return next((rule.reason for rule in table if rule.explains(mutant)), None)


def changed(mutant: Mutant) -> tuple[str, str]:
    """The comparison that a mutant changes, and what it becomes; all that is there where more than one changes."""
    before, after = (_JOINED.split(text) for text in (mutant.before, mutant.after.removeprefix("(").removesuffix(")")))
    differing = [place for place, pair in enumerate(zip(before, after, strict=False)) if pair[0] != pair[1]]
    if len(before) != len(after) or len(before) == 1 or len(differing) != 1 or differing[0] % 2:
        return mutant.before, mutant.after.removeprefix("(").removesuffix(")") if len(before) == 1 else mutant.after
    return _bare(before[differing[0]]), _bare(after[differing[0]])


def _bare(text: str) -> str:
    """Without parentheses that others close or open."""
    while text.count("(") > text.count(")"):
        text = text[text.index("(") + 1 :]
    while text.count(")") > text.count("("):
        text = text[: text.rindex(")")]
    return text.strip()


def at_equality(mutant: Mutant) -> bool:
    """Whether it is one comparison that becomes strict, or no longer is."""
    before, after = (text.split(" ") for text in changed(mutant))
    differing = [pair for pair in zip(before, after, strict=False) if pair[0] != pair[1]]
    if len(before) != len(after) or len(differing) != 1:
        return False
    return STRICTER.get(differing[0][0]) == differing[0][1]


def told_by_proof(mutant: Mutant) -> str | None:
    """What a mutant breaks: the "rule" of a program, or the "derivation" of a constant; None where it breaks none."""
    for program in _with_step_changed(mutant):
        if wrong_limits(program) or SIGNS[program.name](program):
            return "rule"
    proof = PROOFS.get(mutant.function.removeprefix("HC_")) if mutant.function.startswith("HC_") else None
    return "derivation" if proof is not None and not proof(Fraction(float(mutant.after))) else None


def _with_step_changed(mutant: Mutant) -> Iterator[Program]:
    """The program that the function is printed from, with the step changed, if it is a comparison or a junction."""
    program, before, after = PROGRAMS.get(mutant.function), _MACRO.fullmatch(mutant.before), mutant.after
    other = _MACRO.fullmatch(after.removeprefix("(").removesuffix(")"))
    if program is None or before is None or other is None:
        return
    arguments = (before[2], int(before[3]) if before[3] else before[4])
    for number, step in enumerate(program.steps):
        if step.operation == before[1].lower() and step.arguments == arguments:
            steps = (*program.steps[:number], replace(step, operation=other[1].lower()), *program.steps[number + 1 :])
            yield replace(program, steps=steps)
