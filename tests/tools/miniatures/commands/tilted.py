"""Always right about spheroids whose axis may point anywhere."""

from base import serve

from tests.support.tilted_fractions import exact_position


def right(rows):
    assert all(len(row) == 10 for row in rows)
    return [exact_position(row) for row in rows]


serve(right, claims={"tilt": True})
