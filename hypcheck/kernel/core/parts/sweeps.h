/* ---- sweeps: straight motions ---- */

#define HC_SWEEP_STEPS 128
#define HC_SHORTEST 7.1054273576010019e-15 /* 2^-47: a shorter step says that steps come to nothing here */
#define HC_FARTHEST_SWEEP 1.4272476927059599e+45 /* 2^150, limit of coordinates: R and T stay below the cap */
#define HC_GREATEST_SLACK 0.25
#define HC_SEEN 64 /* slacks by which a spheroid grown has contact at the time that is called its first */

/* A sweep from a float centre: `change` is the rounded difference of both ends. At a computed centre, and along `change`
   from there up to the end of the sweep, the exact centre lies within `slack` of the computed one, in radii. For each
   coordinate the change is rounded once, and so are its product with the time and the sum: each by u (|from| + |to|) at
   most, up to second order, which makes 3u (1 + 4u) (|from| + |to|). slack = 4u (1 + the sum of these in radii), with
   the rest for its own rounding and that of b (1 + slack) and b (1 - slack). Where the axis is tilted, the smaller of b and d
   is the radius. */
typedef struct {
    double sizes[4], from[3], change[3], slack;
    double v;           /* where the multiplier was found last */
    const double *axis; /* NULL where it is vertical */
    hc_tilted_scene poles; /* of the spheroid larger by the slack, where it is tilted, as the basis is */
    hc_ball basis[3][3], along[3];
} hc_sweep;

/* The components of a place in the basis. */
static void hc_components(hc_ball components[3], hc_ball basis[3][3], const double place[3]) {
    int i, k;
    for (i = 0; i < 3; i++) {
        components[i] = hc_times(basis[i][0], hc_exactly(place[0]));
        for (k = 1; k < 3; k++) components[i] = hc_plus(components[i], hc_times(basis[i][k], hc_exactly(place[k])));
    }
}

/* Returns 0 where the numbers are too large or small for the bounds. */
static int hc_make_sweep(hc_sweep *sweep, const double row[10], const double *axis) {
    const double least = row[2] < row[3] ? row[2] : row[3];
    double sum = 0, larger[4];
    int k;
    for (k = 0; k < 4; k++) {
        sweep->sizes[k] = row[k];
        if (!(row[k] > HC_least_size && row[k] < HC_greatest_size)) return 0;
    }
    for (k = 0; k < 3; k++) {
        const double from = row[4 + k], to = row[7 + k], reach = hc_size(from) + hc_size(to);
        if (!(reach < HC_FARTHEST_SWEEP)) return 0;
        sweep->from[k] = from;
        sweep->change[k] = to - from;
        sum += reach / (axis ? least : row[k == 2 ? 3 : 2]);
    }
    sweep->slack = HC_u_4 * (1 + sum);
    sweep->v = 0;
    sweep->axis = axis;
    if (!(HC_FLOATS_DECIDE && sweep->slack < HC_GREATEST_SLACK)) return 0;
    if (axis) {
        for (k = 0; k < 4; k++) larger[k] = k < 2 ? row[k] : row[k] * (1 + sweep->slack);
        hc_basis(&sweep->poles, sweep->basis, larger, axis);
        hc_components(sweep->along, sweep->basis, sweep->change);
    }
    return 1;
}

/* The spheroid at a time, b and d multiplied. */
static void hc_sweep_at(const hc_sweep *sweep, double time, double scale, double row[7]) {
    int k;
    for (k = 0; k < 4; k++) row[k] = k < 2 ? sweep->sizes[k] : sweep->sizes[k] * scale;
    for (k = 0; k < 3; k++) row[4 + k] = sweep->from[k] + time * sweep->change[k];
}

/* The exact position of a valid row of seven, with an axis if it is tilted. */
static int hc_position_with(const double row[7], const double *axis) {
    double ten[10];
    hc_bits found;
    if (!axis) return hc_position_of(row);
    memcpy(ten, row, 7 * sizeof *row);
    memcpy(ten + 7, axis, 3 * sizeof *axis);
    found = hc_tilted_plain(ten, 1, 1);
    return HC_FLOATS_DECIDE && found.decided ? (int)found.plus - (int)found.minus : hc_exact_tilted_position(ten);
}

/* Whether the spheroid, b and d multiplied, has contact at a computed centre. With less than its slack that is contact of
   the spheroid itself at the exact centre. */
static int hc_sweep_touches(const hc_sweep *sweep, double time, double scale) {
    double row[7];
    hc_sweep_at(sweep, time, scale, row);
    return hc_position_with(row, sweep->axis) == 0;
}

/* About the multiplier at which a half plane of that side lies farthest from a centre of height Q: the root of
   A/m² = 1 + Q (A+B)/(B - side m)². With m = B v/(1 + side v) that is E(v) = v² (B²/(1 + side v)² + W) = A; Newton's method
   between bounds, from where it was before. Any result is safe. */
