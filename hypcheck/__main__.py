"""`python -m hypcheck`, the same as `hypcheck`."""

import sys

from hypcheck.cli.main import main

if __name__ == "__main__":
    sys.exit(main())
