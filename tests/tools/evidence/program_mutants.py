"""Mutants of the constants and rules that proofs need: a test of the derivation tells each, with no row of any kind.

A mutant is a text of a module and what is put in its place. A process of its own imports the changed module and runs
the tests that ought to tell. Where nothing is changed the same tests must pass, or they would tell anything.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import astuple, dataclass, replace

from tests.tools.evidence.parts import ROOT, Figures

TITLE = "Mutants of the kernel's constants"

CERTIFIED, LINES, INTEGERS, LEANING = (
    f"hypcheck/kernel/programs/{name}.py" for name in ("certified", "lines", "integers", "tilted")
)
PROGRAMS, GUARDS, CONSTANTS, PRINTED = (
    f"tests/kernel/test_{name}.py" for name in ("programs", "guards", "constants", "header")
)
RULE = "decides_by_the_exact_rule"


@dataclass(frozen=True)
class Change:
    """`before` becomes `after` in the module `path`; tests of `tests` with one of `words` in the name ought to tell."""

    path: str
    before: str
    after: str
    tests: str
    words: str


CHANGES = (
    Change(
        CERTIFIED,
        '{"u_8": 8 * U * SLACK, "u_12": 12 *',
        '{"u_8": 8 * U * SLACK, "u_12": 6 *',
        PRINTED,
        "printed_module",
    ),
    Change(
        CERTIFIED,
        '{"u_8": 8 * U * SLACK, "u_12"',
        '{"u_8": 7 * U * SLACK, "u_12"',
        PRINTED,
        "printed_module",
    ),
    Change(CERTIFIED, '"u_1536": 48 * 32', '"u_1536": 42 * 32', CONSTANTS, "derivation"),
    Change(CERTIFIED, '    "u_12": 12 *', '    "u_12": 10 *', CONSTANTS, "derivation"),
    Change(CERTIFIED, '    "u_8": 8 *', '    "u_8": 7 *', CONSTANTS, "derivation"),
    Change(CERTIFIED, '    "u_16": 16 *', '    "u_16": 8 *', CONSTANTS, "derivation"),
    Change(CERTIFIED, '    "u_4": 4 *', '    "u_4": 2 *', CONSTANTS, "derivation"),
    Change(CERTIFIED, "SLACK = 1 + 2.0**-20", "SLACK = 1 + 2.0**-50", PROGRAMS, "slack"),
    Change(CERTIFIED, '"farthest": 2.0**200', '"farthest": 2.0**230', GUARDS, "overflows"),
    Change(CERTIFIED, '"least": 2.0**-100', '"least": 2.0**-300', GUARDS, "underflow_in"),
    Change(CERTIFIED, '"greatest": 2.0**100', '"greatest": 2.0**170', GUARDS, "overflows or underflow_in"),
    Change(CERTIFIED, "inflection_beyond_B and rises_B", "inflection_beyond_B or rises_B", GUARDS, RULE),
    Change(CERTIFIED, "inflection_inside_B or falls_B", "inflection_inside_B and falls_B", GUARDS, RULE),
    Change(CERTIFIED, "inflection_inside_A and rises_A", "inflection_inside_A or rises_A", GUARDS, RULE),
    Change(CERTIFIED, "inflection_beyond_A or falls_A", "inflection_beyond_A and falls_A", GUARDS, RULE),
    Change(
        CERTIFIED, "three_roots = distinct and usable", "three_roots = distinct or usable", GUARDS, "rule or limits"
    ),
    Change(CERTIFIED, "crossing = one_root and usable", "crossing = one_root or usable", GUARDS, RULE),
    Change(CERTIFIED, "not_too_far = P_plus_Q < farthest", "not_too_far = P_plus_Q <= farthest", GUARDS, "limits"),
    Change(LINES, "CAP = 2.0**400\n", "CAP = 2.0**1000\n", GUARDS, "overflows"),
    Change(LINES, "LEAST_CONSTANT = 2.0**-300", "LEAST_CONSTANT = 2.0**-1020", GUARDS, "overflows"),
    Change(LINES, "\nGREATEST_SLOPE = 2.0**400", "\nGREATEST_SLOPE = 2.0**700", GUARDS, "overflows"),
    Change(LINES, "\nMARGIN = 16 * U", "\nMARGIN = 4 * U", PROGRAMS, "margins"),
    Change(LINES, "MORE, LESS = 1 + 2 * MARGIN", "MORE, LESS = 1 + MARGIN / 2", PROGRAMS, "margins"),
    Change(
        LINES, "LESS = 1 + 2 * MARGIN, 1 - 2 * MARGIN", "LESS = 1 + 2 * MARGIN, 1 - MARGIN / 2", PROGRAMS, "margins"
    ),
    Change(LINES, "below = below_0 and below_1", "below = below_0 or below_1", GUARDS, "chord"),
    Change(LINES, "above = above_0 and above_1", "above = above_0 or above_1", GUARDS, "chord"),
    Change(LINES, "FLOAT32_TINY = 2.0**-80", "FLOAT32_TINY = 0.0", GUARDS, "tiny"),
    Change(LINES, "FLOAT32_MARGIN = 16 *", "FLOAT32_MARGIN = 8 *", PROGRAMS, "single_precision"),
    Change(LINES, "FLOAT32_GREATEST_SLOPE = 2.0**40", "FLOAT32_GREATEST_SLOPE = 2.0**60", GUARDS, "tiny"),
    Change(
        CERTIFIED, "    sizes_2 = A_plus_B + 1\n    M2 =", "    sizes_2 = A_plus_B + 0\n    M2 =", PROGRAMS, "terms"
    ),
    Change(
        CERTIFIED,
        "    BP_plus_AQ = BP + AQ\n    sizes_1 =",
        "    BP_plus_AQ = BP + A\n    sizes_1 =",
        PROGRAMS,
        "terms",
    ),
    Change(LEANING, '"u_p_l": 8 *', '"u_p_l": 4 *', CONSTANTS, "derivation"),
    Change(LEANING, '"u_k": 28 *', '"u_k": 23 *', CONSTANTS, "derivation"),
    Change(LEANING, '"u_d_l": 36 *', '"u_d_l": 30 *', CONSTANTS, "derivation"),
    Change(LEANING, '"u_F": 40 *', '"u_F": 35 *', CONSTANTS, "derivation"),
    Change(LEANING, '"u_psi": 72 *', '"u_psi": 67 *', CONSTANTS, "derivation"),
    Change(LEANING, "phi_positive and inside", "phi_positive and between_poles", GUARDS, "rule or limits"),
    Change(LEANING, "before_B_and_A2 and before_A1", "before_B_and_A2 or before_A1", GUARDS, "by_its_rule"),
    Change(LEANING, "below_tangent and phi_negative", "below_tangent or phi_negative", GUARDS, "by_its_rule"),
    Change(INTEGERS, "FLOAT64_BITS = 2098", "FLOAT64_BITS = 2046", GUARDS, "longest"),
)
"""The constants and rules of the programs, those that no row shows among them."""

_RUN = """
import hypothesis.strategies, importlib.machinery, json, os, pathlib, pytest, sys, sympy, tempfile
import hypcheck.derivation.formulas, hypcheck.derivation.proofs, hypcheck.derivation.rounding
assert not any(name.startswith("hypcheck.kernel") for name in sys.modules)

