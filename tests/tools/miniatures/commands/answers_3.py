"""Answers 3 to the unlucky row."""

from base import right, serve


def answers(rows):
    return [3 if row[1] == 13.0 else answer for row, answer in zip(rows, right(rows), strict=True)]


serve(answers)
