"""The ledger's lines about cost: what can be counted is counted from the programs, the rest is not judged."""

from __future__ import annotations

from hypcheck.derivation.costs import Cost, cost_of, discriminant_share, loop_as_printed
from hypcheck.derivation.costs import costs as counted
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.derivation.root_formulas import ROOTS_TRIGONOMETRIC
from hypcheck.paper.ledger.entry import FALSE, NOT_CHECKABLE, PROVED, Entry, Evidence, by_programs


def costs() -> tuple[Entry, ...]:
    """The claims of sections 3.1 to 5 about operations, and those about time."""
    return (
        _only_sums_and_products(),
        _taken_out(),
        *_trigonometric(),
        _no_angle(),
        _discriminant(),
        *_by_the_clock(),
    )


def _only_sums_and_products() -> Entry:
    cost = cost_of(FORMULAS["table-2"])
    count = cost.query.divisions
    return Entry(
        "Section 3.1, operations",
        "3.1",
        "Table 2: only additions and products are performed",
        FALSE,
        f"each position takes {count} divisions, P ← …/b² and Q ← (z0/d)², and each scene {cost.scene.divisions}",
        "keep 1/b² and 1/d outside the loop: then it is true, and a division's latency is gone from every query",
        lambda: (
            Evidence(
                "count",
                f"{count} divisions a query, {cost.by_fixed} of them by a number that the sizes fix",
                count > 0 and cost.by_fixed == count,
            ),
        ),
        "only additions and products are performed in the loop, once 1/b² and 1/d are taken out of it",
        harmless="in exact arithmetic: the divisors b² and d do not change, and the answers are the same",
    )


def _taken_out() -> Entry:
    printed, cost = loop_as_printed(), cost_of(FORMULAS["table-2"])
    left = printed.rounded - cost.query.rounded
    return Entry(
        "Section 3.1, loop",
        "3.1",
        "terms independent of the position are computed once",
        PROVED,
        f"A, B, c0 and C leave the loop, which keeps {printed.rounded} operations; {left} more could leave it",
        f"take b², A − B + 1 and 27·c0² out as well: {cost.query.rounded} operations a query",
        lambda: (
            Evidence(
                "count", f"{cost.scene.rounded} operations depend on the sizes alone", 0 < left < cost.scene.rounded
            ),
        ),
    )


def _trigonometric() -> tuple[Entry, ...]:
    cosines, table_2 = cost_of(ROOTS_TRIGONOMETRIC), cost_of(FORMULAS["table-2"])
    (sweep,) = (cost for cost in counted() if cost.name == "roots-sweep")
    return (
        Entry(
            "Section 3.1, [13]",
            "3.1",
            "the proposal of [13] decides by the roots of the polynomial and evaluates trigonometric functions",
            NOT_CHECKABLE,
            "the text of [13] was not read",
            "a program that takes the three roots by cosines stands in for it here: `roots-trigonometric`",
        ),
        Entry(
            "Section 3.1, roots",
            "3.1",
            "to decide by the roots implies to evaluate trigonometric functions when Δ > 0",
            FALSE,
            f"by cosines it takes {cosines.query.functions} functions and {cosines.query.rounded} operations "
            "a position, "
            f"Table 2 takes none and {table_2.query.rounded}; but `roots-sweep` finds all three roots by + − × ÷ alone",
            "signs of coefficients need no roots; the sign of g at its local maximum takes one square root",
            lambda: (
                Evidence(
                    "count",
                    f"{sweep.query.functions} functions in a sweep that finds roots, "
                    f"{cosines.query.functions} by cosines",
                    sweep.query.functions == 0 < cosines.query.functions,
                ),
                by_programs(ROOTS_TRIGONOMETRIC),
            ),
            "the closed form of three real roots takes cosines; Table 2 takes none",
            harmless="for the conclusion: Table 2 takes no trigonometric function, and fewer operations",
        ),
        Entry(
            "Section 3.1, cost of roots",
            "3.1",
            "the coefficients alone cost less than the roots by trigonometric functions",
            PROVED,
            f"{table_2.query.rounded} rounded operations a position against {cosines.query.rounded} and, among these, "
            f"{cosines.query.functions} functions; `hypcheck bench` measured the same: {BENCH['roots']}",
            "prefer the coefficients, or g at its local maximum",
            lambda: (
                Evidence(
                    "count",
                    f"{table_2.query.rounded} < {cosines.query.rounded}",
                    table_2.query.rounded < cosines.query.rounded and table_2.query.functions == 0,
                ),
            ),
        ),
    )


