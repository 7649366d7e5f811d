"""Never returns from the unlucky row."""

from base import serve


def on_unlucky(sequence, rows):
    while True:
        pass


serve(on_unlucky=on_unlucky)
