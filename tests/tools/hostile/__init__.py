"""Hostile implementations: what each attacks, how it is asked while it is isolated, and what became of it.

`python -m tests.tools.hostile` runs all and prints a table. Each runs with limits that keep the machine safe where the
isolation failed: few processes, little memory, a small scratch folder, and a deadline of its own.
"""
