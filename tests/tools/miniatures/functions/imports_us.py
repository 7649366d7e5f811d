"""Imports hypcheck, which is no description."""

import hypcheck
from hypcheck.kernel.classify import classify

__all__ = ["classify", "hypcheck"]
