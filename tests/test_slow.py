"""What `make check` leaves out is what conftest.py says."""

from __future__ import annotations

from tests.conftest import SLOW, module_of


def test_every_module_listed_as_slow_exists():
    named = [module_of(folder, name) for folder, names in SLOW.items() for name in names.split()]
    assert [str(path) for path in named if not path.exists()] == []
    assert len(named) == len(set(named))
