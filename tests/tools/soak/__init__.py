"""Verify for a long time against implementations that fail in every way: `python -m tests.tools.soak --help`.

Between two runs the process itself is measured: memory, handles, processes, temporary files. Each may have any size,
but must not grow.
"""
