"""`hypcheck classify` and the public functions about hyperboloids that end: options, tables, columns by name."""

from __future__ import annotations

import json
import math
from fractions import Fraction

import numpy as np
import pytest

import hypcheck
from hypcheck.cli.main import main
from tests.support.corpus import files
from tests.support.tilted_fractions import combined, matrices, positive_definite

PAIR = ["--alpha", "3", "--gamma", "4", "--b", "1", "--d", "1", "--center", "2", "0", "4"]
COLUMNS = {"alpha": 3, "gamma": 4, "b": 1, "d": 1, "x": 2, "y": 0, "z": 4}


def said(capsys, *words):
    code = main(["classify", *words])
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def test_one_row_with_ends_is_classified_with_its_proof(capsys):
    code, out, _ = said(capsys, *PAIR[:-3], "3.75", "0", "4.5", "--z-max", "3")
    assert code == 0
    assert out.startswith("exterior\ndistance   ")
    assert "piece" in out
    code, out, _ = said(capsys, *PAIR, "--z-max", "3", "--solid", "--json")
    found = json.loads(out)
    assert (found["position"], found["tangent"], found["clearance"]) == (0, True, 0.0)
    assert found["proof"]["by"] == "points"


def proof_of(capsys, row):
    names = ("alpha", "gamma", "b", "d")
    words = [word for name, value in zip(names, row, strict=False) for word in (f"--{name}", repr(value))]
    words += ["--center", *map(repr, row[4:7]), "--z-max", repr(row[11])]
    words += [] if row[10] == -math.inf else ["--z-min", repr(row[10])]
    code, out, _ = said(capsys, *words, "--json")
    assert code == 0
    shown = said(capsys, *words)[1]
    return json.loads(out)["proof"], shown


def test_multiplier_of_a_pair_with_ends_proves_that_the_spheroid_misses_the_whole_surface(capsys):
    """The row stands for an upright ball beside a hyperboloid that ends at the height 3."""
    row = (3.0, 4.0, 1.0, 1.0, 9.0, 0.0, 4.0, 0.0, 0.0, 1.0, -math.inf, 3.0)
    proof, shown = proof_of(capsys, row)
    assert proof["by"] == "multiplier"
    assert positive_definite(combined(*matrices(row[:10]), Fraction(proof["lambda"])))
    assert "makes S + λH positive definite" in shown


@pytest.mark.parametrize(("center", "low"), [((3.75, 0.0, 4.5), -math.inf), ((4.0, 0.0, -3.5), -2.0)])
def test_pieces_of_heights_cover_all_from_end_to_end_and_prove_that_the_spheroid_misses_each(capsys, center, low):
    """S + λH + μZ > 0 and μ ≥ 0; on the wall H is 0, and Z, the product about the piece's ends, at most 0 in it."""
    row = (3.0, 4.0, 1.0, 1.0, *center, 0.0, 0.0, 1.0, low, 3.0)
    proof, shown = proof_of(capsys, row)
    assert proof["by"] == "pieces"
    S, H = matrices(row[:10])
    reached = low
    for piece in proof["pieces"]:
        ends = [None if "inf" in text else Fraction(text) for text in (piece["low"], piece["high"])]
        assert (-math.inf if ends[0] is None else ends[0]) <= reached
        reached = math.inf if ends[1] is None else ends[1]
        at, mu = Fraction(piece["lambda"]), Fraction(piece["mu"])
        assert mu >= 0
        whole = combined(S, H, at)
        square, linear, constant = between(*ends)
        whole[2][2] += mu * square
        whole[2][3] += mu * linear / 2
        whole[3][2] += mu * linear / 2
        whole[3][3] += mu * constant
        assert positive_definite(whole)
    assert reached >= 3
    assert shown.count("from ") >= len(proof["pieces"])


def between(low, high):
    """The coefficients of z², z and 1 in (z − low)(z − high), low − z or z − high."""
    if low is None:
        return 0, 1, -high
    return (0, -1, low) if high is None else (1, -low - high, low * high)


def test_a_contact_that_no_rational_point_shows_is_proved_by_the_rule_in_the_height(capsys):
    case = next(case for case in files()["ended-groove"]["cases"] if case["id"] == "ended-groove-0048")
    proof, shown = proof_of(capsys, tuple(map(float, case["row"])))
    assert proof == {"by": "rule in the height"}
    assert "no point can be written in rational numbers that shows this contact" in shown


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--z-min", "3", "--z-max", "3"], "z_min is 3.0 and z_max is 3.0; z_min must be less than z_max"),
        (["--z-max", "high"], "--z-max is 'high'; it must be a decimal number"),
        (["--solid"], "--solid says that flat ends belong to the hyperboloid; give --z-min, --z-max or both"),
    ],
)
def test_impossible_heights_are_refused_in_one_sentence(capsys, words, sentence):
    code, out, err = said(capsys, *PAIR, *words)
    assert (code, out) == (2, "")
    assert sentence in err


