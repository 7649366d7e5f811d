"""The whole ledger in order, and every sentence of the paper with the entries that judge it.

A sentence is named by its section and its first words. A displayed formula belongs to the sentence that introduces it.
The lines of a table, and its caption, are a sentence each. Headings, key words, the acknowledgment and the references
are left out: they state nothing.

The ledger has displayed formulas first, then what the text states, section by section.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache

from hypcheck.paper.ledger.entry import LedgerEntry
from hypcheck.paper.ledger.equations import costs, equations, regime_of_section_4
from hypcheck.paper.ledger.flights import flights
from hypcheck.paper.ledger.procedures import procedures
from hypcheck.paper.ledger.propositions import propositions
from hypcheck.paper.ledger.prose import prose

REASONS = {
    "announces": "says what the paper or a part of it does, not that something is so",
    "survey": "speaks of other work, or of the world at large, and gives nothing to check it by",
    "notation": "gives a name to something",
    "choice": "states a choice of the authors: a model, a rule or a size",
    "proposal": "says what could be done, not that it is so",
}
"""Why a sentence has no row, by a word."""

_SENTENCES = """
abstract | In this work we present a new method | =announces
abstract | The proposed strategy is based on the real-time | Abstract; 3.1, speed
abstract | We propose several algorithms for two real applications | =announces
1 | The determination of relative position and collision detection | =survey
1 | These studies have been mainly motivated by | =survey
1 | Collision detection and proximity query is a general | =survey
1 | This geometric approach runs into problems such as | =survey
1 | Classical geometric algorithms for contact detection use quadric | Section 3.1, other methods
1 | For further details see | =survey
1 | The most commonly used bounding volume for contact | Section 1, spheres
1 | Moreover, thus previous methods for contact detection consider | Section 1, convex
1 | Recently, the authors in [10] have characterized all | Tables 1–3 of [10]
1 | The work [10] also provides three different tables | Tables 1–3 of [10]
1 | The first contribution of this paper is to | =announces
1 | The second contribution of this work is the | =announces
1 | The first proposed application will be a video | =announces
1 | In the second proposed application, we will model | =announces
1 | For this application, we also propose an algorithm | =announces
1 | Such a quadcopter could be used for the | =proposal
1 | This work is organized as follows | =announces
1 | Section 2 presents the theory of the proposed | =announces
1 | Section 3 shows two applications | =announces
1 | Section 4 presents the BVHs strategy | =announces
1 | Finally, some concluding remarks are made in Section | =announces
2 | In this section we show how to determine | =announces
2 | We will use the following notation | =announces
2 | We consider H̄ as a circular hyperboloid | (1)
2 | In matrix notation, it can be expressed as | (2); (3)
2 | Note that T denotes the transpose operator | =notation
2 | We also define a spheroid | (4)
2 | We can rewrite this expression using a matrix | (5); (6)
2 | We are interested in the determination of relative | =announces
2 | For this purpose, we have to find the | =announces
2 | Contact detection between H̄ and E is equivalent | Theorem 1; (7); (8)
2 | Let consider the linear application F | (9)
2 | Denoting X̄ = AX, and taking into account | Theorem 1, proof; (7); (10)
2 | Moreover, from (5) and considering that | Theorem 1, proof; (8)
2 | As conclusion it can be said that | Theorem 1; Theorem 1, proof
2 | Considering the isomorphism given in Theorem 1 | =announces
2 | The characteristic polynomial for S and H | Section 2, respectively; (11); (12)
2 | Notice that λ = −a² is one root | after (12)
2 | We focus our attention on finding conditions | =announces
2 | In general, for a monic degree three polynomial | Remark 2; (13)
2 | In our case, the coefficients c0, c1, and | Remark 2; (14)
2 | In practice, the most commonly used hyperboloid | Section 2, in practice
2 | Some examples of this type are the circular | Section 2, in practice
2 | For this reason, we will restrict our study | =choice
2 | In [10], the authors have studied the roots | Tables 1–3 of [10]
2 | Following this work, we can obtain a characterization | Proposition 3.1
2 | Let H̄ and E verifying (γ/d)² ≥ α/b | =choice
2 | The spheroid is exterior to the hyperboloid if | Proposition 3.1; Proposition 3.1, wording
2 | If Δ ≤ 0, then there is contact (Proposition 3) | Proposition 3.2
2 | By Theorem 1, the spheroid E is exterior | Theorem 1
2 | If α/b ≥ 1 then the relative positions | Tables 1–3 of [10]; Tables 1–3 of [10], re-derived
2 | Otherwise, the relative positions between S and H | Tables 1–3 of [10]; Tables 1–3 of [10], re-derived
2 | From these theorems, we have that the spheroid | Proposition 3, proof: roots
2 | Then, using (11), we have that the spheroid | Proposition 3, proof: roots; after (12)
2 | By Descartes' rule of signs we know that | Proposition 3, proof: Descartes
2 | In our case, g(−λ) = | Proposition 3, proof: Descartes
2 | Remember that, from (14), we have that c0 | Proposition 3, proof: Descartes
2 | Therefore, it must be satisfied that c2 < 0 | Proposition 3, proof: signs
2 | Then we have c2 < 0 and c1 > 0 | Proposition 3, proof: signs
2 | Now, by definition of discriminant, we have that | Remark 2
2 | Then we conclude that Δ > 0 and c2 | Proposition 3.1
2 | Finally, using again Theorem 6 and Theorem 14 | Proposition 3.2; Tables 1–3 of [10]
2 | Notice that under the conditions (Remark 4) | Remark 4; Tables 1–3 of [10]
2 | The following result is obtained in a similar | Tables 1–3 of [10]; Proposition 5.1
2 | Let H̄ and E verifying α/b > 1 | Proposition 5, regime
2 | The spheroid is interior to the hyperboloid if | Proposition 5.1
2 | If Δ ≤ 0, then there is contact (Proposition 5) | Proposition 5.2
2 | Notice that under the conditions (Remark 6) | Remark 6; Proposition 5, regime; Tables 1–3 of [10]
3 | Simulated environments (including video games, virtual reality | =survey
3 | In this section we will show two applications | =announces
3 | Before doing any movement, the updated position is | =choice
3.1 | In order to show how to use our | =announces
3.1 | The woman is modelled with a simple spheroid | =choice
3.1 | This object can do any displacement | Section 3, yaw and throttle; Section 3.1, heights
3.1 | The tree trunks are modelled by hyperboloids satisfying | =choice
3.1 | Thus, as you can see in the figure | =notation
3.1 | From the first condition of Proposition 3, we | Table 1
3.1 | Table 1, its lines | Table 1
3.1 | Procedure 1 for video game, with (caption of Table 1) | Table 1
3.1 | This procedure is valid for both cases α/b | Table 1, caption
3.1 | Table 2, its head and result | Table 2
3.1 | Table 2, its lines | Table 2, lines
3.1 | Pseudocode of Procedure 1 for video game (caption of Table 2) | Table 2, lines
3.1 | From (14) and (13), we can write the | Table 2, lines; Section 3.1, loop
3.1 | Since only additions or products are performed | Section 3.1, operations; Abstract; 3.1, speed
3.1 | This procedure exhibits several advantages | Section 3.1, cost of roots; Section 3.1, other methods
3.1 | Our proposal in [13] determines | Section 3.1, f in (12); Section 3.1, [13]; Section 3.1, roots
3.1 | Moreover, other methods described in [3,4,5,6,7] can not | Section 3.1, other methods
3.2 | Because of its potential for commercial, military | =survey
3.2 | Contact detection methods based on computing the distance | Section 3.2, distance; Section 3.2, shape
3.2 | Figure 2 shows two hyperboloid structures | Section 3.2, heights
3.2 | We consider that the UAV flies inside | Section 3.2, pitch; Section 3, yaw and throttle
3.2 | Note that this last displacement must be restricted | Section 3.2, heights
3.2 | Figure 3 shows the geometric model | =announces
3.2 | Observe that this quadcopter can be bounded by | Section 3.2, l and g1
3.2 | The i-th rotor, i = 1, 2, 3, 4 | Section 3.2, l and g1
3.2 | The Cartesian coordinates of the centre point is | (15)
3.2 | Notice that, in general, the angles | (15); Section 3.2, angles
3.2 | Contact detection between the hyperboloid and the spheroid | (16); (17); Theorem 1
3.2 | Considering (15) and applying T1² + T2² | Section 3.2, T1 and T2; (18)
3.2 | Observe that the c0 coefficient in (14) does | (19)
3.2 | Then, for all the spheroids it verifies | (19)
3.2 | We introduce the following expressions | (20)
3.2 | As shown in Appendix A, we obtain the | (21)
3.2 | Considering that the quadcopter flies in the interior | Table 3
3.2 | We will use Proposition 5 to determine non-valid | =announces
3.2 | This method can be applied if α/b_s ≥ | Table 3; Proposition 5, regime
3.2 | Table 3, its lines | Table 3
3.2 | Procedure 2.a for UAV control, with (caption of Table 3) | Table 3
3.2 | Notice that (19), (20), and (21) indicate | Section 3.2, angles
3.2 | As a consequence, similar operations to those shown | =proposal
4 | A BVH is based on modelling an object | =notation
4 | Sphere and spheroid tree hierarchies are simple | Section 4, trees of volumes
4 | The procedures proposed in the previous section could | =proposal
4 | As an example, we will consider the application | =announces
4 | We consider that the rotors are bounded by | Section 3.2, l and g1
4 | Procedure 2.b (Table 4 is used to detect | Table 4
4 | Firstly, we would analyse the big bounding spheroid | Section 4, regime; Proposition 5, regime
4 | If the procedure detects contact, i.e. Δ ≤ 0 | Section 4, contact
4 | Otherwise, we consider the condition given in the | Proposition 5.1; Table 4
4 | Table 4, its lines | Table 4
4 | Procedure 2.b for UAV control, with (caption of Table 4) | Table 4
4 | This algorithm is valid for both cases (γ/d)² | Table 4, caption
4 | Notice that the pseudocode corresponding to the condition | Section 4, pseudocode
4 | Since the computation of Δ(g_i) has a considerable | Section 4, cost
4 | Towards this end, we consider a computer simulated | =choice
4 | This tower has α = 2 m and γ | =choice
4 | The UAV is bounded by a spheroid with | =choice
4 | The UAV flies inside the cooling tower following | Section 4, probabilities; Section 4, which procedure
4 | For instance, Fig. 4 shows the 3D and | =announces
4 | Figure 4 (c) shows the values of the | =announces
4 | The values of Δ closest to zero correspond | Section 4, near the wall
4 | We consider now that the UAV follows a | =choice
4 | Before any movement, the UAV evaluates Procedure 2.b | Section 4, which procedure
4 | This prediction is done considering the position of | Section 4, look-ahead; Table 5, equal steps
4 | For a non-valid movement, the UAV turns and | =choice
4 | Table 5 shows the number of executions in | Table 5
4 | We will referred to as execution percentage | =notation
4 | As you can see in the table, we | Table 5, below 14 %
4 | Note that for t = 0.1 m/s the | Section 4, unit of t; Table 5, t = 0.1
4 | Otherwise, this percentage is reduced as speed increases | Table 5, speed; Table 5, reason; Section 4, discriminant
4 | This also happens for increasing t values | Table 5, response time
4 | Again, the probability of interior or exterior positions | Table 5, reason
4 | Table 5, its figures | Table 5; Table 5, equal steps
5 | We have focused this work on the determination | =announces
5 | We show how this method could be used | =announces
5 | Applying the developed theory, we propose three algorithms | Section 5
A | In this appendix we obtain the expressions | =announces
A | Substituting (15) into c1 given by (14), we | A.1
A | Using (18), we can express c1(g_i) as follows | A.2a; A.2b
A | If we define | A.3
A | c1(g_i) could be consequently rewritten in this way | A.4
A | Using a similar reasoning, c2(g_i) can be expressed | A.5; A.6
A | Now, defining | (22); (23)
"""


@dataclass(frozen=True)
class Sentence:
    """A sentence of the paper: where it stands, its first words, and the `rows` that judge it or a `reason`."""

    section: str
    words: str
    rows: tuple[str, ...]
    reason: str


@cache
def sentences() -> tuple[Sentence, ...]:
    """All of them, in the paper's order."""
    return tuple(map(_sentence, _SENTENCES.strip().splitlines()))


def _sentence(line: str) -> Sentence:
    section, words, judged = line.split(" | ")
    if judged.startswith("="):
        return Sentence(section, words, (), judged[1:])
    rows = judged.replace("Abstract; 3.1", "Abstract, 3.1").split("; ")
    return Sentence(section, words, tuple(row.replace("Abstract, 3.1", "Abstract; 3.1") for row in rows), "")


def coverage() -> str:
    """How many sentences the ledger judges, and why it leaves out the rest, in words."""
    every = sentences()
    without = [each.reason for each in every if each.reason]
    counted = ", ".join(f"{without.count(word)} {word} ({meaning})" for word, meaning in REASONS.items())
    return (
        f"The paper has {len(every)} sentences, its tables' lines and captions counted in; "
        f"{len(every) - len(without)} have a row or several, and {len(without)} have none, for a reason: {counted}."
    )


COQ = {
    "(11)": ("UnitBall.determinant_is_cubic", "Paper.equation_11_is_misprinted"),
    "(12)": ("UnitBall.determinant_is_cubic", "Paper.equation_12_is_misprinted"),
    "(14)": ("UnitBall.g_expanded",),
    "Theorem 1": ("Geometry.scaling",),
    "after (12)": ("UnitBall.determinant_is_cubic",),
    "Tables 1–3 of [10], re-derived": (
        "RootPatterns.table_is_complete",
        "RootPatterns.every_row_occurs",
        "RootPatterns.meaning_of_bodies",
    ),
    "Proposition 3.1": ("Paper.proposition_3_1_is_false", "Rule.proposition_3_repaired"),
    "Proposition 3.2": ("Paper.proposition_3_2_is_false", "Rule.no_discriminant"),
    "Proposition 3, proof: roots": ("Paper.roots_in_the_proof_of_3_are_false",),
    "Proposition 3, proof: signs": ("Paper.signs_in_the_proof_of_3_are_false",),
    "Proposition 5.1": (
        "Paper.proposition_5_1_is_false_where_c2_is_0",
        "Paper.proposition_5_1_is_false_where_c1_is_0",
        "Rule.proposition_5_repaired",
    ),
    "Proposition 5.2": ("Paper.proposition_5_2_is_false", "Rule.no_discriminant"),
    "Section 4, contact": (
        "Paper.proposition_5_2_is_false",
        "Paper.caption_of_table_4_is_false",
        "Rule.no_discriminant",
    ),
    "Table 4, caption": ("Paper.caption_of_table_4_is_false",),
}
"""The theorems of hypcheck/proofs that say of a claim what the ledger says."""


@cache
def entries() -> tuple[LedgerEntry, ...]:
    """Every entry, in order."""
    ordered = (*equations(), *sorted(_statements(), key=lambda entry: entry.section))
    return tuple(map(_with_theorems, ordered))


def statement(number: str) -> LedgerEntry:
    """The entry of a statement in words; only those before it are derived. Raises StopIteration if there is none."""
    return _with_theorems(next(entry for entry in _statements() if entry.number == number))


def _statements() -> Iterator[LedgerEntry]:
    yield from propositions()
    yield regime_of_section_4()
    for part in (procedures, costs, flights, prose):
        yield from part()


def _with_theorems(entry: LedgerEntry) -> LedgerEntry:
    return replace(entry, coq=COQ.get(entry.number, ()))
