"""The published schemas that are generated from classes, by file; `make schemas` writes them."""

from __future__ import annotations

from pathlib import Path

import hypcheck
from hypcheck.record import SCHEMA
from hypcheck.record import schema as record
from hypcheck.report import summary

PACKAGE = Path(hypcheck.__file__).parent

PUBLISHED = {
    PACKAGE / f"report/schemas/record-{SCHEMA}.json": record.schema,
    PACKAGE / f"report/schemas/summary-{summary.SCHEMA}.json": summary.schema,
}

if __name__ == "__main__":
    for file, schema in PUBLISHED.items():
        file.write_text(record.text(schema()), encoding="utf-8")
