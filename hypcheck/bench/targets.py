"""`hypcheck bench --kernel`: every target of the fast path's speed, each a line "kernel" of the record.

The kernels are compared with plain numpy expressions (Table 2 with powers, and with products), with numpy.roots and
FCL. A target that cannot be measured here becomes a line "absent".

For hyperboloids that end, the targets are the cost of ends, and the share of each family's rows that C leaves open. The
rows are of the paper's tower between z −17.8 and 17.8; each kind is compared with the same rows without ends.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import thread_time_ns

import numpy as np
from numpy.typing import NDArray

import hypcheck
from hypcheck.bench import call_targets, compiled_targets
from hypcheck.bench.c_library import TOWER_SIZES, c_baselines
from hypcheck.bench.compiled_targets import KernelTarget, listed, target, tower_rows, uniform_columns
from hypcheck.errors import UnavailableError
from hypcheck.geometry.pair import Sizes
from hypcheck.geometry.rows import CANNOT_SAY, Columns, Floats, Positions, Rows
from hypcheck.implementations.alternatives import delta_with_powers, numpy_roots
from hypcheck.implementations.meshes import FCL, SceneMesh, height_of, scene_mesh
from hypcheck.kernel import numpy_kernel
from hypcheck.kernel.choice import choice
from hypcheck.kernel.compiled_kernel import answer_ended, answer_rows, answer_sweeps
from hypcheck.record import Recorder
from hypcheck.record.measurements import AbsentLine, KernelLine
from hypcheck.runs import timing
from hypcheck.vectors.families import ENDED_FAMILIES, ENDED_SWEEP_FAMILIES

SEED = 1
PACED = 20_000
ORDINARY, NEAR = 20_000, 2_000
"""Rows of each ordinary family, and of each family near a rim, a flat end or the wall."""

END = 17.8
FAR_AWAY = 1e4


def paces(rounds: int) -> Iterator[KernelLine]:
    """Targets of rows whose ends are far away, and of rows near the rim, upright and tilted."""
    random = np.random.Generator(np.random.PCG64(SEED))
    around = random.uniform((-4, -4, -20), (4, 4, 20), (PACED, 3))
    turn, off = random.uniform(0, 2 * math.pi, PACED), random.uniform(-0.4, 0.4, PACED)
    radius = TOWER_SIZES[0] * math.hypot(1, END / TOWER_SIZES[1]) + off
    level = END + random.uniform(-0.3, 0.3, PACED)
    rim = np.stack([radius * np.cos(turn), radius * np.sin(turn), level], axis=1)
    for kind, axes, width in (
        ("upright", np.tile([0.0, 0.0, 1.0], (PACED, 1)), 7),
        ("tilted", random.uniform(-1, 1, (PACED, 3)), 10),
    ):
        whole = np.ascontiguousarray(_rows(around, axes, FAR_AWAY)[:, :width])
        far, near = _rows(around, axes, FAR_AWAY), _rows(rim, axes, END)
        entries = [
            timing.TimingEntry("whole", PACED, timing.thread_clocked(partial(_answered, whole))),
            timing.TimingEntry("far", PACED, timing.thread_clocked(partial(answer_ended, far, 1))),
            timing.TimingEntry("near", PACED, timing.thread_clocked(partial(answer_ended, near, 1))),
        ]
        samples = timing.measured_samples(entries, rounds)
        for name, text in (("far", "ends far away"), ("near", "ends near the rim")):
            says = f"{timing.rate_text(samples[name])}; without ends {timing.rate_text(samples['whole'])}"
            yield target(f"{text}, {kind}").against(samples[name], samples["whole"], says)


def _answered(rows: Rows) -> Positions:
    return answer_rows(rows, "position", 1)[0]


def _rows(centres: Floats, axes: Floats, end: float) -> Rows:
    n = len(centres)
    ends = np.tile([-end, end, 0.0], (n, 1))
    return np.ascontiguousarray(np.column_stack([np.tile(TOWER_SIZES, (n, 1)), centres, axes, ends]))


def left_open(_rounds: int) -> Iterator[KernelLine]:
    """Targets of the rows and sweeps of each family that C answers with 2; Python then decides these exactly."""
    counts = {name: _open_share(name) for name in (*ENDED_FAMILIES, *ENDED_SWEEP_FAMILIES)}
    for subject, ordinary in (("left open, ordinary", True), ("left open, near an end", False)):
        some = {name: share for name, share in counts.items() if name.endswith("uniform") is ordinary}
        n = ORDINARY if ordinary else NEAR
        words = ", ".join(f"{name} {round(share * n)}" for name, share in some.items() if share) or "none of any family"
        yield target(subject).line([max(some.values())], f"of {n:,} of each of {len(some)} families: {words}")


def _open_share(name: str) -> float:
    sweeps = name in ENDED_SWEEP_FAMILIES
    family = ENDED_SWEEP_FAMILIES[name] if sweeps else ENDED_FAMILIES[name]
    rows = np.ascontiguousarray(family.rows(SEED, ORDINARY if name.endswith("uniform") else NEAR))
    answers = answer_sweeps(rows)[0] if sweeps else answer_ended(rows, 1)
    return float((answers == CANNOT_SAY).mean())


def with_powers(sizes: Sizes, x: Floats, y: Floats, z: Floats) -> NDArray[np.int8]:
    """Whether each centre is exterior, with `**2` and `**3` as in the paper's formula; it is not certified."""
    delta, c1, c2 = delta_with_powers(sizes, x, y, z)
    return np.asarray((delta > 0) & (c2 < 0) & (c1 > 0)).view(np.int8)


