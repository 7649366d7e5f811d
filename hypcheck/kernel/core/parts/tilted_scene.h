
/* ---- the half spaces of one orientation: which they are, and that they prove ---- */

/* Numbers with bounds of their errors, both NaN where nothing is known. The bounds hold in any rounding mode: each operation
   adds HC_unit |v| for its own rounding, a 2^-40th of e for those of e, and HC_lost for what underflows. */
static double hc_size(double value) { return value < 0 ? -value : value; }

static double hc_nothing_known(void) {
    const uint64_t bits = (uint64_t)0x7ff8 << 48;
    double nan;
    memcpy(&nan, &bits, sizeof nan);
    return nan;
}

static hc_ball hc_exactly(double value) {
    hc_ball ball;
    ball.v = value;
    ball.e = 0;
    return ball;
}

static hc_ball hc_ball_of(double v, double e) {
    hc_ball ball;
    ball.v = v;
    ball.e = (e + HC_unit * hc_size(v)) * HC_more_than + HC_lost;
    if (!(hc_size(v) < HC_cap && e < HC_cap)) ball.v = ball.e = hc_nothing_known();
    return ball;
}

static hc_ball hc_plus(hc_ball a, hc_ball b) { return hc_ball_of(a.v + b.v, a.e + b.e); }
static hc_ball hc_minus(hc_ball a, hc_ball b) { return hc_ball_of(a.v - b.v, a.e + b.e); }
static hc_ball hc_times(hc_ball a, hc_ball b) {
    return hc_ball_of(a.v * b.v, hc_size(a.v) * b.e + a.e * (hc_size(b.v) + b.e));
}

/* a/b - a'/b' = ((a - a') + (a'/b') (b' - b))/b */
static hc_ball hc_over(hc_ball a, hc_ball b) {
    const double least = (hc_size(b.v) - b.e * HC_more_than) / HC_more_than, v = a.v / b.v;
    return hc_ball_of(v, least > 0 ? (a.e + hc_size(v) * HC_more_than * b.e) / least : hc_nothing_known());
}

/* |√a - r| = |a - r²|/(√a + r) <= |a - r²|/r */
static hc_ball hc_root(hc_ball a) {
    double root = hc_rough_root(a.v);
    hc_ball rest;
    if (!(root > 0 && a.v > a.e)) return hc_ball_of(hc_nothing_known(), 0);
    root = 0.5 * (root + a.v / root);
    root = 0.5 * (root + a.v / root);
    rest = hc_minus(a, hc_times(hc_exactly(root), hc_exactly(root)));
    return hc_ball_of(root, (hc_size(rest.v) + rest.e) / root);
}

static double hc_at_most(hc_ball a) { return (a.v + a.e) * (a.v + a.e > 0 ? HC_more : HC_less); }
static double hc_at_least(hc_ball a) { return (a.v - a.e) * (a.v - a.e > 0 ? HC_less : HC_more); }

/* The rows of the basis in units of 1/b: the horizontal one across the axis, and those of the plane of both axes, where
   D = diag(1/p, -1/s), M = (c + h/t, (1/t - 1)√(hc); ., h + c/t). With D y = y M y's eigenvalue, a row is M y of unit
   length, and y is taken from the line of D - M/A2, or of D + M/B, in which nothing cancels. */
