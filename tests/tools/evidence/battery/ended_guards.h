/* The guards of hyperboloids that end, at their limits; CHECK and two() are those of guards.h. What is right follows from the
   geometry, or from the limit that a guard has. Of alpha = 3, gamma = 4 the circle at height 3 has the radius 15/4. */

static void put_row(double row[13], double b, double d, double x, double y, double z, const double axis[3]) {
    const double first[7] = {3, 4, b, d, x, y, z}, upward[3] = {0, 0, 1};
    memcpy(row, first, sizeof first);
    memcpy(row + 7, axis ? axis : upward, sizeof upward);
    row[10] = -1, row[11] = 3, row[12] = 0;
}

static hc_sections pair_of(double b, double d, double x, double y, double z, const double axis[3]) {
    double row[13];
    hc_sections pair;
    put_row(row, b, d, x, y, z, axis);
    CHECK(hc_make_sections(&pair, row));
    return pair;
}

static int ended_at(const double row[13]) {
    int8_t answers[2];
    hypcheck_classify_ended(1, row, answers);
    hypcheck_classify_columns(1, 13, row, answers + 1);
    CHECK(answers[0] == answers[1]);
    return answers[0];
}

/* ---- what bounds are made of ---- */

static int sections_made(int place, double value) {
    double row[13];
    hc_sections pair;
    put_row(row, 1, 2, 4, 1, 2, NULL);
    row[place] = value;
    return hc_make_sections(&pair, row);
}

static int sections_along(double x, double y, double z) {
    double row[13];
    hc_sections pair;
    put_row(row, 1, 2, 4, 1, 2, NULL);
    row[7] = x, row[8] = y, row[9] = z;
    return hc_make_sections(&pair, row);
}

static void check_sections(void) {
    const double high = two(100), low = two(-100);
    int place;
    for (place = 0; place < 7; place++) {
        CHECK(sections_made(place, high) && !sections_made(place, hc_next(high, 1)) && !sections_made(place, two(101)));
        CHECK(sections_made(place, low) && sections_made(place, hc_next(low, -1)) == (place > 3) && sections_made(place, 0) == (place > 3));
    }
    CHECK(sections_along(1, 2, 3) && !sections_along(0, 0, 0) && !sections_along(two(1000), two(-21), 0));
    CHECK(sections_along(two(-128), 0, 1) && !sections_along(0.99 * two(-128), 0, 1) && !sections_along(two(-200), 0, 1));
    CHECK(sections_along(0, two(-128), 1) && !sections_along(0, two(-129), 1) && sections_along(0, 0, two(-39)));
    {
        /* Directions of 45°: T = (b² + d²)/2, and the ellipses have the half axes b and bd/√T; they move (d² - b²)/2T a step. */
        const double axis[3] = {3, 4, 5};
        const hc_sections pair = pair_of(1, 7, 2, 1, 0, axis);
        CHECK(fabs(pair.T - 25) < 1e-12 && pair.mu1 == 1 && fabs(pair.mu2 - 25.0 / 49) < 1e-14 && fabs(pair.k + 24.0 / 25) < 1e-14);
        CHECK(fabs(pair.c - 0.6) < 1e-15 && fabs(pair.s - 0.8) < 1e-15 && fabs(pair.xi0 - 2) < 1e-15 && fabs(pair.eta - 1) < 1e-15);
        CHECK(pair.across == 3 && hc_radius(&pair, 0) == 3 && fabs(hc_radius(&pair, 3) - 3.75) < 1e-15);
    }
}

/* Beside a circle of radius 3 the nearest point is 2 away: 5/(1 + lambda) = 3. On the axis all points are as near, and lambda comes
   as near to -mu as it does. */
static void check_multipliers(void) {
    const hc_sections beside = pair_of(1, 1, 0, 5, 0, NULL), on_axis = pair_of(1, 1, 0, 0, 0, NULL);
    CHECK(fabs(hc_ended_multiplier(&beside, 3, 0) - 2.0 / 3) < 1e-8);
    CHECK(hc_ended_multiplier(&on_axis, 3, 0) == two(-40) - 1 && hc_ended_multiplier(&on_axis, 3, two(-50)) < two(-40) - 1 + 1e-15);
}

