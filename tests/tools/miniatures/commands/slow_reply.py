"""Needs long for the unlucky row, which is no fault."""

import time

from base import reply, right, serve, write


def on_unlucky(sequence, rows):
    time.sleep(0.35)
    write(reply(sequence, right(rows)))


serve(on_unlucky=on_unlucky)