static void hc_basis(hc_tilted_scene *scene, hc_ball rows[3][3], const double sizes[4], const double axis[3]) {
    const hc_ball one = hc_exactly(1), b = hc_exactly(sizes[2]);
    const hc_ball alpha = hc_over(hc_exactly(sizes[0]), b), gamma = hc_over(hc_exactly(sizes[1]), b);
    const hc_ball d = hc_over(hc_exactly(sizes[3]), b), vx = hc_exactly(axis[0]), vy = hc_exactly(axis[1]);
    const hc_ball vz = hc_exactly(axis[2]), level = hc_plus(hc_times(vx, vx), hc_times(vy, vy));
    const hc_ball w = hc_plus(level, hc_times(vz, vz)), h = hc_over(level, w), c = hc_over(hc_times(vz, vz), w);
    const hc_ball p = hc_times(alpha, alpha), s = hc_times(gamma, gamma), t = hc_times(d, d), k0 = hc_times(p, s);
    const hc_ball along = hc_plus(hc_times(t, h), c), across = hc_plus(hc_times(t, c), h);
    const hc_ball k1 = hc_minus(hc_times(s, along), hc_times(p, across));
    const hc_ball root = hc_root(hc_plus(hc_times(k1, k1), hc_times(hc_exactly(4), hc_times(k0, t))));
    const hc_ball larger = hc_times(hc_exactly(0.5), k1.v < 0 ? hc_minus(root, k1) : hc_plus(root, k1));
    const hc_ball one_pole = hc_over(larger, t), other_pole = hc_over(k0, larger);
    const hc_ball length = hc_root(level), east = hc_over(vx, length), north = hc_over(vy, length);
    const hc_ball M11 = hc_over(across, t), M22 = hc_over(along, t); /* c + h/t, h + c/t */
    const hc_ball M12 = hc_times(hc_minus(hc_over(one, t), one), hc_over(hc_times(length, vz), w));
    int i, k;
    scene->A1 = p;
    scene->A2 = k1.v < 0 ? one_pole : other_pole;
    scene->B = k1.v < 0 ? other_pole : one_pole;
    rows[0][0] = hc_over(hc_minus(hc_exactly(0), north), b);
    rows[0][1] = hc_over(east, b);
    rows[0][2] = hc_exactly(0);
    for (i = 1; i < 3; i++) {
        const hc_ball pole = i == 1 ? scene->A2 : scene->B, mixed = hc_over(hc_minus(hc_exactly(0), M12), pole);
        const hc_ball whole = hc_plus(hc_over(one, i == 1 ? s : p), hc_over(i == 1 ? M22 : M11, pole));
        const hc_ball y1 = i == 1 ? whole : mixed, y2 = i == 1 ? mixed : whole;
        const hc_ball m1 = hc_plus(hc_times(M11, y1), hc_times(M12, y2)), m2 = hc_plus(hc_times(M12, y1), hc_times(M22, y2));
        const hc_ball unit = hc_times(hc_root(hc_plus(hc_times(y1, m1), hc_times(y2, m2))), b);
        rows[i][0] = hc_over(hc_times(m1, east), unit);
        rows[i][1] = hc_over(hc_times(m1, north), unit);
        rows[i][2] = hc_over(m2, unit);
    }
    scene->zeta = 0;
    for (i = 0; i < 3; i++) {
        double eta = 0;
        for (k = 0; k < 3; k++) eta += 4 * HC_unit * hc_size(rows[i][k].v) + rows[i][k].e;
        eta *= (sizes[2] > sizes[3] ? sizes[2] : sizes[3]) * HC_more_than;
        eta = (2 * eta + eta * eta + 2 * HC_unit) * HC_more_than;
        if (!(eta < 1)) eta = 1;
        if (eta > scene->zeta) scene->zeta = eta;
    }
}

static const hc_plane hc_never_above = {1, HC_NEVER, 0}, hc_never_below = {1, -1, 0};

/* z of the margins: more than (1 + a + M) zeta for all a and M that may come of it. */
static double hc_margin(const hc_tilted_scene *scene, double a, double M) { return 2 * (1 + a + M) * scene->zeta; }

/* A plane for comparisons > or >= (side 1), < (side -1), if its constants and its margin allow. */
static hc_plane hc_proper(const hc_tilted_scene *scene, double a, double K, double M, double z, int greater) {
    hc_plane plane;
    const int proper = a > HC_least_ratio && a < HC_greatest_ratio && K >= HC_least_constant && K < HC_cap && M >= 0 &&
                       M <= HC_greatest_slope && (1 + a + M) * scene->zeta * HC_more <= z && z < 0.125 && z < 0.125 * a;
    plane.a = a * (greater ? HC_less : HC_more);
    plane.K = K * (greater ? HC_more : HC_less);
    plane.M = M * (greater ? HC_more : HC_less);
    return proper ? plane : greater ? hc_never_above : hc_never_below;
}

/* The plane of one λ: exterior beyond it for λ > 0, interior within it for λ < 0. */
static hc_plane hc_tilted_tangent(const hc_tilted_scene *scene, double l, int side) {
    const hc_ball at = hc_exactly(l), from_A1 = hc_plus(scene->A1, at), from_A2 = hc_plus(scene->A2, at);
    const hc_ball from_B = hc_minus(scene->B, at), beta = hc_over(from_A1, from_A2), nu = hc_over(from_A1, from_B);
    const hc_ball kappa = hc_times(from_A1, hc_plus(hc_exactly(1), hc_over(hc_exactly(1), at)));
    const double z = hc_margin(scene, beta.v, nu.v);
    const int inside = hc_at_least(from_A1) > 0 && hc_at_least(from_A2) > 0 && hc_at_least(from_B) > 0 && side * l > 0;
    if (!inside) return side > 0 ? hc_never_above : hc_never_below;
    if (side > 0)
        return hc_proper(scene, hc_at_least(beta) - z, hc_at_most(kappa) * (1 + z), hc_at_most(nu) * (1 + z) + z, z, 1);
    return hc_proper(scene, hc_at_most(beta) + z, hc_at_least(kappa) * (1 - z), hc_at_least(nu) * (1 - z) - z, z, 0);
}

