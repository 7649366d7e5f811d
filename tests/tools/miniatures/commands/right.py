"""Always right."""

from base import serve

serve()
