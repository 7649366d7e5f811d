/* ---- hyperboloids that end ---- */

#define HC_MOST_PIECES 48
#define HC_ENDED_STEPS 14 /* of Newton's method for a multiplier; any result is safe */
#define HC_ENDED_ERROR 1.4210854715202004e-14 /* 2^-46 = 128u */
#define HC_MOST_ASKED 160 /* pieces that are looked at, of which HC_MOST_PIECES wait */
#define HC_ENDED_AIMS 4
#define HC_ENDED_NEAREST 9e-13 /* below 2^-40: how near lambda may come to -mu, in mu */
#define HC_ENDED_LEAST 8.6361685550944446e-78 /* 2^-256 */
#define HC_ENDED_GREATEST 1.157920892373162e+77 /* 2^256 */

/* A pair in the directions of the horizontal ellipses that planes cut from the spheroid (truth/sections.py of hypcheck
   has the rule). At a height w, with t = w - z, the ellipse is mu1 (X - eta)² + mu2 (Y - xi)² <= 1 - t²/T, xi = xi0 - k t,
   and the circle has r² = alpha² (1 + w²/gamma²). For one lambda > -min(mu1, mu2) the circle misses the ellipse where

       phi(w) = t²/T - 1 - lambda r² + f1 eta² + f2 xi² > 0,    f = lambda mu/(mu + lambda),

   a quadratic in w. (c, s) is the horizontal direction of the axis. `across` is |x| + |y|, which eta and xi0 are below. */
typedef struct {
    double alpha, ratio, z, T, mu1, mu2, eta, xi0, k, c, s, across;
} hc_sections;

static void hc_place_sections(hc_sections *made, const double center[3]) {
    made->xi0 = center[0] * made->c + center[1] * made->s;
    made->eta = center[0] * made->s - center[1] * made->c;
    made->z = center[2];
    made->across = hc_size(center[0]) + hc_size(center[1]);
}

/* Returns 0 where the numbers are too large or small for the bounds: mu, T, r² and their products stay normal. */
static int hc_make_sections(hc_sections *made, const double row[10]) {
    const double b = row[2], d = row[3];
    double v[3], s2, c2, away, flat, length;
    int k;
    memcpy(v, row + 7, sizeof v);
    hc_scale_axis(v);
    flat = v[0] * v[0] + v[1] * v[1];
    length = flat + v[2] * v[2];
    for (k = 0; k < 7; k++) {
        const double size = hc_size(row[k]);
        if (size > 1.2676506002282294e+30 /* 2^100 */ || (k < 4 && size < 7.8886090522101181e-31 /* 2^-100 */)) return 0;
    }
    if (!(length > HC_ENDED_LEAST && length < HC_ENDED_GREATEST) || (flat != 0 && flat < HC_ENDED_LEAST)) return 0;
    s2 = flat / length;
    c2 = v[2] * v[2] / length;
    away = flat == 0 ? 0 : 1 / hc_fine_root(flat);
    made->alpha = row[0];
    made->ratio = 1 / row[1];
    made->T = b * b * s2 + d * d * c2;
    made->mu1 = 1 / (b * b);
    made->mu2 = made->T / (b * b * (d * d));
    made->c = flat == 0 ? 1 : v[0] * away;
    made->s = v[1] * away;
    made->k = v[2] * flat * away / length * ((b - d) * (b + d)) / made->T;
    hc_place_sections(made, row + 4);
    return 1;
}

static double hc_radius(const hc_sections *pair, double w) {
    const double slope = w * pair->ratio;
    return pair->alpha * hc_fine_root(1 + slope * slope);
}

/* About the lambda at which phi(w) is greatest: the root of mu1² eta²/(mu1+l)² + mu2² xi²/(mu2+l)² = r². In n = l + the
   smaller mu the left side falls from infinity; Newton's method for its inverse root, between bounds. */
