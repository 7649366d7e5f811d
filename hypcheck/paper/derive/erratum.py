"""An erratum to the paper, in LaTeX: formulas, propositions and procedures put right, each with a short proof.

erratum.tex is the note, with names in angle brackets for what is computed elsewhere: corrected formulas from the
derivation, the smallest counterexamples from the search, the figures of Table 5 from the ledger. The proofs are those
of docs/mathematics.md, shortened.
"""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from importlib import resources
from pathlib import Path

from hypcheck.paper.derive.latex import formula, sentence
from hypcheck.paper.derive.selection import Selection
from hypcheck.paper.ledger.book import entries
from hypcheck.paper.ledger.entry import LedgerEntry
from hypcheck.paper.ledger.points import PointFacts
from hypcheck.paper.tower import PRINTED
from hypcheck.tables.streams import writing
from hypcheck.version import VERSION

COMPILER = "pdflatex"


def lines(_: Selection) -> Iterator[str]:
    """The whole note, whatever was chosen: an erratum is one."""
    ledger = {entry.number: entry for entry in entries()}
    text = resources.files("hypcheck.paper.derive").joinpath("erratum.tex").read_text(encoding="utf-8")
    for name, value in _values(ledger).items():
        text = text.replace(f"<{name}>", value)
    yield from text.splitlines()


def _values(ledger: dict[str, LedgerEntry]) -> dict[str, str]:
    """What the note leaves to the ledger, by the names in it."""
    ring, beyond = _witnesses(ledger["Proposition 3.1"])[0], _witnesses(ledger["Proposition 5.2"])[0]
    without_c2, without_c1 = _witnesses(ledger["Proposition 5.1"])
    rotor = _witnesses(ledger["Table 3"])[0]
    hull, low = _witnesses(ledger["Table 4"])[0], _witnesses(ledger["Table 4, caption"])[0]
    return {
        "version": VERSION,
        "equation 11": formula(ledger["(11)"].correction),
        "equation 12": formula(_lambda_cubic(ledger["(12)"].correction)),
        "equation A2": formula(ledger["A.2b"].correction),
        "misled": _pair(_witnesses(ledger["(12)"])[0]),
        "ring": _pair(ring),
        "ring beyond": _pair(beyond),
        "zero c2": _pair(without_c2),
        "zero c1": _pair(without_c1),
        "rotor": _pair(rotor),
        "hull": _pair(hull),
        "low hull": _pair(low),
        "equal steps": sentence(ledger["Table 5, equal steps"].why),
        "second row": ", ".join(f"{figure:.4f}" for figure in PRINTED[1]),
        "t is": sentence(ledger["Table 5, t = 0.1"].why),
    }


def _witnesses(entry: LedgerEntry) -> list[PointFacts]:
    return [witness.facts for evidence in entry.evidence for witness in evidence.witnesses]


def _lambda_cubic(text: str) -> str:
    """(12) with its terms from the highest power of λ down, in two displays' worth of one line."""
    name, _, rest = text.partition(" = ")
    constant, _, others = rest.partition(" + ")
    return f"{name} = {others} {constant.replace('−', '− ', 1)}"


def _pair(facts: PointFacts) -> str:
    """A pair and its numbers, "a = 1, c = 2, centre (5/2, 0, 0): exterior, Δ = 0, …", as LaTeX."""
    point = facts.point
    numbers = rf"\Delta={facts.delta},\ c_2={facts.c2},\ c_1={facts.c1}"
    return rf"$a={point.a}$, $c={point.c}$, centre $({point.r},0,{point.z})$: {facts.position.label}, ${numbers}$"


def compile_note(path: Path) -> str:
    """Make the PDF beside the LaTeX file; what was done, or why nothing was, in a sentence.

    LaTeX runs in a folder of its own, so nothing but the PDF is left.
    """
    if shutil.which(COMPILER) is None:
        return f"not compiled: there is no {COMPILER} on this machine"
    with tempfile.TemporaryDirectory() as folder:
        command = [COMPILER, "-interaction=nonstopmode", "-halt-on-error", "-no-shell-escape", "note.tex"]
        shutil.copyfile(path, Path(folder, "note.tex"))
        try:
            done = subprocess.run(command, cwd=folder, capture_output=True, check=False, timeout=120)  # noqa: S603
        except subprocess.TimeoutExpired:
            return f"not compiled: {COMPILER} took longer than 120 s"
        if done.returncode:
            return f"not compiled: {COMPILER} ended with {done.returncode}; run it on {path} to see why"
        target = path.with_suffix(".pdf")
        with writing(str(target)) as file:
            file.write(Path(folder, "note.pdf").read_bytes())
    return f"wrote {target}"
