"""What figures may not fall below, and not rise above; a figure is named by its keys, joined by dots."""

from __future__ import annotations

from tests.tools.evidence.parts import Figures

AT_LEAST: dict[str, dict[str, float]] = {
    "kernel-mutants": {"mutants": 1290},
    "constants": {"mutants": 40},
    "fuzz": {"short.executions": 100},
    "python-coverage": {"percent": 98.5},
    "python-mutants": {"mutants": 2000, "percent killed": 86},
    "coverage": {"functions.share": 100, "branches.share": 99.5, "mcdc.share": 98.8},
    "emitted": {"functions.share": 100, "branches.share": 88.5, "mcdc.share": 96.5},
}
"""By part and figure."""

AT_MOST: dict[str, dict[str, float]] = {
    "fuzz": {"short.findings": 0},
    "faults": {"wrong": 0},
    "coverage": {"count": 0},
    "emitted": {"count": 0},
    "kernel-mutants": {"count": 5},
    "constants": {"lives": 0},
    "python-mutants": {"left": 0},
}
"""By part and figure: survivors, findings."""


def broken(name: str, figures: Figures) -> list[str]:
    """A sentence for each figure of the part `name` that has fallen."""
    low = [
        f"{name}: {key} is {_value(figures, key)}; it must be at least {floor}"
        for key, floor in AT_LEAST.get(name, {}).items()
        if not _value(figures, key) >= floor
    ]
    high = [
        f"{name}: {key} is {_value(figures, key)}; it must be at most {ceiling}"
        for key, ceiling in AT_MOST.get(name, {}).items()
        if not _value(figures, key) <= ceiling
    ]
    return low + high


def _value(figures: Figures, key: str) -> float:
    found = figures
    for name in key.split("."):
        found = found[name]
    return found