static double hc_sweep_multiplier(double A, double B, double Q, int side, double *before) {
    const double W = Q * (A + B), root = hc_rough_root(A), room = B - side * root;
    double low = 0, high = room > 0 ? root / room : HC_cap, v;
    int i;
    if (W * high * high > A) high = hc_rough_root(A / W) * (1 + HC_settled);
    if (high > 1 / HC_settled) high = 1 / HC_settled;
    v = *before > 0 && *before < high ? *before : side > 0 && high > 1 ? 1 : high;
    for (i = 0; i < 24; i++) {
        const double inverse = 1 / (1 + side * v), square = B * inverse * (B * inverse) + W;
        const double off = v * v * square - A, rise = 2 * v * (B * inverse * (B * inverse) * inverse + W);
        double moved = v - off / rise;
        if (off > 0) high = v;
        else low = v;
        if (!(moved > low && moved < high)) moved = low > 0 && high > 4 * low ? hc_rough_root(low * high) : 0.5 * (low + high);
        if (hc_size(moved - v) < HC_settled * HC_settled * v) break;
        v = moved;
    }
    *before = v;
    v = B * v / (1 + side * v);
    return side < 0 && v > A * (1 - HC_settled) ? A * (1 - HC_settled) : v;
}

static void hc_tangent_high(const double sizes[4], double mu, hc_line *line) {
    const double alpha = sizes[0], gamma = sizes[1], b = sizes[2], d = sizes[3];
    const double u_8 = HC_u_8, more = HC_more, less = HC_less;
    /* printed from the program "tangent-high" */
    @TANGENT_HIGH@
    /* end of the program "tangent-high" */
    const int proves = mu > 0 && mu < 1 && across_least > 0 && fall_most >= HC_least_constant && M_least <= HC_greatest_slope;
    line->K = proves ? -fall_most : -1;
    line->M = proves ? M_least : 0;
}

/* A number below the first root of here + 2 slope s + bend s², here > 0; 2 where there is none in [0, 1]. The root is
   here/(√D - slope), D = slope² - here bend. D is off by 3u of its terms' sizes at most, hence 4u; Heron's step is not
   below the root of what it is asked, but for its 4 roundings. What underflows in D is below 2^-1020, so 2^-500 covers it;
   that costs nothing where `here` is not below 2^-402; it is 0 or more than that beside half planes. */
static double hc_sweep_root(double here, double slope, double bend) {
    const double square = slope * slope, product = here * bend, size = hc_size(product);
    const double most = square - product + HC_u_4 * (square + size);
    double root = 3.0549363634996047e-151 /* 2^-500 */, bottom;
    if (!(here > 9.6817414919811262e-122 /* 2^-402 */)) return 0;
    if (most < 0) return 2;
    if (most > 1e-290) {
        const double rough = hc_rough_root(most);
        root += 0.5 * (rough + most / rough) * (1 + HC_u_8);
    }
    bottom = root - slope;
    return bottom > 0 && here < 2 * bottom ? here / bottom * HC_less : 2;
}

/* The same for a tilted spheroid: the m at which side (P1/(A1+l) + P2/(A2+l) - Q/(B-l) - 1 - 1/l), l = side m, is
   greatest: P1 (m/(A1+l))² + P2 (m/(A2+l))² + Q (m/(B-l))² = 1, which rises with m, m = pole v/(1 + v). */
static double hc_tilted_sweep_multiplier(const hc_sweep *sweep, const hc_ball at[3], int side, double *before) {
    const double poles[3] = {sweep->poles.A1.v, sweep->poles.A2.v, sweep->poles.B.v};
    const double nearer = poles[0] < poles[1] ? poles[0] : poles[1], pole = side > 0 ? poles[2] : nearer;
    double low = 0, high = 1 / HC_settled, v = *before > 0 ? *before : 1; /* below `high`: each one kept was, and lost HC_settled² */
    int i, k;
    for (i = 0; i < 48; i++) {
        const double inverse = 1 / (1 + v), m = pole * v * inverse;
        double off = -1, rise = 0, moved;
        for (k = 0; k < 3; k++) {
            const double from = 1 / (poles[k] + (k < 2 ? side : -side) * m), part = m * from * at[k].v * at[k].v;
            off += part * m * from;
            rise += 2 * part * poles[k] * from * from * pole * inverse * inverse;
        }
        if (off > 0) high = v;
        else low = v;
        moved = v - off / rise;
        if (!(moved > low && moved < high)) moved = low > 0 && high > 4 * low ? hc_rough_root(low * high) : 0.5 * (low + high);
        if (hc_size(moved - v) < HC_settled * HC_settled * v) break;
        v = moved;
    }
    *before = v;
    return side * pole * v / (1 + v);
}

/* As hc_sweep_reach, for a tilted spheroid. With l fixed, side (P1/(A1+l) + P2/(A2+l) - Q/(B-l) - 1 - 1/l) > 0 proves the
   side, and is quadratic along the sweep; numbers with bounds compute it. */
