"""Declares a key that nobody knows."""

hypcheck = {"presicion": "float32"}


def classify(rows):
    return [0] * len(rows)
