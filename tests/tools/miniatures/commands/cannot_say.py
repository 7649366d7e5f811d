"""Cannot say, ever."""

from base import serve


def answers(rows):
    return [2] * len(rows)


serve(answers)
