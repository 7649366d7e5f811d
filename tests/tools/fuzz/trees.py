"""From a real document to a damaged one by its tree: values of other types, repeated names, exchanged parts.

A document with changed bytes can seldom be parsed. With a changed tree it can, so that the code behind the parser runs.
JSON, lines of JSON, TOML and the header of an .npy file are trees. Some numbers and texts are known to break readers.
"""

from __future__ import annotations

import ast
import contextlib
import json
import sys
from collections.abc import Iterator
from random import Random
from typing import Any

NUMBERS = (
    *(b"0", b"-0", b"-0.0", b"1e308", b"1e309", b"-1e309", b"1e-400", b"5e-324", b"2.2250738585072014e-308", b"0.1e1"),
    *(b"1.7976931348623157e308", b"NaN", b"nan", b"-nan", b"Infinity", b"inf", b"-inf", b"+inf", b"1e", b"1e+", b".5"),
    *(b"5.", b".", b"01", b"+1", b"--1", b"1_000", b"0x1p+0", b"0x1p99999", b"0x", b"0b1", b"0o7", b"true", b"null"),
    *(b"1e99999999999999999999", b"0e99999999999999999999", b"1e-99999999999999999999", b"1e22", b"1e23", b"1e-5"),
    *(b"4294967296", b"9007199254740993", b"9223372036854775808", b"-9223372036854775809", b"18446744073709551616"),
    *(b"9" * 400, b"9" * 5000, b"0" * 5000, b"0." + b"0" * 5000 + b"1", b"1e" + b"9" * 5000),
    *(b"0x" + b"f" * 5000, b"0o" + b"7" * 9000, b"1979-05-27T07:32:00-08:00", b"1979-05-27", b"07:32:00.999999999"),
    *("٣".encode(), "１".encode(), "−1".encode()),
)

_TEXTS = (
    *("", " ", "\t", "\u00a0", "\u202e", "\u2066", "\u200b", "\ufeff", "\x00", "\x1b[31m", "\x1b]0;x\x07", "\x7f"),
    *("\x85", "\u2028", "\u2029", "\ud800", "\udfff", "\U0010ffff", "\ufffe", "\ue000", "e\u0301" * 50, "ß", "ı"),
    *(r"\ud800", r"\udc00\ud800", r"\u0000", r"\u202e", r"\U00110000", r"\x41", r"\"", "\\", "'", '"', '"""', "''''"),
    *("%s%n%d", "{}", "{0}", "$(id)", "`id`", "../../x", "/", "//", ":", "::", ",", ";", "#", "[", "]", "{", "}", "="),
    *("|", "\r", "\n", "\r\n", "\n\n", "<b>", "&amp;", "]]>", "-->", "__class__", "α", "𝟙", "Ａ", "inf", "A" * 300),
    "x" * 70_000,
)
TEXTS = (
    *(text.encode("utf-8", "surrogatepass") for text in _TEXTS),
    *(b"\xff", b"\xc0\x80", b"\xed\xa0\x80", b"\xf4\x90\x80\x80", b"\xe2\x82", b"\x80" * 9),
)
"""Of control and direction marks, of half characters, of what is markup somewhere, and very long."""


if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

_EMPTY = (b"[]", b"{}", b"[[]]", b"[{}]", b'""', b'[""]', b"[0]", b"true", b"false", b"null", b"[null, null]")


class Raw(bytes):
    """What is written as it stands: a number, or what stands in the place of one."""


class Object(list):
    """The members of an object, pairs of a name and a value, so that a name can stand twice."""


def tree(data: bytes, random: Random, _: object = None) -> bytes:
    """A document after one change of its tree, or a few; as it is where it is none."""
    for kind in (_json, _lines, _toml, _npy):
        with contextlib.suppress(ValueError, RecursionError, SyntaxError, TypeError, MemoryError):
            return kind(data, random)
    return data


def _json(data: bytes, random: Random) -> bytes:
    raw = {name: lambda text: Raw(text.encode()) for name in ("parse_int", "parse_float", "parse_constant")}
    return _written(_changed(json.loads(data, object_pairs_hook=Object, **raw), random), b": ")


def _lines(data: bytes, random: Random) -> bytes:
    """One line, or two."""
    lines = data.split(b"\n")
    for _ in range(random.choice((1, 1, 2))):
        place = random.choice([number for number, line in enumerate(lines) if line[:1] == b"{"] or [0])
        lines[place] = _json(lines[place], random)
    return b"\n".join(lines)


