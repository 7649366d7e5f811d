"""What somebody may have meant by a name that is not there."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

_LONGEST = 100
"""Characters of a name that are compared: comparing takes time with the square of their number."""


def advice(name: str, known: Iterable[str], *, most: int = 3, otherwise: str = "there are") -> str:
    """The end of a sentence about a name that is not `known`: up to `most` names like it, else all that there are.

    `otherwise` is what stands before the list of all.
    """
    known = tuple(known)
    shown = {_plain(each): each for each in known}
    near = [shown[each] for each in get_close_matches(_plain(name[:_LONGEST]), shown, n=most)]
    if not near:
        return f"{otherwise} {', '.join(known)}"
    return "did you mean " + " or ".join(filter(None, (", ".join(near[:-1]), near[-1]))) + "?"


def _plain(name: str) -> str:
    return name.casefold().replace("_", "").replace("-", "")
