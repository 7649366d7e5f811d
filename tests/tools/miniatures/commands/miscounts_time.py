"""The checksum of what it timed is wrong."""

from base import serve

serve(checksum=len, claims={"time": True})
