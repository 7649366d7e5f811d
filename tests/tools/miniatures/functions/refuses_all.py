"""Refuses every row, as it declares."""

hypcheck = {"refuses": True}


def classify(rows):
    return [127] * len(rows)
