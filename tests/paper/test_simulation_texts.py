"""The texts of simulations: each number where it belongs, one and many, lists that are cut."""

from __future__ import annotations

from dataclasses import replace

import pytest

from hypcheck.errors import InputError
from hypcheck.paper.forest import ForestPlan, simulate_forest
from hypcheck.paper.simulation_text import SHOWN, forest_lines, pitch_lines, tower_lines
from hypcheck.paper.tower import TowerPlan, simulate_tower
from hypcheck.report.write import ready_for, write_simulation
from hypcheck.scene.reading import read_scene
from tests.support.without_drawing import draw_nothing

LEANS = {
    "degrees": 20.0,
    "total": {"moves": 1000, "wrong": 30, "dangerous": 4, "body_wrong": 1, "body_dangerous": 0},
    "near_wall": {
        "centres": 200,
        "anywhere": {"changed": 9, "dangerous": 3},
        "outward": {"changed": 0, "dangerous": 0},
    },
}


@pytest.fixture(scope="module")
def walked():
    return simulate_forest(ForestPlan(read_scene("forest"), 3, 15, continuous=False))


@pytest.fixture(scope="module")
def flown():
    scene = read_scene("tower")
    short = replace(scene, flight=replace(scene.flight, distance=3.0))
    return simulate_tower(TowerPlan(short, 7, 5.0, 0.2, 0), None, lambda _: None)


def test_text_about_pitch_counts_dangerous_and_needless_answers_separately():
    assert list(pitch_lines(LEANS)) == [
        "Tilted by 20 degrees into each movement ahead or back, which Procedure 2.b does not know:",
        "  of 1,000 horizontal moves its answer is wrong about 30 (3.000 %):",
        "    4 dangerous, clear only upright; 26 needlessly refused",
        "  of 1,000 horizontal moves the body alone is judged wrongly for 1 (0.100 %):",
        "    0 dangerous, clear only upright; 1 clear only tilted",
        "  of 200 centres within b of the wall the body's position is another",
        "    for 9 (4.500 %), tilted anywhere; 3 of these are dangerous",
        "    for 0 (0.000 %), tilted along the radius, outwards; 0 of these are dangerous",
    ]


def test_text_about_pitch_without_a_counted_move_has_no_share():
    none = {**LEANS, "total": dict.fromkeys(LEANS["total"], 0)}
    assert "  of 0 horizontal moves its answer is wrong about 0:" in list(pitch_lines(none))


def ways(**changes):
    contact = {"start": [0.0, 1.0, 2.0], "end": [0.5, 1.0, 2.0], "rotor": 2, "first_upper": 0.123456}
    return {
        "vertical": 10,
        "vertical_touching": 3,
        "vertical_begun": 1,
        "horizontal": 0,
        "horizontal_touching": 0,
        "horizontal_begun": 0,
        "contacts": [contact],
        "turns": 8,
        "turns_touching": 1,
        "wrongly_accepted": 1,
        "wrongly_refused": 0,
        "asked": 20,
        "repaired_2b_differs": 0,
        "repaired_2a_differs": 4,
        "procedure_2a_differs": 5,
        **changes,
    }


@pytest.mark.slow
def test_text_of_the_tower_counts_contacts_on_the_sweeps_and_turns_of_flights_and_of_the_table(flown):
    text = list(tower_lines({**flown, "flights": {**flown["flights"], "ways": ways()}}))
    assert text[
        text.index("  10 accepted vertical moves: 3 touch (30.000 %), 1 from their beginning and 2 on the way") :
    ][1:5] == [
        "  0 accepted horizontal moves: 0 touch, 0 from their beginning and 0 on the way",
        "    (0.000, 1.000, 2.000) to (0.500, 1.000, 2.000): rotor 2 first at 0.123 of the way",
        "  8 turns in place: 1 sweeps a rotor through contact (12.500 %)",
        "  at the ends of moves the procedure was wrong 1 time",
    ]
    one = list(
        tower_lines({**flown, "flights": {**flown["flights"], "ways": ways(vertical_touching=1, vertical_begun=1)}})
    )
    assert "  10 accepted vertical moves: 1 touches (10.000 %), 1 from their beginning and 0 on the way" in one


def test_text_of_the_tower_has_the_part_about_pitch_between_empty_lines(flown):
    text = list(tower_lines({**flown, "pitch": LEANS}))
    tilted = list(pitch_lines(LEANS))
    start = text.index(tilted[0])
    assert text[start : start + len(tilted)] == tilted
    assert text[start - 1] == text[start + len(tilted)] == ""


def test_text_of_a_tower_with_ends_counts_the_moves_of_the_table_only_if_the_table_was_simulated(flown):
    counts = {"asked": 9, "reaching": 7, "beyond": 4, "touching": 1, "dangerous": 2, "needless": 3}
    lines = [
        "of 9 moves asked about the body reaches beyond an end in 7;",
        "    there the centre's height decides 5 otherwise: 2 dangerous, 3 needlessly refused",
        "    of 4 draws to beyond the height 1 would touch the wall (25.000 %)",
    ]
    for table, names in ((None, ["figure"]), (counts, ["figure", "table"])):
        text = list(tower_lines({**flown, "ends": {"flights": counts, "table_5": table}}))
        start = text.index("The tower as it ends, where the flights ask for the height of the centre alone:") + 1
        wanted = [line for name in names for line in (f"  flights of the {name}: {lines[0]}", *lines[1:])]
        assert text[start : text.index("", start)] == wanted


def test_the_text_of_a_tower_mentions_that_its_ends_are_not_modelled(flown):
    endless = {**flown, "assumptions": {**flown["assumptions"], "height": None}}
    begin = "  tower alpha = 2, gamma = 17.8; "
    assert f"{begin}no end of its height is modelled" in list(tower_lines(endless))
    assert any(line.startswith(f"{begin}its height from -17.8 to 17.8,") for line in tower_lines(flown))


def stop(number):
    return {"kind": "phantom", "at": [0, 0, 0], "tried": [number, 0.0, 0.0], "trees": ["oak", "fir"], "gap": 1.5}


def test_the_text_of_the_forest_lists_a_few_phantoms_and_counts_the_rest(walked):
    text = list(forest_lines({**walked, "stops": [stop(number) for number in range(SHOWN + 3)]}))
    listed = [line for line in text if "from touching" in line]
    assert listed[0] == "  at (0.000, 0.000, 0.000), 1.50 from touching: oak, fir"
    assert len(listed) == SHOWN
    assert "  and 3 more" in text
    assert "more" not in "".join(forest_lines({**walked, "stops": [stop(1)] * SHOWN})).partition("from touching")[2]


@pytest.mark.parametrize(("count", "verb"), [(1, "leads"), (2, "lead")])
def test_the_text_of_the_forest_counts_steps_that_were_wrongly_allowed(walked, count, verb):
    text = list(forest_lines({**walked, "steps": {**walked["steps"], "wrongly_allowed": count}}))
    assert f"  {count} of the made ones {verb} into contact" in text
    assert "of the made ones" not in "".join(forest_lines(walked))


def test_a_file_of_a_simulation_that_could_not_be_written_or_removed_is_named(monkeypatch, tmp_path):
    draw_nothing(monkeypatch)
    (tmp_path / "tower-pitch.svg").mkdir()
    refused = pytest.raises(InputError, match=r"cannot be written: tower-pitch\.svg in it is a folder")
    with refused, ready_for("tower", tmp_path):
        pass
    with pytest.raises(InputError, match=r"cannot remove .*tower-pitch\.svg: is a directory"):
        write_simulation({"simulation": "tower"}, tmp_path)
