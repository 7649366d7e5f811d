//! The predicate under test.

/// What it claims. "question" may be position (+1 exterior, 0 contact, -1 interior), exterior, interior or contact
/// (1 yes, 0 no). Table 2 claims to be right where (gamma/d)² ≥ alpha/b; without "domain" all sizes are asked.
/// With "tilt":true before "binary" it is asked about tilted spheroids: tilted answers all rows then.
pub const DESCRIPTION: &str = concat!(
    r#"{"protocol":1,"name":"@NAME@","version":"0.0.0","language":"rust","precision":"float64","#,
    r#""question":"exterior","domain":{"regimes":["c2>=a"]},"binary":true,"time":true}"#
);

/// Is the spheroid with semi-axes b, b, d and centre (x, y, z) exterior to x²/alpha² + y²/alpha² − z²/gamma² = 1?
///
/// Replace this with your predicate, or with a call of it. The stub is Table 2 (Procedure 1) of "Algorithms for
/// Determining Relative Position between Spheroids and Hyperboloids with One Sheet": right in the paper's scenes, wrong
/// on the ring, where its discriminant vanishes far from the surface.
#[allow(non_snake_case)]
pub fn predicate([alpha, gamma, b, d, x, y, z]: [f64; 7]) -> i8 {
    let A = (alpha / b) * (alpha / b);
    let B = (gamma / d) * (gamma / d);
    let c0 = -(A * B);
    let C = c0 + A - B;

    let P = (x * x + y * y) / (b * b);
    let Q = (z / d) * (z / d);
    let c1 = C + B * P - A * Q;
    let c2 = A - B + 1.0 - P - Q;
    let delta = -4.0 * (c2 * c2 * c2) * c0 + (c2 * c1) * (c2 * c1) + 18.0 * c2 * c1 * c0
        - 4.0 * (c1 * c1 * c1)
        - 27.0 * (c0 * c0);
    (delta > 0.0 && c2 < 0.0 && c1 > 0.0) as i8
}

/// The same with the spheroid's axis of revolution, a vector of any length and sign, behind the other numbers; upright
/// where its x and y are 0. The stub ignores it: wrong as soon as the spheroid is tilted. Asked only with "tilt":true.
pub fn tilted([alpha, gamma, b, d, x, y, z, _axis_x, _axis_y, _axis_z]: [f64; 10]) -> i8 {
    predicate([alpha, gamma, b, d, x, y, z])
}
