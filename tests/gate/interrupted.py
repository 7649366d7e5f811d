"""A gating run that keeps its progress at every step, of chunks so small that there are many: to be interrupted."""

from __future__ import annotations

import sys

from hypcheck.cli.main import main
from hypcheck.gate import chunks, progress, schedule

if __name__ == "__main__":
    progress.EVERY, progress.SHARE = 0.0, 0
    chunks.SIZE, schedule.ROUND = 1024, 2500
    sys.exit(main())