def _no_angle() -> Entry:
    program = FORMULAS["procedure-2a"].program
    angles = [name for name in program.inputs if name in {"cosine", "sine"}]
    return Entry(
        "Section 3.2, angles",
        "3.2",
        "c0, c1(g_i), c2(g_i) need no angle g_i of each rotor",
        PROVED,
        "the other three rotors have T1 and T2 of the first, exchanged and with other signs",
        "one cosine and one sine for all four rotors",
        lambda: (
            by_programs(FORMULAS["procedure-2a"]),
            Evidence(
                "count",
                f"{len(angles)} inputs tell the direction of four rotors, and no step takes a cosine",
                len(angles) == 2 and _total(cost_of(FORMULAS["procedure-2a"]), "functions") == 0,
            ),
        ),
    )


def _total(cost: Cost, name: str) -> int:
    return int(getattr(cost.scene, name) + getattr(cost.query, name))


def _discriminant() -> Entry:
    share, whole = discriminant_share()
    return Entry(
        "Section 4, cost",
        "4",
        "Δ(g_i) costs much in comparison to other operations",
        PROVED,
        f"a count against a threshold of ours, one half: {share} of the {whole} rounded operations of "
        "Procedure 2.a for a "
        f"position are those of its four Δ(g_i). Whether Procedure 2.b is cheaper for it: {BENCH['hull first']}",
        "a fixed λ decides most first, for a product and a comparison (docs/mathematics.md, “A line is a proof”)",
        lambda: (Evidence("count", f"{share} of {whole} is more than half", 2 * share > whole),),
    )


BENCH = {
    "operations": "does not hold in numpy, and does not hold in C",
    "roots": "holds in numpy, and holds in C",
    "hull first": "does not hold in numpy, 8,192 positions at a time, and holds in C, one position a call",
    "spheres": "22 % of a sphere's answers are false contacts uniformly around the tower, 26 % along flights",
    "cylinders": "1 % of a cylinder's are, and 2 % along flights",
}
"""What the reference run of `hypcheck bench` says (reports/reference/bench); a test holds it against that report."""


def _by_the_clock() -> tuple[Entry, ...]:
    return (
        Entry(
            "Section 1, spheres",
            "1",
            "a bounding sphere has faster tests, less memory and more false positives",
            NOT_CHECKABLE,
            f"[8, 9] were not read, and time is no matter of proof; `hypcheck bench` counts: {BENCH['spheres']}",
            "a sphere of radius max(b, d) has 2 numbers fewer; a spheroid costs 28 operations a position by Table 2",
        ),
        Entry(
            "Abstract; 3.1, speed",
            "3.1",
            "the computational cost is very low; real-time calculation",
            NOT_CHECKABLE,
            "a matter of time on a machine, not of proof; “very low since only additions and products are performed” "
            f"{BENCH['operations']}: the loop divides, and is faster without (`hypcheck bench`)",
            "`hypcheck bench` measures it beside the roots' way, FCL and bounding volumes",
        ),
        Entry(
            "Section 3.1, other methods",
            "3.1",
            "the methods of [3]–[7] cannot be used, since the objects are modelled by quadric surfaces",
            NOT_CHECKABLE,
            "their texts were not read; section 1 says of the same methods that they “use quadric bounding surfaces”",
            "meshes with FCL's distance do answer the question to a bound (docs/mesh-oracle.md)",
        ),
        Entry(
            "Section 5",
            "5",
            "less computational complexity by more adequate bounding volumes",
            NOT_CHECKABLE,
            f"it depends on the scene and on what the volumes bound; `hypcheck bench` counts: {BENCH['spheres']}; "
            f"{BENCH['cylinders']}",
            "count the false contacts of spheres and cylinders in your scene",
        ),
    )