static void check_multiplier_bounds(void) {
    const hc_sections round = pair_of(2, 2, 4, 3, 0, NULL);
    const double axis[3] = {1, 0, 1};
    const hc_sections pair = pair_of(1, 7, 4, 3, 0, axis);
    const double near = HC_ENDED_NEAREST;
    CHECK(hc_phi_about(&round, -0.25 * (1 - 1.0625 * near), 0, 1).safe && !hc_phi_about(&round, -0.25 * (1 - 0.9375 * near), 0, 1).safe);
    CHECK(hc_phi_about(&pair, -pair.mu2 * (1 - 1.0625 * near), 0, 1).safe && !hc_phi_about(&pair, -pair.mu2 * (1 - 0.9375 * near), 0, 1).safe);
    CHECK(hc_phi_about(&pair, 0, 0, 1).safe && !hc_phi_about(&pair, -1, 0, 1).safe && !hc_phi_about(&pair, -2, 0, 1).safe);
}

static void check_least(void) {
    CHECK(hc_least_of(1, 1, 2) == 0 && hc_least_of(-1, 0, 2) == -2 && hc_least_of(-1, 1, 2) == -0.25 && hc_least_of(-4, 1, 2) == -4);
    CHECK(hc_least_of(-5, 1, 2) == -6 && hc_least_of(1, -1, 2) == -2 && hc_least_of(1, -1, 0.5) == 0 && hc_least_of(0, 1, 2) == 0 && hc_least_of(-1, 1, 0) == 0);
    CHECK(hc_least_between(1, 0, 0, 2, 5) == -2 && hc_least_between(-1, 0, 0, 2, 5) == -5 && hc_least_between(0, 0, 1, 2, 5) == -5);
    CHECK(hc_least_between(1, 0, 3, 2, 5) == -10 && hc_least_between(0, 0, 0, 2, 5) == 0 && hc_least_between(1, 0, 0, 5, 2) == -5);
    CHECK(hc_kept_within(1, 2, 3) == 2 && hc_kept_within(2, 2, 3) == 2 && hc_kept_within(2.5, 2, 3) == 2.5 && hc_kept_within(3, 2, 3) == 3);
    CHECK(hc_kept_within(4, 2, 3) == 3 && hc_kept_within(NAN, 2, 3) == 2);
}

/* ---- points that lie within ---- */

static void check_points(void) {
    const hc_sections pair = pair_of(1, 1, 3.5, 0, 0, NULL), far = pair_of(1, 1, 4, 0, 0, NULL);
    double row[13];
    hc_fine_sections fine;
    put_row(row, 1, 1, 4 - two(-60), 0, 0, NULL);
    fine = hc_make_fine(row, 0);
    CHECK(hc_point_within(&pair, 3, 0, pair.xi0, pair.eta, pair.xi0) && !hc_point_within(&pair, 3, 0, pair.xi0, 0, 0));
    CHECK(!hc_point_within(&pair, 3, 0, pair.xi0, -pair.eta, -pair.xi0) && !hc_point_within(&pair, 3, 1, pair.xi0, pair.eta, pair.xi0));
    CHECK(!hc_point_within(&far, 3, 0, far.xi0, far.eta, far.xi0)); /* it touches */
    CHECK(!hc_point_surely_within(&far, &fine, 0, 0, 0) && !hc_point_surely_within(&far, &fine, 0, 0, two(128)));
    CHECK(!hc_point_surely_within(&far, &fine, 0, 0, two(-128)) && !hc_point_surely_within(&far, &fine, 0, 0, two(127)));
}

/* Whether the direction is r long, and what the signs of its two parts are, as 3 + 1: 4 of both > 0. */
static int direction_of(double b, double d, const double axis[3], double eta, double xi, double lambda_) {
    hc_sections pair = pair_of(b, d, 0, 0, 0, axis);
    double a, c;
    pair.eta = eta;
    hc_direction_of(&pair, lambda_, 5, xi, &a, &c);
    CHECK(fabs(a * a + c * c - 25) < 1e-12);
    return 3 * ((a > 0) - (a < 0)) + (c > 0) - (c < 0);
}

