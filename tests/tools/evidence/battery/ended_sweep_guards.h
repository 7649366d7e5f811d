/* The guards of sweeps beside hyperboloids that end, and of numbers of two doubles, at their limits. Included after
   ended_guards.h. */

/* ---- numbers of two doubles ---- */

/* 1 + 2^-60 and its like: what is behind the high part is kept, in quotients and roots too. */
static void check_twins(void) {
    const hc_twin one = hc_twin_of(1), more = hc_two_sum(1, two(-60)), third = hc_twin_quotient(one, hc_twin_of(3));
    const hc_twin back = hc_twin_difference(hc_twin_product(third, hc_twin_of(3)), one), half = hc_twin_root(hc_twin_of(0.25));
    const hc_twin root = hc_twin_root(hc_twin_of(2)), two_again = hc_twin_difference(hc_twin_square(root), hc_twin_of(2));
    CHECK(more.high == 1 && more.low == two(-60) && hc_twin_difference(more, one).high == two(-60) && hc_two_sum(two(-60), 1).low == two(-60));
    CHECK(fabs(back.high) < two(-100) && half.high + half.low == 0.5 && fabs(two_again.high) < two(-98) && third.low != 0 && root.low != 0);
    CHECK(hc_twin_product(more, more).low == two(-59) && hc_two_product(1 + two(-40), 1 + two(-40)).low == two(-80));
    CHECK(hc_two_product(134217729, 134217729).high + hc_two_product(134217729, 134217729).low == 18014398777917441.0);
    CHECK(hc_twin_root(hc_twin_of(0)).high == 0 && hc_twin_root(hc_twin_of(-1)).high == 0 && hc_twin_minus(more).low == -two(-60));
}

static int is_fine(hc_fine_ball a) { return a.v.high == a.v.high && a.e == a.e; }

static void check_fine_balls(void) {
    const hc_twin one = hc_twin_of(1);
    hc_fine_ball vague = hc_fine(1), broad = hc_fine(4);
    vague.e = 1, broad.e = 1;
    CHECK(is_fine(hc_fine_ball_of(one, two(399), 0)) && !is_fine(hc_fine_ball_of(one, two(400), 0)) && !is_fine(hc_fine_ball_of(one, NAN, 0)));
    CHECK(is_fine(hc_fine_ball_of(one, 1, two(399))) && !is_fine(hc_fine_ball_of(one, 1, two(400))) && !is_fine(hc_fine_ball_of(one, 1, NAN)));
    CHECK(!is_fine(hc_fine_over(broad, vague)) && !is_fine(hc_fine_over(broad, hc_fine(0))) && is_fine(hc_fine_over(vague, broad)));
    CHECK(hc_fine_over(hc_fine(3), hc_fine(2)).v.high == 1.5 && hc_fine_over(vague, hc_fine(-2)).e >= 0.5 && hc_fine_over(hc_fine(4), broad).e > 0.33);
    CHECK(hc_fine_plus(vague, broad).e >= 2 && hc_fine_minus(broad, vague).v.high == 3 && hc_fine_times(vague, broad).e >= 6);
    CHECK(hc_fine_ball_of(one, 1, 0).e >= HC_TIME_UNIT && hc_fine_ball_of(one, 0, 0).e > 0);
    CHECK(hc_fine_at_least(hc_fine(1)) < 1 && hc_fine_at_least(hc_fine(-1)) < -1 && hc_fine_at_least(broad) < 3 && hc_fine_at_least(vague) < 0);
}

/* ---- times of hits ---- */

/* l = side pole v/(1 + v). One place at 4 beside the pole 1: (2 + 1/v)² = 16 - the root is 1/2, whatever it is looked for from. */
static void check_shares(void) {
    const double poles[3] = {1, 1, 4}, at[3] = {4, 0, 0}, none[3] = {0, 0, 0};
    CHECK(hc_share_of_pole(poles, at, 1, 0) > 0 && fabs(hc_share_of_pole(poles, at, 1, 0) / hc_share_of_pole(poles, at, 1, two(70)) - 1) < 1e-9);
    CHECK(hc_share_of_pole(poles, at, 1, two(71)) == hc_share_of_pole(poles, at, 1, 0) && hc_share_of_pole(poles, at, 1, -1) == hc_share_of_pole(poles, at, 1, 1));
    CHECK(hc_share_of_pole(poles, none, 1, 0) > two(69)); /* on the axis it is the pole */
}

