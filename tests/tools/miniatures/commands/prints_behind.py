"""Prints that it is done, behind its reply."""

import time

from base import reply, right, serve, write


def on_unlucky(sequence, rows):
    write(reply(sequence, right(rows)))
    time.sleep(0.1)
    write("done\n")


serve(on_unlucky=on_unlucky)
