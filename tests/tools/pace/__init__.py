"""How many rows `verify` asks in a second, of short runs and of long ones: `python -m tests.tools.pace --help`."""