static double hc_ended_multiplier(const hc_sections *pair, double r, double xi) {
    const double p = pair->mu1 * hc_size(pair->eta), q = pair->mu2 * hc_size(xi);
    const double least = pair->mu1 < pair->mu2 ? pair->mu1 : pair->mu2, most = p + q;
    double low = least * 9.0949470177292824e-13 /* 2^-40 */, high = most / r > low ? most / r : low, n = high;
    int i;
    for (i = 0; i < HC_ENDED_STEPS; i++) {
        const double one = 1 / (n + (pair->mu1 - least)), two = 1 / (n + (pair->mu2 - least));
        const double sum = p * one * (p * one) + q * two * (q * two), root = hc_rough_root(sum);
        const double fall = (p * one * (p * one) * one + q * two * (q * two) * two);
        double moved;
        if (!(sum > 0)) return low - least;
        if (root > r) low = n;
        else high = n;
        moved = n + (root / r - 1) * sum / fall;
        if (hc_size(moved - n) < 1e-9 * n) return moved - least; /* at the root itself it may be out of bounds by an ulp */
        if (!(moved > low && moved < high)) moved = high > 4 * low ? hc_rough_root(low * high) : 0.5 * (low + high);
        n = moved;
    }
    return n - least;
}

/* The least slope v + bend v² for 0 <= v <= reach. */
static double hc_least_of(double slope, double bend, double reach) {
    const double end = (slope + bend * reach) * reach;
    if (bend > 0 && slope < 0 && -slope < 2 * bend * reach) return -slope * slope / (4 * bend);
    return end < 0 ? end : 0;
}

static double hc_least_between(double slope, double bend, double pull, double below, double above) {
    const double up = hc_least_of(slope - pull, bend, above), down = hc_least_of(-slope - pull, bend, below);
    return up < down ? up : down;
}

static double hc_kept_within(double at, double low, double high) { return !(at > low) ? low : at < high ? at : high; }

/* phi about a height w for one lambda, value + slope v + bend v². Over a piece its parts are right within 32u of `size`, f
   within 32u mu/(mu + lambda) of itself, since mu + lambda may cancel; the slope and the bend, times what v is at most,
   within 32u of `pull` times that. `safe`: lambda is not too near -mu. */
typedef struct {
    double value, slope, bend, size, pull;
    int safe;
} hc_phi;

static hc_phi hc_phi_about(const hc_sections *pair, double lambda_, double w, double reach) {
    const double n1 = pair->mu1 + lambda_, n2 = pair->mu2 + lambda_;
    const double f1 = lambda_ * pair->mu1 / n1, f2 = lambda_ * pair->mu2 / n2, t = w - pair->z, xi = pair->xi0 - pair->k * t;
    const double g = pair->ratio * pair->alpha, l2 = lambda_ * (g * g), top = hc_size(t) + reach, wide = hc_size(w) + reach;
    const double along = pair->across + hc_size(pair->k) * top, loose = hc_size(f2) * (1 + pair->mu2 / n2);
    hc_phi phi;
    phi.value = t * t / pair->T - 1 - lambda_ * (pair->alpha * pair->alpha) - l2 * (w * w) + f1 * (pair->eta * pair->eta) + f2 * (xi * xi);
    phi.slope = 2 * (t / pair->T - l2 * w - f2 * (xi * pair->k));
    phi.bend = 1 / pair->T - l2 + f2 * (pair->k * pair->k);
    phi.size = 1 + top * top / pair->T + hc_size(lambda_) * (pair->alpha * pair->alpha) + hc_size(l2) * (wide * wide) +
               hc_size(f1) * (pair->across * pair->across) * (1 + pair->mu1 / n1) + loose * (along * along);
    phi.pull = 4 * (top / pair->T + hc_size(l2) * wide + loose * (along * hc_size(pair->k)));
    phi.safe = n1 > pair->mu1 * HC_ENDED_NEAREST && n2 > pair->mu2 * HC_ENDED_NEAREST;
    return phi;
}

/* The size of the terms of a point of the circle. */
static double hc_point_size(const hc_sections *pair, double r, double w) {
    const double t = w - pair->z, across = r + pair->across, along = across + hc_size(pair->k * t);
    return pair->mu1 * (across * across) + pair->mu2 * (along * along) + t * t / pair->T + 1;
}

/* Whether the point of the circle at height w in the direction (a, c) of eta and xi surely lies inside the spheroid. */
static int hc_point_within(const hc_sections *pair, double r, double w, double xi, double a, double c) {
    const double length = hc_fine_root(a * a + c * c), t = w - pair->z;
    double off, aside;
    if (!(length > 0)) return 0;
    off = r * (a / length) - pair->eta;
    aside = r * (c / length) - xi;
    return pair->mu1 * (off * off) + pair->mu2 * (aside * aside) + t * t / pair->T - 1 < -HC_ENDED_ERROR * hc_point_size(pair, r, w);
}

