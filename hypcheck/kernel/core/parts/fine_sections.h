/* ---- a pair's sections by numbers of two doubles ---- */

#define HC_FINE_ERROR 8.0779356694631609e-28 /* 2^-90: 128u of numbers of two doubles, u = 2^-100, and room */

/* hc_sections of ended.h without roots: eta = E/sqrt(F), xi = (X - kappa t)/sqrt(F), F the square of
   the horizontal part of the axis. `alpha2` is alpha², `rise2` alpha²/gamma², b2 is 1/mu1, c2 is 1/mu2. */
typedef struct {
    hc_twin alpha2, rise2, z, T, b2, c2, E, X, kappa, F;
    double v[2]; /* the horizontal part of the axis */
} hc_fine_sections;

static void hc_place_fine(hc_fine_sections *made, hc_twin x, hc_twin y, hc_twin z) {
    const hc_twin v0 = hc_twin_of(made->v[0]), v1 = hc_twin_of(made->v[1]);
    made->E = hc_twin_difference(hc_twin_product(x, v1), hc_twin_product(y, v0));
    made->X = hc_twin_sum(hc_twin_product(x, v0), hc_twin_product(y, v1));
    made->z = z;
}

/* b² and d² are multiplied by 1 + more. */
static hc_fine_sections hc_make_fine(const double row[10], double more) {
    const hc_twin one = hc_twin_of(1), share = hc_two_sum(1, more), d2 = hc_twin_product(hc_two_product(row[3], row[3]), share);
    hc_fine_sections made;
    double v[3];
    memcpy(v, row + 7, sizeof v);
    hc_scale_axis(v);
    made.alpha2 = hc_two_product(row[0], row[0]);
    made.rise2 = hc_twin_quotient(made.alpha2, hc_two_product(row[1], row[1]));
    made.b2 = hc_twin_product(hc_two_product(row[2], row[2]), share);
    made.v[0] = v[0], made.v[1] = v[1];
    if (v[0] == 0 && v[1] == 0) {
        made.T = d2;
        made.c2 = made.b2;
        made.kappa = hc_twin_of(0);
        made.F = one;
        made.v[0] = 1;
    } else {
        const hc_twin flat = hc_twin_sum(hc_two_product(v[0], v[0]), hc_two_product(v[1], v[1])), up = hc_twin_of(v[2]);
        const hc_twin length = hc_twin_sum(flat, hc_twin_square(up)), sum = hc_two_sum(row[2], row[3]);
        const hc_twin wide = hc_twin_product(hc_twin_product(hc_two_sum(row[2], -row[3]), sum), share);
        const hc_twin all = hc_twin_sum(hc_twin_product(made.b2, flat), hc_twin_product(d2, hc_twin_square(up)));
        made.T = hc_twin_quotient(all, length);
        made.c2 = hc_twin_quotient(hc_twin_product(made.b2, d2), made.T);
        made.kappa = hc_twin_quotient(hc_twin_product(hc_twin_product(up, flat), wide), all);
        made.F = flat;
    }
    hc_place_fine(&made, hc_twin_of(row[4]), hc_twin_of(row[5]), hc_twin_of(row[6]));
    return made;
}

static hc_twin hc_fine_square_of_radius(const hc_fine_sections *fine, double w) {
    return hc_twin_sum(fine->alpha2, hc_twin_product(fine->rise2, hc_two_product(w, w)));
}

/* t²/T - 1 at a height. */
static hc_twin hc_fine_share(const hc_fine_sections *fine, hc_twin t) {
    return hc_twin_difference(hc_twin_quotient(hc_twin_square(t), fine->T), hc_twin_of(1));
}

/* phi at a height, f being lambda/(1 + lambda/mu); the error is as in hc_phi_about, of doubles of 100 bits. */
static double hc_fine_phi(const hc_fine_sections *fine, double lambda_, double w) {
    const hc_twin t = hc_twin_difference(hc_twin_of(w), fine->z), l = hc_twin_of(lambda_), one = hc_twin_of(1);
    const hc_twin aside = hc_twin_difference(fine->X, hc_twin_product(fine->kappa, t));
    const hc_twin n1 = hc_twin_sum(one, hc_twin_product(l, fine->b2)), n2 = hc_twin_sum(one, hc_twin_product(l, fine->c2));
    const hc_twin parts = hc_twin_sum(hc_twin_quotient(hc_twin_square(fine->E), n1), hc_twin_quotient(hc_twin_square(aside), n2));
    const hc_twin off = hc_twin_difference(hc_twin_quotient(parts, fine->F), hc_fine_square_of_radius(fine, w));
    return hc_twin_sum(hc_fine_share(fine, t), hc_twin_product(l, off)).high;
}

/* What hc_point_within compares, by numbers of two doubles. */
static double hc_fine_point(const hc_fine_sections *fine, double w, double a, double c) {
    const hc_twin t = hc_twin_difference(hc_twin_of(w), fine->z), length = hc_twin_sum(hc_two_product(a, a), hc_two_product(c, c));
    const hc_twin scale = hc_twin_root(hc_twin_quotient(hc_twin_product(fine->F, hc_fine_square_of_radius(fine, w)), length));
    const hc_twin off = hc_twin_difference(hc_twin_product(scale, hc_twin_of(a)), fine->E);
    const hc_twin xi = hc_twin_difference(fine->X, hc_twin_product(fine->kappa, t));
    const hc_twin aside = hc_twin_difference(hc_twin_product(scale, hc_twin_of(c)), xi);
    const hc_twin sum = hc_twin_sum(hc_twin_quotient(hc_twin_square(off), fine->b2), hc_twin_quotient(hc_twin_square(aside), fine->c2));
    return hc_twin_sum(hc_twin_quotient(sum, fine->F), hc_fine_share(fine, t)).high;
}