/* Whether the tangent at λ = l of φ = λ (P/(A+λ) - Q/(B-λ)) - 1 - λ is below 0 between 0 and the pole of that side: then
   so is φ, and the place (P, Q) is not exterior (side 1), or not interior (side -1). */
static int hc_below_tangent(hc_ball A, hc_ball B, double P, double Q, double l, int side) {
    const hc_ball one = hc_exactly(1), at = hc_exactly(l), p = hc_exactly(P), q = hc_exactly(Q);
    const hc_ball from_A = hc_plus(A, at), from_B = hc_minus(B, at), part_P = hc_over(p, from_A), part_Q = hc_over(q, from_B);
    const hc_ball phi = hc_minus(hc_times(at, hc_minus(part_P, part_Q)), hc_plus(one, at));
    const hc_ball rise = hc_times(hc_over(A, from_A), part_P), fall = hc_times(hc_over(B, from_B), part_Q);
    const hc_ball slope = hc_minus(hc_minus(rise, fall), one), at_0 = hc_minus(phi, hc_times(slope, at));
    const hc_ball to_pole = side > 0 ? from_B : hc_minus(hc_exactly(0), from_A), at_pole = hc_plus(phi, hc_times(slope, to_pole));
    return hc_at_least(from_A) > 0 && hc_at_least(from_B) > 0 && hc_at_most(at_0) < 0 && hc_at_most(at_pole) < 0;
}

/* The same with the best λ, which Newton's method finds for φ' = 0, and with λ = 0. */
static int hc_not_on_side(hc_ball A, hc_ball B, double P, double Q, int side) {
    double l = side * hc_best_multiplier(A.v, B.v, Q, side);
    int i;
    for (i = 0; i < 4; i++) {
        const double a = 1 / (A.v + l), b = 1 / (B.v - l), rise = A.v * P * a * a, fall = B.v * Q * b * b;
        const double moved = l + (rise - fall - 1) / (2 * (rise * a + fall * b));
        if (!(moved > -A.v && moved < B.v && side * moved > 0)) break;
        l = moved;
    }
    return hc_below_tangent(A, B, P, Q, l, side) || hc_below_tangent(A, B, P, Q, 0, side);
}

/* A plane over Q in [from, to] whose corners are no exterior ones (side 1), or no interior ones (side -1). */
static hc_plane hc_tilted_chord(const hc_tilted_scene *scene, double from, double to, int side) {
    static const double steps[3] = {9.3132257461547852e-10 /* 2^-30 */, 1.52587890625e-05 /* 2^-16 */, 0.00390625 /* 2^-8 */};
    const hc_ball A[2] = {scene->A1, scene->A2}, B = scene->B;
    const double ends[2] = {from, to};
    double edge[2][2], at[2];
    int i, k, step;
    for (i = 0; i < 2; i++)
        for (k = 0; k < 2; k++) {
            edge[i][k] = hc_edge(A[i].v, B.v, ends[k], side);
            if (!(edge[i][k] > 0)) edge[i][k] = 0;
        }
    for (step = 0; step < 3; step++) {
        const double a = edge[1][1] > 0 ? edge[0][1] / edge[1][1] : 1;
        double K, M, z;
        int proved = 1;
        for (k = 0; k < 2; k++) {
            const double first = edge[0][k], second = a * edge[1][k];
            at[k] = (side * (first - second) < 0 ? first : second) * (1 - side * steps[step]);
        }
        M = to > from ? (at[1] - at[0]) / (to - from) : 0;
        K = at[0] - M * from;
        if (side < 0 && K < 2 * HC_least_constant) {
            M = to > 0 ? at[1] / to * (1 + steps[0]) : 0;
            K = 2 * HC_least_constant;
        }
        z = hc_margin(scene, a, M);
        for (i = 0; i < 2; i++)
            for (k = 0; k < 2; k++) {
                const hc_ball line = hc_plus(hc_exactly(K), hc_times(hc_exactly(M), hc_exactly(ends[k])));
                const hc_ball corner = i ? hc_over(line, hc_exactly(a)) : line;
                const double P = side > 0 ? hc_at_most(corner) : hc_at_least(corner);
                proved = proved && P >= 0 && hc_not_on_side(A[i], B, P, ends[k], side);
            }
        if (proved && side > 0) return hc_proper(scene, a * (1 - z) + z, K * (1 - z), M * (1 - z) - z, z, 0);
        if (proved) return hc_proper(scene, a * (1 + z) - z, K * (1 + z), M * (1 + z) + z, z, 1);
    }
    return side > 0 ? hc_never_below : hc_never_above;
}

