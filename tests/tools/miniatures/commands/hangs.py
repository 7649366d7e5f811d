"""Never answers any question."""

import time

from base import serve


def on_any(sequence, rows):
    time.sleep(60)


serve(on_any=on_any)
