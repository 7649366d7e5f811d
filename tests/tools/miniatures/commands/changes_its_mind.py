"""Describes itself in another way each time, and dies of the unlucky row."""

import os

from base import serve


def on_unlucky(sequence, rows):
    os.abort()


serve(on_unlucky=on_unlucky, claims={"version": os.urandom(8).hex()})
