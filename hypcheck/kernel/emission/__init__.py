"""Kernels in other languages, written from a scene's plan: small, readable, without anything that the plan omits."""
