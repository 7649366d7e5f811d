"""The record of a run: one JSON object a line, from which every report is made. docs/record.md says what is in it."""

from __future__ import annotations

from hypcheck.record.model import Line, Record
from hypcheck.record.reading import read
from hypcheck.record.writing import SCHEMA, Recorder, plain

__all__ = ["SCHEMA", "Line", "Record", "Recorder", "plain", "read"]
