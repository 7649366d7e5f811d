"""The designs of hypcheck/vectors/crossed.toml anew: `python -m tests.tools.covering`.

covertable makes them: any three values of different factors that go together do so in one combination.
"""

from __future__ import annotations

from pathlib import Path

import covertable

from hypcheck.vectors import crossed

FILE = Path(crossed.__file__).with_suffix(".toml")
STRENGTH = 3
HEAD = """\
# Made by `python -m tests.tools.covering`: combinations of the values of the factors in crossed.py, a hexadecimal digit
# for each factor, such that any three values that go together do so in one of them.
"""


def combinations(name: str) -> list[tuple[int, ...]]:
    """Of a family's factors: the places of their values."""
    factors = crossed.FACTORS[name]
    keys = {factor: f"factor{place}" for place, factor in enumerate(factors)}
    never = [
        {
            "operator": "and",
            "conditions": [_equals(keys[factor], factor.index(value)) for factor, value in each.items()],
        }
        for each in crossed.NEVER
        if set(each) <= set(factors)
    ]
    constraints = [{"operator": "not", "condition": condition} for condition in never]
    values = {keys[factor]: list(range(len(factor))) for factor in factors}
    made = covertable.make(values, strength=STRENGTH, constraints=constraints)
    return [tuple(row[key] for key in keys.values()) for row in made]


def _equals(key: str, value: int) -> dict[str, object]:
    return {"operator": "eq", "left": key, "value": value}


def text() -> str:
    """The file."""
    parts = [HEAD]
    for name in crossed.FACTORS:
        words = ["".join(f"{place:x}" for place in row) for row in combinations(name)]
        lines = [" ".join(words[start : start + 15]) for start in range(0, len(words), 15)]
        parts.append(f'[{name}]\ncombinations = """\n' + "\n".join(lines) + '\n"""\n')
    return "\n".join(parts)


if __name__ == "__main__":
    FILE.write_text(text(), encoding="utf-8")
