"""Verify for a long time against implementations that fail in every way: `python -m tests.tools.soak --help`.

What is looked at between two runs is the process itself: memory, handles, processes, temporary files. Each may be
of any size, but must not grow.
"""
