"""Starts a daemon, as daemons are started: by a child that ends, in a session of its own."""

import os
import subprocess
import sys

from base import serve

DAEMON = [sys.executable, "-c", "import time; time.sleep(60)"]
child = os.fork()
if child == 0:
    subprocess.Popen(DAEMON, start_new_session=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    os._exit(0)
os.waitpid(child, 0)
serve()
