"""The bins of a group's line: each case is in the bin that its sizes and its place say."""

from __future__ import annotations

import math
from collections import Counter

import numpy as np

from hypcheck import groups
from hypcheck.judge import Criterion


def test_bins_count_what_a_plain_loop_counts():
    rng = np.random.default_rng(4)
    rows = 2.0 ** rng.uniform(-9, 9, (500, 7))
    status = rng.choice(["right", "wrong"], 500).astype(object)
    judged = groups.Judged("family", rows, status, (), 0, str)
    line = groups.line(judged, np.zeros(0), Criterion())
    for field, key in (
        ("size_bins", lambda r: (math.floor(math.log2(r[0] / r[2])), math.floor(math.log2(r[1] / r[3])))),
        (
            "place_bins",
            lambda r: (min(63, int(8 * math.hypot(r[4], r[5]) / r[0])), min(63, int(8 * abs(r[6]) / r[1]))),
        ),
    ):
        asked = Counter(key(row) for row in rows.tolist())
        wrong = Counter(key(row) for row, how in zip(rows.tolist(), status, strict=True) if how == "wrong")
        assert {(a, b): (n, w) for a, b, n, w in line[field]} == {at: (asked[at], wrong[at]) for at in asked}
