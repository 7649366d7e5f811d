"""Weakened constants and comparisons that Coq must refuse: each makes a statement false, or takes a proof's reserve.

A proof that went through in spite of one would prove less than it says. Every change is made in a copy of the
compiled proofs, and Coq is asked about the changed file alone.
"""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from hypcheck.proofs.build import BUILT, refusal, source


@dataclass(frozen=True, slots=True)
class Weakened:
    """A change of one place of a file: what stands there, what is put in its place, and what that would allow."""

    file: str
    old: str
    new: str
    allows: str


WEAKENED = (
    Weakened("Checker", "less 0 l && less l B && less 0 (", "less 0 l && less 0 (", "a λ beyond the pole B"),
    Weakened("Checker", "less l B && less 0 (q_g", "less l B && Qle_bool 0 (q_g", "exterior at a tangency"),
    Weakened("Checker", "less (- A) l && less l 0 &&", "less l 0 &&", "a λ below the pole −A"),
    Weakened("Checker", "less (- A) l && less l 0", "less (- A) l && less l B", "interior by a positive λ"),
    Weakened("Checker", "\n  && negb (Qeq_bool m B && less (- q_c2 A B P Q - 2 * m) B)", "", "the ring as a tangency"),
    Weakened("Checker", " && Qeq_bool (q_slope A B P Q m) 0", "", "a simple root as a tangency"),
    Weakened("Checker", "Qle_bool m B\n", "Qle_bool m (2 * B)\n", "a double root above B as a tangency"),
    Weakened("Checker", "Qle_bool (- A) m", "Qle_bool (- (2 * A)) m", "a double root below −A as a tangency"),
    Weakened(
        "Checker",
        "Qle_bool (q_depth r X) 0) points\n  && ex",
        "Qle_bool (q_depth r X) 1) points\n  && ex",
        "points outside",
    ),
    Weakened("Checker", "Qle_bool 0 (q_height r X)", "Qle_bool (- (1)) (q_height r X)", "two points on one side"),
    Weakened("Checker", "- B * Q * (A + l).", "- Q * (A + l).", "a wrong constant in g"),
    Weakened("Checker", "(q_x r * q_x r + q_y r * q_y r) /", "(q_x r * q_x r) /", "a P without y"),
    Weakened(
        "UnitBall",
        "tangent_by_double_root m : m <> 0 -> - A <=",
        "tangent_by_double_root m : m <> 0 -> - 2 * A <=",
        "a tangency below −A",
    ),
    Weakened("Geometry", "- pz X ^ 2 / gamma p ^ 2", "+ pz X ^ 2 / gamma p ^ 2", "an ellipsoid for the hyperboloid"),
    Weakened("Completeness", "0 < Q2R q < B /\\", "0 < Q2R q < B / 2 /\\", "a multiplier in half the interval always"),
    Weakened("Cubic", "- (27 * (k low * k high))", "- (26 * (k low * k high))", "a wrong constant in the discriminant"),
    Weakened(
        "Rule",
        "~ (a2 < - 3 * B /\\ 0 < slope A B P Q B)) \\/ ring",
        "~ (a2 < - 2 * B /\\ 0 < slope A B P Q B)) \\/ ring",
        "2B for 3B",
    ),
    Weakened(
        "Rule",
        "a2 < 3 * A /\\ 0 < slope A B P Q (- A).\nProof.\n  destruct",
        "a2 < 20 * A /\\ 0 < slope A B P Q (- A).\nProof.\n  destruct",
        "20A for 3A",
    ),
    Weakened(
        "Rule",
        "proposition_3_repaired : A <= B ^ 2",
        "proposition_3_repaired : A <= 2 * B ^ 2",
        "Proposition 3 beyond its regime",
    ),
    Weakened(
        "Rule",
        "proposition_5_repaired : 1 <= A",
        "proposition_5_repaired : 1 <= 2 * A",
        "Proposition 5 beyond its regime",
    ),
    Weakened(
        "Rule",
        "slope A B P Q B = 0 /\\ A < B ^ 2.\n\nLet",
        "slope A B P Q B = 0 /\\ A <= B ^ 2.\n\nLet",
        "osculation as the ring",
    ),
    Weakened(
        "RootPatterns",
        '    ("exterior-ring", ClearOutside,',
        '    ("exterior-ring", TouchesOutside,',
        "the ring as a tangency",
    ),
    Weakened(
        "RootPatterns",
        '    ("interior-tangent-circle", TouchesInside, [(AtMinusA, 2); (AtB, 1)]);\n',
        "",
        "a table without a row",
    ),
    Weakened(
        "Rounding", "S (max (count entry a) (count entry b))", "max (count entry a) (count entry b)", "exact sums"
    ),
    Weakened(
        "Rounding",
        "| Mul a b | Div a b => S (count entry a + count entry b) end%nat",
        "| Mul a b | Div a b => S (max (count entry a) (count entry b)) end%nat",
        "lost roundings",
    ),
    Weakened("Floats", "Definition unit_to_nearest := / 2 *", "Definition unit_to_nearest := / 4 *", "half the unit"),
    Weakened("Kernel", "<= 8 * u * M0", "<= 4 * u * M0", "half of what c0 needs"),
    Weakened("RunningBound", "4 * unit * slack; 8 *", "unit * slack; 8 *", "a quarter of what h1, h2, h3 need"),
    Weakened("Region", "  division_free e && less", "  less", "a division by what may be 0"),
)
"""Each must be refused."""

CONTROL = Weakened("Checker", "Definition less", "Definition less", "nothing")
"""No change at all: this must be accepted, or the refusals would mean nothing."""


def accepted(change: Weakened) -> bool:
    """Whether Coq accepts the changed file, which it must not. Raises ValueError where the change does not fit."""
    text = source(change.file)
    if text.count(change.old) != 1:
        raise ValueError(f"{change.file}.v has {text.count(change.old)} places with {change.old!r}; one is needed")
    with TemporaryDirectory(prefix="hypcheck-proofs-") as folder:
        for compiled in BUILT.glob("*.vo"):
            if compiled.stem != change.file:
                shutil.copy(compiled, folder)
        (Path(folder) / f"{change.file}.v").write_text(text.replace(change.old, change.new), encoding="utf-8")
        message = refusal(Path(folder), change.file)
    if "Syntax error" in message:
        raise ValueError(f"the change of {change.file}.v is no Coq: {message}")
    return not message
