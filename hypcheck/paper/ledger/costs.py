"""The ledger's lines about cost: what can be counted is counted from the programs, the rest is not judged."""

from __future__ import annotations

from hypcheck.derivation.costs import Cost, cost_of, discriminant_share, loop_as_printed
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.derivation.root_formulas import ROOTS_TRIGONOMETRIC
from hypcheck.paper.ledger.entry import FALSE, NOT_CHECKABLE, PROVED, Entry, Evidence, by_programs


def costs() -> tuple[Entry, ...]:
    """The claims of sections 3.1 to 5 about operations, and those about time."""
    return (
        _only_sums_and_products(),
        _taken_out(),
        _trigonometric(),
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


def _trigonometric() -> Entry:
    roots, table_2 = cost_of(ROOTS_TRIGONOMETRIC), cost_of(FORMULAS["table-2"])
    return Entry(
        "Section 3.1, roots",
        "3.1",
        "the roots' way evaluates trigonometric functions when Δ > 0, the coefficients' way none",
        PROVED,
        f"by cosines {roots.query.functions} functions and {roots.query.rounded} operations a query, Table 2 none and "
        f"{table_2.query.rounded}",
        "signs of coefficients do without roots; so does g at its local maximum, with one square root",
        lambda: (
            Evidence(
                "count",
                f"{roots.query.functions} functions against {table_2.query.functions}",
                roots.query.functions > table_2.query.functions == 0,
            ),
            by_programs(ROOTS_TRIGONOMETRIC),
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
        f"{share} of the {whole} rounded operations of Procedure 2.a for a position are those of its four Δ(g_i)",
        "a fixed λ decides most first, for a product and a comparison (docs/mathematics.md, “A line is a proof”)",
        lambda: (Evidence("count", f"{share} of {whole}", 2 * share > whole),),
    )


def _by_the_clock() -> tuple[Entry, ...]:
    return (
        Entry(
            "Abstract; 3.1, speed",
            "3.1",
            "the computational cost is very low; real-time calculation",
            NOT_CHECKABLE,
            "a matter of time on a machine, not of proof",
            "`hypcheck bench` measures it beside the roots' way, FCL and bounding volumes",
        ),
        Entry(
            "Section 3.1, other methods",
            "3.1",
            "the methods of [3]–[7] cannot be used between two quadrics of these kinds",
            NOT_CHECKABLE,
            "their texts were not consulted",
            "meshes with FCL's distance do answer the question to a bound (docs/mesh-oracle.md)",
        ),
        Entry(
            "Section 5",
            "5",
            "less computational complexity by more adequate bounding volumes",
            NOT_CHECKABLE,
            "it depends on the scene and on what the volumes bound",
            "`hypcheck bench` counts the false contacts of spheres and cylinders in given scenes",
        ),
    )
