// The explorer's exact answer where the hyperboloid ends, in BigInt: the rule in the height (docs/mathematics.md,
// "Towers that end"). At height w the plane cuts the wall in a circle of radius r, and the solid spheroid in a disc of
// radius s. With Q = r² − s² + R, R = x² + y², circle and disc miss each other where Q > 0 and F = Q² − 4 R r² > 0.
"use strict";

const ends = (() => {
  /** More bits than this in a coefficient of F would take long: then nothing is said. */
  const MOST_BITS = 40000;

  const sign = (n) => (n > 0n ? 1 : n < 0n ? -1 : 0);
  const at = (polynomial, w) => polynomial.reduce((sum, coefficient) => sum * w + coefficient, 0n);

  /** The polynomial from its first coefficient that is not 0 on; none is left of 0. */
  function trimmed(polynomial) {
    const first = polynomial.findIndex((n) => n !== 0n);
    return first < 0 ? [] : polynomial.slice(first);
  }

  /** The remainder of f by g, the highest power first, times a number > 0. */
  function remainder(f, g) {
    let left = f;
    const [head, size] = [g[0], g[0] < 0n ? -g[0] : g[0]];
    while (left.length >= g.length) {
      const first = head < 0n ? -left[0] : left[0];
      left = left.map((n, place) => size * n - first * (g[place] ?? 0n)).slice(1);
    }
    return trimmed(left);
  }

  /** How many real roots F, which is not 0 at either height, has between them; null is no end. Sturm's theorem. */
  function roots(f, low, high) {
    const chain = [f, f.slice(0, -1).map((n, place) => n * BigInt(f.length - 1 - place))];
    for (;;) {
      const next = remainder(chain[chain.length - 2], chain[chain.length - 1]);
      if (!next.length) break;
      chain.push(next.map((n) => -n));
    }
    const changes = (w, far) => {
      const signs = chain.map((g) => (w === null ? sign(g[0]) * (g.length % 2 ? 1 : far) : sign(at(g, w)))).filter(Boolean);
      return signs.filter((each, place) => place && each !== signs[place - 1]).length;
    };
    return changes(low, -1) - changes(high, 1);
  }

  /**
   * The exact position of a row of seven numbers beside a wall from `low` to `high`, which may be infinite, with flat
   * ends if it is `solid`; `whole` is that without ends. null: numbers are too long for it to be decided here.
   */
  function position(row, { low, high, solid }, whole) {
    const [alpha, gamma, b, d, x, y, z] = row;
    const finite = [low, high].filter(Number.isFinite);
    const [alpha_, b_, x_, y_] = explorer.integers(alpha, b, x, y);
    const [gamma_, d_, z_, ...heights] = explorer.integers(gamma, d, z, ...finite);
    const [p, q, R] = [alpha_ * alpha_, b_ * b_, x_ * x_ + y_ * y_];
    const [s, t] = [gamma_ * gamma_, d_ * d_];
    const bottom = Number.isFinite(low) ? heights[0] : null;
    const top = Number.isFinite(high) ? heights[heights.length - 1] : null;
    // r² and s², times γ² d²: quadratic in w
    const wall = [p * t, 0n, p * t * s];
    const disc = [-q * s, 2n * q * s * z_, q * s * (t - z_ * z_)];
    const Q = [wall[0] - disc[0], -disc[1], wall[2] - disc[2] + R * s * t];
    const circleMisses = (w) => {
      const [one, square] = [at(Q, w), at(wall, w)];
      return one > 0n && one * one > 4n * R * s * t * square;
    };
    const meetsWall = () => {
      if ([bottom, top].some((w) => w !== null && !circleMisses(w))) return true;
      const [u, v, w] = Q;
      const far = 4n * R * s * t;
      const F = [u * u, 2n * u * v, v * v + 2n * u * w - far * wall[0], 2n * v * w, w * w - far * wall[2]];
      if (F.some((n) => n.toString(16).length * 4 > MOST_BITS)) return null;
      return roots(F, bottom, top) > 0;
    };
    const meetsDisc = (w) => {
      const [square, other] = [at(wall, w), at(disc, w)];
      const m = R * s * t - square - other;
      return other >= 0n && (m <= 0n || m * m <= 4n * square * other);
    };
    const meets = whole === 0 ? meetsWall() : false;
    if (meets) return 0;
    if (solid && [bottom, top].some((w) => w !== null && meetsDisc(w))) return 0;
    if (meets === null) return null;
    const between = (bottom === null || bottom <= z_) && (top === null || z_ <= top);
    return between && R * s <= p * (s + z_ * z_) ? -1 : 1;
  }

  return { position };
})();
