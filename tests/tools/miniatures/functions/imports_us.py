"""Imports hypcheck, which is no description."""

import hypcheck
from hypcheck import classify

__all__ = ["classify", "hypcheck"]
