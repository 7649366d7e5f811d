"""The computations that a scene needs, and no others: settings, lines, a discriminant with a bound, a search."""