static void fine_sweep(hc_fine_sweep *made, double b, double d, const double *axis, int side) {
    const double row[10] = {3, 4, b, d, 9, 0, 0, 0, 0, 0};
    hc_make_fine_sweep(made, row, axis, side);
}

/* The poles of 3, 4: 9/b² beside 16/d² upright, the other one of -9/b² and the third where it is tilted. */
static void check_fine_reaches(void) {
    const double axis[3] = {0, 3, 4};
    hc_fine_sweep made;
    int side;
    fine_sweep(&made, 1, 2, NULL, 1);
    CHECK(fabs(made.pole.high - 4) < 1e-15);
    CHECK(hc_fine_reach(&made, hc_twin_of(1), 0) > 0.4 && hc_fine_reach(&made, hc_twin_of(1), 0) < 5.0 / 9);
    CHECK(hc_fine_reach(&made, hc_twin_of(3.9), 0) >= 0 && hc_fine_reach(&made, hc_twin_of(4), 0) == 0 && hc_fine_reach(&made, hc_twin_of(5), 0) == 0);
    CHECK(hc_fine_reach(&made, hc_twin_of(-9), 0) == 0 && hc_fine_reach(&made, hc_twin_of(-10), 0) == 0 && hc_fine_reach(&made, hc_twin_of(0), 0) == 0);
    CHECK(hc_fine_reach(&made, hc_twin_of(1), two(250)) == 0); /* a square beyond the cap */
    {
        const double swift[10] = {3, 4, 1, 2, 9, 0, 0, 0x1p250, 0, 0};
        hc_make_fine_sweep(&made, swift, NULL, 1);
        CHECK(hc_fine_reach(&made, hc_twin_of(1), 0) == 0); /* the bend is beyond the cap, the place is not */
    }
    fine_sweep(&made, 1, 2, NULL, -1);
    CHECK(fabs(made.pole.high - 9) < 1e-14);
    for (side = -1; side < 2; side += 2) { /* wider than high: -9/4 is the nearest pole within; higher than wide: the other one */
        fine_sweep(&made, 2, 1, axis, side);
        CHECK(side > 0 || made.pole.high == 2.25);
        CHECK(hc_fine_reach(&made, hc_twin_of(-3), 0) == 0 && hc_fine_reach(&made, hc_twin_of(1000), 0) == 0);
        fine_sweep(&made, 1, 2, axis, side);
        CHECK(side > 0 || (made.pole.high < 9 && made.pole.high > 9.0 / 4));
    }
}

/* Along x from 9 to 0 of 3, 4: contact begins 5/9 of the way, with radius 1. */
static void check_nearest_times(void) {
    const double row[10] = {3, 4, 1, 1, 9, 0, 0, 0, 0, 0};
    double rounded_up;
    hc_sweep sweep;
    CHECK(hc_make_sweep(&sweep, row, NULL));
    CHECK(fabs(hc_nearest_time(&sweep, row, 1, 0, 1) - 5.0 / 9) < 1e-15 && hc_nearest_time(&sweep, row, 1, 0, 0.25) == 0);
    fesetround(FE_UPWARD);
    rounded_up = hc_nearest_time(&sweep, row, 1, 0, 1);
    fesetround(FE_TONEAREST);
    CHECK(rounded_up <= 0x1.1c71c71c71c71p-1 && rounded_up > 0x1.1c71c71c71c6p-1); /* 5/9 = 0x1.1c71c71c71c71c...p-1 */
    CHECK(hc_nearest_time(&sweep, row, 1, 0.5, 1) <= 5.0 / 9 && hc_nearest_time(&sweep, row, 1, 0.75, 1) == 0.75);
}

/* ---- what sweeps beside ends are made of ---- */

/* A sweep along y at x, from y to -y at height z, past the end at 3. */
static void put_sweep(double row[16], double b, double d, double x, double y, double z) {
    const double first[16] = {3, 4, b, d, x, -y, z, x, y, z, 0, 0, 1, -1, 3, 0};
    memcpy(row, first, sizeof first);
}

static int sweep_made(double b, double share, int place, double value) {
    double row[16];
    hc_ended_sweep made;
    put_sweep(row, b, b, 0, share * two(49) * b, 0);
    row[place] = value;
    return hc_make_ended_sweep(&made, row, NULL);
}

