"""Forgets to return anything."""


def classify(rows):
    rows.sum()
