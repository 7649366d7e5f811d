"""Starts, and stays without a description; its argument tells what it does meanwhile: nothing, drip, flood."""

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
