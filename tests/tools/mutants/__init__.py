"""Wrong and right implementations, a few lines and a sentence each, that show that the gate can fail, and only then.

`python -m tests.tools.mutants` gates every one through `hypcheck verify` and prints what became of it.
"""