/* The sections of the spheroid larger and smaller by the slack, here `share`, must be made, too. */
static void check_making(void) {
    const double high = two(100), low = two(-100);
    CHECK(sweep_made(1, 0.125, 3, 1) && sweep_made(1, 0.125, 0, 0.99 * high) && !sweep_made(1, 0.125, 0, high) && !sweep_made(1, 0.125, 0, low));
    CHECK(sweep_made(0.75 * high, 0.125, 0, 3) && !sweep_made(0.95 * high, 0.125, 0, 3) && sweep_made(0.95 * high, two(-20), 0, 3));
    CHECK(sweep_made(1.25 * low, 0.125, 0, 3) && !sweep_made(1.05 * low, 0.125, 0, 3) && sweep_made(1.05 * low, two(-20), 0, 3));
}

static void made_sweep(hc_ended_sweep *made, const double row[16]) {
    CHECK(hc_make_ended_sweep(made, row, row[10] != 0 || row[11] != 0 ? row + 10 : NULL));
    made->clear[0] = made->clear[1] = 1;
    hc_place_sections(&made->larger, row + 4);
    hc_place_sections(&made->smaller, row + 4);
}

/* A form's error, which is none where lambda is too near to -mu or numbers are too large. */
static void check_form_errors(void) {
    const double near = HC_ENDED_NEAREST;
    double row[16];
    hc_ended_sweep made;
    double mu;
    put_sweep(row, 2, 2, 4, 1, 3);
    made_sweep(&made, row);
    mu = made.larger.mu1;
    CHECK(hc_form_error(&made, &made.larger, 0, 3, 1, 1) < 1e-11 && hc_form_error(&made, &made.larger, -mu, 3, 1, 1) == DBL_MAX);
    CHECK(hc_form_error(&made, &made.larger, -mu * (1 - 0.9375 * near), 3, 1, 1) == DBL_MAX);
    CHECK(hc_form_error(&made, &made.larger, -mu * (1 - 1.0625 * near), 3, 1, 1) < DBL_MAX);
    CHECK(hc_form_error(&made, &made.larger, 0, two(399), 1, 1) < DBL_MAX && hc_form_error(&made, &made.larger, 0, two(402), 1, 1) == DBL_MAX);
    row[3] = 7, row[10] = 1; /* tilted by 45°: the second one is the smaller */
    made_sweep(&made, row);
    mu = made.larger.mu2;
    CHECK(mu < made.larger.mu1 && hc_form_error(&made, &made.larger, -mu * (1 - 0.9375 * near), 3, 1, 1) == DBL_MAX);
    CHECK(hc_form_error(&made, &made.larger, -mu * (1 - 1.0625 * near), 3, 1, 1) < DBL_MAX);
}

static double least_about(double time, double by_height, double by_time, double xx, double xy, double yy, int surely) {
    const hc_form form = {1, by_height, by_time, xx, xy, yy};
    const hc_rectangle in = {-1, 2, 0, 1};
    const double no_pulls[2] = {0, 0};
    return surely ? 1 + hc_form_least_surely(&form, &in, 0, time, no_pulls) : hc_form_least(&form, &in, 0, time);
}

static double least_of_form(double by_height, double by_time, double xx, double xy, double yy, int surely) {
    return least_about(0.5, by_height, by_time, xx, xy, yy, surely);
}

/* On heights from -1 to 2 and times within 0.5: below what each term is at least, and not far below the least value. */
static void check_form_least(void) {
    int surely;
    for (surely = 0; surely < 2; surely++) {
        CHECK(least_of_form(0, 0, 1, 0, 1, surely) == 1 && least_of_form(1, 0, 0, 0, 0, surely) == 0 && least_of_form(-1, 0, 0, 0, 0, surely) == -1);
        CHECK(least_of_form(0, 1, 0, 0, 0, surely) == 0.5 && least_of_form(0, 0, -1, 0, 0, surely) == -3 && least_of_form(0, 0, 0, 0, -4, surely) == 0);
        CHECK(least_about(0.75, 0, 0, 0, 1, 0, surely) == -2 && least_about(0.25, 0, 0, 0, 1, 0, surely) == -2);
        CHECK(least_of_form(0, 0, 0, 1, 0, surely) == -1 && least_of_form(0, 0, 1, 1, -1, surely) <= 0.5 && least_of_form(0, 0, 4, 1, 4, surely) == 1);
        CHECK(least_of_form(0, 0, 1, 2, 1, surely) <= 0.25 && least_of_form(0, 0, 1, 2, 1, surely) >= 0);
    }
    CHECK(least_of_form(1, 0, 1, 0.5, 1, 1) <= 0.75 && least_of_form(1, 0, 1, 0.5, 1, 1) > 0.25);
    CHECK(least_of_form(0, 0, INFINITY, 1, 1, 1) == 0 || least_of_form(0, 0, INFINITY, 1, 1, 1) <= 1); /* it has no root that helps */
}

