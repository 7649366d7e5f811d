/* ---- one row ---- */

/* A cheaper bound for the common case, c² > a > 1; 2 where it cannot say. */
static int hc_single(const double row[7]) {
    const double alpha = row[0], gamma = row[1], b = row[2], d = row[3], x = row[4], y = row[5], z = row[6];
    const double u_8 = HC_u_8, u_12 = HC_u_12, u_1536 = HC_u_1536;
    /* printed from the program "single" */
    @SINGLE@
    /* end of the program "single" */
    /* Without a branch for each comparison: which side it is no processor can foresee, and a wrong guess costs as much as
       half of the arithmetic. P + Q beyond `farthest` is left: products overflow there, and rounded towards zero they would
       look finite. */
    const int sizes_fit = (alpha > 0) & (gamma > 0) & (b > HC_least) & (b < HC_greatest) & (d > HC_least) & (d < HC_greatest);
    const int ratios_fit = (A > HC_slack) & (A < HC_greatest) & (B > HC_least) & (B < HC_greatest) & (BB > HC_slack * A);
    const int contact = delta_3 < -E, apart = delta_3 > E;
    const int outside = (c2 < -e2) & (c1 > e1), inside = (c2 > e2) | (c1 < -e1);
    if (!(sizes_fit & ratios_fit & (P_plus_Q < HC_farthest) & (contact | (apart & (outside | inside))))) return 2;
    return apart * (outside - inside);
}

static int hc_position_of(const double row[7]) {
    const int quick = HC_FLOATS_DECIDE ? hc_single(row) : 2;
    hc_bits found;
    if (quick != 2) return quick;
    found = hc_certified_plain(row, 1, 1);
    if (HC_FLOATS_DECIDE && found.decided) return (int)found.plus - (int)found.minus;
    return hc_valid(row) ? hc_exact_position(row) : 127;
}

/* ---- one scene: the half planes of the first stage ---- */

/* The value cut to 26 significant bits, so that its square is exact; `up` takes the next such number. */
static double hc_short(double value, int up) {
    const uint64_t low = ((uint64_t)1 << 27) - 1;
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    bits = (up ? bits + low : bits) & ~low;
    memcpy(&value, &bits, sizeof bits);
    return value;
}

/* Where (A+λ)(1 + 1/λ) + Q (A+λ)/(B−λ) is least over λ in (0, B), for side 1, and where (A−μ)(1 − 1/μ) + Q (A−μ)/(B+μ)
   is greatest over μ in (0, A), for side -1: Newton's method for A/λ² = 1 + Q (A+B)/(B∓λ)². Any result is safe; a good
   one leaves fewer rows to the next stage. */
static double hc_best_multiplier(double A, double B, double Q, int side) {
    const double weight = Q * (A + B);
    double at = hc_rough_root(A / (1 + weight / (B * B)));
    int i;
    if (side > 0 && at > 0.99 * B) at = 0.99 * B;
    for (i = 0; i < 4; i++) {
        const double inverse = 1 / at, other = 1 / (B - side * at);
        const double first = A * inverse * inverse, second = weight * other * other;
        const double step = (first - 1 - second) / (2 * (first * inverse + side * second * other));
        const double moved = at + step;
        if (!(moved > 0.25 * at)) break; /* NaN: a step is shorter than half of `at` otherwise */
        at = side > 0 && moved > 0.5 * (at + B) ? 0.5 * (at + B) : moved;
    }
    return at;
}

/* About the P at which the bodies touch from that side at height Q. */
static double hc_edge(double A, double B, double Q, int side) {
    const double at = hc_best_multiplier(A, B, Q, side);
    return (A + side * at) * (1 + side / at) + Q * (A + side * at) / (B - side * at);
}

static void hc_tangent_beyond(const double sizes[4], double lambda_, hc_line *line) {
    const double alpha = sizes[0], gamma = sizes[1], b = sizes[2], d = sizes[3];
    const double u_8 = HC_u_8, more = HC_more;
    /* printed from the program "tangent-beyond" */
    @TANGENT_BEYOND@
    /* end of the program "tangent-beyond" */
    const int proves = lambda_ > 0 && gap_least > 0 && K_most >= HC_least_constant && M_most <= HC_greatest_slope;
    line->K = proves ? K_most : HC_NEVER;
    line->M = proves ? M_most : 0;
}

static void hc_tangent_within(const double sizes[4], double mu, hc_line *line) {
    const double alpha = sizes[0], gamma = sizes[1], b = sizes[2], d = sizes[3];
    const double u_8 = HC_u_8, less = HC_less;
    /* printed from the program "tangent-within" */
    @TANGENT_WITHIN@
    /* end of the program "tangent-within" */
    const int proves = mu > 1 && across_least > 0 && K_least >= HC_least_constant && M_least <= HC_greatest_slope;
    line->K = proves ? K_least : -1;
    line->M = proves ? M_least : 0;
}

/* A place (z, x) where the position is known not to be `side`, near the edge P at that height; R = -1 if none was found. */
typedef struct {
    double T, R;
} hc_point;