/* The greatest and the least Q that the centres have, from a sample of them. */
static void hc_sample_Q(const hc_tilted_scene *scene, size_t n, const double *x, const double *y, const double *z,
                        double *least, double *greatest) {
    const size_t step = n / 64 + 1;
    size_t i;
    *least = HC_NEVER;
    *greatest = 0;
    for (i = 0; i < n; i += step) {
        const double c3 = scene->r3_x * x[i] + scene->r3_y * y[i] + scene->r3_z * z[i], Q = c3 * c3;
        if (Q < *least) *least = Q;
        if (Q > *greatest && Q < HC_greatest) *greatest = Q;
    }
}

/* Chooses and proves the half spaces number `first` to `last`: 0 is over all heights, 1 over the lower, 2 over the upper ones. */
static void hc_make_planes(hc_tilted_scene *scene, int first, int last) {
    const double *const Q = scene->heights, A = 0.5 * (scene->A1.v + scene->A2.v), B = scene->B.v;
    double most = 0;
    int i;
    for (i = first; i <= last; i++) {
        const int from = i == 2, to = i == 1 ? 1 : 2;
        const double middle = i == 0 ? Q[1] : 0.5 * (Q[from] + Q[to]);
        const hc_plane *const under = scene->under + i;
        double P;
        scene->beyond[i] = hc_tilted_tangent(scene, hc_best_multiplier(A, B, middle, 1), 1);
        scene->within[i] = hc_tilted_tangent(scene, -hc_best_multiplier(A, B, middle, -1), -1);
        scene->under[i] = hc_tilted_chord(scene, Q[from], Q[to], 1);
        scene->above[i] = hc_tilted_chord(scene, Q[from], Q[to], -1);
        P = 8 * (under->K + (1 + under->M) * Q[2]) * (1 + 1 / under->a);
        if (under->K > 0 && P > most) most = P;
    }
    /* A computed Q up to `reach` and what "under" leaves of P say that the exact Q is at most Q[2]: with z < a/8 < 1/8 they
       bound N = P1 + P2 + Q by Q + 1.15 (K + (M + 1/8) Q)(1 + 1.25/a), and Q exceeds the computed one by zeta N at most. */
    scene->reach = (Q[2] - scene->zeta * (most + 2 * Q[2])) * HC_less;
}

/* Returns 0, and the first stage is left out, where the sizes are too large or small for the margins. */
static int hc_make_tilted_scene(hc_tilted_scene *scene, const double sizes[4], const double axis[3], size_t n,
                                const double *x, const double *y, const double *z) {
    hc_ball rows[3][3];
    double least, greatest, *const Q = scene->heights;
    int i;
    for (i = 0; i < 4; i++)
        if (!(sizes[i] > HC_least_size && sizes[i] < HC_greatest_size)) return 0;
    hc_basis(scene, rows, sizes, axis);
    if (!(scene->zeta < HC_greatest_zeta)) return 0;
    scene->r1_x = rows[0][0].v, scene->r1_y = rows[0][1].v;
    scene->r2_x = rows[1][0].v, scene->r2_y = rows[1][1].v, scene->r2_z = rows[1][2].v;
    scene->r3_x = rows[2][0].v, scene->r3_y = rows[2][1].v, scene->r3_z = rows[2][2].v;
    hc_sample_Q(scene, n, x, y, z, &least, &greatest);
    Q[0] = 0;
    Q[2] = greatest > HC_least ? 1.125 * greatest : HC_least;
    Q[1] = least < greatest && least > 0.3 * Q[2] ? 0.999 * least : 0.3 * Q[2];
    hc_make_planes(scene, 0, 0);
    scene->has_two = 0;
    return HC_FLOATS_DECIDE;
}
