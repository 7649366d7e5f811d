"""Imports hypcheck, which is no description."""

import hypcheck
from tests.support.inside import classify

__all__ = ["classify", "hypcheck"]
