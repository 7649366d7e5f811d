"""Always right, with a description."""

from hypcheck.kernel.classify import classify

hypcheck = {"name": "right", "version": "2.1", "domain": {"regimes": ["a>=1"], "ratio": [0.1, 10]}}
__all__ = ["classify", "hypcheck"]
