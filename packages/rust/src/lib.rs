#![no_std]
#![doc = include_str!("../README.md")]
#![deny(missing_docs)]

use core::ffi::{c_char, c_int, CStr};
use core::fmt;

mod ffi;

/// The semi-axes, in one unit: `alpha` and `gamma` of the hyperboloid x²/α² + y²/α² − z²/γ² = 1, and `b`, `b`, `d` of the
/// spheroid, `d` along its axis of revolution. Each is finite and greater than 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sizes {
    /// The radius of the hyperboloid's waist.
    pub alpha: f64,
    /// Its imaginary semi-axis: far from the waist the radius grows by `alpha / gamma` a height.
    pub gamma: f64,
    /// The spheroid's semi-axis across its axis of revolution.
    pub b: f64,
    /// Its semi-axis along that axis.
    pub d: f64,
}

/// Where the hyperboloid ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heights {
    /// The lower end, −∞ for none.
    pub z_min: f64,
    /// The upper end, ∞ for none; `z_min` is less.
    pub z_max: f64,
    /// Whether flat ends belong to it; else the wall alone is there.
    pub solid: bool,
}

/// The position of the spheroid, exact for the given numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(i8)]
pub enum Position {
    /// Within the hyperboloid, without contact.
    Interior = -1,
    /// The solid spheroid and the surface have a point in common; a tangency counts.
    Contact = 0,
    /// Outside, without contact.
    Exterior = 1,
}

/// What happens on a straight way, its two ends included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Passage {
    /// There is no contact at any time.
    Clear,
    /// There is contact. `not_before` is a time from 0 to 1 before which the way is clear, NaN where bounds do not tell.
    Hit {
        /// See above.
        not_before: f64,
    },
    /// The bounds do not tell: the way grazes the surface, or the lengths are extreme. Treat it as contact, or ask Python.
    Undecided,
}

/// What no position can be given of: a size that is not finite or not greater than 0, a centre that is not finite, an axis
/// that is 0, 0, 0 or not finite, heights that are not z_min < z_max.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Invalid;

impl fmt::Display for Invalid {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str("sizes must be finite and greater than 0, centres and axes finite, an axis not 0, 0, 0, and z_min < z_max")
    }
}

impl core::error::Error for Invalid {}

/// The answer of [`classify`] and its like about a row that is not valid.
pub const INVALID: i8 = 127;

/// The answer about a row where bounds do not tell: of rows with heights, and of ways.
pub const UNDECIDED: i8 = 2;

fn position_of(answer: i8) -> Result<Position, Invalid> {
    match answer {
        -1 => Ok(Position::Interior),
        0 => Ok(Position::Contact),
        1 => Ok(Position::Exterior),
        _ => Err(Invalid),
    }
}

/// The exact position of one upright spheroid with its centre at `center`, seen from the hyperboloid's centre.
///
/// # Errors
/// [`Invalid`] where a number is none.
pub fn position(sizes: Sizes, center: [f64; 3]) -> Result<Position, Invalid> {
    let [x, y, z] = center;
    // SAFETY: the function takes numbers and touches no memory of ours.
    let answer = unsafe { ffi::hypcheck_position(sizes.alpha, sizes.gamma, sizes.b, sizes.d, x, y, z) };
    position_of(i8::try_from(answer).unwrap_or(INVALID))
}

/// The same of a spheroid whose axis of revolution is along `axis`, of any length and sign.
///
/// # Errors
/// [`Invalid`] where a number is none, or the axis is 0, 0, 0.
pub fn position_tilted(sizes: Sizes, center: [f64; 3], axis: [f64; 3]) -> Result<Position, Invalid> {
    let mut answer = [INVALID];
    classify_tilted(&[row_of(sizes, center, axis)], &mut answer);
    position_of(answer[0])
}

/// The same where the hyperboloid ends; `None` where bounds do not tell (within about 2⁻⁴⁶ of contact, or beyond 2^±100).
///
/// # Errors
/// [`Invalid`] where a number is none.
pub fn position_ended(
    sizes: Sizes,
    center: [f64; 3],
    axis: [f64; 3],
    heights: Heights,
) -> Result<Option<Position>, Invalid> {
    let mut answer = [INVALID];
    let mut row = [0.0; 13];
    row[..10].copy_from_slice(&row_of(sizes, center, axis));
    row[10..].copy_from_slice(&[heights.z_min, heights.z_max, f64::from(u8::from(heights.solid))]);
    classify_ended(&[row], &mut answer);
    if answer[0] == UNDECIDED {
        return Ok(None);
    }
    position_of(answer[0]).map(Some)
}

