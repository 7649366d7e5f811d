"""Small records of sample lines, made through the Recorder, builders of further lines, and ways to spoil them."""

from __future__ import annotations

import json
from pathlib import Path

from hypothesis import strategies as st

from hypcheck.record import SCHEMA, Record, Recorder, RecordLine, plain
from hypcheck.record.reader import line_of
from tests.support.records import GrowingText, resealed

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
    first = next(line for line in lines() if line["type"] == "finding")
    where = {"formula": formula, "family": family, "first_case": f"{family}/1/1/0"}
    return {**first, **where, "inside": inside, "cause": cause, "reason": reason}


def sample(name):
    """The lines of a file beside this one: "verification", a run in which all held; "benchmark"; "failures"."""
    text = Path(__file__).with_name("samples").joinpath(f"{name}.jsonl").read_text(encoding="utf-8")
    return [json.loads(line) for line in text.splitlines()]


def lines():
    """The lines between header and footer of a run in which all held."""
    return sample("verification")


DISAGREEMENT, UNPROVED, EXACT_WRONG, CRASHED, DRIFT = sample("failures")[:5]

HEADER = {
    "type": "header",
    "schema": SCHEMA,
    "hypcheck": "0.0.9",
    "started": "2026-01-02T03:04:05+06:00",
    "python": "3.11.7",
    "versions": {"numpy": "2.4.6"},
    "machine": {"system": "Linux", "architecture": "x86_64", "processor": "a processor", "cores": None},
    "options": {"seed": 1, "tolerance": 8.0, "baseline": "before/record.jsonl", "reference": "table-2-numpy-float32"},
    "settings": {"file": "hypcheck.toml", "weakened": []},
}


def every_line():
    """The bytes of a record with all these samples: what no right program writes, and a real run seldom."""
    body = [line for name in ("verification", "benchmark", "failures") for line in sample(name)]
    footer = {"type": "footer", "lines": len(body) + 2, "exit_code": 6, "seconds": 12.5}
    return resealed([HEADER, *body, footer])


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
