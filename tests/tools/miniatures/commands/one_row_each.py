"""Leaves after each reply, as a program for one question would."""

import sys

from base import reply, right, serve, write


def on_any(sequence, rows):
    write(reply(sequence, right(rows)))
    sys.exit(0)


serve(on_any=on_any)
