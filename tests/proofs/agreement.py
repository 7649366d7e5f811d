"""The proved checker against truth/certificate.py, on certificates right and wrong: `python -m tests.proofs.agreement`.

Rows are drawn from all families. Each gets the certificate of its exact answer and others that are wrong, or nearly so:
another claim, a multiplier at a pole or beyond it, a root moved a little, points moved outwards or left out.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction

from hypcheck.geometry.pair import Pair, Position
from hypcheck.proofs.build import BUILT, CHECKER
from hypcheck.vectors.families import FAMILIES
from tests.support.inside import Certificate, check_certificate, prove

BATCH = 5000


def certificates(pair: Pair) -> Iterator[Certificate]:
    """The right certificate first, then others, one thing changed in each."""
    right = prove(pair)
    yield right
    for claim in Position:
        if claim is not right.position:
            yield replace(right, position=claim)
    alpha, gamma, b, d, x, y, z = map(Fraction, pair.row)
    A, B = (alpha / b) ** 2, (gamma / d) ** 2
    if right.multiplier is not None:
        for at in (-right.multiplier, Fraction(0), -A, B, 2 * right.multiplier, right.multiplier / 1024):
            yield replace(right, multiplier=at)
        yield Certificate(Position.CONTACT, double_root=right.multiplier)
        yield Certificate(Position.CONTACT, points=((x, y, z),))
    elif right.double_root is not None:
        m = right.double_root
        for at in (-m, Fraction(0), -A, B, m * (1 + Fraction(1, 1 << 60))):
            yield replace(right, double_root=at)
        yield Certificate(Position.EXTERIOR, multiplier=m)
        yield Certificate(Position.INTERIOR, multiplier=m)
    else:
        yield replace(right, points=right.points[:1])
        yield replace(right, points=(*right.points, (x + b, y, z)))
        yield replace(right, points=(*right.points, (x + b * (1 + Fraction(1, 1 << 60)), y, z)))
        yield replace(right, points=((x + b * Fraction(3, 5), y, z + d * Fraction(4, 5)), (x, y, z - d)))


def line(pair: Pair, certificate: Certificate) -> str:
    """A question for `check_cases --rows`."""
    if certificate.multiplier is not None:
        kind, numbers = "multiplier", [certificate.multiplier]
    elif certificate.double_root is not None:
        kind, numbers = "double_root", [certificate.double_root]
    else:
        kind, numbers = "points", [number for point in certificate.points for number in point]
    words = (int(certificate.position), kind, *(number.hex() for number in pair.row), *numbers)
    return " ".join(map(str, words))


def questions(count: int, seed: int = 1) -> Iterator[tuple[Pair, Certificate]]:
    """So many rows with a certificate each, from every family in turn."""
    each = -(-count // (len(FAMILIES) * 8))
    for family in FAMILIES.values():
        for row in family.rows(seed, each).tolist():
            pair = Pair.from_row(row)
            for certificate in certificates(pair):
                yield pair, certificate


def verdicts(asked: list[tuple[Pair, Certificate]]) -> list[bool]:
    """What the proved checker says of each."""
    text = "".join(line(*question) + "\n" for question in asked)
    done = subprocess.run([BUILT / CHECKER, "--rows"], input=text, capture_output=True, text=True, check=True)
    return [answer == "1" for answer in done.stdout.split()]


def disagreements(count: int, seed: int = 1) -> tuple[int, int, list[str]]:
    """How many certificates were asked about, how many prove their claim, and the questions with two answers."""
    number = proved = 0
    different: list[str] = []
    batch: list[tuple[Pair, Certificate]] = []
    source = questions(count, seed)
    while True:
        batch = [question for _, question in zip(range(BATCH), source, strict=False)]
        if not batch:
            return number, proved, different
        for question, answer in zip(batch, verdicts(batch), strict=True):
            number += 1
            proved += answer
            if check_certificate(*question) is not answer:
                different.append(line(*question))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=1_000_000)
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    number, proved, different = disagreements(asked.count, asked.seed)
    for question in different[:20]:
        print(question)  # noqa: T201
    print(f"{number} certificates, {proved} of them proofs; {len(different)} with two answers")  # noqa: T201
    sys.exit(bool(different))


if __name__ == "__main__":
    main()