/* The same by numbers of two doubles. */
static int hc_point_surely_within(const hc_sections *pair, const hc_fine_sections *fine, double w, double a, double c) {
    const double length = a * a + c * c;
    if (!(length > HC_ENDED_LEAST && length < HC_ENDED_GREATEST)) return 0;
    return hc_fine_point(fine, w, a, c) < -HC_FINE_ERROR * hc_point_size(pair, hc_radius(pair, w), w);
}

/* The direction of the point of the circle at which phi for this lambda is taken, scaled to r where lambda is as near to -mu
   as it comes: there the share of that axis is what is left. */
static void hc_direction_of(const hc_sections *pair, double lambda_, double r, double xi, double *a, double *c) {
    double left;
    *a = pair->eta * (pair->mu1 / (pair->mu1 + lambda_));
    *c = xi * (pair->mu2 / (pair->mu2 + lambda_));
    left = r * r - *a * *a - *c * *c;
    if (!(left > 1e-6 * (r * r))) return;
    if (pair->mu1 < pair->mu2) *a = (pair->eta < 0 ? -1 : 1) * hc_fine_root(*a * *a + left);
    else *c = (xi < 0 ? -1 : 1) * hc_fine_root(*c * *c + left);
}

/* Moves a height of a piece to about where max phi over lambda is least, by Newton's method: its slope is that of phi, its
   bend greater by what a lambda that follows adds. Any result is safe. Returns lambda there. */
static double hc_aim_at_least(const hc_sections *pair, double low, double high, double *height) {
    double w = *height;
    int i;
    for (i = 0;; i++) {
        const double xi = pair->xi0 - pair->k * (w - pair->z), lambda_ = hc_ended_multiplier(pair, hc_radius(pair, w), xi);
        const double n1 = pair->mu1 + lambda_, n2 = pair->mu2 + lambda_, s1 = pair->mu1 / n1, s2 = pair->mu2 / n2;
        const double all = s1 * s1 * (pair->eta * pair->eta) / n1 + s2 * s2 * (xi * xi) / n2, g = pair->ratio * pair->alpha;
        const double follow = g * g * w + s2 * s2 * (xi * pair->k);
        const hc_phi phi = hc_phi_about(pair, lambda_, w, 0);
        const double bend = all > 0 ? phi.bend + follow * follow / all : phi.bend;
        double at;
        *height = w;
        if (i == HC_ENDED_AIMS) return lambda_;
        at = hc_kept_within(bend > 0 ? w - phi.slope / (2 * bend) : phi.slope < 0 ? high : low, low, high);
        if (at == w) return lambda_;
        w = at;
    }
}

/* 0 where the wall between two heights surely meets the spheroid, 1 where it surely misses it, 2 where neither is known.
   Numbers of two doubles are asked where doubles leave the sign open of the least that is found in a piece. */
