"""The record of a run: one JSON object a line, from which every report is made. docs/record.md describes it."""

from __future__ import annotations

from hypcheck.record.fields import RecordLine, plain
from hypcheck.record.lines import SCHEMA
from hypcheck.record.reader import Record, read
from hypcheck.record.writer import Recorder

__all__ = ["SCHEMA", "Record", "RecordLine", "Recorder", "plain", "read"]
