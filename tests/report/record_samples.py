"""A small record with every type of line, made through the Recorder, and ways to spoil it."""

from __future__ import annotations

import json

from hypothesis import strategies as st

from hypcheck.record import Record, Recorder, RecordLine, plain
from hypcheck.record.reader import line_of
from tests.support.records import GrowingText

FOREIGN = st.lists(
    st.one_of(
        st.characters(),
        *(st.characters(categories=[category]) for category in ("Cc", "Cf", "Cs", "Zl", "Zp")),
        st.sampled_from("|`*_<>&'\"\\$[](){}#-+=1.!~@: \t\n\r"),
    ),
    min_size=1,
    max_size=12,
).map(lambda characters: json.loads(json.dumps("".join(characters))))
"""Foreign names and sentences, with characters that terminals and parsers mishandle, as JSON gives them back."""

HELD = (
    "HELD: no disagreement in the cases asked of exact (40), nearest (40) and roots (5), 2 undecided; 2 proofs hold; "
    "fast right on all 40 cases."
)
"""The verdict on lines()."""

TOWER = (2.0, 17.8, 0.25, 0.15)
ON_THE_RING = (1.0, 2.0, 1.0, 1.0, 2.5, -0.0, 0.0)
"""α, γ, b, d and a centre where the discriminant vanishes in the air; any valid row would do."""


def hexes(row):
    return [value.hex() for value in row]


def worst(case, status, error_u, answer=0, truth=1, mistake="false-contact"):
    return {
        "case": case,
        "row": hexes(ON_THE_RING),
        "truth": truth,
        "answer": answer,
        "mistake": mistake,
        "status": status,
        "backward_error": error_u if error_u == "inf" else error_u * 2.0**-53,
        "backward_error_u": error_u,
    }


def group(method, precision, family, counts, cases=(), *, exact=False, mistakes=None, **others):
    asked = sum(number for status, number in counts.items() if status != "skipped")
    not_right = counts.get("wrong", 0) + counts.get("tolerated", 0)
    return {
        "type": "group",
        "exact": exact,
        "title": f"what {method} is, {precision}",
        "method": method,
        "question": "position",
        "precision": precision,
        "family": family,
        "asked": asked,
        "counts": counts,
        "mistakes": mistakes or {},
        "octaves": {"-inf": dict(counts)},
        "size_bins": [[0, 1, asked, not_right]],
        "place_bins": [[20, 0, asked, not_right]],
        "worst": list(cases),
        **others,
    }


def oracle(name, family, stages, *, undecided=0, cases=(), disagreeing=None, seconds=0.25):
    return {
        "type": "oracle",
        "oracle": name,
        "family": family,
        "asked": sum(stages.values()),
        "undecided": undecided,
        "stages": stages,
        "seconds": seconds,
        "disagreeing": len(cases) if disagreeing is None else disagreeing,
        "disagreements": list(cases),
    }


def disagreement(name, case="ring/1/1/3", opinion="contact, tangent: False, None"):
    row = hexes(ON_THE_RING)
    return {
        "oracle": name,
        "case": case,
        "row": row,
        "exact": "exterior, tangent: False, exterior",
        "opinion": opinion,
    }


def finding(formula, family, *, inside, reason, cause="ring"):
    return {
        "type": "finding",
        "formula": formula,
        "family": family,
        "inside": inside,
        "cause": cause,
        "asked": 60,
        "wrong": 12,
        "first_case": f"{family}/1/1/0",
        "first_row": hexes(ON_THE_RING),
        "reason": reason,
    }


