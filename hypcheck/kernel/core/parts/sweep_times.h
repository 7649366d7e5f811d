/* ---- first contacts on sweeps by numbers of two doubles ---- */

#define HC_TIME_UNIT 3.1554436208840472e-30 /* 2^-98: each operation is right within 2^-100 (twins.h), and room */
#define HC_TIME_STEPS 64
#define HC_POLE_STEPS 96
#define HC_NEAREST_POLE 1.1805916207174113e+21 /* 2^70 */

/* Numbers of two doubles with bounds of their errors, as hc_ball is one of doubles: each operation adds HC_TIME_UNIT of its
   result (a sum: of its operands), a 2^-40th of e for what e and sizes are rounded by, and HC_lost for what underflows. */
typedef struct {
    hc_twin v;
    double e;
} hc_fine_ball;

static hc_fine_ball hc_fine_ball_of(hc_twin v, double size, double e) {
    hc_fine_ball made;
    made.v = v;
    made.e = (e + HC_TIME_UNIT * size) * HC_more_than + HC_lost;
    if (!(size < HC_cap && e < HC_cap)) made.v.high = made.v.low = made.e = hc_nothing_known();
    return made;
}

static hc_fine_ball hc_finely(hc_twin v) {
    hc_fine_ball made;
    made.v = v;
    made.e = 0;
    return made;
}

static hc_fine_ball hc_fine(double v) { return hc_finely(hc_twin_of(v)); }

static hc_fine_ball hc_fine_plus(hc_fine_ball a, hc_fine_ball b) {
    return hc_fine_ball_of(hc_twin_sum(a.v, b.v), hc_size(a.v.high) + hc_size(b.v.high), a.e + b.e);
}

static hc_fine_ball hc_fine_minus(hc_fine_ball a, hc_fine_ball b) {
    b.v = hc_twin_minus(b.v);
    return hc_fine_plus(a, b);
}

static hc_fine_ball hc_fine_times(hc_fine_ball a, hc_fine_ball b) {
    const hc_twin v = hc_twin_product(a.v, b.v);
    return hc_fine_ball_of(v, hc_size(v.high), hc_size(a.v.high) * b.e + a.e * (hc_size(b.v.high) + b.e));
}

/* As hc_over; what underflows in the quotient is divided by b. */
static hc_fine_ball hc_fine_over(hc_fine_ball a, hc_fine_ball b) {
    const double least = (hc_size(b.v.high) - b.e * HC_more_than) / HC_more_than;
    const hc_twin v = hc_twin_quotient(a.v, b.v);
    const double e = (a.e + hc_size(v.high) * HC_more_than * b.e + HC_lost) / least;
    return hc_fine_ball_of(v, hc_size(v.high), least > 0 ? e : hc_nothing_known());
}

/* e is more than 2^-99 |v|, so that a second e covers what low - 2e is rounded by. For results of operations alone. */
static double hc_fine_at_least(hc_fine_ball a) {
    const double least = a.v.high + (a.v.low - 2 * a.e);
    return least * (least > 0 ? HC_less : HC_more);
}

/* A sweep in the directions across the axis, along its horizontal part h, each times |h|, and upwards. E^-1, the matrix b² +
   (d² - b²) v v^T of the unit axis v, is b², `across` and T on its diagonal there, and `mixed` |h| between the last two.
   `square` is |h|². The spheroid is as it is: no slack. */
typedef struct {
    hc_fine_ball from[3], moved[3], alpha2, gamma2, b2, across, T, mixed, square;
    hc_twin pole; /* of the side: the l > 0, or -l > 0, nearest to 0 at which E^-1 l + H^-1 is singular */
    int side;
} hc_fine_sweep;

/* The pole of the side, of a sweep whose squares are made. The roots of b² d² l² + p l = alpha² gamma², of which one is > 0,
   and -alpha²/b². */
static hc_twin hc_fine_pole(const hc_fine_sweep *made, hc_fine_ball d2) {
    const hc_fine_ball ends = hc_fine_times(made->alpha2, made->gamma2), axes = hc_fine_times(made->b2, d2);
    const hc_fine_ball p = hc_fine_minus(hc_fine_times(made->alpha2, made->T), hc_fine_times(made->gamma2, made->across));
    const hc_fine_ball squares = hc_fine_plus(hc_fine_times(p, p), hc_fine_times(hc_fine(4), hc_fine_times(axes, ends)));
    const hc_twin size = p.v.high < 0 ? hc_twin_minus(p.v) : p.v, sum = hc_twin_sum(hc_twin_root(squares.v), size);
    const hc_twin half = hc_twin_product(sum, hc_twin_of(0.5)), other = hc_twin_quotient(made->alpha2.v, made->b2.v);
    const hc_twin root = (made->side > 0) == (p.v.high < 0) ? hc_twin_quotient(half, axes.v) : hc_twin_quotient(ends.v, half);
    return made->side < 0 && other.high < root.high ? other : root;
}

