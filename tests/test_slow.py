"""What `make check` and `make test` leave out is what conftest.py says."""

from __future__ import annotations

import pytest

from tests.conftest import SLOW, THOROUGH, module_of


@pytest.mark.parametrize("table", [SLOW, THOROUGH], ids=["slow", "thorough"])
def test_every_test_module_listed_as_slow_or_thorough_exists(table):
    named = [module_of(folder, name) for folder, names in table.items() for name in names.split()]
    assert [str(path) for path in named if not path.exists()] == []
    assert len(named) == len(set(named))