def timing(name, samples):
    return {
        "type": "timing",
        "workload": "tower-body",
        "median_ns": sorted(samples)[len(samples) // 2],
        "name": name,
        "title": f"how {name} works",
        "rows": 1000,
        "loops": 3,
        "samples_ns": list(samples),
        "checksum": 12,
    }


def lines():
    """The lines between header and footer of a run in which all held."""
    equation = {"type": "equation", "number": "1", "holds": True, "verdict": "holds", "statement": "x² = 1"}
    misprint = {"type": "equation", "number": "12", "holds": False, "verdict": "misprint", "statement": "g = λ³ + x_c²"}
    return [
        {"type": "unavailable", "oracle": "mesh", "reason": "python-fcl cannot be imported"},
        {**equation, "finding": "right − left = 0", "correction": ""},
        {**misprint, "finding": "the coefficient of λ² lacks − z_c²", "correction": "g = λ³ + x_c² − z_c²"},
        {
            "type": "proof",
            "formula": "table-2",
            "quantity": "c2",
            "holds": True,
            "statement": "c2 is A − B + 1 − P − Q",
        },
        {"type": "proof", "formula": "table-2", "quantity": "c2", "holds": True, "statement": "c2 of A, B is …"},
        oracle("exact", "ring", {"proved": 20}),
        oracle("exact", "tower-body", {"proved": 20}),
        oracle("nearest", "ring", {"double-double": 15, "exact": 5}),
        oracle("nearest", "tower-body", {"double-double": 20}),
        oracle("roots", "ring", {"signs suffice": 3, "undecided": 2}, undecided=2, seconds=0.0004),
        finding("table-2", "ring", inside=True, reason="the ring: Δ = 0 without contact"),
        finding("procedure-1", "ring", inside=True, reason="the ring: Δ = 0 without contact"),
        finding("table-2", "out-of-regime", inside=False, reason=None, cause="none known"),
        group("fast", "float64", "ring", {"right": 20}, exact=True),
        group("fast", "float64", "tower-body", {"right": 20}, exact=True),
        group(
            "table-2-float32",
            "float32",
            "ring",
            {"right": 9, "skipped": 1, "tolerated": 4, "wrong": 6},
            [worst("ring/1/1/7", "wrong", "inf"), worst("ring/1/1/2", "wrong", 3.1e6)],
            mistakes={"false-clear": 1, "false-contact": 9},
        ),
        group(
            "table-2-float32",
            "float32",
            "tower-body",
            {"right": 19, "tolerated": 1},
            [worst("tower-body/1/1/5", "tolerated", 2.5)],
            mistakes={"false-contact": 1},
        ),
        group("table-2-float64", "float64", "ring", {"right": 20}),
        group("table-2-float64", "float64", "tower-body", {"skipped": 20}),
        {
            "type": "map",
            "name": "cooling tower",
            "method": "table-2-float32",
            "sizes": list(TOWER),
            "r": [0.0, 34.0],
            "z": [-17.8, 17.8],
            "wrong": 1,
            "points": 15,
            "lines": ["iceee", "iceEe", "iceee"],
        },
        {
            "type": "map",
            "name": "the ring",
            "method": "table-2-float32",
            "sizes": list(TOWER),
            "r": [29.7, 29.8],
            "z": [-0.05, 0.05],
            "wrong": 4,
            "points": 9,
            "lines": ["eee", "EEE", "eEe"],
        },
        timing("fast path", [50.0, 90.0, 80.0]),
        timing("plain numpy formula", [100.0, 100.0, 200.0]),
    ]


def record(body=None, exit_code=0, options=None) -> Record:
    """The record of these lines (the sample's own unless given), through the Recorder; None as exit code: truncated."""
    return text_and_record(body, exit_code, options)[1]


def text_and_record(body=None, exit_code=0, options=None):
    stream = GrowingText()
    recorder = Recorder(stream, {"seed": 1, "tolerance": 8.0} if options is None else options)
    for line in lines() if body is None else body:
        recorder.add(line if isinstance(line, RecordLine) else line_of(plain(line)))
    made = recorder.close(0 if exit_code is None else exit_code)
    text = stream.text
    if exit_code is None:
        made = Record(made.header, made.lines, None)
        text = text[: text.rstrip("\n").rindex("\n") + 1]
    return text, made


def rewritten(changed, old: str, new: str):
    """The lines with every text `old` in them replaced by `new`: names, titles, keys."""
    text = json.dumps(changed)
    return json.loads(text.replace(json.dumps(old)[1:-1], json.dumps(new)[1:-1]))
