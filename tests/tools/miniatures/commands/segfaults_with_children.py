"""Dies while a child of its own holds its output open."""

import os
import subprocess
import sys

from base import serve


def on_unlucky(sequence, rows):
    subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"])
    os.abort()


serve(on_unlucky=on_unlucky)
