"""The C core: hypcheck.h for engines, its parts, and the binding that makes it hypcheck's own kernel."""

from __future__ import annotations

from pathlib import Path

HEADER = Path(__file__).with_name("hypcheck.h")
"""What another program includes."""