static int hc_wall_misses(const hc_sections *pair, const double row[10], double low, double high) {
    double lows[HC_MOST_PIECES], highs[HC_MOST_PIECES];
    hc_fine_sections fine;
    int left = 1, asked = 0, made = 0;
    lows[0] = low, highs[0] = high;
    while (left) {
        double w, middle, reach, xi, r, lambda_, a, c, below, above, lowest;
        hc_phi phi;
        left--;
        low = lows[left], high = highs[left];
        w = middle = hc_kept_within(low + 0.5 * (high - low), low, high);
        reach = (high - low) * (1 + HC_u_8);
        r = hc_radius(pair, w);
        xi = pair->xi0 - pair->k * (w - pair->z);
        lambda_ = hc_ended_multiplier(pair, r, xi);
        below = (w - low) * (1 + HC_u_8), above = (high - w) * (1 + HC_u_8);
        phi = hc_phi_about(pair, lambda_, w, below > above ? below : above);
        if (phi.safe && phi.value + hc_least_between(phi.slope, phi.bend, 0, below, above) > HC_ENDED_ERROR * phi.size) continue;
        hc_direction_of(pair, lambda_, r, xi, &a, &c);
        if (hc_point_within(pair, r, w, xi, a, c) || hc_point_within(pair, r, w, xi, 1, 0) || hc_point_within(pair, r, w, xi, -1, 0) ||
            hc_point_within(pair, r, w, xi, 0, 1) || hc_point_within(pair, r, w, xi, 0, -1))
            return 0;
        lambda_ = hc_aim_at_least(pair, low, high, &w);
        r = hc_radius(pair, w);
        xi = pair->xi0 - pair->k * (w - pair->z);
        below = (w - low) * (1 + HC_u_8), above = (high - w) * (1 + HC_u_8);
        phi = hc_phi_about(pair, lambda_, w, reach);
        lowest = phi.value + hc_least_between(phi.slope, phi.bend, 0, below, above);
        if (phi.safe && lowest > HC_ENDED_ERROR * phi.size) continue;
        hc_direction_of(pair, lambda_, r, xi, &a, &c);
        if (hc_point_within(pair, r, w, xi, a, c)) return 0;
        if (phi.value <= 2 * HC_ENDED_ERROR * phi.size && -phi.value <= 2 * HC_ENDED_ERROR * (phi.size + hc_point_size(pair, r, w))) {
            if (!made) fine = hc_make_fine(row, 0);
            made = 1;
            if (hc_point_surely_within(pair, &fine, w, a, c)) return 0;
            if (phi.safe) {
                const double value = hc_fine_phi(&fine, lambda_, w), error = HC_FINE_ERROR * phi.size;
                if (value + hc_least_between(phi.slope, phi.bend, HC_ENDED_ERROR * phi.pull, below, above) > error) continue;
                if (hc_size(value) <= error) return 2;
            }
        }
        if (++asked > HC_MOST_ASKED || left + 2 > HC_MOST_PIECES || !(middle > low && middle < high)) return 2;
        if (w - low > 0.125 * (high - low) && high - w > 0.125 * (high - low)) middle = w;
        lows[left] = low, highs[left++] = middle;
        lows[left] = middle, highs[left++] = high;
    }
    return 1;
}

/* The same of the disc at a height, whose rim is known to miss the spheroid. */
static int hc_disc_misses(const hc_sections *pair, double w) {
    const double t = w - pair->z, share = t * t / pair->T, r = hc_radius(pair, w), xi = pair->xi0 - pair->k * t;
    const double off = pair->eta * pair->eta + xi * xi - r * r, along = pair->across + hc_size(pair->k * t);
    const double size = along * along + pair->across * pair->across + r * r;
    if (share - 1 > HC_ENDED_ERROR * (share + 1) || off > HC_ENDED_ERROR * size) return 1;
    return 1 - share > HC_ENDED_ERROR * (share + 1) && off < -HC_ENDED_ERROR * size ? 0 : 2;
}

/* The same by numbers of two doubles. */
static int hc_disc_surely_misses(const hc_sections *pair, const double row[10], double w) {
    const hc_fine_sections fine = hc_make_fine(row, 0);
    const hc_twin t = hc_twin_difference(hc_twin_of(w), fine.z), xi = hc_twin_difference(fine.X, hc_twin_product(fine.kappa, t));
    const hc_twin center = hc_twin_quotient(hc_twin_sum(hc_twin_square(fine.E), hc_twin_square(xi)), fine.F);
    const double share = hc_fine_share(&fine, t).high, off = hc_twin_difference(center, hc_fine_square_of_radius(&fine, w)).high;
    const double high = w - pair->z, r = hc_radius(pair, w), along = pair->across + hc_size(pair->k * high);
    const double most = HC_FINE_ERROR * (along * along + pair->across * pair->across + r * r), error = HC_FINE_ERROR * (high * high / pair->T + 1);
    if (share > error || off > most) return 1;
    return share < -error && off < -most ? 0 : 2;
}

/* Whether the centre lies in the body, 2 where bounds do not tell: rounding leaves each side right within 8u. */
static int hc_center_inside(const double row[13]) {
    const double x = row[4] / row[0], y = row[5] / row[0], up = row[6] / row[1];
    const double out = x * x + y * y, in = up * up + 1;
    if (!(row[6] >= row[10] && row[6] <= row[11]) || out > in * (1 + HC_ENDED_ERROR)) return 0;
    return out * (1 + HC_ENDED_ERROR) < in ? 1 : 2;
}

