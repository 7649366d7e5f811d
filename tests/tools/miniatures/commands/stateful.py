"""Right in its first three questions, and the other way round from then on."""

from base import right, serve

asked = []


def answers(rows):
    asked.append(1)
    return [answer if len(asked) <= 3 else -answer for answer in right(rows)]


serve(answers)
