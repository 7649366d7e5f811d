"""Prints what it is doing before it replies."""

from base import reply, right, serve, write


def on_unlucky(sequence, rows):
    write("computing the discriminant ...\n")
    write(reply(sequence, right(rows)))


serve(on_unlucky=on_unlucky)
