"""The machine-checked proofs: Coq sources, the program that reads cases for the extracted checker, and their build."""