/* Where all points of a circle are as near, and the spheroid moves away from the axis, no bend leads to a least. */
static void check_aims(void) {
    const hc_rectangle in = {-1, 2, 0, 1};
    double row[16], height = 0, time = 0.5, lambda_;
    hc_sections on_axis = pair_of(1, 1, 0, 0, 0, NULL);
    hc_ended_sweep made;
    lambda_ = hc_aim_at_least(&on_axis, -1, 3, &height);
    CHECK(lambda_ == two(-40) - 1 && height >= -1 && height <= 3);
    put_sweep(row, 1, 2, 0, 1, 0);
    made_sweep(&made, row);
    height = 0;
    (void)hc_aim(&made, &made.larger, &in, &height, &time);
    CHECK(height >= -1 && height <= 2 && time >= 0 && time <= 1);
    row[10] = 1; /* leaning, and moving across */
    made_sweep(&made, row);
    height = 0, time = 0.5;
    (void)hc_aim(&made, &made.larger, &in, &height, &time);
    CHECK(height >= -1 && height <= 2 && time >= 0 && time <= 1);
}

/* ---- exact contact at simple times ---- */

static int touched_at(const double row[16], double at) {
    hc_ended_sweep made;
    double contact = 7;
    int touched, k;
    made_sweep(&made, row);
    for (k = 0; k < 3; k++) made.moved[k] = hc_two_sum(row[7 + k], -row[4 + k]);
    touched = hc_touched_at(&made, at, &contact);
    CHECK(contact == (touched ? at : 7));
    return touched;
}

/* A sphere over the end at 3 touches the flat end all along, or the rim where y is 0. */
static void check_touches(void) {
    double row[16];
    put_sweep(row, 1, 1, 3.75, 2, 4);
    CHECK(touched_at(row, 0.5) && !touched_at(row, 0.25) && !touched_at(row, 0) && !touched_at(row, 1));
    row[15] = 1, row[4] = row[7] = 1;
    CHECK(touched_at(row, 0.5) && touched_at(row, 0.25) && touched_at(row, 0) && touched_at(row, 1));
    row[5] = 0.1, row[8] = 0.7; /* their difference is no double, or the place is none */
    CHECK(!touched_at(row, 0.5) && !touched_at(row, 0));
    row[5] = 0, row[8] = two(-52) + 1;
    CHECK(touched_at(row, 1) && touched_at(row, 0.25) && !touched_at(row, 0.75));
    row[5] = 1, row[8] = 1 + two(-51);
    CHECK(touched_at(row, 0.5) && touched_at(row, 1) && !touched_at(row, 0.25));
    row[5] = 0, row[8] = two(-240); /* a part of it may lose bits */
    CHECK(touched_at(row, 0) && !touched_at(row, two(-20)));
    put_sweep(row, 1, 1, 4, 0, 0);
    row[5] = 0, row[8] = two(-1074); /* beside the waist: half of that is 0, and no place of the sweep after its start touches */
    CHECK(touched_at(row, 0) && !touched_at(row, 0.5) && !touched_at(row, two(-20)));
    put_sweep(row, 1, 2, 1, 2, 4);
    row[6] = row[9] = 3.75, row[15] = 1, row[10] = 1, row[12] = 0;
    CHECK(touched_at(row, 0.5) && touched_at(row, 0.125));
    row[6] = row[9] = 4.25; /* lying it has the radius 1 downwards */
    CHECK(!touched_at(row, 0.5));
}

