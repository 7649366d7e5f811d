"""Gives its answers one by one, the first word of the command line apart in seconds; one after the second word."""

import sys
import time

from base import right, serve, write

LONGER = 10


def on_any(sequence, rows):
    write(f"{sequence} {len(rows)}\n")
    for place, answer in enumerate(right(rows)):
        time.sleep(float(sys.argv[2 if place == LONGER and len(sys.argv) > 2 else 1]))
        write(f"{answer}\n")


serve(on_any=on_any)
