"""Why some conditions of the C header are never seen with both values: a proof for each function and text of it."""

from __future__ import annotations

import re

_MACHINE = (
    "the processor: this machine has leaf 7, and its system saves registers. An old one is answered 1 there, the level "
    "that every x86-64 has; what follows from the bits of newer ones is asked of hc_level_of, for each of them"
)
_CONSTANT = (
    "a constant of the build, 1 here: no input changes it. It is 0 where a machine rounds otherwise "
    "(x87); `tests/tools/processors` builds and asks the header so"
)
_WITHIN_DELTA = (
    "unreachable. About λ = -A the cubic is N μ³ + β μ² + σ μ - h, with β = -offset, σ = slope, h >= 0, "
    "and its discriminant is β²σ² - 4Nσ³ + 4β³h - 18Nβσh - 27N²h². The line before leaves offset and "
    "slope >= 0 within their errors of 22 units. If offset is not told, |β| <= 44 units, and σ >= -44; if "
    "slope alone is not told, β < 0 and |σ| <= 44. Either way no term is > 0 but those with two such "
    "factors or three, too small to count, and 18N|βσ|h with one. There N and the larger of β and σ are "
    "below 2^-3 of a product's unit, as all coefficients are balanced (BALANCED in programs/fixed.py), "
    "and h, at most ps + n1 A - 2N A³ with A below 4 in units of 2^k, is below 5/8. So three times the "
    "discriminant is below 3·18·44·5/8·2^-6 < 24 units of 2^grown, and delta > 0 is told from 31 on. The "
    "largest of 13,000 such rows, among 31 million that were drawn for it, has 1 unit"
)

REASONS: dict[tuple[str, str], str] = {
    ("hc_fixed_position", "offset > 0"): _WITHIN_DELTA,
    ("hc_fixed_position", "slope > 0"): _WITHIN_DELTA,
    ("hc_position_of", "HC_FLOATS_DECIDE && found.decided"): _CONSTANT,
    ("hc_settle", "HC_FLOATS_DECIDE && found.decided >> i & 1"): _CONSTANT,
    ("hc_tilted_settle", "HC_FLOATS_DECIDE && found.decided >> i & 1"): _CONSTANT,
    ("hc_scale_axis", "!HC_FLOATS_DECIDE"): _CONSTANT,
    ("hc_make_sweep", "HC_FLOATS_DECIDE && sweep->slack < HC_GREATEST_SLACK"): _CONSTANT,
    ("hc_position_with", "HC_FLOATS_DECIDE && found.decided"): _CONSTANT,
    ("hc_ended_position", "!HC_FLOATS_DECIDE"): _CONSTANT,
    ("hc_best_level", "__get_cpuid_max(0, NULL) < 7"): _MACHINE,
    ("hc_best_level", "!(leaf_1 & system_saves)"): _MACHINE,
    ("hc_tilted", "count - at < HC_WIDTH"): (
        "unreachable where HC_WIDTH is 1, which it is in the plain level: the loop goes on while count - at > 0. The "
        "levels with wider vectors reach it"
    ),
    ("hc_wall_misses", "phi.safe"): (
        "unreachable: hc_ended_multiplier ends with some n >= 2^-40 (1 - 10^-9) of the smaller mu, and lambda is n "
        "less that mu. So mu + lambda, of either mu, is at least (2^-40 (1 - 10^-9) - 2^-52) mu, which is above "
        "HC_ENDED_NEAREST mu. If mu is no number, phi is none, and the line before is false. The condition stays, for "
        "with it any multiplier is safe"
    ),
    ("hc_fine_pole", "made->side < 0 && other.high < root.high"): (
        "seen by no measurement: clang records no test vectors of a decision that chooses between two structs. Both of "
        "its conditions have been true and false, and the branches show it"
    ),
    ("hc_tilted_sweep_reach", "position * l.v > 0"): (
        "unreachable: l is position · pole · v/(1 + v). The loop before has returned unless every pole - or + "
        "l is proved > 0, which NaN is not; then the poles, quotients and squares of positive numbers, are > "
        "0. v is > 0: it begins so, and hc_tilted_sweep_multiplier takes only what is above `low` >= 0, or half of "
        "high > 0. The condition stays, for with it a wrong guess could not prove anything wrong"
    ),
    ("hc_halve_factor", "middle < *high"): (
        "unreachable but on x87 set to 24 bits. If most > 2 least, the product of the roots is below most / "
        "√2 (1 + 2^-48), so below *high. Else `middle` is least + (most - least)/2, at most the larger of "
        "both. If that is `least`, it is *low, and middle > *low is false, or HC_width / 2, below *high. If "
        "it is `most` <= *high, high - low > HC_width max(low, 1) leaves most - least > HC_width / 2 max(low, "
        "1), or `most` is `largest` < *high: half of it is more than what two roundings take"
    ),
}


