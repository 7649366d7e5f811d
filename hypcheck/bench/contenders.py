"""Everything that is compared, by name: what it is, and how it is loaded in a process that measures."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from hypcheck.bench.plan import REFERENCE, BenchPlan, chosen
from hypcheck.bench.ways import InPython, Way
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.kernel import numpy_path
from hypcheck.methods import bounding, roots
from hypcheck.methods.builtin import builtin_methods
from hypcheck.methods.domain import Domain, representable
from hypcheck.methods.dual import dual_by_scene
from hypcheck.methods.formula import ByScene, by_scene
from hypcheck.methods.method import Method
from hypcheck.rows import Rows


@dataclass(frozen=True)
class Contender:
    """A method as it is compared.

    `name`, `title`, `question`, `precision`, `exact` and `domain` are as a Method has them. `tier` is what it is
    written in, and kin are compared inside one: "C", "numpy", "python", "FCL" or "foreign"; `kind` what it does.
    `judged` rows of a workload are asked of it at most, and `timed` rows make a timed batch. `amortised` says of a mesh
    whether it is built once for a scene or for each row. `load` makes the way to call it.
    """

    name: str
    title: str
    tier: str
    kind: str
    precision: str
    question: str
    domain: Domain
    load: Callable[[], Way]
    exact: bool = False
    judged: int | None = None
    timed: int | None = None
    amortised: str | None = None
    accuracy_only: bool = False
    note: str = ""

    def asked(self, rows: Rows) -> NDArray[np.intp]:
        """The places of the rows it is asked to be right about: inside its domain, and numbers of its format."""
        return np.flatnonzero(self.domain.holds(rows) & representable(rows, self.precision))[: self.judged]


ALGEBRAIC = ("coefficients", "hessian", "shared", "local-maximum", "dual")
PRECISIONS = ("float32", "float64")
PAPER = "the paper's own formula; it answers whether the pair is exterior, no more"
_UNSAID = "what does not converge is not said"
SIZES_ONCE = "what depends on sizes alone is computed once a scene"


def contenders(plan: BenchPlan) -> dict[str, Contender]:
    """All that this run compares, by name, the reference first. Raises InputError where the plan names none."""
    found = {each.name: each for each in everything()}
    names = chosen(list(found), plan.methods, "method")
    return {name: found[name] for name in dict.fromkeys((REFERENCE, *names))}


def everything() -> Iterable[Contender]:
    """Every method, chosen or not."""
    methods = builtin_methods()
    yield from _formulas(methods)
    yield from _fast(methods)
    yield from _roots(methods)
    yield from _exact(methods)
    yield from _shapes(methods)


def _formulas(methods: dict[str, Method]) -> Iterable[Contender]:
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
            note=f"{PAPER}; {SIZES_ONCE}" if paper else SIZES_ONCE,
            timed=8192 if formula == "dual" else None,
        )


def _scene_of_formula(name: str, format_name: str) -> ByScene:
    return partial(dual_by_scene, format_name) if name == "dual" else by_scene(FORMULAS[name], format_name)


def _fast(methods: dict[str, Method]) -> Iterable[Contender]:
    yield of_method(
        methods["fast"],
        "numpy",
        "certified",
        name="fast-numpy",
        scene=numpy_path.positions_of_scene,
        note="exact: where its bound cannot tell, integers do",
    )


def _roots(methods: dict[str, Method]) -> Iterable[Contender]:
    for precision in PRECISIONS:
        scene, method = roots.trigonometric_by_scene(precision), methods[f"trigonometric-{precision}"]
        yield of_method(method, "numpy", "roots", scene=scene, note="the way attributed to the paper's [13]")
    yield of_method(methods["numpy-roots"], "python", "roots", judged=2000, timed=192, note="one call a row")
    for name in (name for name in methods if name.startswith("mpmath-roots-")):
        yield of_method(methods[name], "python", "roots", judged=240, timed=4, note=_UNSAID)


def _exact(methods: dict[str, Method]) -> Iterable[Contender]:
    yield of_method(methods["exact-integers"], "python", "exact", judged=3000, timed=256, note="")
    yield of_method(methods["exact-oracle"], "python", "exact", judged=3000, timed=256, note="")
    yield of_method(methods["nearest-point"], "numpy", "exact", judged=3000, timed=512, note="gives the distance too")


def _shapes(methods: dict[str, Method]) -> Iterable[Contender]:
    scenes: dict[str, ByScene] = {
        "bounding-sphere": bounding.sphere_scene,
        "bounding-cylinder": bounding.cylinder_scene,
    }
    for name, scene in scenes.items():
        yield of_method(methods[name], "numpy", "bounding", scene=scene, note="another shape in the spheroid's place")


def of_method(
    method: Method,
    tier: str,
    kind: str,
    *,
    name: str = "",
    scene: ByScene | None = None,
    judged: int | None = None,
    timed: int | None = None,
    accuracy_only: bool = False,
    note: str = "",
) -> Contender:
    """A built-in method as a contender."""
    return Contender(
        name=name or method.name,
        title=method.title,
        tier=tier,
        kind=kind,
        precision=method.precision,
        question=method.question,
        domain=method.domain,
        load=partial(InPython, method.answer, scene),
        exact=method.exact,
        judged=judged,
        timed=timed,
        accuracy_only=accuracy_only,
        note=note,
    )
