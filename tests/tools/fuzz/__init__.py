"""Damaged input for everything that reads: `python -m tests.tools.fuzz --help`.

Each input is made from a real file by a few mutations and is a function of (seed, reader, number), so that one which
fails can be made again. Whatever it is, the reader must give a value or one sentence, in time and in little memory
(judging.py). The inputs that once failed are in corpus/, named by what they show, and are read in every test run.
"""
