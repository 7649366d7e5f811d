"""Ends before it described itself."""

import sys

sys.stderr.write("Error: Unable to access jarfile gate.jar\n")
sys.exit(1)
