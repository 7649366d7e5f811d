"""`python -m hypcheck`, the same as `hypcheck`."""

import sys
from pathlib import Path

if __name__ == "__main__" and not getattr(sys.flags, "safe_path", False):
    # Python puts the working directory first; what lies there is data. The folder of a hypcheck that is not installed
    # comes last, for the processes that are started from this one.
    sys.path[:] = [*sys.path[1:], str(Path(__file__).resolve().parents[1])]

from hypcheck.cli.main import process

if __name__ == "__main__":
    process()
