"""Writes its argument as its description, in one line, and waits."""

import sys

sys.stdout.write(sys.argv[1] + "\n")
sys.stdout.flush()
sys.stdin.read()