static hc_point hc_known_point(const double sizes[4], double z, double P, int side) {
    static const double steps[3] = {9.3132257461547852e-10 /* 2^-30 */, 1.52587890625e-05 /* 2^-16 */, 0.00390625 /* 2^-8 */};
    double row[7];
    hc_point point;
    int i;
    memcpy(row, sizes, 4 * sizeof *row);
    row[5] = 0;
    row[6] = z;
    point.T = z * z;
    for (i = 0; i < 3; i++) {
        row[4] = P > 0 ? hc_short(sizes[2] * hc_rough_root(P * (1 - side * steps[i])), side < 0) : 0;
        point.R = row[4] * row[4];
        /* The cap spares work alone: beyond it R may overflow, and then no slope below is within its limit. */
        if (point.R < HC_cap && hc_position_of(row) != side) return point;
    }
    point.R = -1;
    return point;
}

/* A line below (side 1) or above (side -1) the chord of two points, checked at both; else one that proves nothing. */
static void hc_chord(hc_point from, hc_point to, int side, hc_line *line) {
    const double more = HC_more, less = HC_less, T_0 = from.T, R_0 = from.R, T_1 = to.T, R_1 = to.R;
    const double slope = T_1 > T_0 ? (R_1 - R_0) / (T_1 - T_0) : 0;
    const double M = side < 0 && R_0 - slope * T_0 < 0 ? R_1 / T_1 * (1 + 9.3132257461547852e-10) : slope;
    const double start = (side > 0 && R_1 < R_0 ? R_1 : R_0) - M * T_0;
    const double moved = start * (1 - side * 9.3132257461547852e-10);
    const double K = side < 0 && (M > 0 || moved > 0) && !(moved >= HC_least_constant) ? HC_least_constant : moved;
    /* printed from the program "chord" */
    @CHORD@
    /* end of the program "chord" */
    const int known = R_0 >= 0 && R_1 >= 0 && M >= 0 && M <= HC_greatest_slope;
    const int beyond = side > 0 ? below : above, proves = known && beyond && (side < 0 || K >= HC_least_constant);
    line->K = proves ? K : side > 0 ? -1 : HC_NEVER;
    line->M = proves ? M : 0;
}

/* The heights that the centres have, from a sample of them. */
static void hc_sample_heights(size_t n, const double *z, double *least, double *greatest) {
    const size_t step = n / 64 + 1;
    size_t i;
    *least = HC_NEVER;
    *greatest = 0;
    for (i = 0; i < n; i += step) {
        const double height = z[i] < 0 ? -z[i] : z[i];
        if (height < *least) *least = height;
        if (height > *greatest && height < HC_greatest_height) *greatest = height;
    }
}

/* Chooses and proves the half planes of a scene. Returns 0, and the first stage is left out, where its sizes are too
   large or small for the margins. */
static int hc_make_scene(hc_scene *scene, const double sizes[4], size_t n, const double *z) {
    const double A = sizes[0] / sizes[2] * (sizes[0] / sizes[2]), B = sizes[1] / sizes[3] * (sizes[1] / sizes[3]);
    double least, greatest, heights[3], Q[3];
    hc_point under[3], above[3];
    int i;
    for (i = 0; i < 4; i++)
        if (!(sizes[i] > HC_least_size && sizes[i] < HC_greatest_size)) return 0;
    hc_sample_heights(n, z, &least, &greatest);
    /* Three heights: 0, one below most of the sample, one above nearly all of it. Not 0 itself: T <= reach must not hold
       for heights whose squares have underflowed. */
    heights[0] = 0;
    heights[2] = greatest > HC_least_height ? hc_short(1.0625 * greatest, 1) : HC_least_height;
    heights[1] = hc_short(least < greatest && least > 0.55 * heights[2] ? 0.999 * least : 0.55 * heights[2], 0);
    for (i = 0; i < 3; i++) {
        Q[i] = heights[i] / sizes[3] * (heights[i] / sizes[3]);
        under[i] = hc_known_point(sizes, heights[i], hc_edge(A, B, Q[i], 1), 1);
        above[i] = hc_known_point(sizes, heights[i], hc_edge(A, B, Q[i], -1), -1);
    }
    for (i = 0; i < 3; i++) { /* line 0 over all heights, 1 over the lower, 2 over the upper ones */
        const int from = i == 2, to = i == 1 ? 1 : 2;
        const double Q_middle = i == 0 ? Q[1] : 0.5 * (Q[from] + Q[to]);
        hc_tangent_beyond(sizes, hc_best_multiplier(A, B, Q_middle, 1), scene->beyond + i);
        hc_tangent_within(sizes, hc_best_multiplier(A, B, Q_middle, -1), scene->within + i);
        hc_chord(under[from], under[to], 1, scene->under + i);
        hc_chord(above[from], above[to], -1, scene->above + i);
    }
    scene->reach = under[2].T * HC_less;
    return HC_FLOATS_DECIDE;
}
