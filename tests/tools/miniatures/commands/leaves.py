"""Ends by itself in the middle of a reply."""

import sys

from base import serve, write


def on_unlucky(sequence, rows):
    write(f"{sequence} {len(rows)}\n")
    sys.exit("terminate called after throwing an instance of std::out_of_range")


serve(on_unlucky=on_unlucky)
