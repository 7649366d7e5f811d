"""The validator of the package, under the name that tests know."""

from hypcheck.report.json_schema import violations

__all__ = ["violations"]