static void check_directions(void) {
    const double axis[3] = {1, 0, 1}, near = two(-40);
    /* b < d: mu2 is the smaller one, and with lambda next to it what is left of 5 lies along xi; b > d: along eta. */
    const double wide = 1 / 49.0 * (near - 1), tall = 25 / 49.0 * (near - 1);
    CHECK(direction_of(1, 7, axis, two(-60), two(-60), tall) == 4 && direction_of(1, 7, axis, two(-60), -two(-60), tall) == 2);
    CHECK(direction_of(7, 1, axis, two(-60), two(-60), wide) == 4 && direction_of(7, 1, axis, -two(-60), two(-60), wide) == -2);
    CHECK(direction_of(1, 7, axis, -3, 0, 0) == -2 && direction_of(1, 7, axis, 3, 4, 0) == 4);
}

/* ---- discs, the rim and the wall ---- */

static int disc_misses(double b, double d, double x, double z, double w) {
    const hc_sections pair = pair_of(b, d, x, 0, z, NULL);
    return hc_disc_misses(&pair, w);
}

/* A sphere of radius 1 whose lowest point lies by hairs inside the disc at height 3, on its rim or outside, and by others below
   its plane, in it or above: what bounds leave open numbers of two doubles tell, and integers where two of these are 0. */
static void check_discs(void) {
    const double y[3] = {0, 0, two(-30)}, off[3] = {-two(-50), 0, 0};
    int i, k;
    CHECK(disc_misses(1, 1, 1, 3.5, 3) == 0 && disc_misses(1, 1, 1, 4.5, 3) == 1 && disc_misses(1, 1, 1, 4, 3) == 2);
    CHECK(disc_misses(1, 1, 3.75, 3, 3) == 2 && disc_misses(1, 1, 3.5, 3, 3) == 0 && disc_misses(1, 1, 5, 3, 3) == 1);
    for (i = 0; i < 3; i++)
        for (k = -1; k < 2; k++) {
            double row[13];
            hc_sections pair;
            put_row(row, 1, 1, 3.75 + off[i], y[i], 4 + k * two(-50), NULL);
            row[12] = 1;
            CHECK(hc_make_sections(&pair, row) && hc_disc_misses(&pair, 3) == 2);
            CHECK(hc_disc_surely_misses(&pair, row, 3) == (i == 2 || k == 1 ? 1 : i == 0 && k == -1 ? 0 : 2));
            CHECK(hc_ended_disc_misses(&pair, row, 3, 0) == hc_disc_surely_misses(&pair, row, 3));
            CHECK(hc_ended_disc_misses(&pair, row, 3, 1) == (k == 1 || (k == 0 && i == 2)) && ended_at(row) == (k == 1 || (k == 0 && i == 2)));
            row[5] = two(-300); /* too small for integers beside the others */
            CHECK(hc_ended_disc_misses(&pair, row, 3, 1) == 2 && (ended_at(row) == 2 || ended_at(row) == (k == 1)));
        }
}

static int exact_end(int place, double value) {
    double row[13];
    hc_end end;
    put_row(row, 1, 1, 4, 0, 3, NULL);
    row[place] = value;
    end = hc_exact_end(row, 3);
    return end.known ? end.misses : 2;
}

/* Beside the circle of radius 15/4 at height 3. The bits from the last one of 53 to the first fit 256, or do not. */
static void check_exact_ends(void) {
    CHECK(exact_end(4, 4) == 0 && exact_end(4, 4.75) == 0 && exact_end(4, 4.75 + two(-50)) == 1 && exact_end(4, 2.75 - two(-50)) == 1);
    CHECK(exact_end(2, 10) == 0 && exact_end(6, 4) == 1 && exact_end(6, 5) == 1 && exact_end(2, 0.25) == 0 && exact_end(2, 0.2) == 1);
    CHECK(exact_end(5, two(-200)) == 0 && exact_end(5, two(-201)) == 0 && exact_end(5, two(-202)) == 2 && exact_end(5, two(-300)) == 2);
    CHECK(exact_end(3, two(-201)) == 0 && exact_end(3, two(-202)) == 2 && exact_end(6, two(-300)) == 2 && exact_end(3, two(203)) == 0);
}

