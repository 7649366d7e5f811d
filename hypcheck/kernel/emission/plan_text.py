"""Writes a plan as text: counts of operations, the comment at the head of a kernel, the output of `hypcheck plan`.

The operations before the search are counted, from the programs and the kernel's own comparisons. The comment says for
which scene the kernel is, what it costs and what is proved about it. The output says what each setting of a scene
needs, what is left out and why, and what that saves.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, replace
from fractions import Fraction
from textwrap import wrap
from typing import Any

from hypcheck.derivation.formulas import FORMULAS
from hypcheck.derivation.program import Operations, Step, count, hoist, needed
from hypcheck.geometry.pair import SIZES, Position
from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.kernel.specialise import tilted
from hypcheck.kernel.specialise.first_stages import AXIAL, CENTRE, RADIAL, Thresholds
from hypcheck.kernel.specialise.last_stages import DualSearch, TiltedSearch
from hypcheck.kernel.specialise.plan import ONE_SIDED, ScenePlan, Stages
from hypcheck.kernel.specialise.settings import Setting
from hypcheck.messages import counted, escaped
from hypcheck.scene.model import FREE, SceneModel, Span
from hypcheck.version import VERSION


def thresholds_asked(stages: Stages, question: str) -> tuple[tuple[Position, float], ...]:
    """Return the thresholds that the question needs: exterior above the first one, interior below the other."""
    if not isinstance(stages.last, Thresholds):
        return ()
    sides = [(Position.EXTERIOR, stages.last.outer)]
    if stages.last.inner is not None:
        sides.append((Position.INTERIOR, stages.last.inner))
    return tuple(side for side in sides if question not in ONE_SIDED or side[0] is Position[question.upper()])


def needs_side(stages: Stages, question: str) -> bool:
    """Whether the kernel tests the side of the centre, before the discriminant or instead of it."""
    delta = stages.discriminant
    tells_sides = question == "position" and delta is not None and delta.clear_where_positive
    return bool(stages.centre) and (question in ONE_SIDED or tells_sides)


def operations_before(stages: Stages, question: str) -> Operations:
    """Count the operations of all stages before the search: the most that a centre can cost there."""
    if isinstance(stages.last, Position):
        return Operations()
    sides = thresholds_asked(stages, question)
    if isinstance(stages.last, Thresholds):
        return replace(count(needed(stages.entry, ("R",)) if sides else ()), comparisons=len(sides))
    steps, comparisons = list(stages.entry.steps), 2  # neither R nor zz overflows
    for line in stages.lines:
        steps += line.program.steps
    if needs_side(stages, question):
        steps += CENTRE.steps
    if stages.discriminant is not None:
        steps += stages.discriminant.program.steps
        comparisons += 4 if stages.discriminant.clear_where_positive else 3  # where the bound holds, then the bound
    operations = count(steps)
    return replace(operations, comparisons=operations.comparisons + comparisons)


def operations_text(operations: Operations) -> str:
    """Return the operations in words: "3 additions, 1 multiplication"."""
    return ", ".join(
        counted(number, noun)
        for number, noun in (
            (operations.additions, "addition"),
            (operations.multiplications, "multiplication"),
            (operations.divisions, "division"),
            (operations.comparisons, "comparison"),
        )
    )


WIDTH = 110
LONGEST_NAME = 60
FEW = 4
"""The head describes up to so many settings; if there are more, each is described at its own function."""


def header(plan: ScenePlan, command: Sequence[str], prefix: str) -> str:
    """Return the comment at the head of a kernel; each line begins with `prefix`."""
    return _comment(_paragraphs(plan, command), prefix)


def whole_header(plan: ScenePlan, scene: SceneModel, command: Sequence[str], prefix: str) -> str:
    """Return the comment at the head of a whole scene's kernel; its plan's question is the position."""
    name, question = comment_text(scene.name).replace('"', "'"), _question_in_comment(scene.question)
    pairs = _question_in_comment(plan.question)
    answers = f"It answers {CANNOT_SAY} outside of the scene's region and to numbers that are not finite."
    at_ends = f"Of a mover that reaches over an end of a hyperboloid it answers what bounds tell, else {CANNOT_SAY}."
    note = "`classify` and `predicate` are asked as those of other kernels: x, y and z as seen from the hyperboloid's"
    paragraphs = (
        f'The whole scene "{name}", by `whole`: {question}.',
        f"Beside one hyperboloid, by `classify` and `predicate`: {pairs}.",
        f"Made by hypcheck {VERSION} for {plan.format.name}; do not edit, make it anew by",
        "    " + comment_text(shlex.join(command)),
        "`whole` takes the mover's centre in the scene's coordinates and its heading in degrees, which places parts.",
        f"{answers} {at_ends}",
        f"There are {len(plan.settings)} pairs of sizes. {note} centre; any other sizes are answered {CANNOT_SAY}.",
        _bound(plan),
        "`whole` asks each hyperboloid so, its offset from the mover rounded once: by a unit more.",
    )
    return _comment(paragraphs, prefix)


def _comment(paragraphs: Iterable[str], prefix: str) -> str:
    """Join the paragraphs to one comment, with an empty line between two; each line begins with `prefix`."""
    lines = [line for paragraph in paragraphs for line in (*_wrapped(paragraph), "")]
    return "\n".join(f"{prefix}{line}".rstrip() for line in lines[:-1])


def _wrapped(paragraph: str) -> list[str]:
    """Break a paragraph into lines of at most WIDTH - 3 characters; an indented command stays as it is."""
    if paragraph.startswith("    "):
        return [paragraph]
    return wrap(paragraph, WIDTH - 3, break_long_words=False, break_on_hyphens=False)


def _paragraphs(plan: ScenePlan, command: Sequence[str]) -> Iterator[str]:
    """Yield the paragraphs of the comment at the head of a kernel."""
    scene = comment_text(plan.scene.name).replace(
        '"', "'"
    )  # beside the quotation marks about it, it could end Python's text
    yield f'The position of a spheroid in the scene "{scene}": {_question_in_comment(plan.question)}.'
    yield f"Made by hypcheck {VERSION} for {plan.format.name}; do not edit, make it anew by"
    yield "    " + comment_text(shlex.join(command))
    yield (
        "x, y and z are the centre of the spheroid as seen from the centre of the hyperboloid: finite numbers. "
        f"The sizes alpha, gamma, b, d{_and_axis(plan)} are those below; any other is answered {CANNOT_SAY}, which "
        f"means: cannot say. {_no_direction(plan)}"
        "What is promised below is promised of centres in the region of their sizes, its border included."
    )
    if len(plan.settings) <= FEW:
        for number, stages in enumerate(plan.settings, start=1):
            yield f"{number}. {_setting(stages, plan.question)}"
    else:
        rounded = [operations_before(stages, plan.question).rounded for stages in plan.settings]
        yield (
            f"There are {len(plan.settings)} of these; each has a function, which says at its head where it holds and "
            f"what it costs: {min(rounded)} to {max(rounded)} operations that round, a search not counted."
        )
    yield _bound(plan)


def notes(plan: ScenePlan, stages: Stages) -> list[str]:
    """Return the lines at the head of a setting's function; none if the head of the kernel describes the setting."""
    return [] if len(plan.settings) <= FEW else _wrapped(_setting(stages, plan.question))


