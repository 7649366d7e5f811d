"""Whether exact rule, least value and kernel agree about hyperboloids that end: a tool, run by hand.

    python -m tests.tools.ended_agreement --rows 1000000 --jobs 16 --seconds 400 --log upright.jsonl
    python -m tests.tools.ended_agreement --rows 100000 --tilted --jobs 16 --seconds 100 --log tilted.jsonl
    python -m tests.tools.ended_agreement --ways --rows 100000 [--tilted]
    python -m tests.tools.ended_agreement --modes --rows 1000

Half of the rows are random, half lie within 10⁻⁹ radii of contact with a rim, a flat end or the wall. The least value
is found by a branch and bound, the exact rule by what the sections say. One row in `--mesh` (100) is
asked of meshes and FCL too. With `--ways` the kernel's hits are compared with the exact first contact. With `--modes`
the kernel is asked under all four rounding modes about rows of every family that ends, as many of each, and compared
with the exact rule.

Rows come in chunks, each from the seed and its number. A log keeps what chunks found, so that a run that was ended, by
`--seconds` too, goes on where it was. Progress goes to the standard error. Each disagreement is printed with its row
and makes the status 1. The last lines count rows, and those that the kernel, the least value and the mesh leave open.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections import Counter
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from pathlib import Path

import numpy as np

from hypcheck import passage
from hypcheck.geometry.pair import Pair
from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.kernel import _compiled
from hypcheck.vectors.families import ENDED_FAMILIES, ENDED_SWEEP_FAMILIES
from tests.support.ended_sweeps import near_a_rim, past_a_tower
from tests.support.inside import answer_sweeps, compiled_kernel, least_position, position, verdict
from tests.tools.attack.rounding import DIRECTED, TO_NEAREST, rounded
from tests.tools.progress_line import progress_line

CHUNK = 1000
RANDOM = "random"
PARTS = ("a rim", "a flat end", "the wall")
"""What every third row of hairs lies near."""

NEAREST, NEAR = -50, -30
"""Hairs are from 2⁻⁵⁰ to 2⁻³⁰ radii, 10⁻¹⁵ to 10⁻⁹."""


def random_rows(random, count, *, tilted):
    """Rows (n, 13): any sizes, the end within reach of the spheroid."""
    sizes = np.exp2(random.uniform(-3, 3, (count, 4)))
    alpha, gamma, b, d = sizes.T
    high = random.uniform(-2, 2, count) * gamma
    spread = np.stack([alpha + b, alpha + b, d], axis=1)
    centres = random.normal(size=(count, 3)) * spread + [0, 0, 1] * high[:, None]
    return _with_ends(random, sizes, centres, _axes(random, count, tilted), high)


def hairs(random, count, *, tilted, nearest=NEAREST):
    """The same, but 2^nearest to 2⁻³⁰ radii from contact with a rim, a flat end or the wall below an end."""
    sizes = np.exp2(random.uniform(-3, 3, (count, 4)))
    alpha, gamma, b, d = sizes.T
    high, azimuth = random.uniform(-2, 2, count) * gamma, random.uniform(0, 2 * np.pi, count)
    axis, level = _axes(random, count, tilted), np.stack([np.cos(azimuth), np.sin(azimuth)], axis=1)
    kind = np.arange(count) % 3  # rim, flat end, wall
    height = np.where(kind == 2, high - random.uniform(0, 1, count) * d, high)
    radius = alpha * np.hypot(1, height / gamma)
    point = np.column_stack([radius[:, None] * level, height])
    point[kind == 1, :2] *= random.uniform(0, 1, (count, 1))[kind == 1]
    turn = random.uniform(0, np.pi, count)
    rim = np.column_stack([np.cos(turn)[:, None] * level, np.sin(turn)])
    wall = (
        np.column_stack([(radius / alpha**2)[:, None] * level, -height / gamma**2])
        * random.choice([-1, 1], count)[:, None]
    )
    normal = np.where((kind == 2)[:, None], wall, np.where((kind == 1)[:, None], [[0.0, 0.0, 1.0]], rim))
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    unit = axis / np.linalg.norm(axis, axis=1)[:, None]
    along = (normal * unit).sum(axis=1)[:, None] * unit
    shift = (b * b)[:, None] * (normal - along) + (d * d)[:, None] * along
    share = 1 + random.choice([-1, 1], count) * np.exp2(random.uniform(nearest, NEAR, count))
    centres = point + shift * (share / np.sqrt((normal * shift).sum(axis=1)))[:, None]
    return _with_ends(random, sizes, centres, axis, high)


def _axes(random, count, tilted):
    return random.normal(size=(count, 3)) if tilted else np.tile([0.0, 0.0, 1.0], (count, 1))


def _with_ends(random, sizes, centres, axis, high):
    low = high - sizes[:, 1] * np.exp2(random.uniform(-3, 2, len(high)))
    low[random.uniform(size=len(high)) < 0.3] = -np.inf
    rows = np.column_stack([sizes, centres, axis, low, high, random.integers(0, 2, len(high))])
    down = random.uniform(size=len(high)) < 0.5
    rows[np.ix_(down, [6, 9])] *= -1
    rows[np.ix_(down, [10, 11])] = -rows[np.ix_(down, [11, 10])]
    return np.ascontiguousarray(rows + 0.0)


def compare_positions(rows, kind, counts, every):
    """Count what is open, and yield a sentence for each disagreement; one row in `every` is asked of meshes too."""
    by_kernel = compiled_kernel.answer_ended(rows)
    for number, (row, answer) in enumerate(zip(rows.tolist(), by_kernel.tolist(), strict=True)):
        pair = Pair.from_row(row)
        truth, other = position(pair.lengths), least_position(pair)
        name = kind if kind == RANDOM else f"{kind} of {PARTS[number % 3]}"
        counts[name, "rows"] += 1
        counts[name, "open to the kernel"] += answer == CANNOT_SAY
        counts[name, "open to the least value"] += other is None
        by_mesh = None
        if number % every == 0:
            by_mesh = verdict(pair).position
            counts[name, "asked of meshes"] += 1
            counts[name, "open to meshes"] += by_mesh is None
        if answer not in (CANNOT_SAY, truth) or other not in (None, truth) or by_mesh not in (None, truth):
            yield f"{row}: exact {truth.label}, kernel {answer}, least value {other}, mesh {by_mesh}"


def compare_ways(rows, kind, counts):
    """The same of ways: hits and times of the kernel beside the exact first contact."""
    hits, times = answer_sweeps(rows)
    for row, hit, at in zip(rows.tolist(), hits.tolist(), times.tolist(), strict=True):
        low, high, solid = row[13:]
        truth = passage(row[:4], row[4:7], row[7:10], row[10:13], z_min=low, z_max=high, solid=bool(solid))
        counts[kind, "rows"] += 1
        counts[kind, "open to the kernel"] += hit == CANNOT_SAY
        if hit not in (CANNOT_SAY, truth.hit) or at > truth.first_upper:
            yield f"{row}: exact {truth}, kernel {hit} at {at}"


def compare_modes(given, counts):
    """Rows of every family that ends under four rounding modes, beside the exact rule; ways beside round to nearest."""
    for name, family in {**ENDED_FAMILIES, **ENDED_SWEEP_FAMILIES}.items():
        rows = np.ascontiguousarray(family.rows(given.seed, given.rows))
        ways = rows.shape[1] == len(ENDED_SWEEP_FAMILIES["ended-way-thin"].columns)
        truth = None if ways else np.array([position(Pair.from_row(row).lengths) for row in rows.tolist()])
        for mode in (TO_NEAREST, *DIRECTED):
            answers = np.empty(len(rows), np.int8)
            with rounded(mode):
                (_compiled.passage if ways else _compiled.classify_ended)(rows, answers)
            truth = answers.copy() if truth is None else truth
            counts[name, "rows"] += len(rows)
            counts[name, "open to the kernel"] += int((answers == CANNOT_SAY).sum())
            for index in np.flatnonzero((answers != truth) & (answers != CANNOT_SAY) & (truth != CANNOT_SAY)).tolist():
                yield f"{mode}: {rows[index].tolist()}: {truth[index]}, kernel {answers[index]}"


def chunk_found(given, number):
    """The counts of a chunk as a list of [kind, what, count], and the sentences of its disagreements."""
    counts: Counter[tuple[str, str]] = Counter()
    random, near = np.random.default_rng([given.seed, number]), number % 2 == 1
    if given.ways:
        rows = (near_a_rim if near else past_a_tower)(int(random.integers(2**31)), CHUNK, tilted=given.tilted)
        sentences = list(compare_ways(rows, "beside a rim" if near else RANDOM, counts))
    else:
        rows = (hairs if near else random_rows)(random, CHUNK, tilted=given.tilted)
        sentences = list(compare_positions(rows, "within 1e-9" if near else RANDOM, counts, given.mesh))
    return [[*key, count] for key, count in counts.items()], sentences


def restored(given):
    """What the log has of the chunks of this seed and these rows: of each its number, its counts and its sentences."""
    if given.log is None or not given.log.exists():
        return {}
    lines = (json.loads(line) for line in given.log.read_text(encoding="utf-8").splitlines() if line.endswith("}"))
    return {line["chunk"]: (line["counts"], line["sentences"]) for line in lines if line["of"] == name_of(given)}


def name_of(given):
    """What chunks are of."""
    return [given.seed, given.tilted, given.ways, given.mesh]


def found_in_chunks(given):
    """Yield what each chunk found, first those of the log; new ones are asked until the time is over."""
    done = restored(given)
    wanted = -(-given.rows // CHUNK)
    yield from (found for number, found in done.items() if number < wanted)
    numbers = iter([number for number in range(wanted) if number not in done])
    started = time.monotonic()
    with ProcessPoolExecutor(given.jobs) as pool:
        running = {}
        while True:
            while len(running) < 2 * given.jobs and time.monotonic() - started < given.seconds:
                number = next(numbers, None)
                if number is None:
                    break
                running[pool.submit(chunk_found, given, number)] = number
            if not running:
                return
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                number, (counts, sentences) = running.pop(future), future.result()
                if given.log is not None:
                    line = {"of": name_of(given), "chunk": number, "counts": counts, "sentences": sentences}
                    with given.log.open("a", encoding="utf-8") as log:
                        log.write(json.dumps(line) + "\n")
                yield counts, sentences


def main(arguments):
    """Compare and print; returns the status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rows", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=3600.0, help="no chunk begins later")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--mesh", type=int, default=100, metavar="N", help="one row in N is asked of meshes and FCL")
    parser.add_argument("--log", type=Path, help="keeps what chunks found")
    parser.add_argument("--tilted", action="store_true")
    parser.add_argument("--ways", action="store_true")
    parser.add_argument("--modes", action="store_true")
    given = parser.parse_args(arguments)
    counts: Counter[tuple[str, str]] = Counter()
    disagreed = 0
    started = time.monotonic()
    tell = progress_line(lambda chunks: f"{chunks * CHUNK:,} rows, {disagreed} disagreements", every=20)
    by_modes = (([], [sentence]) for sentence in compare_modes(given, counts))
    results = by_modes if given.modes else found_in_chunks(given)
    for number, (some, sentences) in enumerate(results, 1):
        counts.update({(kind, what): count for kind, what, count in some})
        disagreed += len(sentences)
        for sentence in sentences:
            sys.stdout.write(f"{sentence}\n")
        tell(number)
    for (kind, what), number in sorted(counts.items()):
        sys.stdout.write(f"{kind:28} {what:26} {number:9,}\n")
    rows = sum(number for (_, what), number in counts.items() if what == "rows")
    sys.stdout.write(f"{rows:,} rows, {disagreed} disagreements, {time.monotonic() - started:.0f} s\n")
    return 1 if disagreed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
