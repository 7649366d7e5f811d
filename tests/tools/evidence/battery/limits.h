/* Comparisons at equality, and what follows them where an answer alone would not show it: half planes and half spaces made by
   hand, rows at the limits of one stage, ways whose numbers are put there. Included after guards.h. */

/* ---- half planes and half spaces made by hand ---- */

static hc_scene bare_lines(void) {
    hc_scene scene;
    int i;
    memset(&scene, 0, sizeof scene);
    for (i = 0; i < 3; i++) {
        scene.beyond[i].K = scene.above[i].K = HC_NEVER;
        scene.within[i].K = scene.under[i].K = -1;
    }
    return scene;
}

static hc_tilted_scene bare_planes(void) {
    hc_tilted_scene scene;
    int i;
    memset(&scene, 0, sizeof scene);
    scene.r1_x = scene.r2_y = scene.r3_z = 1;
    for (i = 0; i < 3; i++) {
        scene.beyond[i] = scene.above[i] = hc_never_above;
        scene.within[i] = scene.under[i] = hc_never_below;
    }
    return scene;
}

/* What a block of equal centres is told: 1, 0, -1, or 2 where it is left. */
static int told_by_lines(const hc_scene *scene, int pair, double x, double z) {
    double xs[HC_BLOCK], ys[HC_BLOCK], zs[HC_BLOCK];
    hc_signs signs;
    uint64_t left;
    int i;
    for (i = 0; i < HC_BLOCK; i++) xs[i] = x, ys[i] = 0, zs[i] = z;
    (pair ? hc_level()->two_lines : hc_level()->one_line)[0](scene, 1, xs, ys, zs, 0, &signs, &left);
    return left ? 2 : (int)(signs.plus & 1) - (int)(signs.minus & 1);
}

static int told_by_planes(const hc_tilted_scene *scene, int pair, double x, double z) {
    double xs[HC_BLOCK], ys[HC_BLOCK], zs[HC_BLOCK];
    hc_signs signs;
    uint64_t left;
    int i;
    for (i = 0; i < HC_BLOCK; i++) xs[i] = x, ys[i] = 0, zs[i] = z;
    (pair ? hc_level()->two_planes : hc_level()->one_plane)(scene, 1, xs, ys, zs, 0, &signs, &left);
    return left ? 2 : (int)(signs.plus & 1) - (int)(signs.minus & 1);
}

