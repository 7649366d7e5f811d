"""The command line: a module for each command, which loads its work when it runs."""

from __future__ import annotations

COMPLETE = "_HYPCHECK_COMPLETE"
"""The variable by which a shell asks for completions of the words in its other variables, as click names it."""