static double hc_tilted_sweep_reach(hc_sweep *sweep, const double place[3], int position) {
    const hc_ball *const poles[3] = {&sweep->poles.A1, &sweep->poles.A2, &sweep->poles.B};
    const hc_ball one = hc_exactly(1), nothing = hc_exactly(0);
    hc_ball at[3], sums[3], l;
    double lower[3];
    int i, k;
    hc_components(at, sweep->basis, place);
    l = hc_exactly(hc_tilted_sweep_multiplier(sweep, at, position, &sweep->v));
    sums[0] = hc_minus(nothing, hc_plus(one, hc_over(one, l)));
    sums[1] = sums[2] = nothing;
    for (i = 0; i < 3; i++) {
        const hc_ball from = i < 2 ? hc_plus(*poles[i], l) : hc_minus(*poles[i], l), weight = hc_over(one, from);
        const hc_ball here = hc_times(at[i], at[i]), slope = hc_times(at[i], sweep->along[i]);
        const hc_ball parts[3] = {here, slope, hc_times(sweep->along[i], sweep->along[i])};
        if (!(hc_at_least(from) > 0)) return 0;
        for (k = 0; k < 3; k++) {
            const hc_ball part = hc_times(parts[k], weight);
            sums[k] = i < 2 ? hc_plus(sums[k], part) : hc_minus(sums[k], part);
        }
    }
    for (k = 0; k < 3; k++) {
        lower[k] = hc_at_least(position > 0 ? sums[k] : hc_minus(nothing, sums[k]));
        if (!(hc_size(lower[k]) < HC_cap)) return 0; /* as where nothing is known */
    }
    return position * l.v > 0 ? hc_sweep_root(lower[0], lower[1], lower[2]) : 0;
}

/* How far from a time the spheroid is proved to stay on that side: a part of the whole sweep, 2 to its end, 0 where
   nothing is proved. */
static double hc_sweep_reach(hc_sweep *sweep, double time, int position) {
    const double u_8 = HC_u_8, side = position;
    double row[7];
    hc_line half_plane;
    hc_sweep_at(sweep, time, 1 + sweep->slack, row);
    if (sweep->axis) return hc_tilted_sweep_reach(sweep, row + 4, position);
    {
        const double a = row[0] / row[2], c = row[1] / row[3], q = row[6] / row[3];
        const double at = hc_sweep_multiplier(a * a, c * c, q * q, position, &sweep->v);
        if (position > 0) hc_tangent_beyond(row, at, &half_plane);
        else if (at > 1) hc_tangent_within(row, at, &half_plane);
        else hc_tangent_high(row, at, &half_plane);
    }
    if (half_plane.K == HC_NEVER || half_plane.K == -1) return 0;
    {
        const double x = row[4], y = row[5], z = row[6], K = half_plane.K, M = half_plane.M;
        const double u = sweep->change[0], v = sweep->change[1], w = sweep->change[2];
        /* printed from the program "piece" */
        @PIECE@
        /* end of the program "piece" */
        return size < HC_cap ? hc_sweep_root(here, slope, bend) : 0;
    }
}

/* A time of contact not long after one from which steps come to nothing; 2 where none is found. */
static double hc_sweep_look(const hc_sweep *sweep, double time) {
    double ahead;
    for (ahead = HC_SHORTEST; time + ahead < 1; ahead *= 8)
        if (hc_sweep_touches(sweep, time + ahead, 1 - sweep->slack)) return time + ahead;
    return 2;
}

static double hc_nearest_time(hc_sweep *sweep, const double row[10], int side, double clear, double contact); /* sweep_times.h */

/* 1, 0, or 2 where the bounds do not tell, for a valid row, with an axis if it is tilted; the time is NULL where it is not
   wanted. */
static int hc_passage_of(const double row[10], const double *axis, double *time) {
    double end_row[7], contact, now = 0;
    int start, end, step;
    hc_sweep sweep;
    memcpy(end_row, row, 4 * sizeof *row);
    memcpy(end_row + 4, row + 7, 3 * sizeof *row);
    start = hc_position_with(row, axis);
    end = hc_position_with(end_row, axis);
    if (start == 0) {
        if (time) *time = 0;
        return 1;
    }
    contact = end == start ? 2 : 1; /* a time of contact, 2 while none is known: between unlike positions there is one */
    if (contact < 2 && !time) return 1;
    if (!hc_make_sweep(&sweep, row, axis)) return contact < 2 ? 1 : 2;
    for (step = 0; step < HC_SWEEP_STEPS; step++) {
        const double reach = hc_sweep_reach(&sweep, now, start);
        if (reach * HC_less >= 1 - now) return 0;
        if (!(reach > HC_SHORTEST)) break;
        now += reach - 2 * HC_u_4; /* rounding adds 2^-52 at most */
        if (now + 0.5 * reach < contact && now + 0.5 * reach < 1 && hc_sweep_touches(&sweep, now + 0.5 * reach, 1 - sweep.slack)) {
            contact = now + 0.5 * reach;
            if (!time) return 1;
        }
    }
    if (contact == 2) contact = hc_sweep_look(&sweep, now);
    if (contact == 2) return 2;
    if (time) {
        now = hc_nearest_time(&sweep, row, start, now, contact);
        if (hc_sweep_touches(&sweep, now, 1 + HC_SEEN * sweep.slack)) *time = now;
    }
    return 1;
}