/* h is scaled by a power of two, so that no square of it is lost where the axis is tilted by a hair, and all lengths by the one
   that makes b about 1, so that no product of them is too large. */
static void hc_make_fine_sweep(hc_fine_sweep *made, const double row[10], const double *axis, int side) {
    const uint64_t power = (2046 - (hc_word(row[2]) >> 52)) << 52;
    double h[3] = {1, 0, 0}, scale = 0, unit;
    hc_fine_ball lengths[10], b, d, d2, h0, h1, places[2][3];
    int k;
    memcpy(&unit, &power, sizeof unit);
    for (k = 0; k < 10; k++) lengths[k] = hc_fine_times(hc_fine(row[k]), hc_fine(unit));
    b = lengths[2], d = lengths[3];
    made->alpha2 = hc_fine_times(lengths[0], lengths[0]);
    made->gamma2 = hc_fine_times(lengths[1], lengths[1]);
    made->b2 = hc_fine_times(b, b);
    d2 = hc_fine_times(d, d);
    made->side = side;
    if (axis) {
        h[0] = axis[0], h[1] = axis[1];
        hc_scale_axis(h);
        scale = hc_size(h[0]) > hc_size(h[1]) ? axis[0] / h[0] : axis[1] / h[1];
    }
    h0 = hc_fine(h[0]), h1 = hc_fine(h[1]);
    made->square = hc_fine_plus(hc_fine_times(h0, h0), hc_fine_times(h1, h1));
    for (k = 0; k < 2; k++) {
        hc_fine_ball place[3];
        int i;
        for (i = 0; i < 3; i++) place[i] = k ? hc_fine_minus(lengths[7 + i], lengths[4 + i]) : lengths[4 + i];
        places[k][0] = hc_fine_minus(hc_fine_times(place[0], h1), hc_fine_times(place[1], h0));
        places[k][1] = hc_fine_plus(hc_fine_times(place[0], h0), hc_fine_times(place[1], h1));
        places[k][2] = place[2];
    }
    memcpy(made->from, places[0], sizeof made->from);
    memcpy(made->moved, places[1], sizeof made->moved);
    if (axis) {
        const hc_fine_ball up = hc_fine(axis[2]), s = hc_fine(scale), up2 = hc_fine_times(up, up);
        const hc_fine_ball flat = hc_fine_times(made->square, hc_fine_times(s, s)), length = hc_fine_plus(flat, up2);
        const hc_fine_ball more = hc_fine_times(hc_fine_minus(d, b), hc_fine_plus(d, b));
        made->across = hc_fine_over(hc_fine_plus(hc_fine_times(made->b2, up2), hc_fine_times(d2, flat)), length);
        made->T = hc_fine_over(hc_fine_plus(hc_fine_times(made->b2, flat), hc_fine_times(d2, up2)), length);
        made->mixed = hc_fine_over(hc_fine_times(hc_fine_times(more, up), s), length);
    } else {
        made->across = made->b2;
        made->T = d2;
        made->mixed = hc_fine(0);
    }
    made->pole = hc_fine_pole(made, d2);
}

/* As hc_tilted_sweep_multiplier, v itself: l = side pole v/(1 + v), where v may be so large that l is next to its pole. */
static double hc_share_of_pole(const double poles[3], const double at[3], int side, double before) {
    const double nearer = poles[0] < poles[1] ? poles[0] : poles[1], pole = side > 0 ? poles[2] : nearer;
    double low = 0, high = HC_NEAREST_POLE, v = before > 0 && before < high ? before : 1;
    int i, k;
    for (i = 0; i < HC_POLE_STEPS; i++) {
        const double inverse = 1 / (1 + v), m = pole * v * inverse, rest = pole * inverse;
        double off = -1, rise = 0, moved;
        for (k = 0; k < 3; k++) {
            const double from = (k < 2) == (side > 0) ? poles[k] + m : poles[k] - pole + rest, part = m / from * at[k];
            off += part * part;
            rise += 2 * part * at[k] * (poles[k] / from) * (rest / from) * inverse;
        }
        if (off > 0) high = v;
        else low = v;
        moved = v - off / rise;
        if (!(moved > low && moved < high)) {
            if (low == 0) moved = v / 1024;
            else moved = high > 4 * low ? hc_rough_root(low) * hc_rough_root(high) : 0.5 * (low + high);
        }
        if (hc_size(moved - v) < HC_settled * HC_settled * v) break;
        v = moved;
    }
    return v;
}

/* As hc_sweep_reach, for the exact spheroid. With H of the hyperboloid, c^T (E^-1 l + H^-1)^-1 c - 1 - 1/l, times the side,
   is > 0 beside contact, if l E^-1 + H^-1 has two eigenvalues > 0 and one < 0, as it has at l = 0 and up to the poles. It is
   a sum of three squares over their pivots, the one that vanishes at the pole eliminated last. */