fn row_of(sizes: Sizes, center: [f64; 3], axis: [f64; 3]) -> [f64; 10] {
    let ([x, y, z], [u, v, w]) = (center, axis);
    [sizes.alpha, sizes.gamma, sizes.b, sizes.d, x, y, z, u, v, w]
}

/// What happens while the centre of an upright spheroid goes straight from `start` to `end`.
///
/// # Errors
/// [`Invalid`] where a number is none.
pub fn passage(sizes: Sizes, start: [f64; 3], end: [f64; 3]) -> Result<Passage, Invalid> {
    let ([x0, y0, z0], [x1, y1, z1]) = (start, end);
    let row = [sizes.alpha, sizes.gamma, sizes.b, sizes.d, x0, y0, z0, x1, y1, z1];
    let (mut hit, mut time) = ([INVALID], [f64::NAN]);
    classify_passages(&[row], &mut hit, Some(&mut time));
    match hit[0] {
        0 => Ok(Passage::Clear),
        1 => Ok(Passage::Hit { not_before: time[0] }),
        UNDECIDED => Ok(Passage::Undecided),
        _ => Err(Invalid),
    }
}

/// The positions of many upright spheroids, as `i8`: 1, 0, −1, or [`INVALID`]. Rows are α, γ, b, d, x, y, z.
///
/// # Panics
/// If there are not as many answers as rows.
pub fn classify(rows: &[[f64; 7]], positions: &mut [i8]) {
    check(rows.len(), positions.len());
    // SAFETY: both slices have `rows.len()` entries, which the function reads and writes; a row is seven doubles.
    unsafe { ffi::hypcheck_classify(rows.len(), rows.as_ptr().cast(), positions.as_mut_ptr()) }
}

/// The same of tilted spheroids: the three numbers of the axis behind each row.
///
/// # Panics
/// If there are not as many answers as rows.
pub fn classify_tilted(rows: &[[f64; 10]], positions: &mut [i8]) {
    check(rows.len(), positions.len());
    // SAFETY: as above, and a row is ten doubles.
    unsafe { ffi::hypcheck_classify_tilted(rows.len(), rows.as_ptr().cast(), positions.as_mut_ptr()) }
}

/// The same where hyperboloids end: z_min, z_max and solid (0 or 1) behind the axis. Answers may be [`UNDECIDED`].
///
/// # Panics
/// If there are not as many answers as rows.
pub fn classify_ended(rows: &[[f64; 13]], positions: &mut [i8]) {
    check(rows.len(), positions.len());
    // SAFETY: as above, and a row is thirteen doubles.
    unsafe { ffi::hypcheck_classify_ended(rows.len(), rows.as_ptr().cast(), positions.as_mut_ptr()) }
}

/// Contact on many ways: 1, 0, [`UNDECIDED`] or [`INVALID`]. Rows have `N` numbers: α, γ, b, d, the centre at the start
/// and at the end (10), the axis behind these (13), and z_min, z_max, solid behind that (16).
///
/// # Panics
/// If there are not as many hits, or times, as rows. Rows of another width are answered [`INVALID`].
pub fn classify_passages<const N: usize>(rows: &[[f64; N]], hits: &mut [i8], times: Option<&mut [f64]>) {
    check(rows.len(), hits.len());
    let times = times.map_or(core::ptr::null_mut(), |times| {
        check(rows.len(), times.len());
        times.as_mut_ptr()
    });
    // SAFETY: the slices have `rows.len()` entries, a row is N doubles, and times may be null.
    unsafe { ffi::hypcheck_passage_columns(rows.len(), N, rows.as_ptr().cast(), hits.as_mut_ptr(), times) }
}

fn check(rows: usize, answers: usize) {
    assert!(rows == answers, "there are {answers} answers for {rows} rows; there must be as many");
}

/// One pair of sizes, and an axis, prepared once and asked about many centres. It may be copied and sent anywhere.
#[derive(Clone, Copy)]
pub struct Scene(ffi::Scene);

