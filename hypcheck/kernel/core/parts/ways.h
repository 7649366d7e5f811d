/* ---- straight ways of upright spheroids ---- */

#define HC_WAY_STEPS 128
#define HC_SHORTEST 7.1054273576010019e-15 /* 2^-47: a shorter step says that steps come to nothing here */
#define HC_FARTHEST_WAY 1.4272476927059599e+45 /* 2^150, limit of coordinates: R and T stay below the cap */
#define HC_GREATEST_SLACK 0.25
#define HC_SEEN 16 /* slacks by which a spheroid grown has contact at the time that is called its first */

/* A way from a float centre: `change` is the rounded difference of both ends. At a computed centre, and along `change`
   from there up to the end of the way, the exact centre lies within `slack` of the computed one, in radii. For each
   coordinate the change is rounded once, and so are its product with the time and the sum: each by u (|from| + |to|) at
   most, up to second order, which makes 3u (1 + 4u) (|from| + |to|). slack = 4u (1 + the sum of these in radii), with
   the rest for its own rounding and that of b (1 + slack) and b (1 - slack). */
typedef struct {
    double sizes[4], from[3], change[3], slack;
    double v; /* where the multiplier was found last */
} hc_way;

/* Returns 0 where the numbers are too large or small for the bounds. */
static int hc_make_way(hc_way *way, const double row[10]) {
    double sum = 0;
    int k;
    for (k = 0; k < 4; k++) {
        way->sizes[k] = row[k];
        if (!(row[k] > HC_least_size && row[k] < HC_greatest_size)) return 0;
    }
    for (k = 0; k < 3; k++) {
        const double from = row[4 + k], to = row[7 + k];
        const double reach = hc_size(from) + hc_size(to);
        if (!(reach < HC_FARTHEST_WAY)) return 0;
        way->from[k] = from;
        way->change[k] = to - from;
        sum += reach / row[k == 2 ? 3 : 2];
    }
    way->slack = HC_u_4 * (1 + sum);
    way->v = 0;
    return HC_FLOATS_DECIDE && way->slack < HC_GREATEST_SLACK;
}

/* The spheroid at a time, b and d multiplied. */
static void hc_way_at(const hc_way *way, double time, double scale, double row[7]) {
    int k;
    for (k = 0; k < 4; k++) row[k] = k < 2 ? way->sizes[k] : way->sizes[k] * scale;
    for (k = 0; k < 3; k++) row[4 + k] = way->from[k] + time * way->change[k];
}

/* Contact of the spheroid less its slack at the computed centre is contact of the spheroid at the exact one. */
static int hc_way_touches(const hc_way *way, double time) {
    double row[7];
    hc_way_at(way, time, 1 - way->slack, row);
    return hc_position_of(row) == 0;
}

/* About the multiplier at which a half plane of that side lies farthest from a centre of height Q: the root of
   A/m² = 1 + Q (A+B)/(B - side m)². With m = B v/(1 + side v) that is E(v) = v² (B²/(1 + side v)² + W) = A; Newton's method
   between bounds, from where it was before. Any result is safe. */
