"""Every attack is contained, with namespaces and without, and what was tried is named."""

from __future__ import annotations

import os
import re
import time
from pathlib import Path

import pytest

from hypcheck.cli.main import main
from hypcheck.isolation.launch import isolation_text
from hypcheck.record import read
from hypcheck.record.lines import GroupLine
from hypcheck.runs.known_failures import excusable_causes
from hypcheck.vectors import frozen
from hypcheck.vectors.families import select
from tests.tools.hostile import by_heart
from tests.tools.hostile.running import command_fate
from tests.tools.hostile.table import ATTACKS, HERE, KINDS, is_here

QUICK = ("write_memory_of_judge", "kill_judge", "forge_summary_after_the_end", "fork_bomb", "fill_disk", "link_scratch")
"""Attacks that are made with namespaces wherever tests run; `make thorough` makes all, by all kinds of isolation."""


def cases():
    for attack in ATTACKS:
        for kind, wanted in attack.by_kind().items():
            if wanted is None:
                continue
            reason = f"a program here is {isolation_text(HERE.names, HERE.missing)}"
            marks = [pytest.mark.skipif(not is_here(kind), reason=reason)]
            if attack.name not in QUICK or kind != "namespaces":
                marks.append(pytest.mark.thorough)
            yield pytest.param(attack, KINDS[kind], wanted, id=f"{attack.name}, {kind}", marks=marks)


@pytest.mark.parametrize(("attack", "means", "told"), list(cases()))
def test_attack_by_a_hostile_implementation_is_contained_and_reported(attack, means, told, tmp_path):
    fate = command_fate(attack.name, means, tmp_path)
    assert re.search(told, fate.told), fate
    assert fate.outcome is attack.outcome, fate
    assert not fate.damage, fate
    if "after_the_end" in attack.name:
        time.sleep(0.5)
        assert (tmp_path / "reports" / "summary.json").read_text() == "true"
    assert not [each for each in Path("/proc").glob("[0-9]*/cmdline") if left(each)]


EXCUSES = {
    "nothing": tuple,
    "each family": lambda: [f'family = "{family.name}"' for family in select()],
    "a case of each family": lambda: [
        f'case = "{frozen.load(family.name).ids[0]}"' for family in select() if family.name in frozen.NAMES
    ],
    "every cause": lambda: [f'cause = "{name}"\nmax_u = inf' for name in excusable_causes()],
}
"""What a list of known failures may say in favour of a program that knows rows by heart."""


@pytest.mark.parametrize(
    ("excused", "families"),
    [("every cause", "few"), *(pytest.param(name, "all", marks=pytest.mark.thorough) for name in EXCUSES)],
)
def test_isolated_program_that_knows_rows_by_heart_fails_on_fresh_rows_whatever_is_excused(
    excused, families, tmp_path, monkeypatch, text_reports, request, capsys
):
    """Who fails with every cause excused fails with less."""
    if families == "few":
        request.getfixturevalue("few_families")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("CI", "true")
    count = 8 if families == "few" else 20
    by_heart.write(tmp_path, count)
    Path("known.toml").write_text("".join(_entry(each) for each in EXCUSES[excused]()))
    options = ("--count", str(count), "--known-failures", "known.toml", "--isolate", "on" if HERE.whole else "auto")
    seed = "20261125"  # one seed, so that the count of families that fail is the same each time
    assert main(["verify", by_heart.SPEC, *options, "--fresh", seed, "--out", "out"]) == 1
    record = read(tmp_path / "out")
    groups = {line.family: line for line in record.of(GroupLine)}
    assert all(groups[family.name].fresh > 0 for family in select())
    failed = [line for line in groups.values() if line.failing]
    assert len(failed) >= (3 if families == "few" else 15)  # no cause explains a wrong answer in each of these
    assert {case.case.split("/")[2] for line in failed for case in line.worst if case.status == "wrong"} == {seed}
    known = ("--families", ",".join(family.name for family in select()))  # the directed search follows its answers
    assert main(["verify", by_heart.SPEC, *options[:2], *options[4:], *known, "--fresh", "off", "--out", "out"]) == 0
    assert "; no fresh rows" in capsys.readouterr().out


def test_invented_case_of_a_known_failure_is_refused_before_a_program_starts(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("known.toml").write_text(_entry('case = "ring-99999"'))
    options = ("--known-failures", "known.toml", "--isolate", "on" if HERE.whole else "auto")
    assert main(["verify", by_heart.SPEC, *options, "--out", "out"]) == 2
    assert "known.toml, line 2: known failure 1: there is no case 'ring-99999'" in capsys.readouterr().err


def _entry(line: str) -> str:
    return f'[[known_failure]]\n{line}\nreason = "x"\n'


def left(line: Path) -> bool:
    """Whether a process is one that the attack left."""
    try:
        text = line.read_bytes()
    except OSError:
        return False
    ours = str(os.getpid()).encode()
    return b"600." + ours in text or (b"hostile/command.py" in text and ours in text)
