"""`python -m tests.tools.attack [--rows N] [--seed S]`: ends with 1 where an answer is wrong; prints the first rows."""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from collections.abc import Iterator

from tests.tools.attack.strike import batches, strike, tally
from tests.tools.attack.subjects import subjects


def main() -> int:
    """Attack every kernel and print how often each was asked and wrong, by stratum."""
    parser = argparse.ArgumentParser(prog="python -m tests.tools.attack", description=__doc__)
    parser.add_argument("--rows", type=int, default=12_000_000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    everyone, started = subjects(), time.perf_counter()
    asked, wrong, rows = tally(strike(everyone, batches(options.seed, options.rows)))
    lines = list(_table(asked, wrong))
    lines.append(f"{time.perf_counter() - started:.0f} s, seed {options.seed}")
    worst = [row for some in rows for row in some][:10]
    lines += ["wrong: " + " ".join(float(value).hex() for value in row) for row in worst]
    sys.stdout.write("\n".join(lines) + "\n")
    return 1 if rows else 0


def _table(asked: Counter, wrong: Counter) -> Iterator[str]:
    strata, names = (tuple(dict.fromkeys(key[place] for key in asked)) for place in (0, 1))
    yield f"{'rows asked (wrong)':20}" + "".join(f"{name:>18}" for name in names)
    for stratum in (*strata, None):
        cells = []
        for name in names:
            keys = [key for key in asked if key[1] == name and stratum in (None, key[0])]
            cells.append(f"{sum(asked[key] for key in keys):,} ({sum(wrong[key] for key in keys)})")
        yield f"{stratum or 'all':20}" + "".join(f"{cell:>18}" for cell in cells)


if __name__ == "__main__":
    sys.exit(main())
