"""SPEC: how an implementation under test is named on the command line.

`builtin:NAME`, `python:package.module:function` or `python:file.py:function`, `library:path.so`, `command:WORDS`.
This module only parses the text. Whether the implementation exists and runs is checked when it is opened.
"""

from __future__ import annotations

import json
import re
import shlex
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from types import MappingProxyType

from hypcheck.errors import InputError
from hypcheck.messages import escaped

_LIBRARY = re.compile(r"\.(so(\.\d+)*|dylib|dll)$", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Spec:
    """A parsed SPEC: its text, its kind, and the words after the kind.

    `words` are the name of a built-in method; a file or module and a function; the path of a library; or a command and
    its arguments.
    """

    text: str
    kind: str
    words: tuple[str, ...]

    def __str__(self) -> str:
        return escaped(self.text, 200)


def parse_spec(text: str) -> Spec:
    """Return the SPEC in `text`. Raises InputError with the allowed forms."""
    kind, _, rest = text.partition(":")
    if not begins_as_spec(text):
        kinds = ", ".join(f"{name}:" for name in _KINDS)
        raise InputError(f"{_said(text)} begins with none of {kinds}{_meant(text)}")
    if "\0" in text or any("\ud800" <= character < "\udc80" for character in text):
        raise InputError(f"{_said(text)} contains a character that no path or argument can have")
    return Spec(text, kind, _KINDS[kind](text, rest))


def begins_as_spec(text: str) -> bool:
    """Whether a text begins with the kind of a SPEC; no case and no record does."""
    kind, colon, _ = text.partition(":")
    return bool(colon) and kind in _KINDS


def _builtin(text: str, rest: str) -> tuple[str, ...]:
    """Return the words of builtin:NAME. Raises InputError."""
    if not rest:
        raise InputError(f"{_said(text)} names no method; it must be builtin:NAME")
    return (rest,)


def _python(text: str, rest: str) -> tuple[str, ...]:
    """Return the words of python:…, the file or module and the function. Raises InputError."""
    target, _, function = rest.rpartition(":")  # the last colon: a path may hold others
    right = "python:package.module:function or python:file.py:function"
    if not target or not function.isidentifier():
        raise InputError(f"{_said(text)} names no function; it must be {right}")
    if not is_file(target) and not all(part.isidentifier() for part in target.split(".")):
        raise InputError(f"{_said(text)} names {target!r}, neither a module nor a file; it must be {right}")
    return target, function


def _library(text: str, rest: str) -> tuple[str, ...]:
    """Return the words of library:…, the path. Raises InputError."""
    if not _LIBRARY.search(rest):
        raise InputError(f"{_said(text)} names no shared library; it must be library: and a .so, .dylib or .dll")
    return (rest,)


def _command(text: str, rest: str) -> tuple[str, ...]:
    """Return the words of command:…, the program and its arguments. Raises InputError."""
    words = _json_words(text, rest) if rest.lstrip().startswith("[") else _shell_words(text, rest)
    if not words or not words[0]:
        raise InputError(f"{_said(text)} names no program; it must be command: and a program with its arguments")
    return words


def _json_words(text: str, rest: str) -> tuple[str, ...]:
    """Return the words of a JSON array. Raises InputError."""
    try:
        words = json.loads(rest)
    except (ValueError, RecursionError):
        words = None
    if not isinstance(words, list) or not all(isinstance(word, str) for word in words):
        raise InputError(f'{_said(text)} begins an array; it must be JSON texts, such as ["java", "-jar", "a b.jar"]')
    for word in words:
        if "\0" in word or any("\ud800" <= character < "\udc80" for character in word):
            raise InputError(f"{_said(text)} contains a character that no argument can have")
    return tuple(words)


def _shell_words(text: str, rest: str) -> tuple[str, ...]:
    """Return the words that a shell would read. Raises InputError."""
    try:
        return tuple(shlex.split(rest))
    except ValueError as error:
        why = str(error).lower()
        raise InputError(f"{_said(text)} is not quoted as a shell has it: {why}; or give a JSON array") from None


def is_file(target: str) -> bool:
    """Whether the target of a python: spec is a file rather than a module."""
    return target.endswith(".py") or "/" in target or "\\" in target


def _said(text: str) -> str:
    """Return the beginning of a message about the SPEC."""
    return f"the implementation '{escaped(text, 200)}'"


def _meant(text: str) -> str:
    """Return the end of a message: what may have been meant."""
    kind, _, rest = text.partition(":")
    near = get_close_matches(kind.lower(), _KINDS, n=1)
    if near and rest:
        return f"; was {escaped(f'{near[0]}:{rest}', 200)} meant?"
    if _LIBRARY.search(text):
        return f"; was library:{escaped(text, 200)} meant?"
    if re.search(r"[\w)]:\w+$", text):
        return f"; was python:{escaped(text, 200)} meant?"
    if re.fullmatch(r"[\w-]{1,60}", text):
        return f"; was builtin:{text} meant, or command:{text}?"
    return "; was it meant to be a command: with its arguments?" if text else ""


_KINDS: Mapping[str, Callable[[str, str], tuple[str, ...]]] = MappingProxyType(
    {"builtin": _builtin, "python": _python, "library": _library, "command": _command}
)
