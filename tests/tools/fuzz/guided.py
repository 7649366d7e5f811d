"""`python -m tests.tools.fuzz.guided READER SECONDS FOLDER`: what reaches new code is kept and damaged again.

It needs atheris (`pip install atheris`), which no other test does, and says nothing of times: code that is watched is
slow. Seeds are damaged as mutating.py does it and by libFuzzer, and judged as all others are. Each kind of finding is
put into FOLDER/findings once, and the run goes on; FOLDER/corpus is where another run goes on from.
"""

from __future__ import annotations

import hashlib
import re
import sys
from collections import Counter
from pathlib import Path
from random import Random

import atheris
import click

WATCHED = ["hypcheck", "json", "csv", "tomllib", "numpy.lib"]

with atheris.instrument_imports(include=WATCHED, enable_loader_override=False):
    from tests.tools.fuzz.judging import judged, stop_hangs
    from tests.tools.fuzz.mutating import mutated
    from tests.tools.fuzz.readers import READERS, Reader
    from tests.tools.fuzz.trees import tree

SLOWED = 5
"""How much longer an input may take, since its reader is watched."""

OFTEN = 5000
"""After so many inputs the counts are shown again."""


@click.command()
@click.argument("name", metavar="READER", type=click.Choice(list(READERS)))
@click.argument("seconds", type=click.IntRange(1))
@click.argument("folder", type=click.Path(path_type=Path))
def main(name: str, seconds: int, folder: Path) -> None:
    """Damage what READER reads for so many SECONDS."""
    reader, corpus = READERS[name], folder / "corpus"
    corpus.mkdir(parents=True, exist_ok=True)
    stop_hangs()
    with atheris.instrument_imports(include=WATCHED, enable_loader_override=False):
        for number, data in enumerate(reader.seeds()):
            (corpus / f"seed-{number}").write_bytes(data)
            judged(reader.read, data, 60.0)  # what is loaded when it is used is loaded now, and watched
    flags = [f"-max_total_time={seconds}", "-timeout=300", "-rss_limit_mb=2500", "-max_len=65536", "-len_control=0"]
    flags += [f"-artifact_prefix={folder}/", "-report_slow_units=300", "-reload=0", str(corpus)]
    atheris.Setup([sys.argv[0], *flags], _judge(reader, folder / "findings"), custom_mutator=_mutator(reader))
    atheris.Fuzz()


def _judge(reader: Reader, folder: Path):
    counts: Counter[str] = Counter()
    known = set()

    def judge(data: bytes) -> None:
        verdict = judged(reader.read, data, SLOWED * reader.seconds)
        counts[verdict.kind] += 1
        kind = re.sub(r"\d+|'.*'", "", verdict.says)
        if verdict.kind == "finding" and kind not in known:
            known.add(kind)
            folder.mkdir(exist_ok=True)
            path = folder / hashlib.sha256(kind.encode()).hexdigest()[:12]
            path.write_bytes(data)
            click.echo(f"{path}: {verdict.says}")
        if counts.total() % OFTEN == 0:
            click.echo(dict(counts))

    return judge


def _mutator(reader: Reader):
    seeds = reader.seeds()

    def mutate(data: bytes, most: int, seed: int) -> bytes:
        random = Random(seed)  # noqa: S311 - nothing secret
        way = random.random()
        if way < 0.3:
            return reader.finish(atheris.Mutate(data, most), random)[:most]
        if random.random() < 0.4:  # what was damaged often enough is refused at its first byte
            data = random.choice(seeds)
        data = tree(data, random) if way < 0.7 else mutated(data, random, seeds)
        return reader.finish(data, random)[:most]

    return mutate


if __name__ == "__main__":
    main()