def reason(gap: str) -> str | None:
    """Why a gap is there, which is written as coverage.py does: function, what is missing, text; None if unknown."""
    function, _, rest = gap.partition(": ")
    return next((why for (name, text), why in REASONS.items() if name == function and text in rest), None)


_ALL_AT_ONCE = (
    "unreachable in the functions of settings whose first pass writes no code 3, an open one: its lines, or the "
    "height, answer every centre. So `left` is 0 and pass_over stays 0, and what is for open centres is not entered; "
    "the template has it for all settings"
)

_LINES_FIRST = (
    "unreachable: a centre whose maximum is nearer to a pole than to 0 is beyond the line of its side, and on a side "
    "without a line the side of the centre has answered. Half way to the pole, P and Q must satisfy F > 0, which is "
    "P > (A + B/2)^2/A (1 + 4Q/B), or F <= 0 on the inner side; in both numbers this is beyond the line "
    "(test_emitted_gaps.py compares them for each setting)"
)
_WITHIN_HEIGHT = (
    "unreachable: what has a modelled height is answered beyond it first. Within it zz is within the box of the "
    "discriminant, and a centre with R beyond that box is beyond the line for exterior "
    "(test_emitted_gaps.py compares the numbers); what is no number has been answered too"
)
_ALL_OPEN = (
    "unreachable: the setting has no line, and the question is the position, so the first pass leaves every centre open"
)
_LINKED = (
    "a constant of each program, which its linker sets: true where the predicate lacks the function, and the program "
    "ends there. tests/scaffold/test_adapters.py builds one of those"
)
_NO_PARTS = "unreachable: the mover of this scene has no parts, so the loop over them is not entered"
_FAINT = (
    "unreachable: the bound of the discriminant's error is counted up to a far corner of its box. Between the surface "
    "and the line, and for contact in all of the box, the discriminant itself is within that bound "
    "(test_emitted_gaps.py evaluates it there in intervals)"
)
_QUESTION = "a constant of the text: the scene's question"
_ROOTS = (
    "unreachable: the frame takes the roots of a sum of squares, of which one is 2^-200 at least as the axis is "
    "scaled, of q1^2 + ps/t, and of quotients of positive numbers; the guard keeps 0 from a quotient for programs to "
    "come"
)
_RISES = (
    "unreachable for these sizes: q1 has the sign of s (t h + c) - p (t c + h), and s min(t, 1) is above p max(t, 1) "
    "(test_emitted_gaps.py)"
)
_SECOND = (
    "unreachable where t <= 1: at l = A1 = p the polynomial l^2 + 2 q1 l - ps/t of A2 is p h (p + s)(1 - 1/t) <= 0, so "
    "A2 >= A1; both are compared by their upper halves, and A1 is 64, a double, which an error of 2^-82 cannot pass"
)
_NOT_INSIDE = (
    "unreachable behind a maximum above 0: the question is exterior, and a centre that is not outside has been "
    "answered. One that rounding lets through is on the surface but for a few roundings, where the maximum is below 0"
)

_TILTED_LINES = (
    "unreachable: half way to a pole the dual function has its slope h(X), and the centre is (I + l M^-1 D) X. If h(X) "
    "says that the maximum is nearer to the pole, the centre is beyond the line of its side, whatever the axis "
    "(test_emitted_tilted_gaps.py)"
)
_SHORT_STEPS = (
    "unreachable: where the search ends, `gain` is `loss`, which is 1 at least, but for 2^-44 of both, and both are "
    "known to a small share. So a step of 16 spreads over `bend` is short beside the ways to the poles, and changes "
    "gain - loss by about 32 spreads: it turns its sign (test_emitted_tilted_gaps.py)"
)
_SHORT_OUTSIDE = (
    "unreachable: the question is exterior, so the way to A is never shorter than from 0. Where the search ends, "
    "`gain` is 1 at least but for 2^-44 of it, and known to a small share: a step of 16 spreads over `bend` is below "
    "half that way (test_emitted_tilted_gaps.py)"
)
_ONE_ORDER = "a constant of the frames of this text: which of A1 and A2 is smaller (test_emitted_tilted_gaps.py)"
_ALWAYS_SURE = (
    "unreachable: the height is modelled, and within it and the line phi is known to 2^-70. So what is not clear "
    "leaves 2^-54 of room, and the steps, which are short, cannot use that up (test_emitted_tilted_gaps.py)"
)