def test_classify_gives_bounds_of_the_first_contact_of_a_sweep_beside_ends(capsys):
    code, out, _ = said(capsys, *PAIR[:-3], "3.75", "0", "9", "--end", "3.75", "0", "3.5", "--z-max", "3", "--json")
    found = json.loads(out)
    assert (code, found["hit"]) == (0, 1)
    assert found["first"][0] <= 5 / 5.5 <= found["first"][1]


@pytest.mark.parametrize("ending", ["csv", "jsonl", "npy"])
def test_row_of_a_table_with_heights_is_answered_as_the_same_single_row(tmp_path, ending):
    rows = [COLUMNS | {"z_min": -1, "z_max": high, "solid": solid} for high in (3, 3.25, 9) for solid in (0, 1)]
    source, target = tmp_path / f"in.{ending}", tmp_path / f"out.{ending}"
    if ending == "csv":
        lines = [",".join(rows[0]), *(",".join(map(str, row.values())) for row in rows)]
        source.write_text("\n".join(lines) + "\n")
    elif ending == "jsonl":
        source.write_text("".join(json.dumps(row | {"solid": bool(row["solid"])}) + "\n" for row in rows))
    else:
        np.save(source, np.array([[3, 4, 1, 1, 2, 0, 4, 0, 0, 1, *list(row.values())[7:]] for row in rows], float))
    assert main(["classify", "--input", str(source), "--output", str(target)]) == 0
    ends = [{name: row[name] for name in ("z_min", "z_max", "solid")} for row in rows]
    alone = [hypcheck.position(*list(row.values())[:7], **some) for row, some in zip(rows, ends, strict=True)]
    if ending == "npy":
        assert np.load(target).tolist() == alone
        return
    text = target.read_text().splitlines()
    found = [json.loads(line)["position"] for line in text] if ending == "jsonl" else []
    found = found or [int(line.split(",")[len(rows[0])]) for line in text[1:]]
    assert found == alone


def test_table_may_lack_the_column_of_an_end_and_an_end_may_be_the_word_inf(tmp_path):
    source, target = tmp_path / "in.csv", tmp_path / "out.csv"
    head, row = ",".join(COLUMNS), ",".join(map(str, COLUMNS.values()))
    source.write_text(f"{head},z_max,solid\n{row},3,true\n{row},inf,0\n{row},-Infinity,1\n")
    assert main(["classify", "--input", str(source), "--output", str(target), "--on-invalid", "flag"]) == 0
    assert [line.split(",")[9] for line in target.read_text().splitlines()[1:]] == ["0", "-1", "127"]


def test_columns_by_name_are_broadcast_and_missing_heights_have_their_defaults():
    found = hypcheck.classify(COLUMNS | {"z_max": [3.0, 3.25, np.inf], "solid": [False, True, True]})
    assert found.tolist() == [1, 0, -1]
    assert hypcheck.classify(COLUMNS | {"z_min": 3.5}, question="interior") == 1
    with pytest.raises(hypcheck.InputError, match=r"row 1: z_min is 4\.0 and z_max is 3\.0; z_min must"):
        hypcheck.classify(COLUMNS | {"z_min": [0.0, 4.0], "z_max": 3.0})
    with pytest.raises(hypcheck.InputError, match=r"^solid is 2\.0; it must be 0 or 1"):
        hypcheck.classify(COLUMNS | {"solid": 2})
    assert hypcheck.classify(np.array([[*COLUMNS.values(), 0, 0, 1, 4, 3, 0]]), on_invalid="flag").tolist() == [127]


def test_clearance_beside_ends_lies_between_its_bounds():
    found = hypcheck.clearance(COLUMNS | {"z": [4.5, 3.5, 6.0], "d": [1, 1, 0.5], "z_max": 3, "solid": 1})
    assert found.position.tolist() == [1, 0, 1]
    distances = found.distance_lower, found.distance_upper
    for bounds, true in (((found.lower, found.upper), [0.5, -0.5, 5.0]), (distances, [0.5, 0, 2.5])):
        assert (bounds[0] <= true).all()
        assert (bounds[1] >= true).all()
    assert found.nearest.tolist() == [[2, 0, 3]] * 3
