"""Begins a line that never ends."""

from base import serve, write


def on_unlucky(sequence, rows):
    while True:
        write("1" * 4096)


serve(on_unlucky=on_unlucky)