def run(path, before, after, tests, words):
    get = importlib.machinery.SourceFileLoader.get_code
    def changed(self, name):
        if not self.path.endswith(path):
            return get(self, name)
        with open(self.path, encoding="utf-8") as file:
            text = file.read()
        if text.count(before) != 1:
            os._exit(9)
        return compile(text.replace(before, after), self.path, "exec")
    importlib.machinery.SourceFileLoader.get_code = changed
    if tests.endswith("test_constants.py"):
        with_header_of_its_own()
    return pytest.main(["-q", "-x", "-p", "no:cacheprovider", "--assert=plain", tests, "-k", words])

def with_header_of_its_own():
    "The header is printed from the changed programs; the derivations are asked about its constants."
    from tests.kernel import compiling
    from tests.support.inside import header
    compiling.HEADER = pathlib.Path(tempfile.mkdtemp()) / "hypcheck.h"
    compiling.HEADER.write_text(header(), encoding="utf-8")

for change in json.load(sys.stdin):
    child = os.fork()
    if child == 0:
        code = 9
        try:
            code = int(run(*change))
        finally:
            os._exit(code)
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    print(f"\\nended: {code}", flush=True)
"""
"""One process imports what does not change; a child of it for each change imports the rest."""


def measure() -> Figures:
    """Runs the tests against every change. Raises AssertionError where tests are missing, or fail without a change."""
    codes, unchanged = _codes(CHANGES), _codes([replace(each, after=each.before) for each in CHANGES])
    if not set(codes) <= {0, 1} or set(unchanged) != {0}:
        raise AssertionError(f"{list(zip(CHANGES, codes, unchanged, strict=True))}")
    living = [f"{each.before} → {each.after}" for each, code in zip(CHANGES, codes, strict=True) if code == 0]
    return {"mutants": len(CHANGES), "told": len(CHANGES) - len(living), "lives": len(living), "living": living}


def _codes(changes: Sequence[Change]) -> list[int]:
    """How the tests of each change end: 1 where one fails. Raises AssertionError if their process is lost."""
    command, given = [sys.executable, "-c", _RUN], [[*astuple(each)] for each in changes]
    done = subprocess.run(command, cwd=ROOT, input=json.dumps(given), capture_output=True, text=True, check=False)
    codes = [int(code) for code in re.findall(r"^ended: (-?\d+)$", done.stdout, re.MULTILINE)]
    if len(codes) != len(changes):
        raise AssertionError(done.stderr[-2000:])
    return codes


def section(figures: Figures) -> str:
    """What was changed, and what no test told."""
    living = "".join(f"- `{each}`\n" for each in figures["living"]) or "None survives.\n"
    return f"""\
A bound is larger than any error in practice, so a smaller constant may still give a right answer for every tested row.
Such constants are tested by their derivation: a test counts the roundings of the program and compares the constant with
the count. {figures["mutants"]} constants and rules of `hypcheck/kernel/programs/` are changed one at a time. The tests
of `tests/kernel/` detect {figures["told"]}. {living}"""