/* Whether the spheroid, which is upright, surely meets the circle at a height: with R = x² + y² and the squares r² and s² of
   the radii of both circles there, (√R - r)² < s². */
static int hc_upright_met(const double row[13], double w) {
    const double t = (w - row[6]) / row[3], up = w / row[1], share = t * t;
    const double R = row[4] * row[4] + row[5] * row[5], r = row[0] * row[0] * (1 + up * up), s = row[2] * row[2] * (1 - share);
    const double size = HC_ENDED_ERROR * (R + r + row[2] * row[2] * (1 + share)), off = R + r - s;
    const double most = off + size; /* at or below 0 both circles have points within each other */
    if (!(s > size && most < HC_cap)) return 0;
    return most < 0 || (size > HC_ENDED_LEAST && most * most < 4 * R * r * (1 - HC_ENDED_ERROR));
}

/* Whether F(w) = Q² - 4 R r² surely grows with every step away from an end, for so far into the body: `side` is 1 at the
   upper end. F is a quartic, F' = 2 Q Q' - 4 R (r²)', and |F''| has a bound of the sizes of its terms. Where the circle at
   the end misses the spheroid, so do all those. */
static int hc_grows_from_end(const double row[13], double w, double far, int side) {
    const double g = row[0] / row[1], e = row[2] / row[3], t = w - row[6], R = row[4] * row[4] + row[5] * row[5];
    const double wide = hc_size(w) + far, top = hc_size(t) + far, r2 = 2 * (g * g), s2 = 2 * (e * e);
    const double Q = row[0] * row[0] + 0.5 * r2 * (w * w) + R - row[2] * row[2] + 0.5 * s2 * (t * t);
    const double most = row[0] * row[0] + 0.5 * r2 * (wide * wide) + R + row[2] * row[2] + 0.5 * s2 * (top * top);
    const double rise = r2 * w + s2 * t, steep = r2 * wide + s2 * top;
    const double slope = -side * (2 * Q * rise - 4 * R * (r2 * w));
    const double size = 2 * most * steep + 4 * R * (r2 * wide), bend = 2 * (steep * steep) + 2 * most * (r2 + s2) + 4 * R * r2;
    if (!(size < HC_cap && bend < HC_cap && size > HC_ENDED_LEAST)) return 0;
    return slope > 4 * HC_ENDED_ERROR * size + bend * far * (1 + HC_ENDED_ERROR);
}

#define HC_BESIDE_END 6.103515625e-05 /* 2^-14 of d, which is left out beside an end that is looked at in integers */

/* hc_wall_misses of an upright spheroid where bounds tell nothing: the ends in integers, what is next to them by the slope
   there, and the rest by bounds. */
static int hc_upright_wall_misses(const hc_sections *pair, const double row[13], double bottom, double top) {
    double low = bottom, high = top, far = HC_BESIDE_END * row[3];
    int k;
    if (far > 0.25 * (top - bottom)) far = 0.25 * (top - bottom);
    for (k = 0; k < 2; k++) {
        const double w = row[10 + k];
        hc_end end;
        if (w != (k ? top : bottom)) continue; /* the spheroid does not reach this end */
        end = hc_exact_end(row, w);
        if (!end.known) return 2;
        if (!end.misses) return 0;
        if (!hc_grows_from_end(row, w, 1.0625 * far, k ? 1 : -1)) continue; /* bounds may do */
        if (k) high = w - far;
        else low = w + far;
    }
    return low < high ? hc_wall_misses(pair, row, low, high) : 2;
}

/* 0 where the wall between the ends surely meets the spheroid, 1 where it surely misses it, 2 where neither is known; the
   spheroid meets the surface without ends, and reaches from z - more to z + more at most. */
