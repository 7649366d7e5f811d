"""One answer more than rows, if the unlucky one is among them."""

from base import BINARY, reply, right, serve, write


def on_unlucky(sequence, rows):
    write(reply(sequence, right(rows)) + (b"\1" if BINARY else b"1\n"))


serve(on_unlucky=on_unlucky)
