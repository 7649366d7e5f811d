"""Reports a time that is far too short, as from a clock that is read in seconds for nanoseconds."""

import time

from base import serve


def late(answers):
    time.sleep(1.5)
    return sum(answers)


serve(checksum=late, claims={"time": True})
