"""The speed of `verify` in rows a second, for short and for long runs: `python -m tests.tools.pace --help`."""
