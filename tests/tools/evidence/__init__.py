"""Evidence about our code: coverage, fuzzing, mutants and faults; docs/evidence.md is printed from their figures."""