/* The same end with all lengths along the axis in another unit, which is their own. */
static void check_units_of_ends(void) {
    double row[13];
    int k;
    put_row(row, 1, 1, 4.75 + two(-50), 0, 3, NULL);
    for (k = -300; k <= 300; k += 300) {
        const double along[4] = {row[1] * two(k), row[3] * two(k), row[6] * two(k), 3 * two(k)};
        double other[13];
        hc_end end;
        memcpy(other, row, sizeof other);
        other[1] = along[0], other[3] = along[1], other[6] = along[2];
        end = hc_exact_end(other, along[3]);
        CHECK(end.known && end.misses && end.reached == 1 && end.off == 1);
        CHECK(!hc_exact_end(other, two(k - 300)).known); /* the height of the end is a length, too */
    }
}

static int upright_met(double scale, double b, double x, double z) {
    double row[13];
    int k;
    put_row(row, b, 1, x, 0, z, NULL);
    for (k = 0; k < 7; k++) row[k] *= scale;
    return hc_upright_met(row, 0);
}

/* At height 0, where the radius is 3. */
static void check_upright_contacts(void) {
    CHECK(upright_met(1, 1, 3.5, 0) && upright_met(1, 1, 2.5, 0) && !upright_met(1, 1, 4, 0) && !upright_met(1, 1, 2, 0) && !upright_met(1, 1, 5, 0));
    CHECK(!upright_met(1, 1, 3.5, 1) && !upright_met(1, 1, 3, 1.5) && upright_met(1, 1, 3, 0.99) && upright_met(1, 4, 1.5, 0));
    CHECK(upright_met(1, 5, 1.5, 0)); /* the circle lies within the spheroid */
    CHECK(!upright_met(two(-140), 1, 3.5, 0) && upright_met(two(-100), 1, 3.5, 0) && upright_met(two(190), 1, 3.5, 0));
    CHECK(!upright_met(1, two(201), two(202), 0) && upright_met(two(197), 1, 3.5, 0) && !upright_met(two(202), 1, 3.5, 0));
}

static int leaves_end(double scale, double x, double z, double far, int side) {
    double row[13];
    int k;
    put_row(row, 1, 1, x, 0, z, NULL);
    for (k = 0; k < 7; k++) row[k] *= scale;
    return hc_grows_from_end(row, 3 * scale, far * scale, side);
}

/* From the rim at height 3, radius 15/4: a sphere above it is nearest there, one beside it is not. */
static void check_growth(void) {
    const double steep[13] = {1, two(-100), 1, 1, two(100), 0, 0, 0, 0, 1, -1, 3, 0};
    CHECK(leaves_end(1, 3.75, 4, two(-14), 1) && !leaves_end(1, 3.75, 4, two(-14), -1) && !leaves_end(1, 3.75, 4, 8, 1));
    /* the slope is 0 at these heights, as 2 Q Q' = 4 R (r²)' there; and it outweighs the bend so far, by the sizes of all terms */
    CHECK(leaves_end(1, 3.75, 2.96, 0, 1) && !leaves_end(1, 3.75, 2.92, 0, 1) && leaves_end(1, 1, 4.5, 0, 1) && !leaves_end(1, 1, 4.46, 0, 1));
    CHECK(leaves_end(1, 6, 2.26, 0, 1) && !leaves_end(1, 6, 2.22, 0, 1) && leaves_end(1, 3.75, 4, 0.323, 1) && !leaves_end(1, 3.75, 4, 0.329, 1));
    CHECK(leaves_end(1, 3.75, 8, 0.87, 1) && !leaves_end(1, 3.75, 8, 0.887, 1) && leaves_end(1, 1, 12, 1.31, 1) && !leaves_end(1, 1, 12, 1.34, 1));
    CHECK(leaves_end(two(60), 3.75, 4, two(-14), 1) && !leaves_end(two(140), 3.75, 4, two(-14), 1));
    CHECK(leaves_end(two(-60), 3.75, 4, two(-14), 1) && !leaves_end(two(-90), 3.75, 4, two(-14), 1));
    CHECK(!hc_grows_from_end(steep, two(-11), two(-11), -1) && !hc_grows_from_end(steep, two(-11), two(-11), 1));
}

