"""The version of the package, apart from everything else so that reading it loads nothing."""

VERSION = "1.0.0"
