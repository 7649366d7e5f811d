"""What stands at the head of an emitted kernel: for which scene it is, what it costs, what is proved of it."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator, Sequence
from fractions import Fraction
from textwrap import wrap

from hypcheck.kernel.emission.costs import operations_before, told
from hypcheck.kernel.specialise.entry import AXIAL, RADIAL
from hypcheck.kernel.specialise.plan import Plan, Stages
from hypcheck.kernel.specialise.settings import Setting
from hypcheck.rows import CANNOT_SAY
from hypcheck.scene.model import Span
from hypcheck.version import VERSION
from hypcheck.visible import visible

WIDTH = 110
LONGEST_NAME = 60
FEW = 4
"""Up to so many settings are told in the head; of more each is told at its own function."""


def header(plan: Plan, command: Sequence[str], prefix: str) -> str:
    """The lines of the comment, each after `prefix`."""
    lines = [line for paragraph in _paragraphs(plan, command) for line in (*_wrapped(paragraph), "")]
    return "\n".join(f"{prefix}{line}".rstrip() for line in lines[:-1])


def _wrapped(paragraph: str) -> list[str]:
    if paragraph.startswith("    "):
        return [paragraph]
    return wrap(paragraph, WIDTH - 3, break_long_words=False, break_on_hyphens=False)


def _paragraphs(plan: Plan, command: Sequence[str]) -> Iterator[str]:
    scene = safe(plan.scene.name).replace('"', "'")  # beside the quotation marks about it, it could end Python's text
    yield f'Where a spheroid stands in the scene "{scene}": {_asked(plan.question)}.'
    yield f"Made by hypcheck {VERSION} for {plan.format.name}; do not edit, make it anew by"
    yield "    " + safe(shlex.join(command))
    yield (
        "x, y and z are the centre of the spheroid as seen from the centre of the hyperboloid: finite numbers. "
        f"The sizes alpha, gamma, b, d are those below; any other is answered {CANNOT_SAY}, which means: cannot say. "
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


def notes(plan: Plan, stages: Stages) -> list[str]:
    """What stands at the head of a setting's function: lines, none where the head of the kernel has told it."""
    return [] if len(plan.settings) <= FEW else _wrapped(_setting(stages, plan.question))


def safe(text: str) -> str:
    """A foreign text as a comment, a raw string of Python and the source of C can hold it: visible, on one line.

    Broken by a blank is what would end a comment, open one, or be a trigraph; a backslash that ends a word, and so may
    come to end a line, which C and C++ would join to the next, has a full stop after it.
    """
    plain = visible(text, LONGEST_NAME * 4)
    for found, broken in (("*/", "* /"), ("/*", "/ *"), ('"""', "'''")):
        plain = plain.replace(found, broken)
    plain = re.sub(r"(?<=\?)(?=\?)", " ", plain)
    return re.sub(r"\\(?=\s|$)", r"\\.", plain)


def _asked(question: str) -> str:
    if question == "position":
        return "+1 exterior, 0 contact (tangency included), -1 interior"
    return f"1 if it is {question if question != 'contact' else 'in contact'}, else 0"


def _setting(stages: Stages, question: str) -> str:
    setting = stages.setting
    alpha, gamma, b, d = setting.sizes
    uses = "; ".join(safe(use) for use in setting.uses[:4]) + (" ..." if len(setting.uses) > 4 else "")
    return (
        f"alpha {alpha!r}, gamma {gamma!r}, b {b!r}, d {d!r}: {uses}. {region(setting)} "
        f"{outside(stages)} {_cost(stages, question)}"
    )


def region(setting: Setting) -> str:
    """Where the centre can be, as seen from the hyperboloid's, in a sentence or two."""
    told = [f"{name} {_span(span)}" for name, span in zip("xyz", setting.box.spans, strict=True) if span is not None]
    beyond = "" if setting.cut is None else f" Beyond the height {_span(setting.cut)} the answer is {CANNOT_SAY}."
    return f"Region: {', '.join(told) or 'everywhere'}.{beyond}"


def outside(stages: Stages) -> str:
    """What an answer about a centre outside the region is worth, in a sentence."""
    if stages.always is not None:
        return "Outside it the answer is worth nothing: the centre is not looked at."
    if stages.thresholds is not None:
        return "At any other height the answer is worth nothing: z is not looked at."
    last = stages.search
    if last is None:
        raise AssertionError("stages end with all of one answer, thresholds or a search")
    radial, axial = (float(stages.entry_constants.get(name, 1.0)) for name in (RADIAL, AXIAL))
    across, up = (last.widest / 2) ** 0.5 / radial, last.highest**0.5 / axial
    return (
        f"Outside it the answer is as good, as long as |x| and |y| are below {across:.2g} and |z| below {up:.2g}; "
        f"farther out, where a line does not decide, it is {CANNOT_SAY}."
    )


def _span(span: Span) -> str:
    return f"= {span.low!r}" if span.fixed else f"from {span.low!r} to {span.high!r}"


def _cost(stages: Stages, question: str) -> str:
    if stages.always is not None:
        return "Nothing is computed: all of the region has one answer."
    shares = ", ".join(f"{name} {share:.1%}" for name, share in stages.shares.items() if share)
    most = "at most before the search" if stages.search is not None else "in all"
    operations = told(operations_before(stages, question))
    return f"{operations} {most}. Decided by: {shares} (of centres spread evenly)."


def _bound(plan: Plan) -> str:
    if plan.bound_u == 0:
        return "Proved: every answer is right."
    unit = plan.format.unit
    return (
        "Proved (docs/plans.md) for rounding to nearest: "
        f"an answer is right for inputs each changed by {float(plan.bound_u):g} u at most, "
        f"u = 2^-{plan.format.bits} = {float(unit):.3g}. So it may be wrong only in a band around contact: where "
        f"changing every size and coordinate by a share of {float(Fraction(plan.bound_u) * unit):.2g} changes the "
        "position. There is no wrong answer away from the surface, on the ring of double roots either."
    )
