"""A plan in words and numbers: what each setting of a scene needs, what is left out and why, and what that saves."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

from hypcheck.derivation.counting import Operations, count, hoisted
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.derivation.program import Step
from hypcheck.kernel.emission.header import operations_before, region
from hypcheck.kernel.specialise.centre import CENTRE
from hypcheck.kernel.specialise.plan import ONE_SIDED, Plan, Stages
from hypcheck.pairs import SIZES
from hypcheck.visible import visible

PRINTED = "table-2"
"""What a plan is compared with: the paper's loop, its constant terms taken out as the paper does."""


def plan_lines(plan: Plan) -> Iterator[str]:
    """The plan for people, line by line."""
    yield f"{visible(plan.scene.name, 60)}: {_asked(plan.question)}, in {plan.format.name}"
    for place, stages in enumerate(plan.settings, start=1):
        yield ""
        yield from _setting_lines(place, stages, plan.question)
    yield ""
    yield (
        f"An answer is right for inputs each changed by {float(plan.bound_u):g} u at most, u = 2^-{plan.format.bits}: "
        "it can be wrong only that near to contact."
        if plan.bound_u
        else "Every answer is right."
    )


def plan_as_json(plan: Plan) -> dict[str, Any]:
    """The plan for programs."""
    return {
        "schema": "1.0.0",
        "scene": plan.scene.name,
        "question": plan.question,
        "precision": plan.format.name,
        "bound_u": float(plan.bound_u),
        "settings": [_setting_as_json(stages) for stages in plan.settings],
        "printed": {"formula": PRINTED, "operations": asdict(printed_operations())},
    }


def printed_operations() -> Operations:
    """What Table 2 costs each centre, its constant terms taken out of the loop."""
    return count(hoisted(FORMULAS[PRINTED].program, SIZES).inside)


def _asked(question: str) -> str:
    return {
        "position": "exterior, in contact or interior",
        "exterior": "exterior or not",
        "interior": "interior or not",
        "contact": "in contact or not",
    }[question]


def _setting_lines(place: int, stages: Stages, question: str) -> Iterator[str]:
    setting = stages.setting
    alpha, gamma, b, d = setting.sizes
    yield f"{place}. alpha {alpha!r}, gamma {gamma!r}, b {b!r}, d {d!r}: {visible('; '.join(setting.uses), 90)}"
    yield f"   {region(setting)}"
    yield "   does, in this order"
    for what in _steps(stages, question):
        yield f"     {what}"
    yield "   decided by, of centres spread evenly"
    yield "     " + ", ".join(f"{name} {share:.2%}" for name, share in stages.shares.items())
    yield "   leaves out"
    for omission in stages.omitted:
        yield f"     {omission.what}: {omission.why}"
    yield "   costs"
    average = _average(stages, question)
    yield f"     {_told(operations_before(stages))} before a search; {average:.1f} that round on average"
    yield f"     Table 2 as printed: {_told(printed_operations())}; {printed_operations().rounded} that round"


def _steps(stages: Stages, question: str) -> Iterator[str]:
    if stages.always is not None:
        yield f"nothing: the whole region is {stages.always.name.lower()}"
    if stages.thresholds is not None:
        inner = stages.thresholds.inner
        yield f"R = x² + y² against {stages.thresholds.outer:.17g}" + ("" if inner is None else f" and {inner:.17g}")
    for line in stages.lines:
        yield f"a line: λ = {float(line.multiplier):g} proves {line.side.name.lower()}"
    if question in ONE_SIDED and stages.centre:
        yield "the side of the centre: on the other side the answer is no"
    if stages.discriminant is not None:
        tells = "contact or clear" if stages.discriminant.clear_where_positive else "contact"
        yield f"the discriminant: beyond ±{stages.discriminant.bound:.3g} its sign is certain and tells {tells}"
    if stages.search is not None:
        yield f"the dual function at its maximum, found by {stages.search.steps} halvings"


def _average(stages: Stages, question: str) -> float:
    """Rounded operations a centre of the sample, the search left aside."""
    average = float(_of(stages.entry.steps) + sum(_of(line.program.steps) for line in stages.lines))
    left = 1.0 if question in ONE_SIDED else stages.shares.get("discriminant", 0.0) + stages.shares.get("search", 0.0)
    if stages.centre:
        average += left * _of(CENTRE.steps)
    if stages.discriminant is not None:
        average += (stages.shares["discriminant"] + stages.shares["search"]) * _of(stages.discriminant.program.steps)
    return average


def _of(steps: tuple[Step, ...]) -> int:
    return count(steps).rounded


def _told(operations: Operations) -> str:
    return (
        f"{operations.additions} additions, {operations.multiplications} multiplications, "
        f"{operations.divisions} divisions, {operations.comparisons} comparisons"
    )


def _setting_as_json(stages: Stages) -> dict[str, Any]:
    setting = stages.setting
    spans = {name: [span.low, span.high] for name, span in zip("xyz", setting.box.spans, strict=True) if span}
    return {
        "sizes": list(setting.sizes),
        "spans": spans,
        "uses": list(setting.uses),
        "always": None if stages.always is None else int(stages.always),
        "thresholds": None if stages.thresholds is None else asdict(stages.thresholds),
        "lines": [{"side": int(line.side), "multiplier": str(line.multiplier)} for line in stages.lines],
        "discriminant": None if stages.discriminant is None else {"bound": stages.discriminant.bound},
        "search": stages.search is not None,
        "shares": stages.shares,
        "omitted": [asdict(omission) for omission in stages.omitted],
        "operations": asdict(operations_before(stages)),
        "bound_u": float(stages.bound_u),
    }
