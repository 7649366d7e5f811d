"""What it timed took longer than it says, as of a clock read in seconds for nanoseconds."""

import time

from base import serve


def late(answers):
    time.sleep(1.5)
    return sum(answers)


serve(checksum=late, claims={"time": True})
