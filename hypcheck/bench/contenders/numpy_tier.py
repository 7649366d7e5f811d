"""What is compared in numpy and in Python: the formulas, the fast path's fallback, roots, exact ways, other shapes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import partial

from hypcheck.bench.contenders.contender import Contender, of_method
from hypcheck.bench.contenders.ways import InPython, InScalars
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.kernel import numpy_path
from hypcheck.kernel.choice import choice
from hypcheck.methods import bounding, roots
from hypcheck.methods.builtin import builtin_methods, fast_scene
from hypcheck.methods.dual import dual_by_scene
from hypcheck.methods.formula import ByScene, by_scene
from hypcheck.methods.method import Method

ALGEBRAIC = ("coefficients", "hessian", "shared", "local-maximum", "dual")
PRECISIONS = ("float32", "float64")

PAPER = "the paper's own formula: it answers whether the pair is exterior, no more"
THIRTEEN = "the way that the paper attributes to its [13]"
BISECTED = "its multiplier is found by plain bisection, which nothing was done to make fast"
CERTIFIED = "where its bound cannot tell, integers do"
_UNSAID = "what does not converge is not said"
_QUICK_DIGITS = "-15"

Methods = dict[str, Method]


def contenders() -> Iterable[Contender]:
    """All of them, the reference among them."""
    methods = builtin_methods()
    yield from _formulas(methods)
    yield from _fast(methods)
    yield from _roots(methods)
    yield from _exact(methods)
    yield from _shapes(methods)


def _formulas(methods: Methods) -> Iterable[Contender]:
    """Table 2 in every format, and the others in two."""
    listed = [("table-2", name) for name in ("float16", *PRECISIONS, "longdouble") if f"table-2-{name}" in methods]
    for formula, format_name in [*listed, *((name, each) for name in ALGEBRAIC for each in PRECISIONS)]:
        paper = formula == "table-2"
        yield of_method(
            methods[f"{formula}-{format_name}"],
            "numpy",
            "paper" if paper else "algebraic",
            scene=_scene_of_formula(formula, format_name),
            accuracy_only=format_name == "float16",
            note=PAPER if paper else BISECTED if formula == "dual" else "",
            timed=4096 if formula == "dual" else None,
            singles=8 if formula == "dual" else 32,
        )


def _scene_of_formula(name: str, format_name: str) -> ByScene:
    return partial(dual_by_scene, format_name) if name == "dual" else by_scene(FORMULAS[name], format_name)


def _fast(methods: Methods) -> Iterable[Contender]:
    """The numpy path, the compiled one where it runs, and one call of hypcheck.position for each row."""
    found = of_method(methods["fast-numpy"], "numpy", "certified", timed=8192, note=CERTIFIED)
    yield replace(found, load=partial(InPython, numpy_path.positions, numpy_path.positions_of_scene))
    if choice().kernel == "compiled":
        note = f"{CERTIFIED}; as installed, called from Python, on one thread, {choice().level}"
        # A batch alone: one call at a time is position-python from Python, and fast-c from C.
        yield of_method(methods["fast"], "C", "certified", scene=fast_scene, note=note, singles=0)
    by_one = of_method(methods["fast"], "python", "certified", name="position-python", timed=1024, note=CERTIFIED)
    yield replace(by_one, title="hypcheck.position, one call a row", load=_position, singles=1024)


def _position() -> InScalars:
    from hypcheck.kernel.scalar import position  # noqa: PLC0415 - chooses the kernel where it is loaded

    return InScalars(position)


def _roots(methods: Methods) -> Iterable[Contender]:
    for precision in PRECISIONS:
        scene, method = roots.trigonometric_by_scene(precision), methods[f"trigonometric-{precision}"]
        yield of_method(method, "numpy", "roots", scene=scene, note=THIRTEEN)
    yield of_method(methods["numpy-roots"], "python", "roots", judged=2000, timed=96, note="one call a row")
    for name in (name for name in methods if name.startswith("mpmath-roots-")):
        found = of_method(methods[name], "python", "roots", judged=240, timed=4, note=_UNSAID)
        yield replace(found, quick=name.endswith(_QUICK_DIGITS))


def _exact(methods: Methods) -> Iterable[Contender]:
    yield of_method(methods["exact-integers"], "python", "exact", judged=3000, timed=192)
    yield of_method(methods["exact-oracle"], "python", "exact", judged=3000, timed=192)
    yield of_method(
        methods["nearest-point"], "numpy", "exact", judged=3000, timed=512, singles=16, note="tells the distance too"
    )


def _shapes(methods: Methods) -> Iterable[Contender]:
    scenes: dict[str, ByScene] = {
        "bounding-sphere": bounding.sphere_scene,
        "bounding-cylinder": bounding.cylinder_scene,
    }
    for name, scene in scenes.items():
        yield of_method(methods[name], "numpy", "bounding", scene=scene, note="another shape in the spheroid's place")
