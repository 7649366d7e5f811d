"""Gives its answers one by one, slowly, the first after the word of the command line in seconds and so each further."""

import sys
import time

from base import right, serve, write


def on_any(sequence, rows):
    write(f"{sequence} {len(rows)}\n")
    for answer in right(rows):
        time.sleep(float(sys.argv[1]))
        write(f"{answer}\n")


serve(on_any=on_any)
