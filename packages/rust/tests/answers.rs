//! Answers that are known without computing: tangencies at the waist, and what each kind of row says.

use hypcheck::*;

const TOWER: Sizes = Sizes { alpha: 2.0, gamma: 17.8, b: 0.25, d: 0.15 };
const UPRIGHT: [f64; 3] = [0.0, 0.0, 1.0];

#[test]
fn a_spheroid_at_the_waist_touches_from_outside_and_from_inside_exactly() {
    assert_eq!(position(TOWER, [2.25, 0.0, 0.0]), Ok(Position::Contact));
    assert_eq!(position(TOWER, [2.25_f64.next_up_by_one(), 0.0, 0.0]), Ok(Position::Exterior));
    assert_eq!(position(TOWER, [0.0, -1.75, 0.0]), Ok(Position::Contact));
    assert_eq!(position(TOWER, [0.0, -1.0, 0.0]), Ok(Position::Interior));
}

trait NextUp {
    fn next_up_by_one(self) -> f64;
}

impl NextUp for f64 {
    /// The next double of a positive one.
    fn next_up_by_one(self) -> f64 {
        f64::from_bits(self.to_bits() + 1)
    }
}

#[test]
fn invalid_numbers_are_refused_and_harm_no_other_row() {
    assert_eq!(position(TOWER, [f64::NAN, 0.0, 0.0]), Err(Invalid));
    assert_eq!(position(Sizes { b: 0.0, ..TOWER }, [9.0, 0.0, 0.0]), Err(Invalid));
    assert_eq!(position_tilted(TOWER, [9.0, 0.0, 0.0], [0.0; 3]), Err(Invalid));
    let mut positions = [9; 2];
    classify(&[[2.0, 17.8, 0.25, 0.15, f64::INFINITY, 0.0, 0.0], [2.0, 17.8, 0.25, 0.15, 9.0, 0.0, 0.0]], &mut positions);
    assert_eq!(positions, [INVALID, 1]);
}

#[test]
fn an_axis_counts_and_its_length_does_not() {
    let sizes = Sizes { alpha: 2.0, gamma: 5.0, b: 0.25, d: 1.0 };
    assert_eq!(position_tilted(sizes, [2.5, 0.0, 0.0], UPRIGHT), Ok(Position::Exterior));
    assert_eq!(position_tilted(sizes, [2.5, 0.0, 0.0], [-3.0, 0.0, 0.0]), Ok(Position::Contact));
}

#[test]
fn above_an_end_is_exterior_and_a_flat_end_is_touched() {
    let ends = |solid| Heights { z_min: -1.0, z_max: 1.0, solid };
    let place = [0.0, 0.0, 1.1];
    assert_eq!(position_ended(TOWER, place, UPRIGHT, ends(false)), Ok(Some(Position::Exterior)));
    assert_eq!(position_ended(TOWER, place, UPRIGHT, ends(true)), Ok(Some(Position::Contact)));
    assert_eq!(position_ended(TOWER, place, UPRIGHT, Heights { z_max: -2.0, ..ends(true) }), Err(Invalid));
}

#[test]
fn a_way_through_the_wall_hits_and_one_beside_it_is_clear() {
    let Ok(Passage::Hit { not_before }) = passage(TOWER, [9.5, 0.0, 0.0], [0.0, 0.0, 0.0]) else { panic!() };
    assert!((0.76..=0.77).contains(&not_before)); // 7.25 of 9.5
    assert_eq!(passage(TOWER, [9.5, 0.0, 0.0], [9.5, 4.0, 3.0]), Ok(Passage::Clear));
}

#[test]
fn a_scene_and_many_rows_answer_as_one_row_does() {
    let scene = Scene::new(TOWER, UPRIGHT);
    let x: [f64; 5] = [9.0, 2.25, 2.1, 1.75, 0.5];
    let (zeros, mut by_scene, mut by_rows) = ([0.0; 5], [0; 5], [0; 5]);
    scene.classify(&x, &zeros, &zeros, &mut by_scene);
    classify(&x.map(|x| [2.0, 17.8, 0.25, 0.15, x, 0.0, 0.0]), &mut by_rows);
    assert_eq!((by_scene, by_rows), ([1, 0, 0, 0, -1], [1, 0, 0, 0, -1]));
    for (x, position) in x.into_iter().zip(by_rows) {
        assert_eq!(scene.position([x, 0.0, 0.0]).map(|found| found as i8), Ok(position));
    }
}

#[test]
fn a_clearance_encloses_the_distance_at_the_waist() {
    let found = clearance(TOWER, [9.25, 0.0, 0.0]).unwrap();
    assert!(found.distance_lower <= 7.0 && 7.0 <= found.distance_upper && found.distance_upper < 7.0 + 1e-6);
    assert!((found.nearest[0] - 2.0).abs() < 1e-3);
}

#[test]
#[should_panic(expected = "there must be as many")]
fn too_few_answers_panic() {
    classify(&[[1.0; 7]; 2], &mut [0]);
}

#[test]
fn the_version_is_the_crates() {
    assert_eq!(version(), env!("CARGO_PKG_VERSION"));
    assert!(!level().is_empty());
}
