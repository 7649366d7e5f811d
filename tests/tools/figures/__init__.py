"""The pictures of docs/figures.md and of the README, drawn anew: `python -m tests.tools.figures`."""
