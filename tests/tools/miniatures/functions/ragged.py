"""Answers of several lengths."""


def classify(rows):
    return [[1], [1, 0]] * len(rows)
