"""Writes the number of answers with a width, so that more than one blank separates it from the question's number."""

from base import right, serve, write


def on_unlucky(sequence, rows):
    write(f"{sequence} {len(rows):5d}\n" + "".join(f"{answer}\n" for answer in right(rows)))


serve(on_unlucky=on_unlucky)
