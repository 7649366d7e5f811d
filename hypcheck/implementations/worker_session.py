"""The session of a worker, in which a Python function or a shared library runs: this side of the conversation."""

from __future__ import annotations

import os
import secrets
import sys
from functools import lru_cache
from importlib.util import cache_from_source
from pathlib import Path

import numpy as np

from hypcheck.errors import InputError
from hypcheck.geometry.rows import Rows
from hypcheck.implementations import frames
from hypcheck.implementations.description import LONGEST, Description, described_by_json, foreign_text
from hypcheck.implementations.frames import CallForm, GivenAnswers
from hypcheck.implementations.process import ProcessSession, quoted, stderr_excerpt
from hypcheck.implementations.session import FaultError, Limits, Outcome, StartError
from hypcheck.implementations.spec import Spec
from hypcheck.messages import counted

_PROGRAM = """\
import sys
sys.path[:] = [sys.argv[1], *filter(None, sys.path)]
import hypcheck
del sys.path[0]
from hypcheck.implementations.worker import main
main(sys.argv[2:])
"""
"""Python puts the working directory first on the path, where a struct.py of the user would replace Python's. The
program removes it until hypcheck and numpy are loaded. `hypcheck` is the one that runs here, installed or not."""

WORKER_MODULES = (
    *("__init__", "errors", "float_environment", "messages", "geometry/__init__", "geometry/pair", "geometry/rows"),
    *(f"implementations/{name}" for name in ("__init__", "foreign", "frames", "library", "spec", "worker")),
)
"""What the worker imports of this package: nothing that could answer a question, or tell an answer."""


@lru_cache
def worker_files() -> tuple[str, ...]:
    """Return the files of these modules with Python's compiled versions, and the compiled extension beside them."""
    package = Path(__file__).resolve().parents[1]
    sources = [str(package / f"{name}.py") for name in WORKER_MODULES]
    compiled = [cache_from_source(source) for source in sources] if sys.implementation.cache_tag else []
    calls = [str(path) for path in package.glob("implementations/_calls.*") if path.suffix != ".pyi"]
    return tuple(path for path in (*sources, *compiled, *calls) if os.path.exists(path))


_OURS = (
    f"{os.sep}hypcheck{os.sep}{Path(__file__).parent.name}{os.sep}",
    '"<string>"',
    "Extension modules: ",
    "Fatal Python error: Segmentation fault",
    "(most recent call first)",
)
"""Parts of lines about the worker itself, not about foreign code, in Python's report of a crash."""

_LANGUAGES = {"python": "python", "library": ""}