/* K is 4 on one side, 9 on the other: centres with x² = 4 and x² = 9 are on the lines. */
static void check_lines_at_equality(void) {
    const int whole_lane = strcmp(hypcheck_level(), "plain") == 0 ? 197 : 200; /* a lane adds up 64 squares there, and fewer elsewhere */
    int place;
    for (place = 0; place < 3; place++) {
        const int pair = place > 0, other = 3 - place;
        hc_scene beyond = bare_lines(), within = bare_lines(), contact = bare_lines();
        hc_tilted_scene plane_beyond = bare_planes(), plane_within = bare_planes(), plane_contact = bare_planes();
        beyond.beyond[place].K = within.within[place].K = contact.above[place].K = 4;
        plane_beyond.beyond[place].K = plane_within.within[place].K = plane_contact.above[place].K = 4;
        contact.under[place].K = plane_contact.under[place].K = 9;
        contact.reach = plane_contact.reach = 1;
        if (pair) {
            contact.above[other].K = plane_contact.above[other].K = 1;
            contact.under[other].K = plane_contact.under[other].K = 16;
        }
        CHECK(told_by_lines(&beyond, pair, 2, 0) == 2 && told_by_lines(&beyond, pair, 2.125, 0) == 1);
        CHECK(told_by_lines(&within, pair, 2, 0) == 2 && told_by_lines(&within, pair, 1.875, 0) == -1);
        CHECK(told_by_lines(&contact, pair, 2, 1) == 0 && told_by_lines(&contact, pair, 1.875, 1) == 2);
        CHECK(told_by_lines(&contact, pair, 3, 1) == 2 && told_by_lines(&contact, pair, 2.875, 1) == 0);
        CHECK(told_by_lines(&contact, pair, 2, 1.125) == 2);
        CHECK(told_by_planes(&plane_beyond, pair, 2, 0) == 2 && told_by_planes(&plane_beyond, pair, 2.125, 0) == 1);
        CHECK(told_by_planes(&plane_within, pair, 2, 0) == 2 && told_by_planes(&plane_within, pair, 1.875, 0) == -1);
        CHECK(told_by_planes(&plane_contact, pair, 2, 1) == 0 && told_by_planes(&plane_contact, pair, 1.875, 1) == 2);
        CHECK(told_by_planes(&plane_contact, pair, 3, 1) == 2 && told_by_planes(&plane_contact, pair, 2.875, 1) == 0);
        CHECK(told_by_planes(&plane_contact, pair, 2, 1.125) == 2);
        /* the sum over a block is the cap itself, or below it */
        CHECK(told_by_lines(&beyond, pair, two(whole_lane), 0) == 2 && told_by_lines(&beyond, pair, two(196), 0) == 1);
        CHECK(told_by_planes(&plane_beyond, pair, two(whole_lane), 0) == 2 && told_by_planes(&plane_beyond, pair, two(196), 0) == 1);
    }
    {
        const hc_ball pole = hc_exactly(4);
        const double sizes[4] = {2, 2, 1, 1};
        /* The axis belongs to the line R >= 0, which has no margin; P = 0 is a place on it. */
        CHECK(hc_known_point(sizes, 0, 0, 1).R == 0 && hc_known_point(sizes, 0, 0, -1).R == -1);
        CHECK(hc_not_on_side(pole, pole, 0, 0, 1) && !hc_not_on_side(pole, pole, 0, 0, -1));
    }
}

/* ---- rows at the limits ---- */

static void check_rows_at_limits(void) {
    const double least_a = 1 + two(-21) - two(-43); /* its square is 1 + 2^-20 as it is computed */
    const double end_of_ring[7] = {4, 2, 1, 1, 5, 0, 0}; /* B² = A and a triple root: it touches at the waist */
    /* It touches from without, and the slope at B is 0 as on the ring, where the height is 0. */
    const double like_ring[7] = {48, 72, 35, 35, 6, 87, 26};
    double rows[200 * 7], leaning[200 * 10];
    int8_t answers[200];
    int i;
    CHECK(least_a * least_a == HC_slack && ratio_of(1, 1, least_a, 4, 100) == 2 && ratio_of(1, 1, least_a + two(-40), 4, 100) == 1);
    CHECK(hc_position_by_integers(end_of_ring) == 0 && hc_exact_position(end_of_ring) == 0);
    CHECK(hc_position_by_integers(like_ring) == 0 && hc_exact_position(like_ring) == 0);
    CHECK(scaled(two(-972), 0, 0, 1) && scaled(two(-972), 0, two(-972), 1) && scaled(0, 0, 0, 0));
    for (i = 0; i < 200; i++) {
        const double x = i % 3 == 0 ? 10 : i % 3 == 1 ? 2.5 : 0.25;
        const double row[10] = {4, 4, 1, i % 2 ? 1 : 2, 4 * x, 0, 0, 1, 0, 1};
        memcpy(rows + 7 * i, row, 7 * sizeof *row);
        memcpy(leaning + 10 * i, row, sizeof row);
    }
    CHECK(hypcheck_ask(0, 200, rows, answers) == 0);
    for (i = 0; i < 200; i++) CHECK(answers[i] == (i % 3 == 2 ? -1 : 1));
    CHECK(hypcheck_ask_tilted(0, 200, leaning, answers) == 0);
    for (i = 0; i < 200; i++) CHECK(answers[i] == (i % 3 == 2 ? -1 : 1));
}