static void check_simple_times(void) {
    CHECK(hc_simplest_time(0, 1) == 0 && hc_simplest_time(0.125, 1) == 1 && hc_simplest_time(0.25, 0.75) == 0.5 && hc_simplest_time(0.3, 0.4) == 0.375);
    CHECK(hc_simplest_time(0.5, 0.5) == 0.5 && hc_simplest_time(0.7, 0.9) == 0.75 && hc_simplest_time(1, 1) == 1);
    CHECK(hc_simplest_time(two(-30), two(-29)) == two(-20) && hc_simplest_time(two(-20), two(-19)) == two(-19) && hc_simplest_time(two(-20), two(-20)) == two(-20));
}

/* ---- numbers of two doubles on a rectangle ---- */

static int finely_missed(const double row[16], double lambda_, double w) {
    const hc_rectangle in = {w, w, 0.5, 0.5};
    hc_ended_sweep made;
    double contact = 7;
    int missed;
    made_sweep(&made, row);
    missed = hc_finely_missed(&made, lambda_, w, 0.5, &in, &contact);
    CHECK(contact == (missed == 0 ? 0.5 : 7));
    return missed;
}

/* At the waist, where x of the sphere is 4: it touches half way. Nearest is lambda = 4/3 - 1. */
static void check_fine_rectangles(void) {
    const double near = HC_ENDED_NEAREST, best = 1.0 / 3;
    double row[16];
    hc_ended_sweep made;
    put_sweep(row, 1, 1, 4, 1, 0);
    CHECK(finely_missed(row, best, 0) == 2 && finely_missed(row, 0.5, 0) == 3 && finely_missed(row, -1 + 0.9375 * near, 0) == 3);
    CHECK(finely_missed(row, -1, 0) == 3 && finely_missed(row, -2, 0) == 3 && finely_missed(row, best, 4) == 1);
    row[4] = row[7] = 4 + two(-40);
    CHECK(finely_missed(row, best, 0) == 1);
    row[4] = row[7] = 4 - two(-40);
    CHECK(finely_missed(row, best, 0) == 0);
    put_sweep(row, 1, 7, 4, 1, 0);
    row[10] = 1;
    CHECK(finely_missed(row, -25.0 / 49 * (1 - 0.9375 * near), 0) == 3 && finely_missed(row, -25.0 / 49 * (1 + near), 0) == 3);
    put_sweep(row, two(90), two(90), two(90), two(90), 0);
    CHECK(finely_missed(row, two(-180) * (1.0625 * near - 1), 0) == 3); /* what is along is too long for a direction */
    put_sweep(row, 1.05 * two(-100), 1.05 * two(-100), 0, two(-100), 0);
    row[0] = 0.99 * two(100);
    CHECK(finely_missed(row, 0, 0) == 3); /* a point of the circle is too far away */
    row[0] = row[1] = 3;
    CHECK(finely_missed(row, two(205), 0) == 3 && finely_missed(row, two(200), two(120)) == 3); /* beyond the cap */
    put_sweep(row, 1, 1, 0, 1, 0);
    made_sweep(&made, row);
    hc_make_finer(&made);
    made.between.alpha = two(-130); /* smaller than that of any sweep: it has no direction */
    {
        const hc_rectangle in = {0, 0, 0.5, 0.5};
        double contact;
        CHECK(hc_finely_missed(&made, 0, 0, 0.5, &in, &contact) == 3);
    }
}

static void check_beyond_planes(void) {
    double row[16];
    hc_ended_sweep made;
    put_sweep(row, 1, 1, 0, 1, 4);
    made_sweep(&made, row);
    CHECK(!hc_finely_beyond(&made, 3, 0, 1) && hc_finely_beyond(&made, 2.99, 0, 1) && hc_finely_beyond(&made, 3 - two(-50), 0, 1));
    CHECK(!hc_finely_beyond(&made, two(201), 0, 1) && hc_finely_beyond(&made, two(190), 0, 1));
    row[9] = 2;
    made_sweep(&made, row);
    CHECK(!hc_finely_beyond(&made, 2.875, 0, 1) && hc_finely_beyond(&made, 2.75, 0, 0.0625) && !hc_finely_beyond(&made, 3.5, 0, 1));
    row[6] = 20, row[9] = -20;
    made_sweep(&made, row);
    CHECK(!hc_finely_beyond(&made, 0, 0, 1)); /* beyond it at both ends, on either side */
}

