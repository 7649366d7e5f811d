"""Reports an error about the unlucky row, with what a terminal would obey in it."""

from base import serve, write


def on_unlucky(sequence, rows):
    write("error no root found \x1b[2J\n")


serve(on_unlucky=on_unlucky)
