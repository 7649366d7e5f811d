"""Writes a byte of its reply now and then, so that it never stops for long."""

import time

from base import serve, write


def on_unlucky(sequence, rows):
    for byte in f"{sequence} " + " " * 1000:
        write(byte)
        time.sleep(0.05)


serve(on_unlucky=on_unlucky)
