// The predicate under test.

// What it claims. "question" may be position (+1 exterior, 0 contact, -1 interior), exterior, interior or contact
// (1 yes, 0 no). Table 2 claims to be right where (gamma/d)² ≥ alpha/b; without "domain" all sizes are asked.
// With tilt: true it is asked about tilted spheroids: tilted answers all rows then.
export const description = {
  protocol: 1,
  name: "@NAME@",
  version: "0.0.0",
  language: "javascript",
  precision: "float64",
  question: "exterior",
  domain: { regimes: ["c2>=a"] },
  binary: true,
  time: true,
};

/**
 * Is the spheroid with semi-axes b, b, d and centre (x, y, z) exterior to x²/alpha² + y²/alpha² − z²/gamma² = 1?
 *
 * Replace this with your predicate, or with a call of it. The stub is Table 2 (Procedure 1) of "Algorithms for
 * Determining Relative Position between Spheroids and Hyperboloids with One Sheet": right in the paper's scenes, wrong
 * on the ring, where its discriminant vanishes far from the surface.
 */
export function predicate(alpha, gamma, b, d, x, y, z) {
  const A = (alpha / b) * (alpha / b);
  const B = (gamma / d) * (gamma / d);
  const c0 = -(A * B);
  const C = c0 + A - B;

  const P = (x * x + y * y) / (b * b);
  const Q = (z / d) * (z / d);
  const c1 = C + B * P - A * Q;
  const c2 = A - B + 1 - P - Q;
  const delta =
    -4 * (c2 * c2 * c2) * c0 + (c2 * c1) * (c2 * c1) + 18 * c2 * c1 * c0 - 4 * (c1 * c1 * c1) - 27 * (c0 * c0);
  return delta > 0 && c2 < 0 && c1 > 0 ? 1 : 0;
}

/**
 * The same with the spheroid's axis of revolution along (axisX, axisY, axisZ), a vector of any length and sign, upright
 * where axisX = axisY = 0. The stub ignores it: wrong as soon as the spheroid is tilted. Asked only with tilt: true.
 */
export function tilted(alpha, gamma, b, d, x, y, z, axisX, axisY, axisZ) {
  return predicate(alpha, gamma, b, d, x, y, z);
}
