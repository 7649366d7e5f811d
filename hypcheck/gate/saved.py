"""A state of a run as JSON and back: what a run that was interrupted goes on from, here or elsewhere.

Numbers that must come back exactly are hexadecimal; infinities are the strings that float() reads.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, astuple
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.bins import Bins
from hypcheck.gate.chunks import Chunk
from hypcheck.gate.results import Again, Open, Result
from hypcheck.gate.schedule import State
from hypcheck.methods.faults import Outcome
from hypcheck.methods.runs import Allowance
from hypcheck.pairs import COLUMNS
from hypcheck.record import plain
from hypcheck.record.fields import FARTHEST
from hypcheck.tally import Fault, Tally, Worst
from hypcheck.visible import shortened

Json = dict[str, Any]


def saved(state: State) -> Json:
    """The state as a mapping that JSON can hold."""
    left = {name: getattr(state.left, name) for name in ("restarts", "faults", "over", "hangs")}
    return {"done": state.done, "left": left, "total": saved_result(state.total)}


def restored(content: Json) -> State:
    """The state of such a mapping. Raises ValueError, KeyError, TypeError or AttributeError where it is none.

    Nothing is made larger than what was read; whether the numbers agree is for consistency.require_state to say.
    """
    left = Allowance(**content["left"])
    hangs = 0 if left.hangs is None else left.hangs
    _whole(left.restarts), _whole(left.faults), _whole(hangs), _text(left.over)
    return State(left, _whole(content["done"]), restored_result(content["total"]))


def saved_result(result: Result) -> Json:
    """A result as a mapping that JSON can hold."""
    return {
        "tallies": {family: _saved_tally(tally) for family, tally in result.tallies.items()},
        "open": [
            {"chunk": astuple(each.chunk), "indices": _runs(each.indices), "answers": each.answers.tobytes().hex()}
            for each in result.open
        ],
        "again": asdict(result.again),
        "outcomes": sorted(outcome.label for outcome in result.outcomes),
        "excusing": sorted(result.excusing),
        "named": sorted(result.named),
    }


def restored_result(content: Json) -> Result:
    """The result of such a mapping. Raises as restored does."""
    return Result(
        tallies={_text(family): _restored_tally(tally) for family, tally in content["tallies"].items()},
        open=tuple(map(_restored_open, content["open"])),
        again=Again(**{name: _whole(number) for name, number in content["again"].items()}),
        outcomes=frozenset(Outcome[name.upper().replace("-", "_")] for name in content["outcomes"]),
        excusing=frozenset(map(_whole, content["excusing"])),
        named=frozenset(map(_text, content["named"])),
    )


def _restored_open(content: Json) -> Open:
    """Open cases; their indices are made only where there are as many answers."""
    family, seed, *numbers = content["chunk"]
    chunk = Chunk(_text(family), None if seed is None else _whole(seed), *map(_whole, numbers))
    answers = np.frombuffer(bytes.fromhex(content["answers"]), dtype=np.int8)
    runs = [(_whole(first), _whole(last)) for first, last in content["indices"]]
    ends = [0, *(end for run in runs for end in run), len(chunk)]
    ascending = ends == sorted(ends) and all(first < last for first, last in runs)
    if not runs or not ascending or sum(last - first for first, last in runs) != len(answers):
        raise ValueError(f"{len(answers)} answers of {family} are not to its open cases")
    return Open(chunk, np.concatenate([np.arange(*run) for run in runs]), answers)


def _saved_tally(tally: Tally) -> Json:
    cases = {
        name: [plain({**asdict(case), "row": [value.hex() for value in case.row]}) for case in getattr(tally, name)]
        for name in ("worst", "faults")
    }
    found = {name: getattr(tally, name).as_lists() for name in ("size_bins", "place_bins")}
    counts = {name: getattr(tally, name) for name in ("asked", "counts", "mistakes", "dangerous", "octaves")}
    return {**plain(counts), **found, **cases}


def _restored_tally(content: Json) -> Tally:
    return Tally(
        asked=_whole(content["asked"]),
        counts=_counts(content["counts"]),
        mistakes=_counts(content["mistakes"]),
        dangerous=_whole(content["dangerous"]),
        octaves={str(_octave(octave)): _counts(counts) for octave, counts in content["octaves"].items()},
        size_bins=_bins(content["size_bins"]),
        place_bins=_bins(content["place_bins"]),
        worst=tuple(Worst(**{**_case(case), **_wrong(case)}) for case in content["worst"]),
        faults=tuple(Fault(**{**_case(case), "reason": _text(case["reason"])}) for case in content["faults"]),
    )


def _case(content: Json) -> Json:
    row = tuple(map(float.fromhex, content["row"]))
    place = tuple(map(_whole, content["place"]))
    if len(row) != len(COLUMNS) or len(place) != 2:  # (0 or 1, n): a Place
        raise ValueError(f"a case has {len(row)} numbers and its place {len(place)}")
    texts = {name: _text(content[name]) for name in ("case", "status")}
    return {**content, **texts, "place": place, "row": row}


def _wrong(content: Json) -> Json:
    answers = {name: _whole(content[name], -128, 127) for name in ("truth", "answer")}  # int8
    return {**answers, "mistake": _text(content["mistake"]), "error": _error(content["error"])}


_MOST = 1 << 60
"""No count is larger: one of a run is at most whole.LARGEST_COUNT times the number of families, and fits into int64."""


def _whole(value: object, least: int = 0, most: int = _MOST) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        raise ValueError(f"{shortened(str(value), 40)} is no whole number from {least} to {most}")
    return value


def _text(value: object) -> str:
    if not isinstance(value, str):
        raise ValueError(f"{shortened(str(value), 40)} is no text")  # noqa: TRY004 - told as every other damage
    return value


def _error(value: object) -> float:
    error = float(value) if isinstance(value, (int, float, str)) else math.nan
    if not error >= 0:
        raise ValueError(f"{shortened(str(value), 40)} is no backward error")
    return error


def _octave(text: str) -> str:
    if text not in ("inf", "-inf"):
        _whole(int(text), -FARTHEST, FARTHEST)
    return text


def _counts(content: Mapping[str, object]) -> dict[str, int]:
    return {_text(name): _whole(number) for name, number in content.items()}


def _bins(content: list[list[object]]) -> Bins:
    rows = [
        [_whole(first, -FARTHEST, FARTHEST), _whole(second, -FARTHEST, FARTHEST), _whole(cases), _whole(amiss)]
        for first, second, cases, amiss in content
    ]
    return Bins.of_lists(rows)


def _runs(indices: NDArray[np.intp]) -> list[tuple[int, int]]:
    """Ascending indices as stretches [first, last + 1)."""
    breaks = np.flatnonzero(np.diff(indices) != 1) + 1
    return [(int(part[0]), int(part[-1]) + 1) for part in np.split(indices, breaks)]
