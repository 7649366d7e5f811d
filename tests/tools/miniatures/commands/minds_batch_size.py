"""Right about a single row, wrong about the last of several."""

from base import right, serve


def answers(rows):
    found = right(rows)
    return found if len(found) == 1 else [*found[:-1], 1 if found[-1] < 1 else -1]


serve(answers)
