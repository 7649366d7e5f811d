"""Measure collision engines near contact. Each is installed in its own folder and asked as a command is."""
