"""Every attack is contained, with namespaces and without, and what was tried is named."""

from __future__ import annotations

import os
import re
import time
from pathlib import Path

import pytest

from hypcheck.isolation.means import Means, available, isolation_text
from tests.tools.hostile.running import command_fate
from tests.tools.hostile.table import ATTACKS

HERE = available()
ALONE = Means(False, HERE.landlock, HERE.seccomp, ("no namespaces: a test",))
QUICK = ("write_memory_of_judge", "kill_judge", "forge_summary_after_the_end", "fork_bomb", "fill_disk", "link_scratch")
"""Attacks that are made with namespaces wherever tests run; `make thorough` makes all, both ways."""


def cases():
    for attack in ATTACKS:
        late = () if attack.name in QUICK else pytest.mark.thorough
        lacks = pytest.mark.skipif(
            not HERE.whole, reason=f"a program here is {isolation_text(HERE.names, HERE.missing)}"
        )
        yield pytest.param(attack, HERE, attack.told, id=attack.name, marks=[lacks, *([late] if late else [])])
        if attack.alone is not None:
            lacks = pytest.mark.skipif(
                HERE.landlock < 6, reason=f"a program here is {isolation_text(HERE.names, HERE.missing)}"
            )
            marks = [lacks, pytest.mark.thorough]
            yield pytest.param(attack, ALONE, attack.alone, id=f"{attack.name} by Landlock", marks=marks)


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


def left(line: Path) -> bool:
    """Whether a process is one that the attack left."""
    try:
        text = line.read_bytes()
    except OSError:
        return False
    ours = str(os.getpid()).encode()
    return b"600." + ours in text or (b"hostile/command.py" in text and ours in text)
