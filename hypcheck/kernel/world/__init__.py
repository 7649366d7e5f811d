"""A whole scene asked at once: which hyperboloids are near, what each says exactly, and what that comes to."""
