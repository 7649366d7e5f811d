"""All targets in order; what cannot be measured here is said in a line "absent"."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

from hypcheck.bench.kernel import compiled, python
from hypcheck.errors import UnavailableError
from hypcheck.kernel.choice import choice
from hypcheck.methods.engines import FCL
from hypcheck.record import Recorder
from hypcheck.record.measurements import Absent, Kernel

ROUNDS, QUICK_ROUNDS = 15, 7
STREAM, QUICK_STREAM = 1_000_000_000, 100_000_000

Group = Callable[[Path, bool], Iterable[Kernel]]


def run(recorder: Recorder, advance: Callable[[int], object], quick: bool) -> None:
    """Measure every target and add its line; a quick run takes fewer rounds and streams a tenth."""
    with TemporaryDirectory(prefix="hypcheck-kernel-") as folder:
        for group in _groups():
            try:
                for line in group(Path(folder), quick):
                    recorder.add(line)
            except UnavailableError as error:
                recorder.add(Absent(what="C compiler", reason=str(error)))
            advance(1)
    if choice().kernel != "compiled":
        recorder.add(Absent(what="compiled kernel", reason=choice().reason))
    if (trouble := FCL.trouble()) is not None:
        recorder.add(Absent(what=FCL.title, reason=trouble))


def steps() -> int:
    """How often `run` advances."""
    return len(list(_groups()))


def _groups() -> Iterator[Group]:
    if choice().kernel == "compiled":
        yield lambda folder, quick: compiled.from_memory(folder, _rounds(quick))
        yield lambda folder, quick: compiled.in_cache(folder, _rounds(quick))
        yield lambda folder, quick: compiled.threads_in_cache(folder, _rounds(quick))
        yield lambda _folder, quick: compiled.near_contact(_rounds(quick))
        yield lambda _folder, quick: compiled.streamed(QUICK_STREAM if quick else STREAM, 1 if quick else 3)
    yield lambda _folder, quick: python.against_numpy(3 if quick else 9)
    yield lambda _folder, quick: python.against_others(_rounds(quick))
    yield lambda _folder, quick: python.one_call(_rounds(quick))


def _rounds(quick: bool) -> int:
    return QUICK_ROUNDS if quick else ROUNDS