def comment_text(text: str) -> str:
    """Return a foreign text as one line of visible characters, valid in comments and raw strings of Python and C.

    A blank breaks characters that would end a comment, open one, or be a trigraph. A backslash that ends a word gets a
    full stop after it: at the end of a line, C and C++ would join that line to the next.
    """
    plain = escaped(text, LONGEST_NAME * 4)
    for mark, broken in (("*/", "* /"), ("/*", "/ *"), ('"""', "'''")):
        plain = plain.replace(mark, broken)
    plain = re.sub(r"(?<=\?)(?=\?)", " ", plain)
    return re.sub(r"\\(?=\s|$)", r"\\.", plain)


def _and_axis(plan: ScenePlan) -> str:
    """Return the words about the axis that a query must name; empty if the kernel has none, or takes any."""
    return " and the axis, number by number," if plan.axis is not None and not plan.free else ""


def _question_in_comment(question: str) -> str:
    """Return what the answers to the question mean."""
    if question == "position":
        return "+1 exterior, 0 contact (tangency included), -1 interior"
    return f"1 if it is {question if question != 'contact' else 'in contact'}, else 0"


def _no_direction(plan: ScenePlan) -> str:
    """Return the sentence about queries with an invalid axis; empty unless each query names its axis."""
    return "So is an axis that is 0, 0, 0 or not finite. " if plan.free else ""


def _setting(stages: Stages, question: str) -> str:
    """Return the description of a setting: sizes, pairs of the scene, region, answers outside it, cost."""
    setting = stages.setting
    alpha, gamma, b, d = setting.sizes
    uses = "; ".join(comment_text(use) for use in setting.uses[:4]) + (" ..." if len(setting.uses) > 4 else "")
    return (
        f"alpha {alpha!r}, gamma {gamma!r}, b {b!r}, d {d!r}{axis_text(setting)}: {uses}. {region(setting)} "
        f"{outside(stages)} {_cost(stages, question)}"
    )