def _toml(data: bytes, random: Random) -> bytes:
    """Every table in one line, as TOML has it too."""
    changed = _changed(_of(tomllib.loads(data.decode())), random)
    if not isinstance(changed, Object):
        raise TypeError
    return b"".join(_written(name, b"") + b" = " + _written(value, b" = ") + b"\n" for name, value in changed)


def _npy(data: bytes, random: Random) -> bytes:
    """The header, with its right length, padded or not."""
    if data[:7] != b"\x93NUMPY\x01":
        raise TypeError
    end = 10 + int.from_bytes(data[8:10], "little")
    header = _written(_changed(_of(ast.literal_eval(data[10:end].decode("latin-1"))), random), b": ")
    for old, new in ((b"true", b"True"), (b"false", b"False"), (b"null", b"None")):
        header = header.replace(old, new)
    if random.random() < 0.8:  # what a shape has to be
        header = header.replace(b"[", b"(").replace(b"]", b",)").replace(b"(,)", b"()")
    header = header.ljust(random.choice((0, 118)))[:65534] + b"\n"
    return data[:8] + len(header).to_bytes(2, "little") + header + data[end:]


def _of(value: Any) -> Any:
    if isinstance(value, dict):
        return Object((name, _of(each)) for name, each in value.items())
    if isinstance(value, (list, tuple)):
        return [_of(each) for each in value]
    return value if isinstance(value, (str, bool)) or value is None else Raw(str(value).encode())


def _changed(root: Any, random: Random) -> Any:
    top = [root]
    for _ in range(random.choice((1, 1, 1, 2, 3))):
        places = list(_places(top))
        if places:
            _change(*random.choice(places), places, random)
    return top[0] if top else ""


def _places(holder: list[Any]) -> Iterator[tuple[list[Any], int]]:
    """Every value in the tree: what holds it, and where."""
    for place in range(len(holder)):
        yield holder, place
        if isinstance(_value(holder, place), list):
            yield from _places(_value(holder, place))


def _change(holder: list[Any], place: int, places: list[tuple[list[Any], int]], random: Random) -> None:
    """Another value, a like one of another type, one from elsewhere; twice, gone, or by another name."""
    value, way = _value(holder, place), random.randrange(8)
    if way < 3:
        _put(holder, place, _nasty(random))
    elif way == 3:
        _put(holder, place, _retyped(value, random))
    elif way == 4:
        other = _value(*random.choice(places))
        _put(holder, place, None if isinstance(other, list) else other)
    elif way == 5:
        holder.insert(random.randrange(len(holder) + 1), holder[place])
    elif way == 6:
        del holder[place]
    elif isinstance(holder, Object):
        names = [each[number][0] for each, number in places if isinstance(each, Object)]
        text = random.choice(TEXTS).decode("utf-8", "surrogateescape")
        holder[place] = (random.choice((random.choice(names), text)), value)


def _nasty(random: Random) -> Raw:
    number = random.choice(NUMBERS)
    quoted = b'"' + random.choice(TEXTS).replace(b"\\", b"\\\\").replace(b'"', b'\\"') + b'"'
    return Raw(random.choice((number, number, b'"' + number + b'"', quoted, random.choice(_EMPTY))))


def _retyped(value: Any, random: Random) -> Any:
    """A number as a text, a text as a bare word, anything within a list or an object."""
    if random.random() < 0.5:
        return random.choice(([value], [value, value], Object([("a", value)])))
    if isinstance(value, str):
        return Raw(value.encode("utf-8", "surrogatepass"))
    return value.decode("utf-8", "replace") if isinstance(value, Raw) else [value]


def _value(holder: list[Any], place: int) -> Any:
    return holder[place][1] if isinstance(holder, Object) else holder[place]


def _put(holder: list[Any], place: int, value: Any) -> None:
    holder[place] = (holder[place][0], value) if isinstance(holder, Object) else value


def _written(value: Any, colon: bytes) -> bytes:
    if isinstance(value, Raw):
        return bytes(value)
    if isinstance(value, Object):
        return b"{" + b", ".join(_written(name, b"") + colon + _written(each, colon) for name, each in value) + b"}"
    if isinstance(value, list):
        return b"[" + b", ".join(_written(each, colon) for each in value) + b"]"
    return json.dumps(value, ensure_ascii=False).encode("utf-8", "surrogateescape")
