"""Says of itself what its argument says, in a line, and waits."""

import sys

sys.stdout.write(sys.argv[1] + "\n")
sys.stdout.flush()
sys.stdin.read()
