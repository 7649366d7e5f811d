"""Stops the process that asks it before it answers the unlucky row."""

import os
import signal

from base import reply, right, serve, write


def on_unlucky(sequence, rows):
    os.kill(os.getppid(), signal.SIGSTOP)
    write(reply(sequence, right(rows)))


serve(on_unlucky=on_unlucky)
