"""Why some conditions of the C header are never seen with both values, by a text that the gap has in it."""

from __future__ import annotations

_MACHINE = "the processor: another machine has another value"
_GUESS = "it chooses where a proof is looked for; any result is safe"
_CONSTANT = "HC_FLOATS_DECIDE is 1 for this compiler; 0 for x87"
_ORDINARY = (
    "unreachable: the function is asked about ordinary rows alone, whose lengths lie within 2^±100; "
    "what it compares lies within 2^±450 then"
)

_REASONS = {
    "system_saves": _MACHINE,
    "avx2": _MACHINE,
    "avx512": _MACHINE,
    "__get_cpuid_max": _MACHINE,
    "HC_FLOATS_DECIDE &&": _CONSTANT,
    "moved > 0.25 * at": _GUESS,
    "moved < 4 * at": _GUESS,
    "high > 4 * low": _GUESS,
    "high > 1 / HC_settled": _GUESS,
    "*before < high": _GUESS,
    "side * moved > 0": _GUESS,
    "moved > -A.v": _GUESS,
    "v > A * (1 - HC_settled)": _GUESS,
    "least > 0.3 * Q[2]": _GUESS,
    "least < greatest": _GUESS,
    "grown[k] > HC_least_grown": _ORDINARY,
    "grown[k] < HC_greatest_grown": _ORDINARY,
    "never false: clear": _ORDINARY,
    "clear && hc_position_grown": _ORDINARY,
}


def reason(gap: str) -> str | None:
    """Why that gap is there; None where nobody has said yet."""
    return next((why for text, why in _REASONS.items() if text in gap), None)
