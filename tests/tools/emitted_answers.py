"""Compare the answers of emitted kernels before and after a change of how they are printed.

    python -m tests.tools.emitted_answers FOLDER            # before: writes the texts
    python -m tests.tools.emitted_answers FOLDER --compare [NAME…]  # after: builds both texts, asks both, times both

Names are what the names of texts begin with. Exit status 1 if an answer differs. Texts that did not change are counted
and not built. Rows are those of the families of each kernel's own sizes: tangencies and what lies beside them, where
the last stage decides.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from time import perf_counter

import numpy as np

from hypcheck.implementations.description import domain_of
from hypcheck.scene.model import QUESTIONS
from hypcheck.scene.reading import read_scene, shipped_scenes
from hypcheck.vectors.fixed_sizes import families_for
from tests.kernel.emission.building import COMMAND, COMMANDS, asking, built_of
from tests.kernel.emission.test_tilted import SCENES as TILTED
from tests.support.inside import EMITTED_LANGUAGES, ScenePlan, description, dialect_of, emitted, plan_of

ROWS = 40
TIMES = 5


def plans() -> Iterator[tuple[str, ScenePlan]]:
    """Plans by name: the shipped scenes and the tilted ones of tests, each question, each format."""
    named = {name: read_scene(name) for name in shipped_scenes()} | dict(TILTED)
    for name, scene in named.items():
        for question in QUESTIONS:
            for precision in ("float64",) if name in TILTED else ("float64", "float32"):
                yield f"{name}-{question}-{precision}", plan_of(replace(scene, question=question), precision)


def texts() -> Iterator[tuple[str, str, ScenePlan, str]]:
    """Name, language, plan and text of every kernel."""
    for name, plan in plans():
        for language in EMITTED_LANGUAGES:
            dialect = dialect_of(language)
            if plan.format.name in dialect.numbers:
                yield f"{name}.{dialect.extension}", language, plan, emitted(plan, language, COMMAND)


def rows_of(plan: ScenePlan) -> list[np.ndarray]:
    """Rows for each pair of sizes."""
    domain = domain_of(description(plan, "c")["domain"])
    found = (family.rows(0, ROWS) for family in families_for(domain.settings))
    return [rows for rows in found if len(rows)]


def main(arguments: list[str]) -> int:
    """Write or compare."""
    folder = Path(arguments[0])
    if "--compare" not in arguments:
        folder.mkdir(parents=True)
        for name, _, _, text in texts():
            (folder / name).write_text(text, encoding="utf-8")
        return 0
    changed = unlike = alike = asked = 0
    for name, language, plan, text in texts():
        if arguments[2:] and not name.startswith(tuple(arguments[2:])):
            continue
        before = (folder / name).read_text(encoding="utf-8")
        if before == text:
            alike += 1
            continue
        changed += 1
        answers, spent = [], []
        rows = rows_of(plan)
        for version in (before, text):
            with tempfile.TemporaryDirectory() as place:
                ask = asking(built_of(Path(place), version, language), language)
                answers.append(np.concatenate([ask(part) for part in rows]))
                spent.append(_seconds(ask, rows) if language in (*COMMANDS, "python") else 0.0)
        asked += len(answers[0])
        different = int((answers[0] != answers[1]).sum())
        unlike += different
        seconds = f"{spent[0]:.6f} s before, {spent[1]:.6f} s after"
        sys.stdout.write(f"{name}: {len(answers[0])} rows, {different} differ, {seconds}\n")
        sys.stdout.flush()
    sys.stdout.write(f"{alike} texts as before, {changed} changed, {asked} rows, {unlike} answers differ\n")
    return int(unlike > 0)


def _seconds(ask, rows) -> float:
    best = float("inf")
    for _ in range(TIMES):
        begin = perf_counter()
        for part in rows:
            ask(part)
        best = min(best, perf_counter() - begin)
    return best


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