static double hc_fine_reach(const hc_fine_sweep *made, hc_twin multiplier, double now) {
    const hc_fine_ball one = hc_fine(1), l = hc_finely(multiplier), time = hc_fine(now), crossed = hc_fine_times(l, made->mixed);
    const hc_fine_ball beside = hc_fine_plus(made->alpha2, hc_fine_times(l, made->b2));
    const hc_fine_ball level = hc_fine_plus(made->alpha2, hc_fine_times(l, made->across));
    const hc_fine_ball upward = hc_fine_minus(hc_fine_times(l, made->T), made->gamma2);
    const int outside = made->side > 0, first = outside ? 1 : 2, last = 3 - first;
    const hc_fine_ball pivot = outside ? level : upward;
    const hc_fine_ball part = hc_fine_over(outside ? crossed : hc_fine_times(crossed, made->square), pivot);
    const hc_fine_ball lost = hc_fine_times(part, outside ? hc_fine_times(crossed, made->square) : crossed);
    const hc_fine_ball left = hc_fine_minus(outside ? upward : level, lost), nothing = hc_fine_minus(one, one);
    const hc_fine_ball pivots[3] = {hc_fine_times(beside, made->square), outside ? hc_fine_times(pivot, made->square) : pivot,
                                    outside ? left : hc_fine_times(left, made->square)};
    hc_fine_ball at[3], squares[3][2], sums[3];
    double lower[3];
    int i, k;
    if (!(hc_fine_at_least(beside) > 0)) return 0;
    for (k = 0; k < 2; k++) {
        const double sign = (k == 0) == outside ? 1 : -1;
        const hc_fine_ball asked = k ? left : pivot;
        if (!(hc_fine_at_least(hc_fine_times(hc_fine(sign), asked)) > 0)) return 0;
    }
    for (i = 0; i < 3; i++) at[i] = hc_fine_plus(made->from[i], hc_fine_times(time, made->moved[i]));
    squares[0][0] = at[0], squares[0][1] = made->moved[0];
    squares[1][0] = at[first], squares[1][1] = made->moved[first];
    squares[2][0] = hc_fine_minus(at[last], hc_fine_times(part, at[first]));
    squares[2][1] = hc_fine_minus(made->moved[last], hc_fine_times(part, made->moved[first]));
    sums[0] = hc_fine_minus(nothing, hc_fine_plus(one, hc_fine_over(one, l)));
    sums[1] = sums[2] = nothing;
    for (i = 0; i < 3; i++) {
        const hc_fine_ball here = hc_fine_over(squares[i][0], pivots[i]), change = hc_fine_over(squares[i][1], pivots[i]);
        sums[0] = hc_fine_plus(sums[0], hc_fine_times(here, squares[i][0]));
        sums[1] = hc_fine_plus(sums[1], hc_fine_times(here, squares[i][1]));
        sums[2] = hc_fine_plus(sums[2], hc_fine_times(change, squares[i][1]));
    }
    for (k = 0; k < 3; k++) {
        lower[k] = hc_fine_at_least(hc_fine_times(hc_fine(made->side), sums[k]));
        if (!(hc_size(lower[k]) < HC_cap)) return 0;
    }
    return hc_sweep_root(lower[0], lower[1], lower[2]);
}

/* A time up to which the sweep is clear, as near to its first contact as steps by numbers of two doubles come; `clear` is such
   a time and `contact` one of contact. Each step ends below a root, rounded down. */
static double hc_nearest_time(hc_sweep *sweep, const double row[10], int side, double clear, double contact) {
    const double a = row[0] / row[2], c = row[1] / row[3];
    double poles[3] = {a * a, a * a, c * c}, v = 0;
    hc_fine_sweep made;
    int step, k;
    if (sweep->axis) poles[0] = sweep->poles.A1.v, poles[1] = sweep->poles.A2.v, poles[2] = sweep->poles.B.v;
    hc_make_fine_sweep(&made, row, sweep->axis, side);
    for (step = 0; step < HC_TIME_STEPS; step++) {
        double place[3], at[3], reach, next;
        hc_twin l, sum;
        for (k = 0; k < 3; k++) place[k] = sweep->from[k] + clear * sweep->change[k];
        if (sweep->axis) {
            hc_ball components[3];
            hc_components(components, sweep->basis, place);
            for (k = 0; k < 3; k++) at[k] = components[k].v;
        } else {
            for (k = 0; k < 3; k++) at[k] = place[k] / row[k < 2 ? 2 : 3];
        }
        v = hc_share_of_pole(poles, at, side, v);
        l = hc_twin_product(made.pole, hc_twin_quotient(hc_twin_of(v), hc_two_sum(1, v)));
        reach = hc_fine_reach(&made, side > 0 ? l : hc_twin_minus(l), clear);
        sum = hc_two_sum(clear, reach);
        next = sum.high;
        if (sum.low < 0) { /* rounded down in any mode */
            uint64_t bits;
            memcpy(&bits, &next, sizeof bits);
            bits--;
            memcpy(&next, &bits, sizeof next);
        }
        if (!(next > clear && next < contact)) break;
        clear = next;
    }
    return clear;
}
