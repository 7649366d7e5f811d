"""Always right about ways: `times` gives times too, `leaning` takes axes, `late` a time that is none."""

import math
import sys
from fractions import Fraction

from base import serve

from hypcheck import passage

TIMES, LEANING = "times" in sys.argv, "leaning" in sys.argv


def right(rows):
    assert all(len(row) == (13 if LEANING else 10) for row in rows)
    found = [passage(row[:4], row[4:7], row[7:10]) for row in rows]
    if "nan" in sys.argv:
        return [(int(each.hit), math.nan) for each in found]
    if not TIMES:
        return [int(each.hit) for each in found]
    return [(int(each.hit), float(Fraction(each.first_lower)) if each.hit else math.nan) for each in found]


def total(answers):
    return sum(each[0] if isinstance(each, tuple) else each for each in answers)


claims = {"question": "passage", **({"times": True} if TIMES else {}), **({"tilt": True} if LEANING else {})}
serve(right, claims=claims, checksum=total)