/* ---- ways ---- */

/* A way of a spheroid with these radii, whose coordinate k goes from 0 to `far`. */
static double slack_of(double b, double d, int k, double far, const double *axis) {
    double row[10] = {2, 2, 0, 0, 0, 0, 0, 0, 0, 0};
    hc_sweep sweep;
    row[2] = b, row[3] = d, row[7 + k] = far;
    return hc_make_sweep(&sweep, row, axis) ? sweep.slack / (4 * HC_unit) : -1;
}

static void check_slacks(void) {
    static const double axis[3] = {1, 2, 3};
    int k;
    for (k = 0; k < 3; k++) {
        const double along = k == 2 ? 4 : 16;
        CHECK(slack_of(0.25, 1, k, 4, NULL) >= 1 + along && slack_of(0.25, 1, k, 4, NULL) < 1.01 * (1 + along));
        CHECK(slack_of(0.25, 1, k, 4, axis) >= 17 && slack_of(0.25, 1, k, 4, axis) < 1.01 * 17);
        CHECK(slack_of(1, 0.25, k, 4, axis) >= 17 && slack_of(1, 0.25, k, 4, axis) < 1.01 * 17);
    }
}

static int leaning_hit(double x, double to_x, const double axis[3], double *time) {
    double row[13] = {2, 2, 0.25, 4, 0, 0, 0, 0, 0, 0};
    int8_t hit;
    row[4] = x, row[7] = to_x;
    memcpy(row + 10, axis, 3 * sizeof *axis);
    hypcheck_passage_tilted(1, row, &hit, time);
    return hit;
}

static void check_leaning_ways(void) {
    const double lying[3] = {1, 0, 0}, small[10] = {two(-298), two(-298), two(-300), two(-299), two(-294), 0, 0, 1, 0, 1};
    const double row[10] = {4, 4, 1, 2, 100, 0, 0, 90, 0, 0};
    hc_sweep sweep;
    double time = 7;
    /* It reaches 4 towards the hyperboloid where it lies, and 1/4 where it stands. */
    CHECK(leaning_hit(7, 5, lying, NULL) == 1 && leaning_hit(9, 7, lying, NULL) == 0 && leaning_hit(7, 5, lying, &time) == 1);
    CHECK(time > 0.49 && time <= 0.5);
    CHECK(hc_position_with(small, small + 7) == 1); /* floats leave it, the integers decide */
    CHECK(hc_make_sweep(&sweep, row, small + 7) && hc_tilted_sweep_reach(&sweep, row + 4, 1) > 0);
    sweep.along[0].v = sweep.along[0].e = hc_nothing_known();
    CHECK(hc_tilted_sweep_reach(&sweep, row + 4, 1) == 0);
}

static void check_ends_of_ways(void) {
    const double at_start[10] = {two(150), 2, 1, 1, two(150), 0, 0, two(150), 0, 0};
    const double beside[10] = {4, 4, 1, 1, 5 + two(-50), 0, 0, 0, 0, 0};
    /* No contact, which begins right after its end: a place as far ahead again as the last step lies in it. */
    const double short_of[10] = {10, 1, 2.25, 1.5, -13, -5.5, 6, 3.9982867425851403, -6.6085839179946824, 0.82660838269147963};
    double time = 7;
    int8_t hit;
    hypcheck_passage(1, short_of, &hit, NULL);
    CHECK(hit == 0);
    hypcheck_passage(1, at_start, &hit, &time); /* too large for the steps, and contact from the beginning */
    CHECK(hit == 1 && time == 0);
    hypcheck_passage(1, beside, &hit, &time);
    CHECK(hit == 1 && (time != time || (time >= 0 && time < 1e-6)));
}

static void check_limits(void) {
    check_lines_at_equality();
    check_rows_at_limits();
    check_slacks();
    check_leaning_ways();
    check_ends_of_ways();
}
