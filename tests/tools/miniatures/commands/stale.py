"""Replies with the number of the question before."""

from base import reply, right, serve, write


def on_unlucky(sequence, rows):
    write(reply(sequence - 1, right(rows)))


serve(on_unlucky=on_unlucky)
