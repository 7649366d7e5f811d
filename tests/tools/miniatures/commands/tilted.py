"""Always right about spheroids whose axis may point anywhere."""

from base import serve

from hypcheck.truth.tilted import exact
from hypcheck.truth.tilted.pair import TiltedLengths


def right(rows):
    assert all(len(row) == 10 for row in rows)
    return [int(exact.position(TiltedLengths.of(row))) for row in rows]


serve(right, claims={"tilt": True})
