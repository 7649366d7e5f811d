"""Two implementations that declare that they refuse invalid rows; one does."""

from __future__ import annotations

from tests.runs.faulty import answers_bad_rows, refuses

hypcheck = {"name": "refusing", "refuses": True}

keeps_its_word = refuses
does_not = answers_bad_rows
