"""Text in messages, reports and on a terminal: foreign text escaped, numbers with nouns, suggested names.

Text in messages, reports and on a terminal: what others wrote, made harmless, and numbers with their nouns.

What somebody may have meant by a name that is not there.
"""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches


def escaped(text: object, width: int | None = None) -> str:
    r"""The text on one line, at most `width` characters long, what cannot be seen written as its escape.

    Blanks of every kind, ends of lines among them, become one space each run. Escaped (\x1b, \u202e, \ud800) are the
    characters that a terminal, a parser or an encoding would not pass on: control and direction marks, lone surrogates
    and what Unicode assigns to no character.
    """
    shown = "".join(map(_escaped_character, " ".join(str(text).split())))
    return shown if width is None else shortened(shown, width)


def printable(line: object) -> str:
    """The text of one line with its blanks as they are; what visible() escapes is escaped, ends of lines too."""
    return "".join(map(_escaped_character, str(line)))


LONGEST = 1000
"""Characters of a sentence: a file that is wrong from end to end does not fill the screen."""


def sentence(text: object) -> str:
    """The text as one visible line of at most LONGEST characters; of a longer one the middle is left out.

    The beginning says where something is wrong, and the end what would be right.
    """
    return _without_middle(escaped(_without_middle(str(text))))


def _without_middle(text: str) -> str:
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 400]} … {text[3 - 400 :]}"


def shortened(text: str, width: int) -> str:
    """The text, cut to `width` characters with an ellipsis where it is longer."""
    return text if len(text) <= width else text[: width - 1].rstrip() + "…"


def counted(number: int, noun: str, many: str | None = None) -> str:
    """A number with its noun: "1 case", "5,600 cases"; `many` is the plural that is not the noun with an s."""
    return f"{number:,} {noun if number == 1 else many or f'{noun}s'}"


def _escaped_character(character: str) -> str:
    return character if character.isprintable() else character.encode("unicode_escape").decode("ascii")


_LONGEST = 100
"""Characters of a name that are compared: comparing takes time with the square of their number."""


def suggestion(name: str, known: Iterable[str], *, most: int = 3, otherwise: str = "there are") -> str:
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
