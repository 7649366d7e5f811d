//! The predicate under test.

/// What it claims. Before "binary", "times":true says that times go with hits, and "tilt":true that it is asked about
/// tilted spheroids: tilted answers all rows then.
pub const DESCRIPTION: &str = concat!(
    r#"{"protocol":1,"name":"@NAME@","version":"0.0.0","language":"rust","precision":"float64","#,
    r#""question":"passage","binary":true,"time":true}"#
);

/// When does the spheroid with semi-axes b, b, d, whose centre goes straight from (x0, y0, z0) at time 0 to (x1, y1, z1)
/// at time 1, first touch x²/alpha² + y²/alpha² − z²/gamma² = 1? From 0 to 1, or −1 where it is clear all the way.
///
/// Replace this with your predicate, or with a call of it. The stub takes the spheroid for its centre: right where that
/// goes through the wall, though late, and wrong where only the body touches it.
pub fn predicate([alpha, gamma, _b, _d, x0, y0, z0, x1, y1, z1]: [f64; 10]) -> f64 {
    let (x, y, z) = (x0 / alpha, y0 / alpha, z0 / gamma);
    let (u, v, w) = ((x1 - x0) / alpha, (y1 - y0) / alpha, (z1 - z0) / gamma);
    let (p, q, r) = (
        u * u + v * v - w * w,
        x * u + y * v - z * w,
        x * x + y * y - z * z - 1.0,
    );
    let root = (q * q - p * r).sqrt(); // p t² + 2 q t + r = 0
    let s = -(q + root.copysign(q));
    let (first, last) = ((s / p).min(r / s), (s / p).max(r / s));
    *[first, last]
        .iter()
        .find(|time| (0.0..=1.0).contains(*time))
        .unwrap_or(&-1.0)
}

/// The same with the spheroid's axis of revolution, a vector of any length and sign, behind the other numbers; it stays as
/// it is on the way. The stub ignores it. Asked only with "tilt":true.
pub fn tilted(
    [alpha, gamma, b, d, x0, y0, z0, x1, y1, z1, _axis_x, _axis_y, _axis_z]: [f64; 13],
) -> f64 {
    predicate([alpha, gamma, b, d, x0, y0, z0, x1, y1, z1])
}
