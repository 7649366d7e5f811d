"""The version of the package, apart from everything else so that reading it loads nothing."""

VERSION = "0.1.0"
