// The predicate under test.

// What it claims. times: true says that times go with hits, tilt: true that it is asked about tilted spheroids: tilted
// answers all rows then.
export const description = {
  protocol: 1,
  name: "@NAME@",
  version: "0.0.0",
  language: "javascript",
  precision: "float64",
  question: "passage",
  binary: true,
  time: true,
};

/**
 * When does the spheroid with semi-axes b, b, d, whose centre goes straight from (x0, y0, z0) at time 0 to (x1, y1, z1) at
 * time 1, first touch x²/alpha² + y²/alpha² − z²/gamma² = 1? From 0 to 1, or −1 where it is clear all the way.
 *
 * Replace this with your predicate, or with a call of it. The stub takes the spheroid for its centre: right where that
 * goes through the wall, though late, and wrong where only the body touches it.
 */
export function predicate(alpha, gamma, b, d, x0, y0, z0, x1, y1, z1) {
  const [x, y, z] = [x0 / alpha, y0 / alpha, z0 / gamma];
  const [u, v, w] = [(x1 - x0) / alpha, (y1 - y0) / alpha, (z1 - z0) / gamma];
  const [p, q, r] = [u * u + v * v - w * w, x * u + y * v - z * w, x * x + y * y - z * z - 1];
  const root = Math.sqrt(q * q - p * r); // p t² + 2 q t + r = 0
  const s = -(q + (q < 0 ? -root : root));
  const first = Math.min(s / p, r / s);
  const last = Math.max(s / p, r / s);
  return first >= 0 && first <= 1 ? first : last >= 0 && last <= 1 ? last : -1;
}

/**
 * The same with the spheroid's axis of revolution along (axisX, axisY, axisZ) all the way, a vector of any length and sign.
 * The stub ignores it. Asked only with tilt: true.
 */
export function tilted(alpha, gamma, b, d, x0, y0, z0, x1, y1, z1, axisX, axisY, axisZ) {
  return predicate(alpha, gamma, b, d, x0, y0, z0, x1, y1, z1);
}
