"""Replies before it has read the rows; with an argument, reports an error instead."""

import sys
import time

from base import read, write

write('{"protocol": 1, "name": "hasty"}\n')
while words := sys.stdin.buffer.readline().split():
    sequence, n = int(words[1]), int(words[2])
    write("error cannot\n" if sys.argv[1:] else f"{sequence} {n}\n" + "0\n" * n)
    if not sys.argv[1:]:
        if n > 1:
            time.sleep(1)  # who reads on at once is seen only by who looks at once
        read(sys.stdin.buffer, n, "text", {})
