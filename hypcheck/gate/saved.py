"""A state of a run as JSON and back: what a run that was interrupted goes on from, here or elsewhere.

Numbers that must come back exactly are hexadecimal; infinities are the strings that float() reads.
"""

from __future__ import annotations

from dataclasses import asdict, astuple
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.bins import Bins
from hypcheck.gate.chunks import Chunk
from hypcheck.gate.results import Again, Open, Result
from hypcheck.gate.schedule import State
from hypcheck.groups import Fault, Tally, Worst
from hypcheck.methods.faults import Outcome
from hypcheck.methods.runs import Allowance
from hypcheck.record import plain

Json = dict[str, Any]


def saved(state: State) -> Json:
    """The state as a mapping that JSON can hold."""
    return {"done": state.done, "left": asdict(state.left), "total": saved_result(state.total)}


def restored(content: Json) -> State:
    """The state of such a mapping."""
    return State(Allowance(**content["left"]), content["done"], restored_result(content["total"]))


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
    """The result of such a mapping."""
    return Result(
        tallies={family: _restored_tally(tally) for family, tally in content["tallies"].items()},
        open=tuple(
            Open(
                Chunk(*each["chunk"]),
                np.concatenate([np.arange(*run) for run in each["indices"]]),
                np.frombuffer(bytes.fromhex(each["answers"]), dtype=np.int8),
            )
            for each in content["open"]
        ),
        again=Again(**content["again"]),
        outcomes=frozenset(Outcome[name.upper().replace("-", "_")] for name in content["outcomes"]),
        excusing=frozenset(content["excusing"]),
        named=frozenset(content["named"]),
    )


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
        **{name: content[name] for name in ("asked", "counts", "mistakes", "dangerous", "octaves")},
        size_bins=Bins.of_lists(content["size_bins"]),
        place_bins=Bins.of_lists(content["place_bins"]),
        worst=tuple(Worst(**{**_case(case), "error": float(case["error"])}) for case in content["worst"]),
        faults=tuple(Fault(**_case(case)) for case in content["faults"]),
    )


def _case(content: Json) -> Json:
    return {**content, "place": tuple(content["place"]), "row": tuple(map(float.fromhex, content["row"]))}


def _runs(indices: NDArray[np.intp]) -> list[tuple[int, int]]:
    """Ascending indices as stretches [first, last + 1)."""
    breaks = np.flatnonzero(np.diff(indices) != 1) + 1
    return [(int(part[0]), int(part[-1]) + 1) for part in np.split(indices, breaks)]
