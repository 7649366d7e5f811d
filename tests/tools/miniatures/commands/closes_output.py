"""Closes its standard output and does not end."""

import os
import time

from base import serve


def on_unlucky(sequence, rows):
    os.close(1)
    time.sleep(60)


serve(on_unlucky=on_unlucky)
