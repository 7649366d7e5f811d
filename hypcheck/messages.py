"""Text in messages, reports and on a terminal: foreign text escaped, numbers with nouns, suggested names."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from json import JSONDecodeError


def escaped(text: object, width: int | None = None) -> str:
    r"""Return the text on one line, at most `width` characters long, with escapes for characters that cannot be seen.

    Each run of blanks, ends of lines included, becomes one space. Escaped (\x1b, \u202e, \ud800) are characters that a
    terminal, a parser or an encoding may not pass on: control and direction marks, lone surrogates and unassigned
    characters.
    """
    shown = printable(" ".join(str(text).split()))
    return shown if width is None else shortened(shown, width)


def printable(line: object) -> str:
    """Return the text of one line with its blanks as they are; other characters are escaped as by escaped()."""
    text = str(line)
    return text if text.isprintable() else "".join(map(_escaped_character, text))


LONGEST = 1000
"""The most characters of a sentence, so that a bad file does not fill the screen."""


def sentence(text: object) -> str:
    """Return the text as one printable line of at most LONGEST characters; a longer one loses its middle.

    The beginning says what is wrong and where, the end what would be right.
    """
    return _without_middle(escaped(_without_middle(str(text))))


def _without_middle(text: str) -> str:
    """Replace the middle of a text that is longer than LONGEST by an ellipsis."""
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 400]} … {text[3 - 400 :]}"


def shortened(text: str, width: int) -> str:
    """Return the text, cut to `width` characters with an ellipsis if it is longer."""
    return text if len(text) <= width else text[: width - 1].rstrip() + "…"


def counted(number: int, noun: str, many: str | None = None) -> str:
    """Return a number with its noun: "1 case", "5,600 cases"; `many` is the plural that is not the noun with an s."""
    return f"{number:,} {noun if number == 1 else many or f'{noun}s'}"


def _escaped_character(character: str) -> str:
    """Return a character, or its escape if it is not printable."""
    return character if character.isprintable() else character.encode("unicode_escape").decode("ascii")


def json_trouble(error: JSONDecodeError) -> str:
    """Return the error of Python's JSON reader, as the end of a sentence.

    Some of its sentences end with "at" or "starting at", because the place follows.
    """
    return error.msg.lower().removesuffix(" at").removesuffix(" starting")


_LONGEST_COMPARED = 100
"""The most characters of a name that are compared: the time grows with the square of their number."""


def suggestion(name: str, known: Iterable[str], *, most: int = 3, otherwise: str = "there are") -> str:
    """Return the end of a sentence about a name that is not `known`: up to `most` similar names, else all known ones.

    `otherwise` is the text before the list of all names.
    """
    known = tuple(known)
    shown = {_plain(name_known): name_known for name_known in known}
    near = [shown[plain] for plain in get_close_matches(_plain(name[:_LONGEST_COMPARED]), shown, n=most)]
    if not near:
        return f"{otherwise} {', '.join(known)}"
    return "did you mean " + " or ".join(filter(None, (", ".join(near[:-1]), near[-1]))) + "?"


def _plain(name: str) -> str:
    """Return a name in lower case without - and _, for a comparison."""
    return name.casefold().replace("_", "").replace("-", "")