EMITTED: dict[tuple[str, str], str] = {
    **{
        (
            rf"(forest|tower(-simplest)?|whole,) (float..|position|contact|exterior(, everywhere)?|parts): {function}",
            text,
        ): _LINES_FIRST
        for function, text in (
            ("past_maximum", "never false: is_near_zero"),
            ("search", "never false: is_near_zero"),
            ("search", "never false: beyond_half"),
        )
    },
    (r"tower exterior: search|forest float64: search", "never true: clear_inside"): _NOT_INSIDE,
    (r"two trees, one axis: proved", "never true: clear_inside"): _NOT_INSIDE,
    (r"adapter .*: main", "never true: !(tilt ? "): _LINKED,
    (r"whole, exterior, everywhere: of_parts", "position"): _NO_PARTS,
    (r"whole, exterior, everywhere: of_parts", "k "): _NO_PARTS,
    (r"forest float64: position_1", "never true: delta_3 > "): _FAINT,
    (r"forest float64: position_15", "delta_3 < "): _FAINT,
    (r"forest float64: many_15", "never true: touching"): _FAINT,
    **{
        (r"the tower, (one|any) axis.*: (past_peak|tilted_search)", f"never false: {text}"): _TILTED_LINES
        for text in ("is_near_zero", "beyond_half")
    },
    **{
        (r"the tower, (one|any) axis.*: proved", f"never false: {text}"): _SHORT_STEPS
        for text in ("is_before_a", "is_before_b", "turns_left", "turns_right")
    },
    (r"two trees, one axis: proved", "never false: is_before_a"): _SHORT_OUTSIDE,
    (r"(the tower|two trees), one axis: proved", "a1_is_nearer"): _ONE_ORDER,
    (r"two trees, one axis: position_1", "never true: found == 2"): _ALWAYS_SURE,
    **dict.fromkeys(
        (
            (r"a hill: position_1", "R <= 6.6248"),
            (r"two trees, any axis: position_1", "R <= 6.6248"),
            (r"two trees, any axis: position_1", "never false: zz <= 25.0"),
            (r"two trees, one axis: position_1", "R <= 6.6248"),
            (r"two trees, one axis: position_1", "never false: zz <= 25.0"),
            (r"whole, contact: shape_1", "c[16]"),
            (r"whole, contact: shape_2", "c[19]"),
            (r"whole, parts: shape_1", "c[19]"),
            (r"whole, exterior, everywhere: shape_1", "c[19]"),
        ),
        _WITHIN_HEIGHT,
    ),
    (r"two trees, any axis: many_2", "before == 3.0"): _ALL_OPEN,
    (r"two trees, any axis: many_2", "never false: left"): _ALL_OPEN,
    **{
        (rf"whole, {name}: whole", f"never {way}: {number}"): _QUESTION
        for name, number in (("parts", 0), ("contact", 3), ("exterior, everywhere", 1))
        for way in ("true", "false")
    },
    (r".* any axis.*: dd_sqrt", "never false: is_positive"): _ROOTS,
    (r".* any axis.*: dd_abs", "never true: is_negative"): _RISES,
    (r".* any axis.*: tilted_search_free", "never false: rises"): _RISES,
    (r"the tower, any axis.*: tilted_search_free", "never true: second"): _SECOND,
    **{
        (r"forest float64: many_\d+", text): _ALL_AT_ONCE
        for text in ("never true: left", "pass_over > 0", "code[i] == 3.0", "i < count")
    },
    (r"whole, .*: position_of", "default"): (
        "unreachable: `shape` is a table of the numbers of the cases, written with them; compilers ask for the line"
    ),
    (r"method exact, without its floats: .*", "decided"): "a constant of this build: the floats are left out of it",
    (r"method exact, without its floats: hypcheck_position", "exterior"): "behind that constant",
    (r"method exact, without its floats: hypcheck_position", "interior"): "behind that constant",
    (r"method exact, without its floats: hypcheck_position", "never false: 0"): "that constant itself",
    (r"method exact, without its floats: hypcheck_position", "never true: 0"): "that constant itself",
}
"""The same of emitted code: regular expressions of the text's name and function, and what is missing there."""


def reason_of_emitted(gap: str) -> str | None:
    """Why a gap is there, written as emitted.py does: name, function, what is missing, text; None if unknown."""
    place, _, rest = gap.partition(": ")
    function, _, text = rest.partition(": ")
    return next(
        (why for (where, what), why in EMITTED.items() if re.fullmatch(where, f"{place}: {function}") and what in text),
        None,
    )