def with_products(sizes: Sizes, x: Floats, y: Floats, z: Floats) -> NDArray[np.int8]:
    """As with_powers, with products instead of powers; numpy computes powers by a function of the C library."""
    alpha, gamma, b, d = sizes
    A, B = (alpha / b) ** 2, (gamma / d) ** 2
    c0, bb, dd = -A * B, b * b, d * d
    P, Q = (x * x + y * y) / bb, z * z / dd
    c1 = c0 + A - B + B * P - A * Q
    c2 = A - B + 1 - P - Q
    c21 = c2 * c1
    delta = -4 * c2 * c2 * c2 * c0 + c21 * c21 + 18 * c21 * c0 - 4 * c1 * c1 * c1 - 27 * c0 * c0
    return np.asarray((delta > 0) & (c2 < 0) & (c1 > 0)).view(np.int8)


MANY, FEW, CHUNK = 10_000_000, 200, 1 << 13
TRIANGLES = 2000

EXPRESSIONS = {
    "powers": "the numpy expression with ** 2 and ** 3",
    "products": "the numpy expression with products for powers",
}


@dataclass(frozen=True, slots=True)
class TimesAsFast:
    """A target "`times` times as fast as an expression", as a share of it, or of the possible factor if that is less.

    If the system has large pages for the expression's temporaries, the expression may be so fast that even a loop that
    only reads the rows is not `times` as fast.
    """

    mine: str
    name: str
    subject: str
    times: float
    ceiling: str
    share: float

    def line(self, expression: str, samples: Mapping[str, timing.Samples], says: str) -> KernelLine:
        """The record's line about the expression of that name."""
        own, other, least = (samples[name] for name in (self.mine, expression, self.ceiling))
        gains, most = timing.times_as_fast(own, other), timing.times_as_fast(least, other)
        reached = [gain / min(self.times, self.share * limit) for gain, limit in zip(gains, most, strict=True)]
        limit = f"or {self.share} of what {self.ceiling} allows, if that is less"
        text = f"{self.subject}, of {self.times:g} times the speed of {EXPRESSIONS[expression]}, {limit}; 1e7 rows"
        words = f"{timing.rate_text(own)}; the expression: {timing.rate_text(other)}, {median(gains):.3g} times as long"
        words += f"; {self.ceiling} the rows: {timing.rate_text(least)}{says}"
        return KernelTarget(f"{self.name}, {expression}", text, 1.0).line(reached, words)


def numpy_targets() -> tuple[TimesAsFast, ...]:
    """The targets against numpy expressions that targets.toml lists."""
    return tuple(TimesAsFast(**entry) for entry in listed()["times_as_fast"])


def against_numpy(folder: Path, rounds: int) -> Iterator[KernelLine]:
    """Targets of ten million rows: both numpy expressions and both kernels, as a user calls them, and their limits."""
    columns = uniform_columns(MANY)
    work: dict[str, Callable[[], NDArray[np.signedinteger]]] = {
        "kernel": partial(hypcheck.classify_scene, TOWER_SIZES, *columns, threads=1),
        "fallback": partial(numpy_kernel.positions_of_scene, TOWER_SIZES, *columns),
        "powers": partial(with_powers, TOWER_SIZES, *columns),
        "products": partial(with_products, TOWER_SIZES, *columns),
    }
    entries = [timing.TimingEntry("copying", MANY, timing.thread_clocked(partial(_copied, columns)), loops=1)]
    if choice().kernel == "numpy":
        del work["kernel"]
    else:
        entries.append(timing.TimingEntry("reading", MANY, c_baselines(folder)[0].read(columns), loops=1))
    entries += [timing.TimingEntry(name, MANY, timing.thread_clocked(call), loops=1) for name, call in work.items()]
    samples = timing.measured_samples(entries, rounds)
    for times in numpy_targets():
        for expression in EXPRESSIONS:
            if times.mine in samples:
                yield times.line(expression, samples, f"; {large_pages()}")


def _copied(columns: Columns) -> NDArray[np.signedinteger]:
    """Round all numbers to single precision in numpy, a chunk at a time: the first step of any float32 work on them."""
    buffer, places = np.empty((len(columns), CHUNK), dtype=np.float32), range(0, len(columns[0]), CHUNK)
    for start in places:
        for column, into in zip(columns, buffer, strict=True):
            part = column[start : start + CHUNK]
            np.copyto(into[: len(part)], part, casting="same_kind")
    return np.array([len(places)])


LARGE_PAGES = Path("/sys/kernel/mm/transparent_hugepage/enabled")


