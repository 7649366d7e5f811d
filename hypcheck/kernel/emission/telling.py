"""A plan in words and numbers: what each setting of a scene needs, what is left out and why, and what that saves."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any

from hypcheck.derivation.counting import Operations, count
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.derivation.hoisting import hoist
from hypcheck.derivation.program import Step
from hypcheck.kernel.emission.costs import needs_side, operations_before, thresholds_asked, told
from hypcheck.kernel.emission.header import region
from hypcheck.kernel.specialise.centre import CENTRE
from hypcheck.kernel.specialise.plan import ONE_SIDED, Plan, Stages
from hypcheck.pairs import SIZES, Position
from hypcheck.visible import visible

PRINTED = "table-2"
"""What a plan is compared with: the paper's loop, its constant terms taken out as the paper does."""

Numbered = tuple[int, Stages]


def plan_lines(plan: Plan) -> Iterator[str]:
    """The plan for people, line by line; settings that leave out the same for the same reasons are told together."""
    yield f"{visible(plan.scene.name, 60)}: {_asked(plan.question)}, in {plan.format.name}"
    for group in _alike(plan):
        yield ""
        yield from _group_lines(group, plan.question)
    yield ""
    yield f"Table 2 as printed: {told(printed_operations())}; {printed_operations().rounded} that round."
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
        "settings": [_setting_as_json(stages, plan.question) for stages in plan.settings],
        "printed": {"formula": PRINTED, "operations": asdict(printed_operations())},
    }


def printed_operations() -> Operations:
    """What Table 2 costs each centre, its constant terms taken out of the loop."""
    return count(hoist(FORMULAS[PRINTED].program, SIZES).inside)


def _asked(question: str) -> str:
    return {
        "position": "exterior, in contact or interior",
        "exterior": "exterior or not",
        "interior": "interior or not",
        "contact": "in contact or not",
    }[question]


def _alike(plan: Plan) -> Iterator[list[Numbered]]:
    """The settings, with their numbers in the kernel, grouped by what they leave out and what they cost."""
    groups: dict[object, list[Numbered]] = {}
    for number, stages in enumerate(plan.settings, start=1):
        what = tuple((each.what, _reason(each.why, stages)) for each in stages.omitted)
        groups.setdefault((what, operations_before(stages, plan.question)), []).append((number, stages))
    yield from groups.values()


def _reason(why: str, stages: Stages) -> str:
    """Why something is left out; where the height is fixed, without telling which it is."""
    return why if stages.thresholds is None else why.replace(repr(stages.thresholds.height), "fixed")


def _group_lines(group: Sequence[Numbered], question: str) -> Iterator[str]:
    _, first = group[0]
    for number, stages in group:
        alpha, gamma, b, d = stages.setting.sizes
        uses = visible("; ".join(stages.setting.uses), 90)
        yield f"{number}. alpha {alpha!r}, gamma {gamma!r}, b {b!r}, d {d!r}: {uses}"
        yield f"   {region(stages.setting)}"
        yield from (f"   {what}" for what in _steps(stages, question))
        yield "   decided by, of centres spread evenly: " + ", ".join(
            f"{name} {share:.2%}" for name, share in stages.shares.items()
        )
    yield "   leaves out" if len(group) == 1 else "   each leaves out"
    for omission in first.omitted:
        yield f"     {omission.what}: {_reason(omission.why, first) if len(group) > 1 else omission.why}"
    average = sum(_average(stages, question) for _, stages in group) / len(group)
    most = " before a search" if first.search is not None else ""
    yield f"   costs {told(operations_before(first, question))}{most}; {average:.1f} that round on average"


def _steps(stages: Stages, question: str) -> Iterator[str]:
    if stages.always is not None:
        yield f"asks nothing: the whole region is {stages.always.name.lower()}"
    for position, threshold in thresholds_asked(stages, question):
        side = ">" if position is Position.EXTERIOR else "<"
        yield f"R = x² + y² {side} {threshold:.17g} is {position.name.lower()}"
    for line in stages.lines:
        yield f"a line: λ = {float(line.multiplier):g} proves {line.side.name.lower()}"
    if needs_side(stages, question):
        why = ": on the other side the answer is no" if question in ONE_SIDED else ", for where it is clear"
        yield f"the side of the centre{why}"
    if stages.discriminant is not None:
        tells = "contact or clear" if stages.discriminant.clear_where_positive else "contact"
        yield f"the discriminant: beyond ±{stages.discriminant.bound:.3g} its sign is certain and tells {tells}"
    if stages.search is not None:
        yield f"the dual function at its maximum, found by {stages.search.steps} halvings"


def _average(stages: Stages, question: str) -> float:
    """Rounded operations a centre of the sample, the search left aside."""
    if stages.search is None:
        return operations_before(stages, question).rounded
    average = float(_of(stages.entry.steps) + sum(_of(line.program.steps) for line in stages.lines))
    left = 1.0 if question in ONE_SIDED else stages.shares.get("discriminant", 0.0) + stages.shares.get("search", 0.0)
    if needs_side(stages, question):
        average += left * _of(CENTRE.steps)
    if stages.discriminant is not None:
        average += (stages.shares["discriminant"] + stages.shares["search"]) * _of(stages.discriminant.program.steps)
    return average


def _of(steps: tuple[Step, ...]) -> int:
    return count(steps).rounded


def _setting_as_json(stages: Stages, question: str) -> dict[str, Any]:
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
        "operations": asdict(operations_before(stages, question)),
        "bound_u": float(stages.bound_u),
    }
