"""hypcheck.classify and hypcheck.classify_scene: C answers ordinary calls without Python, Python all others.

An ordinary call has numbers, lists and numpy's arrays of any strides and most types of numbers, all rows valid, no
heights and no margin, and no more rows than one thread answers. C passes any other call to the functions of
classify.py, which convert other types, or raise an error that says what is wrong. Without the compiled kernel they take
all calls.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from hypcheck.geometry.forms import Answers
from hypcheck.kernel import classify as step_by_step
from hypcheck.kernel.choice import choice
from hypcheck.kernel.compiled_kernel import extension

__all__ = ["classify", "classify_scene"]

Call = Callable[..., Answers]


def _calls() -> tuple[Call, Call]:
    if choice().kernel == "numpy":
        return step_by_step.classify, step_by_step.classify_scene
    module = extension()
    module.set_slow_calls(step_by_step.classify, step_by_step.classify_scene, step_by_step.Prepared)
    return module.classify, module.classify_scene


if TYPE_CHECKING:  # for those who read and check types: the same signatures and descriptions
    from hypcheck.kernel.classify import classify, classify_scene
else:
    classify, classify_scene = _calls()
