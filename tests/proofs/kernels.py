"""Has Coq prove the bounds of kernels for random scenes in both formats: `python -m tests.proofs.kernels`."""

from __future__ import annotations

import argparse
import sys
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory

from hypcheck.errors import InputError
from hypcheck.kernel.printing.coq import proof_of
from hypcheck.proofs.build import ProofError, check_kernel
from tests.support.inside import FORMATS, plan_of
from tests.support.scenes import random_scene


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=100)
    asked = parser.parse_args()
    proved = bounds = without = 0
    for seed in count():
        if proved == asked.count:
            break
        plan = plan_of(random_scene(seed), list(FORMATS)[seed % 2])
        try:
            text = proof_of(plan)
        except InputError:
            without += 1  # every position of the region is the same, or the format is too small for a discriminant
            continue
        with TemporaryDirectory() as folder:
            path = Path(folder) / "kernel.v"
            path.write_text(text, encoding="utf-8")
            try:
                check_kernel(path)
            except ProofError as error:
                sys.exit(f"seed {seed}: {error}")
        proved += 1
        bounds += text.count("Theorem sign ")
    print(f"{proved} kernels proved, {bounds} bounds in all; {without} scenes need no discriminant")  # noqa: T201


if __name__ == "__main__":
    main()
