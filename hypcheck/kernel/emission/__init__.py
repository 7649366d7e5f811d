"""Kernels written out in other languages from a scene's plan: small, readable, and nothing but what the plan has."""
