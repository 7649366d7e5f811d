"""Declares float16, and a question."""

hypcheck = {"precision": "float16", "question": "exterior"}


def classify(rows):
    return [1] * len(rows)
