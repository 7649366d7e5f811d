"""The adapters in C and C++ that `hypcheck init` writes, and lines that they are told: right ones and nonsense."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hypcheck.scaffold.project import LANGUAGES, STUBS, Project
from tests.scaffold.test_adapters import NO_ROWS, NONSENSE

_BINARY = {"c": r"\"binary\":true", "cpp": '"binary":true'}


@dataclass(frozen=True)
class Adapter:
    """An adapter with a stub: its texts by file name, the numbers of a row, and whether it tells times."""

    language: str
    stub: str
    claims: tuple[str, ...]
    texts: dict[str, str]

    @property
    def name(self) -> str:
        """What it is called on the page."""
        return " ".join(["adapter", self.language, self.stub, *self.claims])

    @property
    def file_name(self) -> str:
        """Of its program."""
        return self.name.replace(" ", "-")

    @property
    def columns(self) -> int:
        """Numbers of a row."""
        return (7 if self.stub == "position" else 10) + 3 * ("tilt" in self.claims)

    @property
    def form(self) -> str:
        """How questions begin to say how rows come."""
        return "passage-" if self.stub == "passage" else "tilted-" if "tilt" in self.claims else ""


def adapters() -> Iterator[Adapter]:
    """Each language with each stub, and what it may claim."""
    for language in ("c", "cpp"):
        for stub in STUBS:
            for claims in ((), ("tilt",)) if stub == "position" else ((), ("times", "tilt")):
                yield _adapter(language, stub, claims)


def _adapter(language: str, stub: str, claims: tuple[str, ...]) -> Adapter:
    files = Project(LANGUAGES[language], "stub", stub).files()
    texts = {Path(name).name: text for name, text in files.items() if not name.endswith(".gitignore")}
    before = _BINARY[language]
    for name, text in texts.items():
        if name.startswith("predicate.c"):
            assert text.count(before) == 1
            added = "".join(before.replace("binary", claim) + "," for claim in claims)
            texts[name] = text.replace(before, added + before)
    return Adapter(language, stub, claims, texts)


def talk(adapter: Adapter, program: Path) -> None:
    """Tells the adapter good lines between bad ones, and every end of input. Raises AssertionError if it errs."""

    def told(said: bytes) -> bytes:
        done = subprocess.run([program], input=said, capture_output=True, timeout=60, check=True)
        assert done.stderr == b""
        return re.sub(rb"error [ -~]+\n", b"error\n", done.stdout.partition(b"\n")[2])

    words = (b"1 1 1 1 3 0 0 0 0 0" if adapter.stub == "passage" else b"1 2 1 1 4 0 0").split()
    words += [b"0", b"0", b"1"] if "tilt" in adapter.claims else []
    assert len(words) == adapter.columns
    form, row = adapter.form.encode(), b" ".join(words)
    good = b"classify 7 1 " + form + b"text\n" + row + b"\n"
    answer = told(good)
    time = float(answer.split()[3]) if "times" in adapter.claims else 2 / 3
    assert answer.startswith(b"7 1\n1")
    assert time == 2 / 3, answer
    nonsense = [
        *NONSENSE,
        b"classify 1 1 " + form + b"base64",
        b"classify 1 1 " + form,
        b"time 1 1 1 " + form + b"text",
    ]
    nonsense += [
        b"classify 1 1 other-text",
        b"classify 1 65537 " + form + b"text",
        b"time 1 65537 1 " + form + b"binary",
    ]
    nonsense += [b"time 1 1 0 " + form + b"binary", b"time 1 1 2 " + form + b"base64"]
    if form:
        nonsense += [b"classify 1 1 text", b"classify 1 1 binary", b"time 1 1 1 binary"]
    heard = told(b"".join(line + b"\n" + good for line in nonsense))
    assert heard == (b"error\n" + answer) * len(nonsense), heard
    for bad in [*NO_ROWS, row[:-1] + b"x", row + b" 5", row + b" x"]:
        said = b"classify 1 3 " + form + b"text\n" + row + b"\n" + bad + b"\n" + row + b"\n" + good
        if len(bad.split()) != adapter.columns or b"x" in bad:
            assert told(said) == b"error\n" + answer, bad
    assert told(good.replace(b"\n", b" \t\r\n", 2).replace(b"text \t\r", b"text")) == answer
    _talk_binary(adapter, told, form, words, good, answer)


def _talk_binary(
    adapter: Adapter, told: Callable[[bytes], bytes], form: bytes, words: list[bytes], good: bytes, answer: bytes
) -> None:
    """Rows as bytes, the most of them, none, times of a predicate, and ends of the input within them."""
    rows = np.tile(np.array([float(word) for word in words]), (3, 1)).astype("<f8")
    far = rows.copy()
    far[:, 4] = 1e6
    if adapter.stub == "passage":
        far[:, 7] = 1e6
    both = np.concatenate([rows, far])
    heard = told(b"classify 8 6 " + form + b"binary\n" + both.tobytes() + good)
    hit = 1
    right = [hit] * 3 + [0 if adapter.stub == "passage" else 1] * 3
    head, body = heard[:4], heard[4:]
    assert head == b"8 6\n"
    assert list(body[:6]) == right, heard
    times = np.frombuffer(body[6 : 6 + 48 * ("times" in adapter.claims)], "<f8")
    assert ((times[:3] >= 0) & (times[:3] <= 1)).all()
    assert body[6 + 8 * len(times) :] == answer
    heard = told(b"time 9 6 2 " + form + b"binary\n" + both.tobytes() + good)
    assert re.fullmatch(rb"9 \d+ %d\n" % sum(right) + re.escape(answer), heard), heard
    assert told(b"classify 1 0 " + form + b"text\nclassify 2 0 " + form + b"binary\n" + good) == b"1 0\n2 0\n" + answer
    if adapter.stub == "position":
        odd = np.array([[30, 1, 1, 1, x, 0, z, 0, 0, 1] for x in (0.5, 29, 40, 300) for z in (0, 0.5, 3, 200)])
        told(b"classify 1 16 " + form + b"binary\n" + odd[:, : adapter.columns].astype("<f8").tobytes())
    else:
        places = [(x, to) for x in (-9, -3, 0.5, 3, 9) for to in (-9, -2.5, 0.5, 2.5, 9)]
        odd = np.array([[1, 1, 1, 1, x, 0, 0, to, 0, 0, 0, 0, 1] for x, to in places])
        told(b"classify 1 25 " + form + b"binary\n" + odd[:, : adapter.columns].astype("<f8").tobytes())
        lines = b"".join(b" ".join(b"%g" % number for number in one[: adapter.columns]) + b"\n" for one in odd)
        told(b"classify 1 25 " + form + b"text\n" + lines)
    most = np.tile(rows[:1], (65536, 1))
    heard = told(b"classify 1 65536 " + form + b"binary\n" + most.tobytes())
    assert heard[:8] == b"1 65536\n"
    assert set(heard[8 : 8 + 65536]) == {1}
    ends = (b"", b"classify 1", b"classify 1 2 " + form + b"text\n", b"classify 1 2 " + form + b"binary\n1234")
    for end in (
        *ends,
        b"time 1 2 3 " + form + b"binary\n1234",
        b"x" * 2000,
        b"classify 1 1 " + form + b"text\n" + b"1 " * 999,
    ):
        assert told(good + end) in (answer, answer + b"error\n")
