"""From real input to damaged input: bytes, tokens, trees, lines and whole files are changed, and bombs inserted."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from random import Random

from tests.tools.fuzz.trees import NUMBERS, TEXTS, tree

DEPTHS = (3, 30, 300, 3000, 100_000)
OPENERS = (
    *(b"[", b'{"a":', b"{", b"(", b"[[", b"a=[", b"a={b=", b'"', b"'", b"x.", b"-", b"+", b"\\", b" ", b"\n", b"#"),
    *(b",", b":"),
)

TOKEN = re.compile(
    rb'"(?:[^"\\\n]|\\.)*"|[-+]?0[xX][0-9a-fA-F.]+(?:[pP][-+]?\d+)?|[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?|[A-Za-z_][\w-]*|\s+|[^\s\w]|.',
    re.DOTALL,
)

Mutation = Callable[[bytes, Random, Sequence[bytes]], bytes]


def mutated(data: bytes, random: Random, others: Sequence[bytes]) -> bytes:
    """The input after one mutation, or a few; `others` are what parts can be taken from."""
    for _ in range(random.choice((1, 1, 1, 2, 2, 3, 5, 9))):
        (mutation,) = random.choices(tuple(MUTATIONS), tuple(MUTATIONS.values()))
        data = mutation(data, random, others)
        if len(data) > LARGEST:
            data = data[:LARGEST]
    return data


LARGEST = 1 << 18
"""Bytes of an input: what grows with its size must not be beyond reason at this one."""


def _span(data: bytes, random: Random, longest: int) -> tuple[int, int]:
    start = random.randrange(len(data) + 1)
    return start, min(len(data), start + random.randint(0, longest))


def _replaced(data: bytes, start: int, stop: int, part: bytes) -> bytes:
    return data[:start] + part + data[stop:]


def flip(data: bytes, random: Random, _: Sequence[bytes]) -> bytes:
    """One bit."""
    if not data:
        return data
    place = random.randrange(len(data))
    return _replaced(data, place, place + 1, bytes([data[place] ^ 1 << random.randrange(8)]))


def put_byte(data: bytes, random: Random, _: Sequence[bytes]) -> bytes:
    """Another byte, in place of one or before it."""
    place = random.randrange(len(data) + 1)
    return _replaced(data, place, place + random.randrange(2), bytes([random.randrange(256)]))


def lose(data: bytes, random: Random, _: Sequence[bytes]) -> bytes:
    """A span is lost."""
    return _replaced(data, *_span(data, random, random.choice((1, 4, 40, 400))), b"")


def cut(data: bytes, random: Random, _: Sequence[bytes]) -> bytes:
    """The end is lost, or the beginning."""
    place = random.randrange(len(data) + 1)
    return data[:place] if random.random() < 0.8 else data[place:]


def repeat(data: bytes, random: Random, _: Sequence[bytes]) -> bytes:
    """A span stands there again, or a thousand times."""
    start, stop = _span(data, random, random.choice((1, 8, 80)))
    return _replaced(data, start, start, data[start:stop] * random.choice((1, 1, 2, 10, 1000)))


def splice(data: bytes, random: Random, others: Sequence[bytes]) -> bytes:
    """A part of another input stands in it."""
    other = random.choice(others)
    start, stop = _span(other, random, random.choice((8, 80, 8000)))
    return _replaced(data, *_span(data, random, random.choice((0, 8, 80))), other[start:stop])


def _at_token(data: bytes, random: Random, part: bytes, wanted: bytes) -> bytes:
    """The part in place of a token that begins with one of the wanted bytes, if a few guesses find one."""
    for _ in range(12):
        token = TOKEN.search(data, random.randrange(len(data) + 1))
        if token and token[0][:1] in wanted:
            return _replaced(data, token.start(), token.end(), part)
    return data


def number(data: bytes, random: Random, _: Sequence[bytes]) -> bytes:
    """Another number in place of one."""
    return _at_token(data, random, random.choice(NUMBERS), b"0123456789-+")


def text(data: bytes, random: Random, _: Sequence[bytes]) -> bytes:
    """Another text in place of a quoted one, or of a word, or put in anywhere."""
    part = random.choice(TEXTS)
    way = random.randrange(3)
    if way == 0:
        return _at_token(data, random, b'"' + part + b'"', b'"')
    if way == 1:
        return _at_token(data, random, part, b"abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_")
    place = random.randrange(len(data) + 1)
    return _replaced(data, place, place, part)


def token(data: bytes, random: Random, _: Sequence[bytes]) -> bytes:
    """A token is lost, doubled, or stands where another stood; so keys stand twice, and values are of other types."""
    first = TOKEN.search(data, random.randrange(len(data) + 1))
    second = TOKEN.search(data, random.randrange(len(data) + 1))
    if not first or not second:
        return data
    return _replaced(
        data, first.start(), first.end(), random.choice((b"", first[0] * 2, second[0], second[0] + first[0]))
    )


def line(data: bytes, random: Random, _: Sequence[bytes]) -> bytes:
    """A line is lost, doubled or moved."""
    lines = data.splitlines(keepends=True)
    if not lines:
        return data
    taken = lines.pop(random.randrange(len(lines)))
    for _ in range(random.randrange(3)):
        lines.insert(random.randrange(len(lines) + 1), taken)
    return b"".join(lines)


def nest(data: bytes, random: Random, _: Sequence[bytes]) -> bytes:
    """Something opens again and again, and may close as often."""
    opener, depth = random.choice(OPENERS), random.choice(DEPTHS)
    closer = bytes(reversed(opener.translate(bytes.maketrans(b"[{(", b"]})")))) if random.random() < 0.5 else b""
    start, stop = _span(data, random, random.choice((0, 0, 20)))
    return _replaced(data, start, stop, opener * depth + data[start:stop] + closer * depth)


def whole(data: bytes, random: Random, others: Sequence[bytes]) -> bytes:
    """The whole file otherwise: in another encoding, with other line ends, with a mark before it, or twice."""
    return random.choice(WHOLE)(data)


WHOLE: tuple[Callable[[bytes], bytes], ...] = (
    lambda data: b"\xef\xbb\xbf" + data,
    lambda data: data + b"\xef\xbb\xbf",
    lambda data: data.replace(b"\n", b"\r\n"),
    lambda data: data.replace(b"\n", b"\r"),
    lambda data: data.replace(b"\n", b""),
    lambda data: data.replace(b" ", b""),
    lambda data: data.replace(b" ", b"\xc2\xa0"),
    lambda data: data.replace(b'"', b"'"),
    lambda data: data.replace(b",", b";"),
    lambda data: data + data,
    lambda data: data + b"\0" * 512,
    lambda data: data.decode("utf-8", "replace").encode("utf-16", "surrogatepass"),
    lambda data: data.decode("utf-8", "replace").encode("latin-1", "replace"),
    lambda data: data.swapcase(),
    lambda data: data[::-1],
    lambda data: b"",
    lambda data: b"\n",
    lambda data: b"\0",
)

MUTATIONS: dict[Mutation, float] = {
    **dict.fromkeys((number, text), 12),
    **dict.fromkeys((token, tree), 14),
    **dict.fromkeys((flip, put_byte), 9),
    **dict.fromkeys((lose, splice, line), 6),
    **dict.fromkeys((cut, repeat), 4),
    **dict.fromkeys((nest, whole), 1),
}
"""Each mutation with its share."""
