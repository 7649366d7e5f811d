"""`python -m hypcheck`, the same as `hypcheck`."""

from hypcheck.cli.main import process

if __name__ == "__main__":
    process()
