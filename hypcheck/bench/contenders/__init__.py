"""Everything that is compared, by name."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from hypcheck.bench.contenders import c_tier, foreign, mesh_tier, numpy_tier
from hypcheck.bench.contenders.contender import Contender
from hypcheck.bench.plan import REFERENCE, BenchPlan, chosen

_SLOW = 1_000
"""Who is judged on fewer rows than this is slow."""

__all__ = ["Contender", "contenders"]


def contenders(plan: BenchPlan) -> dict[str, Contender]:
    """All that this run compares and can, by name, the reference first. Raises InputError where the plan names none."""
    found = {each.name: _quick(each) if plan.quick else each for each in _everything(plan)}
    others = {each.name: each for each in foreign.contenders(plan.foreign, plan.limits)}
    names = chosen(list(found), plan.methods, "method")
    found |= others
    return {
        name: found[name]
        for name in dict.fromkeys((REFERENCE, *names, *others))
        if found[name].needs not in plan.missing and (found[name].quick or not plan.quick or plan.methods)
    }


def _quick(each: Contender) -> Contender:
    """Of a slow method a quick run asks a quarter: a root by mpmath takes milliseconds."""
    return each if each.judged is None or each.judged >= _SLOW else replace(each, judged=each.judged // 4)


def _everything(plan: BenchPlan) -> Iterable[Contender]:
    """Every method, chosen or not."""
    yield from numpy_tier.contenders()
    yield from c_tier.contenders(plan.compiled)
    yield from mesh_tier.contenders()
