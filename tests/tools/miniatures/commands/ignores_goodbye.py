"""Does not end when its input ends, and neither does a child of its own."""

import subprocess
import sys
import time

from base import serve

child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"])
serve()
time.sleep(60)
