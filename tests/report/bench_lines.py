"""A small benchmark's record with every type of line, as a run of `hypcheck bench` writes them."""

from __future__ import annotations

import math

from tests.report.record_samples import ON_THE_RING, TOWER, hexes, record

OPTIONS = {"command": "bench", "quick": True, "seed": 1, "processes": 2, "rounds": 3}

WORKLOADS = {
    "uniform": "Rows drawn evenly over a box around the tower.",
    "flight": "A drone's way around the tower, a row a time step.",
    "near-contact": "Rows at distances of 2^-50 to 1/2 from contact.",
}

METHODS = (
    # name, tier, kind, precision, exact, amortised, accuracy only, least octave without an error, ns a row
    ("fast", "C", "certified", "float64", True, None, False, None, 2.0),
    ("dual-numpy-float32", "numpy", "algebraic", "float32", False, None, False, -24, 60.0),
    ("table-2-numpy-float32", "numpy", "paper", "float32", False, None, False, -6, 18.0),
    ("table-2-numpy-float16", "numpy", "paper", "float16", False, None, True, 1, None),
    ("table-2-c-float64", "C", "paper", "float64", False, None, False, -40, 1.5),
    ("numpy-roots", "numpy", "roots", "float64", False, None, False, -25, 20000.0),
    ("mpmath-30", "python", "roots", "30 digits", False, None, False, -50, 700000.0),
    ("rational", "python", "exact", "exact", True, None, False, None, 80000.0),
    ("fcl-sphere-1000", "FCL", "mesh", "float64", False, "build once", False, -9, 200000.0),
    ("bounding-sphere", "C", "bounding", "float64", False, None, False, 1, 1.2),
    ("foreign-adapter", "foreign", "foreign", "float32", False, None, False, -12, 5.0),
)


def method(name, tier, kind, precision, exact, amortised, accuracy_only):
    return {
        "type": "method",
        "method": name,
        "title": f"what {name} is",
        "tier": tier,
        "kind": kind,
        "precision": precision,
        "question": "position",
        "exact": exact,
        "amortised": amortised,
        "accuracy_only": accuracy_only,
        "note": "asked one row at a time" if tier == "python" else "",
    }


def accuracy(name, workload, border):
    """Half the answers of every octave below `border` are wrong, and none above; none at all for None."""
    octaves = [[exponent, 100, 50 if border is not None and exponent < border else 0] for exponent in range(-50, 0, 2)]
    if workload == "near-contact":
        octaves.insert(0, ["-inf", 20, 10 if border is not None else 0])
    wrong = sum(row[2] for row in octaves)
    above = 0.0 if not wrong else math.inf if border > 0 else 2.0**border
    case = {
        "case": f"{workload}/1/1/7",
        "row": hexes(ON_THE_RING),
        "truth": 1,
        "answer": 0,
        "flip_distance": 2.0**-7,
    }
    return {
        "type": "accuracy",
        "method": name,
        "workload": workload,
        "asked": sum(row[1] for row in octaves),
        "wrong": wrong,
        "false_clear": wrong // 5,
        "false_contact": wrong - wrong // 5,
        "wrong_side": 0,
        "abstained": 0,
        "octaves": octaves,
        "reliable_above": above,
        "worst": [case] if wrong else [],
    }


def speed(name, workload, mode, ns, reference_ns):
    ratio = ns / reference_ns
    return {
        "type": "speed",
        "method": name,
        "workload": workload,
        "mode": mode,
        "rows": 1 if mode != "batch" else 10_000,
        "loops": 8,
        "samples_ns": [[ns, ns * 1.02, ns * 0.99], [ns * 1.01, ns, ns * 1.03]],
        "median_ns": ns,
        "ci95_ns": [ns * 0.97, ns * 1.05],
        "ratio": ratio,
        "ratio_ci95": [ratio * 0.96, ratio * 1.04],
        "checksum": 12,
        "empty_ns": 30.0,
        "timed_by": "process" if mode == "build" else "worker",
    }


def measured():
    """The lines about each method on each workload."""
    found = []
    for name, _, _, _, _, amortised, accuracy_only, border, ns in METHODS:
        for place, workload in enumerate(WORKLOADS):
            found.append(accuracy(name, workload, border))
            if not accuracy_only:
                found.append(speed(name, workload, "batch", ns * (1 + place / 10), 18.0))
        if not accuracy_only:
            found.append(speed(name, "uniform", "single", ns * 3 + 90, 18 * 3 + 90))
            found.append({"type": "memory", "method": name, "rows": 10_000, "peak_bytes": 4096 * round(ns)})
        if amortised:
            found.append({**speed(name, "uniform", "build", 2e6, 1.0), "ratio": None, "ratio_ci95": None})
    return found


def stability(name, precision, border):
    bins = [[i, j, 40, 20 if i + j > border else 0] for i in range(-2, 9) for j in range(-2, 9)]
    return {"type": "stability", "method": name, "precision": precision, "bins": bins}


def places(name, region, wrong):
    alpha, gamma, b, d = TOWER
    return {
        "type": "places",
        "method": name,
        "scene": {"alpha": alpha, "gamma": gamma, "b": b, "d": d},
        "r": [0.0, 34.0, len(wrong[0])] if region == "whole" else [29.7, 29.8, len(wrong[0])],
        "z": [-17.8, 17.8, len(wrong)] if region == "whole" else [-0.05, 0.05, len(wrong)],
        "wrong": wrong,
        "region": region,
    }