def axis_text(setting: Setting) -> str:
    """Return the axis of a tilted spheroid, after a comma; empty if the spheroid is upright."""
    if setting.axis is None:
        return ""
    return ", axis free" if setting.axis == FREE else f", axis {list(setting.axis)!r}"


def region(setting: Setting) -> str:
    """Return one or two sentences about the region of the centre, relative to the hyperboloid's centre."""
    spans = [f"{name} {_span(span)}" for name, span in zip("xyz", setting.box.spans, strict=True) if span is not None]
    beyond = "" if setting.cut is None else f" Beyond the height {_span(setting.cut)} the answer is {CANNOT_SAY}."
    return f"Region: {', '.join(spans) or 'everywhere'}.{beyond}"


def outside(stages: Stages) -> str:
    """Return a sentence that says whether an answer is right for a centre outside the region."""
    last = stages.last
    if isinstance(last, Position):
        return "Outside it the answer is worth nothing: the centre is not looked at."
    if isinstance(last, Thresholds):
        return "At any other height the answer is worth nothing: z is not looked at."
    radial, axial = (float(stages.entry_constants.get(name, 1.0)) for name in (RADIAL, AXIAL))
    across, up = (last.widest / 2) ** 0.5 / radial, last.highest**0.5 / axial
    return (
        f"Outside it the answer is as good, as long as |x| and |y| are below {across:.2g} and |z| below {up:.2g}; "
        f"farther out, where a line does not decide, it is {CANNOT_SAY}."
    )


def _span(span: Span) -> str:
    """Return the interval of a coordinate in words."""
    return f"= {span.low!r}" if span.fixed else f"from {span.low!r} to {span.high!r}"


def _cost(stages: Stages, question: str) -> str:
    """Return a sentence about the operations of a setting, and how many centres each stage decides."""
    if isinstance(stages.last, Position):
        return "Nothing is computed: all of the region has one answer."
    shares = ", ".join(f"{name} {share:.1%}" for name, share in stages.shares.items() if share)
    most = "at most before the search" if stages.searches else "in all"
    operations = operations_text(operations_before(stages, question))
    return f"{operations} {most}. Decided by: {shares} (of centres spread evenly)."


def _bound(plan: ScenePlan) -> str:
    """Return the sentence about what is proved of the answers."""
    if plan.bound_u == 0:
        return "Proved: every answer is right."
    unit = plan.format.unit
    if plan.axis is not None:
        return (
            "Proved (docs/plans.md) for rounding to nearest: where an answer rests on a clear spheroid, it is right; "
            "where it rests on contact, it is right for b and d each changed by "
            f"{float(tilted.BOUND_U):g} u at most, u = 2^-{plan.format.bits} = {float(unit):.3g}"
            f"{_by_side(plan)}. What double-double does not settle is answered {CANNOT_SAY}."
        )
    return (
        "Proved (docs/plans.md) for rounding to nearest: "
        f"an answer is right for inputs each changed by {float(plan.bound_u):g} u at most, "
        f"u = 2^-{plan.format.bits} = {float(unit):.3g}. So it may be wrong only in a band around contact: where "
        f"changing every size and coordinate by a share of {float(Fraction(plan.bound_u) * unit):.2g} changes the "
        "position. There is no wrong answer away from the surface, on the ring of double roots either."
    )


def _by_side(plan: ScenePlan) -> str:
    """Return the words about the backward error of the centre's side; empty unless the question is one-sided."""
    if plan.question not in ONE_SIDED:
        return ""
    return f", and where it rests on the side of the centre, for inputs each changed by {float(plan.bound_u):g} u"


PRINTED = "table-2"
"""The formula with which a plan is compared: the paper's loop, without its constant terms, as in the paper."""

Numbered = tuple[int, Stages]
"""A setting's number in the kernel, from 1, and its stages."""


def plan_lines(plan: ScenePlan) -> Iterator[str]:
    """Yield the lines that explain a plan to people.

    Settings in which the kernel leaves out the same steps for the same reasons share one group of lines.
    """
    yield f"{escaped(plan.scene.name, 60)}: {_question_in_words(plan.question)}, in {plan.format.name}"
    for group in _alike(plan):
        yield ""
        yield from _group_lines(group, plan.question)
    yield ""
    yield f"Table 2 as printed: {operations_text(printed_operations())}; {printed_operations().rounded} that round."
    yield (
        f"An answer is right for inputs each changed by {float(plan.bound_u):g} u at most, u = 2^-{plan.format.bits}: "
        "it can be wrong only that near to contact."
        if plan.bound_u
        else "Every answer is right."
    )