static int upright_wall_misses(double x, double y, double z, double bottom, double top) {
    double row[13];
    hc_sections pair;
    put_row(row, 1, 1, x, y, z, NULL);
    row[10] = bottom, row[11] = top;
    CHECK(hc_make_sections(&pair, row));
    return hc_upright_wall_misses(&pair, row, bottom, top);
}

static void check_upright_walls(void) {
    CHECK(upright_wall_misses(3.75, 0, 4, 2, 3) == 0 && upright_wall_misses(3.75, 0, 4 + two(-50), 2, 3) == 1);
    CHECK(upright_wall_misses(3.75, two(-300), 4, 2, 3) == 2 && upright_wall_misses(3.75, 0, 4 + two(-50), 3, 3) == 2);
    CHECK(upright_wall_misses(9, 0, 3, 2, 3) == 1 && upright_wall_misses(3.5, 0, 2.5, 2, 3) == 0);
}

static int wall_misses(double b, double d, double x, double y, double z, const double axis[3], double bottom, double top) {
    double row[13];
    hc_sections pair;
    put_row(row, b, d, x, y, z, axis);
    row[10] = bottom, row[11] = top;
    CHECK(hc_make_sections(&pair, row));
    return hc_wall_misses(&pair, row, bottom, top);
}

static void check_walls(void) {
    const double lying[3] = {1, 0, 0};
    hc_sections pair = pair_of(1, 1, 9, 0, 0, NULL);
    double row[13];
    CHECK(wall_misses(1, 1, 4.5, 0, 0, NULL, -1, 1) == 1 && wall_misses(1, 1, 3.5, 0, 0, NULL, -1, 1) == 0 && wall_misses(1, 1, 4, 0, 0, NULL, -1, 1) == 2);
    CHECK(wall_misses(0.5, 1, 4, 0, 0, lying, -0.25, 0.25) == 2 && wall_misses(0.5, 1, 4 - 1e-9, 0, 0, lying, -0.25, 0.25) == 0);
    CHECK(wall_misses(0.5, 1, 4 + 1e-9, 0, 0, lying, -0.25, 0.25) == 1 && wall_misses(0.5, 1, 4 + two(-50), 0, 0, lying, -0.25, 0.25) == 1);
    CHECK(wall_misses(0.5, 1, 4 - two(-50), 0, 0, lying, -0.25, 0.25) == 0);
    put_row(row, 1, 1, 9, 0, 0, NULL);
    pair.mu1 = NAN; /* no number proves anything */
    CHECK(hc_wall_misses(&pair, row, -1, 1) == 2);
}

/* Of a touch that no bounds tell: it is contact where the wall beyond the ends is missed. */
static void check_touches_between_ends(void) {
    double row[13];
    put_row(row, 1, 1, 4, 0, 0, NULL);
    CHECK(ended_at(row) == 0);
    row[11] = 0.5;
    CHECK(ended_at(row) == 0);
    row[10] = 0.25; /* the touch lies below the lower end */
    CHECK(ended_at(row) == 1);
    put_row(row, 0.5, 1, 4, 0, 0, NULL);
    row[7] = 1, row[9] = 0, row[10] = -0.25, row[11] = 0.25; /* lying */
    CHECK(ended_at(row) == 0);
    row[10] = -INFINITY;
    CHECK(ended_at(row) == 0);
    put_row(row, 1, 2, 3.75, 0, 4, NULL);
    row[7] = 1, row[9] = 0; /* it lies on the rim, and the wall without ends would go on through it */
    CHECK(ended_at(row) == 2 || ended_at(row) == 0);
}

/* ---- the centre, and rows that are no rows ---- */

static int center_inside(double x, double z) {
    double row[13];
    put_row(row, 1, 1, x, 0, z, NULL);
    return hc_center_inside(row);
}

