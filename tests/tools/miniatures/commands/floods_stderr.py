"""Writes a megabyte to standard error, control characters among it, and is right."""

import os

from base import right, serve


def answers(rows):
    flood = b"\x1b[31mwarning \xff\x00\r\n" * 60_000
    while flood:
        flood = flood[os.write(2, flood) :]
    return right(rows)


serve(answers)