static double hc_way_multiplier(double A, double B, double Q, int side, double *before) {
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
   that costs nothing, for here is a difference of numbers above 2^-349 and so at least 2^-402. */
static double hc_way_root(double here, double slope, double bend) {
    const double square = slope * slope, product = here * bend, size = hc_size(product);
    const double most = square - product + HC_u_4 * (square + size);
    double root = 3.0549363634996047e-151 /* 2^-500 */, bottom;
    if (most < 0) return 2;
    if (most > 1e-290) {
        const double rough = hc_rough_root(most);
        root += 0.5 * (rough + most / rough) * (1 + HC_u_8);
    }
    bottom = root - slope;
    return bottom > 0 && here < 2 * bottom ? here / bottom * HC_less : 2;
}

/* How far from a time the spheroid is proved to stay on that side: a part of the whole way, 2 to its end, 0 where
   nothing is proved. */
static double hc_way_reach(hc_way *way, double time, int position) {
    const double u_8 = HC_u_8, side = position;
    double row[7];
    hc_line half_plane;
    hc_way_at(way, time, 1 + way->slack, row);
    {
        const double a = row[0] / row[2], c = row[1] / row[3], q = row[6] / row[3];
        const double at = hc_way_multiplier(a * a, c * c, q * q, position, &way->v);
        if (position > 0) hc_tangent_beyond(row, at, &half_plane);
        else if (at > 1) hc_tangent_within(row, at, &half_plane);
        else hc_tangent_high(row, at, &half_plane);
    }
    if (half_plane.K == HC_NEVER || half_plane.K == -1) return 0;
    {
        const double x = row[4], y = row[5], z = row[6], K = half_plane.K, M = half_plane.M;
        const double u = way->change[0], v = way->change[1], w = way->change[2];
        /* printed from the program "piece" */
        @PIECE@
        /* end of the program "piece" */
        return size < HC_cap && here > 0 ? hc_way_root(here, slope, bend) : 0;
    }
}

/* A time of contact not long after one from which steps come to nothing; 2 where none is found. */
static double hc_way_look(const hc_way *way, double time, double contact) {
    double ahead;
    for (ahead = HC_SHORTEST; time + ahead < contact && time + ahead < 1; ahead *= 8)
        if (hc_way_touches(way, time + ahead)) return time + ahead;
    return contact;
}

/* Whether the spheroid, a few slacks larger, has contact at a time. */
static int hc_way_is_met(const hc_way *way, double time) {
    double row[7];
    hc_way_at(way, time, 1 + HC_SEEN * way->slack, row);
    return hc_position_of(row) == 0;
}

/* 1, 0, or 2 where the bounds do not tell, for a valid row; the time is NULL where it is not wanted. */
static int hc_passage_of(const double row[10], double *time) {
    double end_row[7], contact, now = 0;
    int start, end, step;
    hc_way way;
    memcpy(end_row, row, 4 * sizeof *row);
    memcpy(end_row + 4, row + 7, 3 * sizeof *row);
    start = hc_position_of(row);
    end = hc_position_of(end_row);
    if (start == 0) {
        if (time) *time = 0;
        return 1;
    }
    contact = end == start ? 2 : 1; /* a time of contact, 2 while none is known: between unlike positions there is one */
    if (contact < 2 && !time) return 1;
    if (!hc_make_way(&way, row)) return contact < 2 ? 1 : 2;
    for (step = 0; step < HC_WAY_STEPS; step++) {
        const double reach = hc_way_reach(&way, now, start);
        if (reach * HC_less >= 1 - now) return 0;
        if (!(reach > HC_SHORTEST)) break;
        now += reach - 2 * HC_u_4; /* rounding adds 2^-52 at most */
        if (now + 0.5 * reach < contact && now + 0.5 * reach < 1 && hc_way_touches(&way, now + 0.5 * reach)) {
            contact = now + 0.5 * reach;
            if (!time) return 1;
        }
    }
    if (contact == 2) contact = hc_way_look(&way, now, contact);
    if (contact == 2) return 2;
    if (time && hc_way_is_met(&way, now)) *time = now;
    return 1;
}

void hypcheck_passage(size_t n, const double *rows10, int8_t *hits, double *times) {
    const uint64_t nan_bits = (uint64_t)0x7ff8 << 48;
    size_t i;
    for (i = 0; i < n; i++) {
        const double *const row = rows10 + 10 * i;
        double end[7];
        if (times) memcpy(times + i, &nan_bits, sizeof nan_bits);
        memcpy(end, row, 4 * sizeof *row);
        memcpy(end + 4, row + 7, 3 * sizeof *row);
        hits[i] = (int8_t)(hc_valid(row) && hc_valid(end) ? hc_passage_of(row, times ? times + i : NULL) : 127);
    }
}