def convergence(triangles):
    return {
        "type": "convergence",
        "method": "fcl-sphere",
        "triangles": triangles,
        "build_ns": 2000.0 * triangles,
        "query_ns": 3e4 * math.sqrt(triangles),
        "deviation": 0.045 / triangles * 100,
        "asked": 500,
        "wrong": 500 // triangles,
    }


def bounding(shape):
    overlap = [[ratio, 200, round(180 * abs(1 - ratio)), 0.1 / ratio] for ratio in (0.1, 0.5, 1.0)]
    return {
        "type": "bounding",
        "shape": shape,
        "workload": "uniform",
        "asked": 600,
        "false_contact": sum(row[2] for row in overlap),
        "false_clear": 0,
        "overlap": [*overlap, [2.0, 0, 0, None]],
    }


def cost(claim, verdict):
    return {
        "type": "cost",
        "claim": claim,
        "scene": "the tower",
        "compared": [
            {"name": "2.a", "operations": {"+": 10, "*": 12}, "median_ns": 9.0, "ratio": 1.0, "ratio_ci95": [1.0, 1.0]},
            {"name": "2.b", "operations": None, "median_ns": 6.0, "ratio": 0.66, "ratio_ci95": [0.6, 0.7]},
        ],
        "verdict": verdict,
        "says": "Procedure 2.b took 0.66 of the time of 2.a.",
    }


def kernel(name, measured_value, met):
    return {
        "type": "kernel",
        "name": name,
        "target": "queries a second against the plain formula",
        "wanted": 0.8,
        "measured": measured_value,
        "ci95": [measured_value - 0.02, measured_value + 0.02],
        "met": met,
        "says": f"{measured_value} of the plain formula's speed",
    }


def forest(name, trees, ns):
    return {
        "type": "forest",
        "method": name,
        "title": f"what {name} is",
        "exact": name == "hypcheck.Scene",
        "trees": trees,
        "triangles": None if name == "hypcheck.Scene" else 128,
        "asked": 256,
        "wrong": 0,
        "build_s": trees / 1e6,
        "step_ns": ns,
        "ci95_ns": [ns - 10, ns + 10],
        "ratio": ns / 1200,
        "ratio_ci95": [ns / 1300, ns / 1100],
    }


def scene(name, ratio):
    return {
        "type": "scene",
        "scene": name,
        "question": "interior",
        "precision": "float64",
        "settings": 2,
        "rows": 131_072,
        "wrong": 0,
        "shares": {"always": 0.0, "thresholds": 0.0, "lines": 0.96, "discriminant": 0.04, "search": 0.0},
        "batch": scene_times(ratio),
        "single": scene_times(ratio / 2),
    }


def comparison(name, after, verdict):
    return {
        "type": "comparison",
        "method": name,
        "workload": "uniform",
        "mode": "batch",
        "before": 1.0,
        "after": after,
        "change": after,
        "ci95": [after * 0.98, after * 1.02],
        "verdict": verdict,
        "allowed": 1.1,
        "gates": verdict == "same",
    }


def lines():
    """The lines between header and footer of a benchmark in which nothing was slower than its baseline allows."""
    return [
        *(method(*each[:7]) for each in METHODS),
        *(
            {"type": "workload", "workload": name, "title": f"the {name} rows", "rows": 2500, "seed": 1, "text": text}
            for name, text in WORKLOADS.items()
        ),
        {
            "type": "absent",
            "what": "coal",
            "reason": "coal cannot be imported; pip install 'hypcheck[peers]' brings it",
        },
        {"type": "compiler", "program": "/usr/bin/cc", "version": "cc 12.2.0", "flags": ["-O3", "-std=c99"]},
        *measured(),
        {
            "type": "conditions",
            "governor": None,
            "processors": 2,
            "load_before": [0.5, 0.75, 1.0],
            "load_after": [1.0, 0.75, 1.0],
        },
        {
            "type": "noise",
            "workload": "uniform",
            "mode": "batch",
            "ratio": 1.003,
            "ratio_ci95": [0.99, 1.02],
            "floor": 0.02,
        },
        stability("table-2", "float32", 3),
        stability("table-2", "float64", 30),
        places("table-2-numpy-float32", "whole", ["....", "..w.", "...."]),
        places("table-2-numpy-float32", "ring", ["....", "wwww", "..c."]),
        *(convergence(triangles) for triangles in (100, 1000, 10000)),
        bounding("sphere"),
        bounding("cylinder"),
        cost("Procedure 2.b costs less than 2.a (§ 4)", "holds"),
        cost("only additions and products (§ 1)", "does not hold"),
        kernel("certified, batch", 0.9, met=True),
        kernel("rows, batch", 0.8, met=True),
        *(
            forest(name, trees, ns)
            for name, ns in (("hypcheck.Scene", 1200.0), ("fcl-meshes", 2400.0))
            for trees in (10, 10**6)
        ),
        scene("cooling tower", 0.6),
        comparison("fast", 0.98, "same"),
        comparison("foreign-adapter", 1.02, "inconclusive"),
    ]


def bench_record(body=None, exit_code=0, options=None):
    """The record of these lines, the sample's own unless given; None as exit code: truncated."""
    return record(lines() if body is None else body, exit_code, {**OPTIONS, **(options or {})})


def scene_times(ratio):
    return {
        "kernel_ns": ratio,
        "printed_ns": 1.0,
        "certified_ns": 2.0,
        "by_printed": ratio,
        "by_printed_ci95": [ratio - 0.1, ratio + 0.1],
        "by_certified": ratio / 2,
        "by_certified_ci95": [ratio / 2 - 0.1, ratio / 2 + 0.1],
    }
