"""Forgets the line before the answers."""

from base import right, serve, write


def on_any(sequence, rows):
    write("".join(f"{answer}\n" for answer in right(rows)))


serve(on_any=on_any)
