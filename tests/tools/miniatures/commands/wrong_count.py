"""Announces another number of answers than there are rows."""

from base import reply, right, serve, write


def on_unlucky(sequence, rows):
    write(reply(sequence, [*right(rows), 1]))


serve(on_unlucky=on_unlucky)