impl Scene {
    /// Prepares the pair; `axis` is (0, 0, 1) for an upright spheroid. A pair that is not valid answers so everywhere.
    #[must_use]
    pub fn new(sizes: Sizes, axis: [f64; 3]) -> Self {
        let mut scene = ffi::Scene { kept: [0.0; 72] };
        let none = core::ptr::null();
        let sizes = [sizes.alpha, sizes.gamma, sizes.b, sizes.d];
        // SAFETY: the scene is written, sizes and axis are read, and no centre is given.
        unsafe { ffi::hypcheck_prepare(&mut scene, sizes.as_ptr(), axis.as_ptr(), 0, none, none, none) };
        Self(scene)
    }

    /// The positions at these centres, as of [`classify`].
    ///
    /// # Panics
    /// If the columns and the answers are not equally long.
    pub fn classify(&self, x: &[f64], y: &[f64], z: &[f64], positions: &mut [i8]) {
        for column in [x, y, z] {
            check(column.len(), positions.len());
        }
        let (x, y, z) = (x.as_ptr(), y.as_ptr(), z.as_ptr());
        // SAFETY: four slices of one length, of which the last is written.
        unsafe { ffi::hypcheck_ask_prepared(0, &self.0, positions.len(), x, y, z, positions.as_mut_ptr()) };
    }

    /// The position at one centre.
    ///
    /// # Errors
    /// [`Invalid`] where a number is none, of the pair or of the centre.
    pub fn position(&self, center: [f64; 3]) -> Result<Position, Invalid> {
        let ([x, y, z], mut answer) = (center, [INVALID]);
        self.classify(&[x], &[y], &[z], &mut answer);
        position_of(answer[0])
    }
}

/// How far an upright spheroid is from the surface; every bound is proved by exact decisions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// The position, with which the bounds agree in sign.
    pub position: Position,
    /// `lower` ≤ c ≤ `upper`: 1 + c times as large, the spheroid first touches.
    pub lower: f64,
    /// See `lower`; `f64::MAX` is no bound.
    pub upper: f64,
    /// The Euclidean distance lies between this and `distance_upper`; both are 0 in contact.
    pub distance_lower: f64,
    /// See `distance_lower`.
    pub distance_upper: f64,
    /// A point of the hyperboloid that is `distance_upper` away at most, but for the rounding of its coordinates.
    pub nearest: [f64; 3],
}

/// The clearance and the distance of one upright spheroid.
///
/// # Errors
/// [`Invalid`] where a number is none.
pub fn clearance(sizes: Sizes, center: [f64; 3]) -> Result<Clearance, Invalid> {
    let [x, y, z] = center;
    let row = [sizes.alpha, sizes.gamma, sizes.b, sizes.d, x, y, z];
    let mut answer = INVALID;
    let mut near = ffi::Near::default();
    // SAFETY: one row of seven doubles is read, one answer and one hypcheck_near are written.
    unsafe { ffi::hypcheck_clearance(1, row.as_ptr(), &mut answer, &mut near) };
    Ok(Clearance {
        position: position_of(answer)?,
        lower: near.lower,
        upper: near.upper,
        distance_lower: near.distance_lower,
        distance_upper: near.distance_upper,
        nearest: near.nearest,
    })
}

/// The version of hypcheck, which the crate shares.
#[must_use]
pub fn version() -> &'static str {
    // SAFETY: the function returns a constant text.
    text(unsafe { ffi::hypcheck_version() })
}

/// The instruction set in use: "avx512", "avx2", "sse2", "neon" or "plain".
#[must_use]
pub fn level() -> &'static str {
    // SAFETY: the function returns a constant text.
    text(unsafe { ffi::hypcheck_level() })
}

/// Chooses an instruction set for the whole program; `false`, and nothing changes, where this machine or build lacks it.
pub fn use_level(name: &CStr) -> bool {
    // SAFETY: a text that ends in 0 is read.
    let done: c_int = unsafe { ffi::hypcheck_use_level(name.as_ptr()) };
    done != 0
}

fn text(start: *const c_char) -> &'static str {
    // SAFETY: the texts of the library are constants that end in 0.
    unsafe { CStr::from_ptr(start) }.to_str().unwrap_or("")
}
