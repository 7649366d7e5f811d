"""Always right about spheroids whose axis may point anywhere, and refuses what is no row."""

from hypcheck.truth.float_filter import positions

hypcheck = {"name": "tilted", "tilt": True, "refuses": True}


def classify(rows):
    assert rows.shape[1] == 10
    assert rows.flags.c_contiguous
    return positions(rows, on_invalid="flag")
