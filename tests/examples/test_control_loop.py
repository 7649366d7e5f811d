"""The control loop in C++ compiles with the header alone, and stops and climbs where contact is ahead."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

import hypcheck

ROOT = Path(__file__).parents[2]
SIZES = (0.3, 5, 0.4, 0.2)
"""Of the first tree, at (6, 0.1), and the drone, which flies at 2 m/s and looks 3 m ahead."""


COMPILER = shutil.which("c++")


@pytest.mark.skipif(COMPILER is None, reason="there is no C++ compiler")
def test_the_loop_climbs_over_a_tree_that_it_would_meet_and_flies_on_above_its_end(tmp_path):
    program = tmp_path / "control_loop"
    header = ROOT / "hypcheck" / "kernel" / "core"
    source = ROOT / "examples" / "control_loop.cpp"
    subprocess.run([COMPILER, "-std=c++17", "-DHYPCHECK_PLAIN", f"-I{header}", source, "-o", program], check=True)
    lines = subprocess.run([program], check=True, capture_output=True, text=True).stdout.splitlines()
    second, tree, ahead = re.fullmatch(r"(.*) s: tree (\d) in (.*) s; climbing", lines[0]).groups()
    way = {"z_min": -1, "z_max": 8, "solid": 1}
    x = 2 * float(second) - 6
    exact = hypcheck.passage(SIZES, (x, -0.1, 1.5), (x + 3, -0.1, 1.5), **way)
    before = hypcheck.passage(SIZES, (x - 0.04, -0.1, 1.5), (x + 2.96, -0.1, 1.5), **way)
    assert (exact.hit, before.hit, tree) == (True, False, "0")
    assert abs(float(exact.first_lower) * 1.5 - float(ahead)) < 6e-4  # printed to a millisecond
    height = float(re.fullmatch(r".* s: clear at (.*) m; flying on", lines[1])[1])
    assert 8.2 < height < 8.25  # the tree ends at 8, half the drone is 0.2, and a step climbs 0.04
    assert lines[-1].endswith("past the trees at 9.22 m")
