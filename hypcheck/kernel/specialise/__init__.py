"""What a scene needs of the mathematics, and nothing else: settings, lines, a discriminant with a bound, a search."""
