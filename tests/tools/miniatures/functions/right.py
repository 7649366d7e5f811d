"""Always right, with a description."""

from tests.tools.mutants.exactly import position as classify

hypcheck = {"name": "right", "version": "2.1", "domain": {"regimes": ["a>=1"], "ratio": [0.1, 10]}}
__all__ = ["classify", "hypcheck"]
