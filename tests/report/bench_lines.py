"""A small benchmark's record with every type of line, as a run of `hypcheck bench` writes them."""

from __future__ import annotations

from tests.report.record_samples import record, sample

OPTIONS = {"command": "bench", "quick": True, "seed": 1, "processes": 2, "rounds": 3}


def lines():
    """The lines between header and footer of a benchmark in which nothing was slower than its baseline allows."""
    return sample("benchmark")


def line(kind, of=None, /, **changes):
    """The first line of a kind, and of a method if one is named, with these changes."""
    found = (each for each in lines() if each["type"] == kind and of in (None, each.get("method")))
    return {**next(found), **changes}


def accuracy(method, workload, **changes):
    """The errors of a method that is reliable above 2^-24, under another name."""
    return line("accuracy", "dual-numpy-float32", method=method, workload=workload, **changes)


def speed(method, workload, mode, ns, reference_ns):
    """The time of a method: a median with its interval, and its ratio to the reference with its interval."""
    ratio, rows = ns / reference_ns, 10_000 if mode == "batch" else 1
    times = {"median_ns": ns, "ci95_ns": [ns * 0.97, ns * 1.05], "samples_ns": [[ns, ns * 1.02, ns * 0.99]] * 2}
    ratios = {"ratio": ratio, "ratio_ci95": [ratio * 0.96, ratio * 1.04]}
    return line("speed", method=method, workload=workload, mode=mode, rows=rows, **times, **ratios)


def bench_record(body=None, exit_code=0, options=None):
    """The record of these lines, the sample's own unless given; None as exit code: truncated."""
    return record(lines() if body is None else body, exit_code, {**OPTIONS, **(options or {})})
