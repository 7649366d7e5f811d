"""A child of its own holds more and more memory over the unlucky row."""

import subprocess
import sys

from base import serve

EATS = """
held = []
while True:
    held.append(b"1" * (8 << 20))
"""


def on_unlucky(sequence, rows):
    subprocess.run([sys.executable, "-c", EATS], check=True)


serve(on_unlucky=on_unlucky)
