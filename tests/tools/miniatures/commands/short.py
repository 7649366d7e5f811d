"""One answer less than rows, if the unlucky one is among them."""

from base import BINARY, reply, right, serve, write


def on_unlucky(sequence, rows):
    whole = reply(sequence, right(rows))
    write(whole[:-1] if BINARY else b"\n".join(whole.split(b"\n")[:-2]) + b"\n")


serve(on_unlucky=on_unlucky)