def large_pages(setting: Path = LARGE_PAGES) -> str:
    """A sentence about the system's setting of large pages for the temporaries of an expression."""
    try:
        text = setting.read_text(encoding="ascii")
    except (OSError, UnicodeDecodeError):
        return "large pages for temporaries: not reported by this system"
    chosen = text.partition("[")[2].partition("]")[0]
    words = {"always": "always", "madvise": "where asked for, as numpy does for 4 MB and more", "never": "never"}
    return f"large pages for temporaries: {words.get(chosen, 'not reported by this system')}"


def against_others(rounds: int) -> Iterator[KernelLine]:
    """Targets against numpy.roots and FCL, a row at a time, compared with a hundred thousand rows of the kernel."""
    columns = uniform_columns(100_000)
    rows = tower_rows(columns)[:FEW]
    entries = [
        timing.TimingEntry(
            "kernel", 100_000, timing.thread_clocked(partial(hypcheck.classify_scene, TOWER_SIZES, *columns, threads=1))
        ),
        timing.TimingEntry("numpy.roots", FEW, timing.thread_clocked(partial(numpy_roots, rows))),
    ]
    trouble = FCL.trouble()
    if trouble is None:
        mesh = scene_mesh(FCL, "point", TOWER_SIZES, height_of(TOWER_SIZES, rows), TRIANGLES)
        entries.append(timing.TimingEntry("FCL", FEW, _queries(mesh, rows)))
    samples = timing.measured_samples(entries, rounds)
    for name in ("numpy.roots", "FCL"):
        if (other := samples.get(name)) is not None:
            says = f"{timing.rate_text(samples['kernel'])} on {choice().kernel}; {name}: {timing.rate_text(other)}"
            yield target(name).against(samples["kernel"], other, says)


def _queries(mesh: SceneMesh, rows: Rows) -> timing.Clocked:
    """The engine's queries only, in the units of its mesh."""
    touches, centres = mesh.touches, (rows[:, 4:] / np.array(mesh.unit)).tolist()
    if touches is None:
        raise AssertionError("FCL refused the mesh")

    return timing.clocked_calls(touches, centres, thread_time_ns)


ROUNDS, QUICK_ROUNDS, AGAIN = 15, 7, 2
STREAM, QUICK_STREAM = 1_000_000_000, 100_000_000

Group = Callable[[], Iterable[KernelLine]]


def run(recorder: Recorder, advance: Callable[[int], object], quick: bool) -> None:
    """Measure every target and add its line; a quick run has fewer rounds and streams a tenth of the rows."""
    absent = {}
    with TemporaryDirectory(prefix="hypcheck-kernel-") as folder:
        for group in _groups(Path(folder), quick=quick):
            try:
                for line in confirmed_lines(group):
                    recorder.add(line)
            except UnavailableError as error:
                absent["C compiler"] = str(error)
            advance(1)
    if choice().kernel != "compiled":
        absent["compiled kernel"] = choice().reason
    if (trouble := FCL.trouble()) is not None:
        absent[FCL.title] = trouble
    for what, reason in absent.items():
        recorder.add(AbsentLine(what=what, reason=reason))


def confirmed_lines(group: Group) -> list[KernelLine]:
    """The group's lines. A missed target is measured again; it counts as missed only if it is missed each time.

    The interval shows the differences between rounds; it cannot show that another program used the memory in all of
    them.
    """
    lines = list(group())
    for _ in range(AGAIN):
        if all(line.met for line in lines):
            break
        anew = {line.name: line for line in group()}
        lines = [line if line.met else anew[line.name] for line in lines]
    return lines


def steps() -> int:
    """The number of times that `run` advances."""
    return len(_groups(Path(), quick=True))


def _groups(folder: Path, *, quick: bool) -> list[Group]:
    rounds, stream, streams = (QUICK_ROUNDS, QUICK_STREAM, 3) if quick else (ROUNDS, STREAM, 5)
    anywhere: list[Group] = [
        partial(against_numpy, folder, 3 if quick else 9),
        partial(against_others, rounds),
        partial(call_targets.one_call, rounds),
    ]
    if choice().kernel != "compiled":
        return anywhere
    return [
        partial(compiled_targets.from_memory, folder, rounds),
        partial(compiled_targets.in_cache, folder, rounds),
        partial(compiled_targets.threads_in_cache, folder, rounds),
        partial(compiled_targets.near_contact, folder, rounds),
        partial(compiled_targets.slowest_row, rounds),
        partial(compiled_targets.one_orientation, rounds),
        partial(compiled_targets.axis_along_z, rounds),
        partial(compiled_targets.an_axis_each, folder, rounds),
        partial(compiled_targets.streamed, folder, stream, streams),
        partial(call_targets.batches, folder, rounds),
        partial(call_targets.batch, folder, call_targets.MANY, rounds),
        partial(call_targets.ten_centres, rounds),
        partial(call_targets.forms_of_one_pair, rounds),
        partial(call_targets.forms_of_ten_centres, rounds),
        partial(call_targets.forms_of_ten_rows, rounds),
        partial(call_targets.forms_of_many, rounds),
        partial(call_targets.forms_of_an_axis_each, rounds),
        partial(paces, rounds),
        partial(left_open, rounds),
        *anywhere,
    ]