static void check_centres(void) {
    CHECK(center_inside(3, 0) == 2 && center_inside(2.99, 0) == 1 && center_inside(3.01, 0) == 0 && center_inside(3.75, 3) == 2);
    CHECK(center_inside(3 * (1 - two(-48)), 0) == 2 && center_inside(3 * (1 + two(-48)), 0) == 2 && center_inside(3 * (1 - two(-46)), 0) == 1);
    CHECK(center_inside(3 * (1 + two(-46)), 0) == 0 && center_inside(0, -1) == 1 && center_inside(0, 3) == 1);
    CHECK(center_inside(0, two(-53) - 1) == 1 && center_inside(0, -1 - two(-52)) == 0 && center_inside(0, 3 + two(-51)) == 0);
}

/* Centres in the plane of an end, at -3, by 2^-47 off the wall: thin spheroids meet it where it comes to them, upwards from within
   and downwards from without, but not on the other side of the plane. */
static void check_centres_beside_the_wall(void) {
    double row[13];
    int side, above;
    for (side = -1; side < 2; side += 2)
        for (above = 0; above < 2; above++) {
            put_row(row, two(-60), 1, 3.75 + side * two(-47), 0, -3, NULL);
            row[10] = above ? -3 : -9, row[11] = above ? 9 : -3;
            CHECK(hc_position_of(row) == 0 && ended_at(row) == (above == (side > 0) ? side : 0));
            row[5] = two(-300); /* and no integers tell where the centre is */
            CHECK(ended_at(row) == (above == (side > 0) ? 2 : 0));
        }
}

/* Lying in the body, so near to its flat end that it would touch it if it stood; and so in the open one, which has none. */
static void check_lying_within(void) {
    double row[13];
    put_row(row, 0.5, 1, 0, 0, 2.25, NULL);
    row[7] = 1, row[9] = 0;
    CHECK(ended_at(row) == -1);
    row[12] = 1;
    CHECK(ended_at(row) == -1);
    row[6] = 3.75;
    CHECK(ended_at(row) == 1);
    row[12] = 0;
    CHECK(ended_at(row) == 1);
}

static void check_many_rows(void) {
    enum { MANY = 2 * 2048 + 3 }; /* more than are asked together */
    static double rows[MANY * 13], narrow[MANY * 10];
    static int8_t answers[MANY];
    const size_t widths[6] = {0, 1, 8, 11, 14, 16};
    int i;
    for (i = 0; i < MANY; i++) {
        put_row(rows + 13 * i, 1, 1, i % 2 ? 3.5 : 9, 0, 1, NULL);
        memcpy(narrow + 10 * i, rows + 13 * i, 10 * sizeof *narrow);
    }
    hypcheck_classify_ended(MANY, rows, answers);
    for (i = 0; i < MANY; i++) CHECK(answers[i] == (i % 2 ? 0 : 1));
    hypcheck_classify_columns(MANY, 10, narrow, answers);
    for (i = 0; i < MANY; i++) CHECK(answers[i] == (i % 2 ? 0 : 1));
    for (i = 0; i < 6; i++) {
        memset(answers, 0, 3);
        hypcheck_classify_columns(2, widths[i], rows, answers);
        CHECK(answers[0] == 127 && answers[1] == 127 && answers[2] == 0);
    }
}

static int refused(int place, double value) {
    double row[13];
    put_row(row, 1, 1, 3.5, 0, 1, NULL);
    row[place] = value;
    return ended_at(row) == 127;
}

static void check_refusals(void) {
    CHECK(refused(12, 2) && refused(12, NAN) && refused(12, 0.5) && refused(12, -1) && !refused(12, 1) && !refused(12, -0.0));
    CHECK(refused(10, 3) && refused(10, 4) && refused(10, NAN) && refused(11, NAN) && refused(11, -1) && refused(11, -INFINITY) && refused(10, INFINITY));
    CHECK(!refused(10, -INFINITY) && !refused(11, INFINITY) && !refused(10, hc_next(3, -1)) && refused(9, 0) && refused(0, 0) && refused(6, NAN));
}

static void check_ended(void) {
    check_sections();
    check_multipliers();
    check_multiplier_bounds();
    check_least();
    check_points();
    check_directions();
    check_discs();
    check_exact_ends();
    check_units_of_ends();
    check_upright_contacts();
    check_growth();
    check_upright_walls();
    check_walls();
    check_touches_between_ends();
    check_centres();
    check_centres_beside_the_wall();
    check_lying_within();
    check_many_rows();
    check_refusals();
}
