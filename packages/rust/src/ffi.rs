//! What hypcheck.h declares, of which lib.rs makes safe functions. The header says what each does.

use core::ffi::{c_char, c_int};

/// hypcheck_scene.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Scene {
    pub kept: [f64; 72],
}

/// hypcheck_near.
#[repr(C)]
#[derive(Default)]
pub struct Near {
    pub lower: f64,
    pub upper: f64,
    pub touch_error: f64,
    pub distance_lower: f64,
    pub distance_upper: f64,
    pub touch: [f64; 3],
    pub nearest: [f64; 3],
}

extern "C" {
    pub fn hypcheck_position(alpha: f64, gamma: f64, b: f64, d: f64, x: f64, y: f64, z: f64) -> c_int;
    pub fn hypcheck_classify(n: usize, rows: *const f64, positions: *mut i8);
    pub fn hypcheck_classify_tilted(n: usize, rows10: *const f64, positions: *mut i8);
    pub fn hypcheck_classify_ended(n: usize, rows13: *const f64, positions: *mut i8);
    pub fn hypcheck_passage_columns(n: usize, width: usize, rows: *const f64, hits: *mut i8, times: *mut f64);
    pub fn hypcheck_prepare(
        scene: *mut Scene,
        sizes: *const f64,
        axis: *const f64,
        n: usize,
        x: *const f64,
        y: *const f64,
        z: *const f64,
    );
    pub fn hypcheck_ask_prepared(
        question: c_int,
        scene: *const Scene,
        n: usize,
        x: *const f64,
        y: *const f64,
        z: *const f64,
        answers: *mut i8,
    ) -> usize;
    pub fn hypcheck_clearance(n: usize, rows: *const f64, positions: *mut i8, found: *mut Near) -> usize;
    pub fn hypcheck_version() -> *const c_char;
    pub fn hypcheck_level() -> *const c_char;
    pub fn hypcheck_use_level(name: *const c_char) -> c_int;
}
