"""Does not reply to a question with the unlucky row, but to the next."""

from base import serve


def on_unlucky(sequence, rows):
    return


serve(on_unlucky=on_unlucky)
