"""Dies of two rows at once, never of one."""

import os

from base import right, serve


def answers(rows):
    if len(rows) > 1:
        os.abort()
    return right(rows)


serve(answers)
