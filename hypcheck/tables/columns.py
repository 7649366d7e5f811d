"""The names of a table's columns: the seven that are read, the four that are added, and what is wrong with a header."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from difflib import get_close_matches

from hypcheck.errors import InputError
from hypcheck.pairs import COLUMNS
from hypcheck.tables.numbers import shown

ADDED = ("position", "label", "tangent", "clearance")
_MOST_COMPARED = 200
_ALSO_CALLED = {"α": "alpha", "γ": "gamma", "x0": "x", "y0": "y", "z0": "z", "xc": "x", "yc": "y", "zc": "z"}


def check_names(names: Sequence[str], where: str, noun: str = "column") -> None:
    """Raise InputError, beginning with `where`, unless the seven columns are there, once, and none of the added ones.

    Other names are allowed and passed through, as long as none but the empty one stands twice.
    """
    double = first_double([name for name in names if name])
    if double is not None:
        raise InputError(f"{where}: {noun} {double}")
    for name in ADDED:
        if name in names:
            raise InputError(f"{where}: {noun} {name!r} is there already and would be added; rename or remove it")
    missing = [name for name in COLUMNS if name not in names]
    if missing:
        nouns = noun if len(missing) == 1 else f"{noun}s"
        verb = "is" if len(missing) == 1 else "are"
        raise InputError(f"{where}: {nouns} {', '.join(missing)} {verb} missing; {_advice(names, missing)}")


def first_double(names: Sequence[str]) -> str | None:
    """The end of a sentence about the first name that stands more than once, or None."""
    for name, count in Counter(names).items():
        if count > 1:
            return f"{shown(name)} stands {'twice' if count == 2 else f'{count} times'}; it must stand once"
    return None


def _advice(names: Sequence[str], missing: Sequence[str]) -> str:
    """What would be right, with the name that was meant where one is near."""
    others = [name for name in names if name not in COLUMNS][:_MOST_COMPARED]
    for wanted in missing:
        for name in others:
            if _ALSO_CALLED.get(name.casefold(), name.casefold()) == wanted:
                return f"{shown(name)} must be written {wanted}"
        near = get_close_matches(wanted, others, n=1)
        if near:
            return f"{shown(near[0])} must be written {wanted}, if that is what it means"
    if len(names) == 1 and any(mark in names[0] for mark in ";\t"):
        return "columns are separated by commas"
    return f"it needs {', '.join(COLUMNS)}, in any order"
