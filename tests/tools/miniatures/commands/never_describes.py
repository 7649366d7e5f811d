"""Starts without a description; its argument says what it does instead: nothing, drip, flood."""

import sys
import time

sys.stderr.write("loading tables\n")
sys.stderr.flush()
while "flood" in sys.argv:
    sys.stdout.write("x" * 4096)
while "drip" in sys.argv:
    sys.stdout.write(" ")
    sys.stdout.flush()
    time.sleep(0.02)
time.sleep(60)