/* ---- the public function ---- */

static int hit_beside_end(double x, double from, double to, int solid, double scale, double *time) {
    double row[16];
    int8_t hit;
    int k;
    put_sweep(row, 1, 1, x, 0, 0);
    row[6] = from, row[9] = to, row[15] = solid;
    for (k = 0; k < 10; k++) row[k] *= scale;
    row[13] *= scale, row[14] *= scale;
    hypcheck_passage_columns(1, 16, row, &hit, time);
    return hit;
}

/* Down to the rim, which a sphere over it reaches at 4, and into the mouth. */
static void check_ended_hits(void) {
    double time = 7;
    CHECK(hit_beside_end(3.75, 9, 4, 0, 1, &time) == 1 && time > 1 - 1e-9 && time <= 1);
    CHECK(hit_beside_end(3.75, 9, 4.5, 0, 1, &time) == 0 && time != time && hit_beside_end(0, 9, 0, 0, 1, NULL) == 0);
    CHECK(hit_beside_end(0, 9, 0, 1, 1, &time) == 1 && fabs(time - 5.0 / 9) < 1e-12 && hit_beside_end(0, 0, 9, 1, 1, NULL) == 1);
    /* beyond the bounds contact at the end is known, and the time is not; that there is none is known from far away alone */
    CHECK(hit_beside_end(3.5, 9, 2, 0, two(101), &time) == 1 && time != time && hit_beside_end(3.5, 9, 2, 0, two(101), NULL) == 1);
    CHECK(hit_beside_end(4.5, 9, 3.99, 0, two(101), &time) == 2 && time != time && hit_beside_end(9, 9, 4.5, 0, two(101), &time) == 0);
}

static void check_widths_of_sweeps(void) {
    const size_t widths[6] = {0, 7, 9, 11, 14, 17};
    double row[16], two_rows[32], times[3];
    int8_t hits[3];
    int i;
    put_sweep(row, 1, 1, 3.5, 4, 1);
    row[6] = 9, row[9] = 2;
    memcpy(two_rows, row, sizeof row);
    memcpy(two_rows + 16, row, sizeof row);
    for (i = 0; i < 6; i++) {
        hits[2] = 5, times[2] = 5;
        hypcheck_passage_columns(2, widths[i], two_rows, hits, i % 2 ? times : NULL);
        CHECK(hits[0] == 127 && hits[1] == 127 && hits[2] == 5 && times[2] == 5 && !(i % 2 && times[0] == times[0]));
    }
    for (i = 0; i < 3; i++) { /* ends that are infinite, both or one, and none */
        row[13] = i < 2 ? -INFINITY : -99, row[14] = i == 0 || i == 2 ? INFINITY : 99;
        hypcheck_passage_columns(1, 16, row, hits, times);
        hypcheck_passage_columns(1, 13, row, hits + 1, times + 1);
        CHECK(hits[0] == hits[1] && hits[0] == 1 && times[0] == times[1]);
    }
}

/* An end at the greatest double is one: the spheroid, which stays where it is, meets the cone beyond it alone. */
static void check_greatest_ends(void) {
    const double most = DBL_MAX, nowhere = INFINITY;
    int up;
    for (up = -1; up < 2; up += 2) {
        double row[16] = {0}, time;
        int8_t hit;
        row[0] = two(999), row[1] = two(1000), row[2] = 1, row[3] = 0.9 * most;
        row[4] = row[7] = 0.6 * most, row[6] = row[9] = up * 0.5 * most, row[12] = 1;
        row[13] = -nowhere, row[14] = nowhere;
        hypcheck_passage_columns(1, 16, row, &hit, &time);
        CHECK(hit == 1 && time == 0);
        if (up > 0) row[14] = most;
        else row[13] = -most;
        hypcheck_passage_columns(1, 16, row, &hit, &time);
        CHECK(hit == 2 && time != time);
    }
}

static void check_ended_sweeps(void) {
    check_twins();
    check_fine_balls();
    check_shares();
    check_fine_reaches();
    check_nearest_times();
    check_making();
    check_form_errors();
    check_form_least();
    check_aims();
    check_touches();
    check_simple_times();
    check_fine_rectangles();
    check_beyond_planes();
    check_ended_hits();
    check_widths_of_sweeps();
    check_greatest_ends();
}