def plan_as_json(plan: ScenePlan) -> dict[str, Any]:
    """Return the plan for programs, as values of JSON."""
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
    """Count the operations of the paper's Table 2 for one centre, without the constant terms."""
    return count(hoist(FORMULAS[PRINTED].program, SIZES).inside)


def _question_in_words(question: str) -> str:
    """Return the question as the output of `hypcheck plan` has it."""
    return {
        "position": "exterior, in contact or interior",
        "exterior": "exterior or not",
        "interior": "interior or not",
        "contact": "in contact or not",
    }[question]


def _alike(plan: ScenePlan) -> Iterator[list[Numbered]]:
    """Yield groups of settings that leave out the same and cost the same, with their numbers in the kernel."""
    groups: dict[object, list[Numbered]] = {}
    for number, stages in enumerate(plan.settings, start=1):
        what = tuple((omission.what, _reason(omission.why, stages)) for omission in stages.omitted)
        groups.setdefault((what, operations_before(stages, plan.question)), []).append((number, stages))
    yield from groups.values()


def _reason(why: str, stages: Stages) -> str:
    """Return the reason why something is left out, with the word "fixed" in place of a fixed height."""
    return why.replace(repr(stages.last.height), "fixed") if isinstance(stages.last, Thresholds) else why


def _group_lines(group: Sequence[Numbered], question: str) -> Iterator[str]:
    """Yield the lines about a group of settings: each one's stages, then what they leave out and cost."""
    _, first = group[0]
    for number, stages in group:
        alpha, gamma, b, d = stages.setting.sizes
        uses = escaped("; ".join(stages.setting.uses), 90)
        yield f"{number}. alpha {alpha!r}, gamma {gamma!r}, b {b!r}, d {d!r}{axis_text(stages.setting)}: {uses}"
        yield f"   {region(stages.setting)}"
        yield from (f"   {what}" for what in _steps(stages, question))
        yield "   decided by, of centres spread evenly: " + ", ".join(
            f"{name} {share:.2%}" for name, share in stages.shares.items()
        )
    yield "   leaves out" if len(group) == 1 else "   each leaves out"
    for omission in first.omitted:
        yield f"     {omission.what}: {_reason(omission.why, first) if len(group) > 1 else omission.why}"
    average = sum(_average(stages, question) for _, stages in group) / len(group)
    most = " before a search" if first.searches else ""
    yield f"   costs {operations_text(operations_before(first, question))}{most}; {average:.1f} that round on average"


def _steps(stages: Stages, question: str) -> Iterator[str]:
    """Yield a line for each stage of a setting."""
    if isinstance(stages.last, Position):
        yield f"asks nothing: the whole region is {stages.last.name.lower()}"
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
    if isinstance(stages.last, DualSearch | TiltedSearch):
        doubled = "" if stages.setting.axis is None else ", in double-double"
        yield f"the dual function at its maximum, found by {stages.last.steps} halvings{doubled}"


def _average(stages: Stages, question: str) -> float:
    """Return the mean number of rounded operations for a centre of the sample, without those of the search."""
    if not stages.searches:
        return operations_before(stages, question).rounded
    average = float(_of(stages.entry.steps) + sum(_of(line.program.steps) for line in stages.lines))
    left = 1.0 if question in ONE_SIDED else stages.shares.get("discriminant", 0.0) + stages.shares.get("search", 0.0)
    if needs_side(stages, question):
        average += left * _of(CENTRE.steps)
    if stages.discriminant is not None:
        average += (stages.shares["discriminant"] + stages.shares["search"]) * _of(stages.discriminant.program.steps)
    return average


def _of(steps: tuple[Step, ...]) -> int:
    """Return how many operations of the steps round."""
    return count(steps).rounded


def _setting_as_json(stages: Stages, question: str) -> dict[str, Any]:
    """Return a setting and its stages as values of JSON."""
    setting, last = stages.setting, stages.last
    return {
        "sizes": list(setting.sizes),
        **setting.named_axis,
        "spans": setting.spans,
        "uses": list(setting.uses),
        "always": int(last) if isinstance(last, Position) else None,
        "thresholds": asdict(last) if isinstance(last, Thresholds) else None,
        "lines": [{"side": int(line.side), "multiplier": str(line.multiplier)} for line in stages.lines],
        "discriminant": None if stages.discriminant is None else {"bound": stages.discriminant.bound},
        "search": stages.searches,
        "shares": stages.shares,
        "omitted": [asdict(omission) for omission in stages.omitted],
        "operations": asdict(operations_before(stages, question)),
        "bound_u": float(stages.bound_u),
    }
