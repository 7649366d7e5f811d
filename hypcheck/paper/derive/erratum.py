"""An erratum to the paper, in LaTeX: misprints, and corrected propositions and procedures, with short proofs.

erratum.tex is the note; a mark <<name>> in it is replaced by a computed value: the simplest counterexamples from the
ledger's search, the figures of Table 5. The proofs are those of docs/mathematics.md, shortened.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from importlib import resources
from pathlib import Path

from hypcheck.geometry.pair import Position
from hypcheck.paper.derive.content import Selection
from hypcheck.paper.ledger import statements
from hypcheck.paper.ledger.book import entries
from hypcheck.paper.ledger.checks import by_12
from hypcheck.paper.ledger.counts import figures
from hypcheck.paper.ledger.entry import LedgerEntry
from hypcheck.paper.ledger.points import PointFacts, PointWitness, TiltedWitness
from hypcheck.paper.tower import PRINTED
from hypcheck.tables.streams import replace_output
from hypcheck.version import VERSION

COMPILER = "pdflatex"

_PLACE = re.compile(r"<<([a-z0-9-]+)>>")


def lines(_: Selection) -> Iterator[str]:
    """Yield the whole note; the selection does not matter, because an erratum has no parts."""
    text = resources.files("hypcheck.paper.derive").joinpath("erratum.tex").read_text(encoding="utf-8")
    values = _values({entry.number: entry for entry in entries()})
    yield from filled(text, values).splitlines()


def filled(text: str, values: Mapping[str, str]) -> str:
    """Return the text with a value for each name in it. Raises KeyError for a name without one."""
    return _PLACE.sub(lambda match: values[match[1]], text)


def _values(ledger: dict[str, LedgerEntry]) -> dict[str, str]:
    """Return the values from the ledger, by their names in the note."""
    return {
        "version": VERSION,
        **_counterexamples(ledger),
        **_quadcopters(ledger),
        **_tilted(ledger["Section 3.2, pitch"]),
        **_steps(),
        "delta-axis": _times_a_power(figures()["delta_on_the_axis"]),
        "delta-wall": _times_a_power(figures()["delta_near_the_wall"]),
    }


def _counterexamples(ledger: dict[str, LedgerEntry]) -> dict[str, str]:
    """Return the numbers of the counterexamples, as TeX, by the name of their place in the erratum.

    They are those of the ledger's witnesses.
    """
    exterior, interior = (witness.facts for witness in _witnesses(ledger["(12)"]))
    ring, beyond = _witnesses(ledger["Proposition 3.1"])[0].facts, _witnesses(ledger["Proposition 5.2"])[0].facts
    without_c2, without_c1 = (witness.facts for witness in _witnesses(ledger["Proposition 5.1"]))
    signs = _witnesses(ledger["Proposition 3, proof: signs"])[0].facts
    return {
        **_named("exterior-by-12", exterior, by_12(exterior)),
        **_named("interior-by-12", interior, by_12(interior)),
        **_named("ring", ring),
        "ring-clearance": f"${ring.point.r - ring.point.a - 1}$",
        **_named("ring-beyond", beyond),
        **_named("signs", signs),
        **_named("zero-c2", without_c2),
        **_named("zero-c1", without_c1),
    }


def _quadcopters(ledger: dict[str, LedgerEntry]) -> dict[str, str]:
    rotor = _witnesses(ledger["Table 3"])[0].facts
    hull, low = _witnesses(ledger["Table 4"])[0].facts, _witnesses(ledger["Table 4, caption"])[0].facts
    crossing = _witnesses(ledger["Table 4, purpose"])[0]
    return {
        **_named("rotor", rotor),
        "rotor-arm": f"${rotor.point.r}$",
        **_named("hull", hull),
        **_named("low-hull", low),
        **_sizes("low", statements.refused_though_inside(low)),
        **_named("crossing", crossing.facts),
        **_sizes("crossing", statements.cleared_by_its_rotors(crossing.facts)),
        "crossing-part": _point(statements.part_beyond_the_wall(crossing)),
    }


def _witnesses(entry: LedgerEntry) -> list[PointWitness]:
    """Return all witnesses in the evidence of an entry."""
    return [witness for evidence in entry.evidence for witness in evidence.witnesses]


def _named(name: str, facts: PointFacts, shown: PointFacts | None = None) -> dict[str, str]:
    """Return a pair and the numbers of its cubic, each as a separate formula, by names that begin with `name`.

    With `shown` the numbers are those of another cubic.
    """
    point, cubic = facts.point, shown or facts
    numbers = ((r"\Delta", cubic.delta), ("c_2", cubic.c2), ("c_1", cubic.c1))
    first, second, third = (f"${letter}={number}$" for letter, number in numbers)
    pair = f"$a={point.a}$, $c={point.c}$, centre {_point((point.r, Fraction(0), point.z))}"
    return {name: pair, f"{name}-numbers": f"{first}, {second} and {third}"}


def _sizes(name: str, quadcopter: statements.Quadcopter | None) -> dict[str, str]:
    if quadcopter is None:
        raise ValueError(f"{name}: the ledger's witness has no quadcopter")
    return {f"{name}-size": f"${quadcopter.size}$", f"{name}-arm": f"${quadcopter.arm}$"}


def _point(coordinates: Iterable[Fraction | float]) -> str:
    return f"$({','.join(map(str, coordinates))})$"


def _tilted(entry: LedgerEntry) -> dict[str, str]:
    """Return the pair that is clear upright and in contact tilted."""
    witnesses = [witness for evidence in entry.evidence for witness in evidence.tilted]
    (dangerous,) = (witness for witness in witnesses if witness.certificate.position is Position.CONTACT)
    return _words_of(dangerous)


def _words_of(witness: TiltedWitness) -> dict[str, str]:
    alpha, gamma, b, d, *rest = (f"{number:g}" for number in witness.pair.row)
    return {
        "tilted-sizes": rf"$\alpha={alpha}$, $\gamma={gamma}$, $b={b}$, $d={d}$",
        "tilted-centre": f"$({','.join(rest[:3])})$",
        "tilted-axis": f"$({','.join(rest[3:])})$",
        "tilted-upright": witness.vertical.position.label,
        "tilted-position": witness.certificate.position.label,
    }


def _steps() -> dict[str, str]:
    """Printed figures at equal v·t; the rows are for t = 0.1, 0.2 and 0.3, the columns for v = 5, …, 10."""

    def both(one: tuple[int, int], other: tuple[int, int]) -> str:
        (first, at), (second, there) = one, other
        return rf"{PRINTED[first][at]:.4f}\,\% and {PRINTED[second][there]:.4f}\,\%"

    return {"steps-1": both((0, 5), (1, 0)), "steps-2": both((2, 1), (1, 4)), "steps-3": both((2, 0), (1, 1))}


def _times_a_power(units: str) -> str:
    """Return three digits, a number of units of 10¹⁸, as LaTeX: "158" becomes 1.58·10²⁰."""
    return rf"{int(units) / 100:.2f}\cdot10^{{20}}"


def compile_note(path: Path, seconds: float = 120) -> str:
    """Make the PDF beside the LaTeX file; returns a sentence about the result, or the reason why there is none.

    LaTeX runs in a temporary folder, so only the PDF is left.
    """
    if shutil.which(COMPILER) is None:
        return f"not compiled: there is no {COMPILER} on this machine"
    with tempfile.TemporaryDirectory() as folder:
        command = [COMPILER, "-interaction=nonstopmode", "-halt-on-error", "-no-shell-escape", "note.tex"]
        shutil.copyfile(path, Path(folder, "note.tex"))
        try:
            result = subprocess.run(command, cwd=folder, capture_output=True, check=False, timeout=seconds)  # noqa: S603
        except subprocess.TimeoutExpired:
            return f"not compiled: {COMPILER} took longer than {seconds:g} s"
        if result.returncode:
            return f"not compiled: {COMPILER} ended with {result.returncode}; run it on {path} to see why"
        target = path.with_suffix(".pdf")
        with replace_output(str(target)) as file:
            file.write(Path(folder, "note.pdf").read_bytes())
    return f"wrote {target}"
