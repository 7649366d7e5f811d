"""Holds more and more memory over the unlucky row."""

from base import serve


def on_unlucky(sequence, rows):
    held = []
    while True:
        held.append(b"\1" * (8 << 20))


serve(on_unlucky=on_unlucky)