static int hc_ended_wall_misses(const hc_sections *pair, const double row[13], double more, int upright) {
    const double z = row[6], bottom = row[10] > z - more ? row[10] : z - more, top = row[11] < z + more ? row[11] : z + more;
    int misses;
    if (bottom > top) return 1; /* z - more and z + more lie beyond the spheroid, though rounded */
    misses = hc_wall_misses(pair, row, bottom, top);
    if (misses == 2 && (bottom > z - more ? hc_wall_misses(pair, row, z - more, bottom) == 1 : 1) &&
        (top < z + more ? hc_wall_misses(pair, row, top, z + more) == 1 : 1))
        return 0; /* it meets the surface, but not beyond the ends */
    return misses == 2 && upright ? hc_upright_wall_misses(pair, row, bottom, top) : misses;
}

/* hc_disc_misses, where its bounds do not tell in integers of an upright spheroid, by numbers of two doubles of others. */
static int hc_ended_disc_misses(const hc_sections *pair, const double row[13], double w, int upright) {
    const int misses = hc_disc_misses(pair, w);
    hc_end end;
    if (misses != 2) return misses;
    if (!upright) return hc_disc_surely_misses(pair, row, w);
    end = hc_exact_end(row, w);
    return !end.known ? 2 : end.misses && (end.reached < 0 || end.off > 0);
}

/* The position of a valid row of 13 whose position without ends is `whole`; 2 where the bounds do not tell. */
static int hc_ended_position(const double row[13], int whole) {
    const int upright = hc_is_upright(row), solid = row[12] != 0;
    const double z = row[6], reach = row[2] > row[3] && !upright ? row[2] : row[3], low = row[10], high = row[11];
    const double slack = HC_u_8 * (hc_size(z) + reach), below = z - low, above = high - z;
    const double more = reach + slack, under = hc_size(low) <= HC_ENDED_GREATEST ? HC_u_8 * hc_size(low) : 0;
    const double over = hc_size(high) <= HC_ENDED_GREATEST ? HC_u_8 * hc_size(high) : 0;
    const double level = z < low ? low : z > high ? high : z;
    hc_sections pair;
    int misses, inside, k;
    if (below > more + under && above > more + over) return whole;
    if (-below > more + under || -above > more + over || (solid && whole == 1)) return 1;
    if (whole != 0 && !solid) return whole == -1 && z >= low && z <= high ? -1 : 1;
    if (!HC_FLOATS_DECIDE) return 2;
    if (whole == 0 && upright && hc_upright_met(row, level)) return 0; /* most contacts */
    if (!hc_make_sections(&pair, row)) return 2;
    misses = 1;
    if (whole == 0) {
        const double t = level - z, xi = pair.xi0 - pair.k * t;
        if (hc_point_within(&pair, hc_radius(&pair, level), level, xi, pair.eta, xi)) return 0;
        misses = hc_ended_wall_misses(&pair, row, more, upright);
    }
    for (k = 10; solid && k < 12 && misses == 1; k++)
        if (hc_size(row[k]) <= HC_ENDED_GREATEST) misses = hc_ended_disc_misses(&pair, row, row[k], upright);
    if (misses != 1) return misses;
    if (whole != 0) return z >= low && z <= high ? whole : 1; /* without ends inside, and the discs missed */
    inside = hc_center_inside(row);
    if (inside == 2) {
        const hc_end end = hc_exact_end(row, z);
        if (!end.known) return 2;
        inside = end.off <= 0;
    }
    return inside ? -1 : 1;
}

#define HC_ENDED_TOGETHER 2048 /* rows that are still in the cache when their ends are looked at */

void hypcheck_classify_ended(size_t n, const double *rows13, int8_t *positions) {
    size_t i, k;
    for (i = 0; i < n; i += HC_ENDED_TOGETHER) {
        const size_t count = n - i < HC_ENDED_TOGETHER ? n - i : HC_ENDED_TOGETHER;
        const double *row = rows13 + 13 * i;
        int8_t *const some = positions + i;
        hc_ask_rows(HYPCHECK_POSITION, count, 13, row, some);
        for (k = 0; k < count; k++, row += 13) {
            const double more = 1.5 * (row[2] + row[3]), low = row[10], high = row[11];
            const int valid = row[12] == 0 || row[12] == 1;
            if (valid && row[6] - low > more && high - row[6] > more) continue; /* between the ends: as without them */
            if (!(valid && low < high)) some[k] = 127;
            else if (some[k] != 127) some[k] = (int8_t)hc_ended_position(row, some[k]);
        }
    }
}
