"""Published beside the Python package: a folder for each language, and `python -m packages` that builds them."""
