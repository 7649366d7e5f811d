"""Declares an unknown key."""

hypcheck = {"presicion": "float32"}


def classify(rows):
    return [0] * len(rows)