class WorkerSession(ProcessSession):
    """A Python function or a shared library that answers in a process of its own.

    `run` is the number of the run. The process puts its arrays at other addresses of memory in each run, so that
    answers which depend on an address change.
    """

    max_batch = frames.LARGEST

    def __init__(self, spec: Spec, limits: Limits, run: int) -> None:
        self._spec = spec
        folder = str(Path(__file__).resolve().parents[2])
        if not sys.executable:
            raise StartError("this Python does not know the path of its program, which runs the worker")
        words = (sys.executable, "-c", _PROGRAM, folder, str(3 * run), spec.kind, *spec.words)
        super().__init__(words, limits, worker_files())

    def _meet(self) -> Description:
        """Return the description of the loaded code. Raises StartError."""
        spec = self._spec
        try:
            what, _, body = self._reply(self._limits.startup_timeout)
        except FaultError as fault:
            reason = fault.reason
            if fault.outcome is Outcome.TIMEOUT:
                reason = f"it was not loaded within {self._limits.startup_timeout:g} s"
            elif fault.outcome is Outcome.CRASH:
                reason = f"while it was loaded {reason}"
            self._process.kill()
            raise StartError(f"{reason}{self.evidence}") from None
        if what != frames.READY:
            raise StartError(_text(body))
        first, _, described = bytes(body).partition(b"\n")
        entries = first.decode("utf-8", "replace").split()  # foreign code may have written into the pipe
        name = os.path.basename(spec.words[0]) + "".join(f":{word}" for word in spec.words[1:])
        defaults = Description(name=name, language=_LANGUAGES[spec.kind], binary=True, time=True)
        try:
            description = described_by_json(described or b"{}", defaults)
        except InputError as error:
            raise StartError(str(error)) from None
        tilt, question = description.tilt, description.asked
        self._call = CallForm(question.entry, question.layout, description.times)
        self.scene = not description.heights and self._call._replace(scene=True).entry_name(tilt=tilt) in entries
        if spec.kind == "library":
            wide = self._call._replace(columns=True)
            own = not description.heights and self._call.entry_name(tilt=tilt) in entries
            if not own and wide.entry_name(tilt=tilt) not in entries:
                raise StartError(_lacking(spec.words[0], description, wide if description.heights else self._call))
            self._call = self._call if own else wide
        return description

    def classify(self, rows: Rows, *, by_scene: bool = False) -> GivenAnswers:
        """Return an integer for each row, and times if the description promises them."""
        call = self._call._replace(scene=by_scene)
        width, body = self._ask(frames.CLASSIFY, call, rows, 1, frames.ANSWERS)
        n, times = len(rows), self._call.times
        if len(body) != (width + 8 * times) * n:
            raise _broken(f"{counted(len(body), 'byte')} of answers to {counted(n, 'row')}")
        answers = frames.integers(body[: width * n], width)
        return GivenAnswers(answers, np.frombuffer(body[width * n :], dtype="<f8") if times else None)

    def time(self, rows: Rows, repeat: int, *, by_scene: bool = False, row_by_row: bool = False) -> tuple[int, int]:
        """Return nanoseconds for `repeat` times the rows, and the sum of the answers.

        With `row_by_row` it makes one call for each row.
        """
        call = self._call._replace(scene=by_scene and not row_by_row)
        _, body = self._ask(frames.TIME_EACH if row_by_row else frames.TIME, call, rows, repeat, frames.TIMED)
        if len(body) != frames.TIMES.size:
            raise _broken(f"{counted(len(body), 'byte')} of times")
        nanoseconds, total = frames.TIMES.unpack(body)
        return nanoseconds, total

    def _ask(self, kind: bytes, call: CallForm, rows: Rows, repeat: int, expected: bytes) -> tuple[int, bytearray]:
        """Send a request; return the bytes of an answer and the body of the reply. Raises FaultError."""
        self._process.mark()
        rows, mark = self._columns(rows), secrets.randbits(64)
        head = frames.REQUEST.pack(kind, frames.CALLS.index(call), rows.shape[1], len(rows), repeat, mark)
        self._process.send((head, frames.row_bytes(rows)))
        what, width, body = self._reply(self._limits.timeout, mark)
        if what == expected:
            return width, body
        outcome = {frames.ERROR: Outcome.ERROR, frames.PROTOCOL: Outcome.PROTOCOL}.get(what)
        if outcome is None:
            raise _broken(quoted(what))
        raise FaultError(outcome, _text(body), fatal=False)

    def _reply(self, seconds: float, mark: int = 0) -> tuple[bytes, int, bytearray]:
        """Return the next reply: its kind, the bytes of an answer, its body. Raises FaultError."""
        until = self._process.now() + seconds
        self._await(frames.REPLY.size, until, seconds)
        incoming = self._process.incoming
        what, width, size, marked = frames.REPLY.unpack_from(incoming)
        if marked != mark or width not in {1, 8} or size > max(16 * frames.LARGEST, 2 * LONGEST):
            raise _broken(quoted(incoming))
        self._await(frames.REPLY.size + size, until, seconds)
        body = incoming[frames.REPLY.size : frames.REPLY.size + size]
        del incoming[: frames.REPLY.size + size]
        return what, width, body

    def _await(self, size: int, until: float, seconds: float) -> None:
        """Wait until so many bytes have arrived. Raises FaultError at the time `until`."""
        while len(self._process.incoming) < size:
            if self._process.now() >= until:
                raise FaultError(Outcome.TIMEOUT, f"no answer within {seconds:g} s", fatal=True)
            self._process.pump(until)

    @property
    def evidence(self) -> str:
        """The output of the foreign code since the last question, as the end of a sentence."""
        return stderr_excerpt([line for line in self._process.stderr if not any(part in line for part in _OURS)])


def _lacking(path: str, described: Description, call: CallForm) -> str:
    """Return the sentence that a library lacks the function to be called."""
    question, name = described.asked, call.entry_name(tilt=described.tilt)
    rows = f"rows{len(described.columns)}" if described.tilt and not call.columns else "rows"
    reasons = [f'"question": "{question.name}"'] if question.layout.has_end else []
    reasons += ['"tilt": true'] if described.tilt else []
    reasons += ['"takes": ["heights"]'] if described.heights else []
    why = f", since it describes itself with {' and '.join(reasons)}" if reasons else ""
    answers = "int8_t *hits, double *times" if question.layout.has_end else "int8_t *positions"
    width = ", size_t width" if call.columns else ""
    wanted = f"void {name}(size_t n{width}, const double *{rows}, {answers})"
    return f'{path!r} has no symbol {name}; it must export {wanted}, in C++ as extern "C"{why}'


def _text(body: bytes | bytearray) -> str:
    """Return the text of a reply; foreign code may have written it."""
    return foreign_text(body.decode("utf-8", "replace")) or "(without a text)"


def _broken(shown: str) -> FaultError:
    """Return the fault of code that wrote something else into the worker's pipe."""
    return FaultError(Outcome.PROTOCOL, f"it wrote into the worker's pipe: {shown}", fatal=True)
