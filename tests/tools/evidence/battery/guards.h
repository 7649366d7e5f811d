/* The guards of hypcheck.h one by one, at their limits: what a function that proves something says just within a limit, and
   that it proves nothing at the limit or beyond. Powers of two, so that the limits themselves are met. */

#include <math.h>

static void check(int holds, const char *what) {
    if (holds) return;
    printf("wrong: guard: %s\n", what);
    if (!getenv("HC_ALL")) exit(1);
}
#define CHECK(claim) check(claim, #claim)

static double two(int power) { return ldexp(1, power); }

/* ---- one row ---- */

static int single_of(double alpha, double gamma, double b, double d, double x, double z) {
    const double row[7] = {alpha, gamma, b, d, x, 0, z};
    return hc_single(row);
}

/* Semi-axes b and d, alpha and gamma a and c times these, the centre r times b off the axis. */
static int ratio_of(double b, double d, double a, double c, double r) { return single_of(a * b, c * d, b, d, r * b, 0); }

static void check_single(void) {
    CHECK(ratio_of(1, 1, 4, 4, 100) == 1 && ratio_of(1, 1, 4, 4, 0) == -1 && ratio_of(1, 1, 4, 4, 4) == 0);
    CHECK(single_of(-4, 4, 1, 1, 100, 0) == 2 && single_of(4, -4, 1, 1, 100, 0) == 2);
    CHECK(ratio_of(two(-100), 1, 4, 4, 100) == 2 && ratio_of(two(-99), 1, 4, 4, 100) == 1);
    CHECK(ratio_of(two(100), 1, 4, 4, 100) == 2 && ratio_of(two(99), 1, 4, 4, 100) == 1);
    CHECK(ratio_of(1, two(-100), 4, 4, 100) == 2 && ratio_of(1, two(-99), 4, 4, 100) == 1);
    CHECK(ratio_of(1, two(100), 4, 4, 100) == 2 && ratio_of(1, two(99), 4, 4, 100) == 1);
    CHECK(ratio_of(1, 1, 1, 4, 100) == 2 && ratio_of(1, 1, 1.125, 4, 100) == 1);
    CHECK(ratio_of(1, 1, two(50), two(40), two(60)) == 2 && ratio_of(1, 1, two(49), two(40), two(60)) == 1);
    CHECK(ratio_of(1, 1, 4, two(50), two(60)) == 2 && ratio_of(1, 1, 4, two(49), two(60)) == 1);
    CHECK(ratio_of(1, 1, 4, 2, 100) == 2 && ratio_of(1, 1, 4, 2.125, 100) == 1 && ratio_of(1, 1, 4, 0.5, 100) == 2);
    CHECK(ratio_of(1, 1, 4, 4, two(100)) == 2 && ratio_of(1, 1, 4, 4, 1.75 * two(99)) == 1);
    CHECK(ratio_of(1, 1, 4, 4, 5) == 2 && ratio_of(1, 1, 4, 4, 3) == 2);
    CHECK(hypcheck_position(4, 4, 1, 1, 5, 0, 0) == 0 && hypcheck_position(4, 4, 1, 1, NAN, 0, 0) == 127);
    CHECK(single_of(4, 4, NAN, 1, 100, 0) == 2 && single_of(4, 4, 1, NAN, 100, 0) == 2);
}

static int valid_with(int place, double value) {
    double row[7] = {1, 1, 1, 1, 0, 0, 0};
    row[place] = value;
    return hc_valid(row);
}

static void check_valid(void) {
    int i;
    for (i = 0; i < 7; i++) {
        CHECK(valid_with(i, 1) && valid_with(i, DBL_MAX) && valid_with(i, 4.9406564584124654e-324));
        CHECK(!valid_with(i, INFINITY) && !valid_with(i, -INFINITY) && !valid_with(i, NAN));
        CHECK(valid_with(i, 0) == (i >= 4) && valid_with(i, -0.0) == (i >= 4) && valid_with(i, -1) == (i >= 4));
    }
    for (i = 0; i < 3; i++) {
        double axis[3] = {0, 0, 0};
        CHECK(!hc_has_direction(axis));
        axis[i] = -0.0;
        CHECK(!hc_has_direction(axis));
        axis[i] = -4.9406564584124654e-324;
        CHECK(hc_has_direction(axis));
        axis[i] = -DBL_MAX;
        CHECK(hc_has_direction(axis));
        axis[(i + 1) % 3] = INFINITY;
        CHECK(!hc_has_direction(axis));
        axis[(i + 1) % 3] = NAN;
        CHECK(!hc_has_direction(axis));
    }
}

/* Whether floats decide a spheroid that leans, all lengths times `scale`, the axis times `length`, b times `tall` for d. */
static int tilted_decides(double a, double c, double tall, double r, double scale, double length) {
    const double row[10] = {a * scale, c * scale, scale, tall * scale, r * scale, 0, 0, length, 0, length};
    const hc_bits found = hc_tilted_plain(row, 1, 1);
    return (int)(found.decided & 1);
}

/* The limits of programs/tilted.py: b, then squares of ratios to b, the axis' square and the distance's. */
static void check_tilted_limits(void) {
    const double turned[10] = {4, 4, 1, 2, 100, 0, 0, 1, 0, 1};
    int k;
    CHECK(tilted_decides(4, 4, 2, 100, 1, 1));
    CHECK(!tilted_decides(4, 4, 2, 100, two(-300), 1) && tilted_decides(4, 4, 2, 100, 1.25 * two(-300), 1));
    CHECK(!tilted_decides(4, 4, 2, 100, two(300), 1) && tilted_decides(4, 4, 2, 100, 0.8 * two(300), 1));
    CHECK(!tilted_decides(two(-27), 4, 2, 100, 1, 1) && tilted_decides(1.25 * two(-27), 4, 2, 100, 1, 1));
    CHECK(!tilted_decides(two(27), 4, 2, two(40), 1, 1) && tilted_decides(0.8 * two(27), 4, 2, two(40), 1, 1));
    CHECK(!tilted_decides(4, two(-27), 2, 100, 1, 1) && tilted_decides(4, 1.25 * two(-27), 2, 0, 1, 1));
    CHECK(!tilted_decides(4, two(27), 2, 100, 1, 1) && tilted_decides(4, 0.8 * two(27), 2, 100, 1, 1));
    CHECK(!tilted_decides(4, 4, two(-27), 100, 1, 1) && tilted_decides(4, 4, 1.25 * two(-27), 100, 1, 1));
    CHECK(!tilted_decides(4, 4, two(27), two(40), 1, 1) && tilted_decides(4, 4, 0.8 * two(27), two(40), 1, 1));
    CHECK(!tilted_decides(4, 4, 2, two(54), 1, 1) && tilted_decides(4, 4, 2, 0.8 * two(54), 1, 1));
    CHECK(!tilted_decides(4, 4, 2, 100, 1, 0.7 * two(-50)) && tilted_decides(4, 4, 2, 100, 1, 0.8 * two(-50)));
    CHECK(!tilted_decides(4, 4, 2, 100, 1, 0.8 * two(50)) && tilted_decides(4, 4, 2, 100, 1, 0.7 * two(50)));
    for (k = 0; k < 4; k++) {
        double row[10];
        memcpy(row, turned, sizeof row);
        CHECK(hc_tilted_plain(row, 1, 1).decided & 1);
        row[k] = -row[k];
        CHECK(!(hc_tilted_plain(row, 1, 1).decided & 1));
        row[k] = NAN;
        CHECK(!(hc_tilted_plain(row, 1, 1).decided & 1));
    }
}

static int scaled(double x, double y, double z, double first) {
    double axis[3];
    axis[0] = x, axis[1] = y, axis[2] = z;
    hc_scale_axis(axis);
    return axis[0] == first && (x == 0 || (y / x == axis[1] / axis[0] && z / x == axis[2] / axis[0]));
}

static void check_axes(void) {
    CHECK(scaled(3, 1, 2, 3) && scaled(two(40), 1, 2, two(40) / two(40)) && scaled(two(39), 1, 2, two(39)));
    CHECK(scaled(two(-40), 0, 0, 1) && scaled(two(-39), 0, 0, two(-39)) && scaled(-two(-40), two(-41), 0, -1));
    CHECK(scaled(two(-1074), 0, 0, two(-51)) && scaled(two(1000), two(900), 0, 1) && scaled(0, 0, 0, 0));
    CHECK(scaled(two(1000), two(-19), 0, 1) && scaled(two(1000), two(-21), 0, two(1000)));
    CHECK(scaled(two(-61), two(-1050), 0, two(-61)));
}

/* ---- half planes of one scene ---- */

static int beyond_proves(double alpha, double gamma, double b, double d, double lambda_) {
    const double sizes[4] = {alpha, gamma, b, d};
    hc_line line;
    hc_tangent_beyond(sizes, lambda_, &line);
    CHECK((line.K == HC_NEVER) == (line.M == 0));
    return line.K != HC_NEVER;
}

static int within_proves(double alpha, double gamma, double b, double d, double mu) {
    const double sizes[4] = {alpha, gamma, b, d};
    hc_line line;
    hc_tangent_within(sizes, mu, &line);
    CHECK((line.K == -1) == (line.M == 0));
    return line.K != -1;
}

static int high_proves(double alpha, double gamma, double b, double d, double mu) {
    const double sizes[4] = {alpha, gamma, b, d};
    hc_line line;
    hc_tangent_high(sizes, mu, &line);
    CHECK((line.K == -1) == (line.M == 0) && line.K < 0);
    return line.K != -1;
}

static void check_tangents(void) {
    CHECK(beyond_proves(2, 2, 1, 1, 1) && !beyond_proves(2, 2, 1, 1, 0) && !beyond_proves(2, 2, 1, 1, -1));
    CHECK(!beyond_proves(2, 2, 1, 1, 4) && !beyond_proves(2, 2, 1, 1, 5) && beyond_proves(2, 2, 1, 1, 3.5));
    CHECK(!beyond_proves(two(-160), 2, two(-160), 1, 1) && beyond_proves(two(-140), 2, two(-140), 1, 1));
    CHECK(!beyond_proves(two(210), 2, 1, 1, 1) && beyond_proves(two(190), 2, 1, 1, 1));
    CHECK(within_proves(4, 2, 1, 1, 2) && !within_proves(4, 2, 1, 1, 1) && !within_proves(4, 2, 1, 1, 0.5));
    CHECK(!within_proves(4, 2, 1, 1, 16) && !within_proves(4, 2, 1, 1, 20) && within_proves(4, 2, 1, 1, 15));
    CHECK(!within_proves(two(-160), 2, two(-162), 1, 2) && within_proves(two(-140), 2, two(-142), 1, 2));
    CHECK(!within_proves(two(230), 2, 1, 1, 2) && within_proves(two(190), 2, 1, 1, 2));
    CHECK(high_proves(4, 2, 1, 1, 0.5) && !high_proves(4, 2, 1, 1, 1) && !high_proves(4, 2, 1, 1, 0) && !high_proves(4, 2, 1, 1, -1));
    CHECK(!high_proves(0.5, 2, 1, 1, 0.5) && !high_proves(0.5, 2, 1, 1, 0.25) && high_proves(0.5, 2, 1, 1, 0.125));
    CHECK(!high_proves(two(-160), 2, two(-159), 1, 0.125) && high_proves(two(-140), 2, two(-139), 1, 0.125));
    CHECK(!high_proves(two(230), 2, 1, 1, 0.5) && high_proves(two(190), 2, 1, 1, 0.5));
}

static hc_line chord_of(double T_0, double R_0, double T_1, double R_1, int side) {
    const hc_point from = {T_0, R_0}, to = {T_1, R_1};
    hc_line line;
    hc_chord(from, to, side, &line);
    return line;
}

static int chord_proves(double T_0, double R_0, double T_1, double R_1, int side) {
    const hc_line line = chord_of(T_0, R_0, T_1, R_1, side);
    return side > 0 ? line.K != -1 : line.K != HC_NEVER;
}

static void check_chords(void) {
    int side;
    for (side = -1; side < 2; side += 2) {
        CHECK(chord_proves(0, 1, 1, 2, side) && chord_proves(0, 1, 1, 1, side));
        CHECK(!chord_proves(0, -1, 1, 2, side) && !chord_proves(0, 1, 1, -1, side));
        CHECK(!chord_proves(0, 1, two(-401), 2, side) && chord_proves(0, 1, two(-400), 2, side));
        CHECK(!chord_proves(1, 2, 2, 1, side) || chord_of(1, 2, 2, 1, side).M >= 0);
    }
    CHECK(chord_of(0, 1, 0, 1, 1).M == 0 && chord_of(0, 0, 0, 0, -1).K == 0 && chord_of(1, 0.125, 2, 1, -1).K == HC_least_constant);
    CHECK(chord_proves(0, two(-298), 1, two(-297), 1) && !chord_proves(0, two(-300), 1, two(-299), 1));
    CHECK(chord_of(1, 0.125, 2, 1, -1).M < 0.51 && chord_proves(1, 2, 1, 1, 1) && chord_proves(1, 2, 1, 1, -1));
    CHECK(chord_of(0, two(-310), 1, two(-309), -1).K == HC_least_constant);
}

static int scene_made(double alpha, double gamma, double b, double d) {
    const double sizes[4] = {alpha, gamma, b, d}, z[3] = {0, 0.5, 1};
    hc_scene scene;
    return hc_make_scene(&scene, sizes, 3, z);
}

static int tilted_scene_made(double alpha, double gamma, double b, double d) {
    const double sizes[4] = {alpha, gamma, b, d}, z[3] = {0, 0.5, 1}, axis[3] = {1, 2, 3};
    hc_tilted_scene scene;
    return hc_make_tilted_scene(&scene, sizes, axis, 3, z, z, z);
}

static void check_scenes(void) {
    const double steep[3] = {1, 0, two(-12)}, sizes[4] = {2, 2, 1, 1}, thin[4] = {2, 2, 1, two(-40)}, where[2] = {1, 2};
    const double flat[4] = {2, 2, 1, two(-8)}, flatter[4] = {2, 2, 1, two(-10)}, slanted[3] = {1, 0, 1}, vast[3] = {two(300), two(300), 0};
    hc_tilted_scene scene, other;
    hc_scene upright;
    hc_point point;
    int i;
    CHECK(scene_made(2, 2, 1, 1) == HC_FLOATS_DECIDE && tilted_scene_made(2, 3, 1, 1.5) == HC_FLOATS_DECIDE);
    for (i = 0; i < 4; i++) {
        double low[4] = {2, 2, 1, 1}, high[4] = {2, 2, 1, 1};
        low[i] = two(-100), high[i] = two(100);
        CHECK(!scene_made(low[0], low[1], low[2], low[3]) && !scene_made(high[0], high[1], high[2], high[3]));
        CHECK(!tilted_scene_made(low[0], low[1], low[2], low[3]) && !tilted_scene_made(high[0], high[1], high[2], high[3]));
        low[i] = two(-99), high[i] = two(99);
        CHECK(scene_made(low[0], low[1], low[2], low[3]) && scene_made(high[0], high[1], high[2], high[3]));
    }
    CHECK(!tilted_scene_made(two(101), two(102), two(100), two(101)) && tilted_scene_made(two(98), two(99), two(97), two(98)));
    CHECK(!tilted_scene_made(two(-99), two(-98), two(-100), two(-99)) && tilted_scene_made(two(-97), two(-98), two(-99), two(-98)));
    CHECK(hc_make_tilted_scene(&scene, sizes, steep, 2, where, where, where));
    CHECK(!hc_make_tilted_scene(&scene, thin, steep, 2, where, where, where) || scene.zeta < HC_greatest_zeta);
    CHECK(hc_make_tilted_scene(&scene, flat, slanted, 2, where, where, where) && scene.zeta > two(-18) && scene.under[0].K > 0);
    CHECK(!hc_make_tilted_scene(&other, flatter, slanted, 2, where, where, where) && other.zeta < 2 * HC_greatest_zeta);
    CHECK(scene.reach < scene.heights[2] - scene.zeta * (8 * scene.under[0].K + 2 * scene.heights[2]));
    CHECK(!hc_make_tilted_scene(&scene, sizes, vast, 2, where, where, where));
    for (i = 0; i < 2; i++) CHECK((hc_word(hc_short(1.0 / 3, i)) & 0x7ffffff) == 0 && (hc_short(1.0 / 3, i) > 1.0 / 3) == i);
    CHECK(hc_make_scene(&upright, sizes, 2, where) && upright.reach < hc_short(2.125, 1) * hc_short(2.125, 1) * (1 - 8 * DBL_EPSILON));
    point = hc_known_point(sizes, 0, 9, 1); /* the border of exterior positions at height 0 */
    CHECK(point.T == 0 && point.R > 8.9 && point.R < 9 && hypcheck_position(2, 2, 1, 1, sqrt(point.R), 0, 0) == 0);
    CHECK(hc_known_point(sizes, 0, two(402), 1).R == -1);
    point = hc_known_point(sizes, 0, 9.5, 1);
    CHECK(point.R == -1); /* no step of 2^-8 reaches contact */
    point = hc_known_point(sizes, 0, 1, -1);
    CHECK(point.R > 1 && point.R < 1.1);
    CHECK(hc_known_point(sizes, 0, 0.5, -1).R == -1);
}

/* ---- numbers with bounds ---- */

static int is_known(hc_ball a) { return a.v == a.v && a.e == a.e; }

static void check_balls(void) {
    hc_ball a, b;
    CHECK(is_known(hc_ball_of(two(399), 0)) && !is_known(hc_ball_of(two(400), 0)) && !is_known(hc_ball_of(-two(400), 0)));
    CHECK(is_known(hc_ball_of(1, two(399))) && !is_known(hc_ball_of(1, two(400))) && !is_known(hc_ball_of(NAN, 0)));
    a.v = a.e = 1;
    CHECK(!is_known(hc_root(a)));
    a = hc_exactly(3), b = hc_ball_of(1, 1);
    CHECK(hc_exactly(3).e == 0 && hc_over(a, hc_exactly(2)).v == 1.5 && !is_known(hc_over(a, b)) && !is_known(hc_over(a, hc_exactly(0))));
    CHECK(is_known(hc_root(hc_exactly(2))) && !is_known(hc_root(hc_exactly(0))) && !is_known(hc_root(hc_exactly(-1))));
    CHECK(!is_known(hc_root(b)) && is_known(hc_root(hc_ball_of(1, 0.5))));
    CHECK(hc_at_most(hc_exactly(1)) > 1 && hc_at_most(hc_exactly(-1)) > -1 && hc_at_most(hc_exactly(0)) == 0);
    CHECK(hc_at_least(hc_exactly(1)) < 1 && hc_at_least(hc_exactly(-1)) < -1 && hc_at_least(hc_exactly(0)) == 0);
    CHECK(hc_at_most(hc_exactly(1)) == HC_more && hc_at_least(hc_exactly(-1)) == -HC_more);
    CHECK(hc_at_most(hc_exactly(-1)) == -HC_less && hc_at_least(hc_exactly(1)) == HC_less);
    CHECK(hc_plus(a, b).e >= b.e && hc_minus(a, b).e >= b.e && hc_times(a, b).e >= 3 * b.e && hc_ball_of(1, 0).e >= HC_unit);
    CHECK(hc_ball_of(0, 0).e == HC_lost);
}

static int proper(double a, double K, double M, double z, int greater) {
    hc_tilted_scene scene;
    hc_plane plane;
    memset(&scene, 0, sizeof scene);
    scene.zeta = two(-50);
    plane = hc_proper(&scene, a, K, M, z, greater);
    CHECK((plane.K == (greater ? HC_NEVER : -1)) == (plane.a == 1 && plane.M == 0) || plane.K > 0);
    return plane.K != (greater ? HC_NEVER : -1);
}

static void check_planes(void) {
    const double z = two(-40);
    int greater;
    for (greater = 0; greater < 2; greater++) {
        CHECK(proper(1, 1, 1, z, greater) && proper(1, 1, 0, z, greater) && !proper(1, 1, -z, z, greater));
        CHECK(!proper(two(-20), 1, 1, z, greater) && proper(two(-19), 1, 1, z, greater));
        CHECK(!proper(two(20), 1, 1, z, greater) && proper(two(19), 1, 1, two(-30), greater));
        CHECK(proper(1, two(-300), 1, z, greater) && !proper(1, two(-301), 1, z, greater));
        CHECK(proper(1, two(399), 1, z, greater) && !proper(1, two(400), 1, z, greater));
        CHECK(!proper(1, 1, two(401), 0.1, greater) && proper(1, 1, two(40), 0.1, greater));
        CHECK(!proper(1, 1, 1, two(-49), greater) && !proper(1, 1, two(30), two(-20), greater));
        CHECK(proper(1, 1, 1, 0.124, greater) && !proper(1, 1, 1, 0.125, greater));
        CHECK(!proper(0.5, 1, 1, 0.0625, greater) && proper(0.5, 1, 1, 0.0624, greater) && !proper(2, 1, 1, 0.125, greater));
    }
}

static hc_tilted_scene upright_poles(double A1, double A2, double B) {
    hc_tilted_scene scene;
    memset(&scene, 0, sizeof scene);
    scene.A1 = hc_exactly(A1), scene.A2 = hc_exactly(A2), scene.B = hc_exactly(B);
    scene.zeta = two(-50);
    return scene;
}

static void check_tilted_tangents(void) {
    const hc_tilted_scene scene = upright_poles(16, 4, 4), other = upright_poles(4, 16, 4);
    hc_tilted_scene vague = scene;
    CHECK(hc_tilted_tangent(&scene, 1, 1).K != HC_NEVER && hc_tilted_tangent(&scene, -2, -1).K != -1);
    CHECK(hc_tilted_tangent(&scene, 4, 1).K == HC_NEVER && hc_tilted_tangent(&scene, 5, 1).K == HC_NEVER);
    CHECK(hc_tilted_tangent(&scene, -1, 1).K == HC_NEVER && hc_tilted_tangent(&scene, 1, -1).K == -1);
    CHECK(hc_tilted_tangent(&scene, -4, -1).K == -1 && hc_tilted_tangent(&scene, -5, -1).K == -1);
    CHECK(hc_tilted_tangent(&other, -4, -1).K == -1 && hc_tilted_tangent(&other, -5, -1).K == -1);
    CHECK(hc_tilted_tangent(&other, -2, -1).K != -1 && hc_tilted_tangent(&scene, 0, 1).K == HC_NEVER);
    /* P = 9 is the border of exterior places at Q = 0 for A = 4, B = 4; 1 that of interior ones. */
    CHECK(hc_not_on_side(scene.A2, scene.B, 8.9, 0, 1) && !hc_not_on_side(scene.A2, scene.B, 9.1, 0, 1));
    CHECK(hc_not_on_side(scene.A2, scene.B, 1.1, 0, -1) && !hc_not_on_side(scene.A2, scene.B, 0.9, 0, -1));
    CHECK(hc_below_tangent(scene.A2, scene.B, 8, 0, 2, 1) && !hc_below_tangent(scene.A2, scene.B, 10, 0, 2, 1));
    CHECK(!hc_below_tangent(scene.A2, scene.B, 8, 0, 4, 1) && !hc_below_tangent(scene.A2, scene.B, 8, 0, -4, -1));
    CHECK(hc_below_tangent(scene.A2, scene.B, 2, 0, -1, -1) && !hc_below_tangent(scene.A2, scene.B, 0.5, 0, -1, -1));
    CHECK(hc_tilted_chord(&scene, 0, 1, 1).K != -1 && hc_tilted_chord(&scene, 0, 1, -1).K != HC_NEVER);
    vague.A1.e = 15; /* no corner on its axis is proved */
    CHECK(hc_tilted_chord(&vague, 0, 1, 1).K == -1 && hc_tilted_chord(&vague, 0, 1, -1).K == HC_NEVER);
    CHECK(hc_tilted_chord(&scene, 0, 0, 1).M <= 0 || hc_tilted_chord(&scene, 0, 0, 1).K == -1);
}

/* ---- ways ---- */

static int way_made(int place, double value, int leans) {
    const double axis[3] = {1, 2, 3};
    double row[10] = {2, 2, 1, 1, 1, 1, 1, 2, 2, 2};
    hc_sweep sweep;
    row[place] = value;
    return hc_make_sweep(&sweep, row, leans ? axis : NULL);
}

static void check_ways(void) {
    const double row[10] = {2, 2, 1, 1, 1, 1, 1, 2, 2, 2};
    hc_sweep sweep;
    int i;
    for (i = 0; i < 4; i++) {
        CHECK(!way_made(i, two(-100), 0) && !way_made(i, two(100), 0) && !way_made(i, 0, 0));
        CHECK(way_made(i, two(-40), 0) && way_made(i, two(40), 0) && way_made(i, 1, 1));
        if (i < 2) CHECK(way_made(i, two(-99), 0) && way_made(i, two(99), 0));
    }
    for (i = 4; i < 10; i++) {
        CHECK(!way_made(i, two(150), 0) && !way_made(i, -two(150), 0) && !way_made(i, NAN, 0) && !way_made(i, INFINITY, 0));
        CHECK(!way_made(i, two(60), 0) && !way_made(i, two(60), 1) && way_made(i, two(40), 0)); /* the slack */
    }
    CHECK(hc_make_sweep(&sweep, row, NULL) && sweep.slack > 4 * HC_unit * 10 && sweep.slack < 8 * HC_unit * 10);
    CHECK(hc_sweep_root(1, 1, 1) == 2 && hc_sweep_root(0, -1, 0) == 0 && hc_sweep_root(two(-402), -1, 0) == 0);
    CHECK(hc_sweep_root(1, -1, 0) <= 0.5 && hc_sweep_root(1, -1, 0) > 0.4999 && hc_sweep_root(1, -0.25, 0) >= 1);
    CHECK(hc_sweep_root(1, -0.5, 0) < 1 && hc_sweep_root(1, 0, -1) < 1 && hc_sweep_root(1, 0, 1) == 2 && hc_sweep_root(NAN, 0, 0) == 0);
    CHECK(hc_sweep_root(1, -1, 1) <= 1 && hc_sweep_root(1, -1, 1) > 0.99 && hc_sweep_root(1, -1, 1.5) == 2);
    CHECK(hc_sweep_root(1, 0, 0) == 2 && hc_sweep_root(1, -0.249, 0) == 2 && hc_sweep_root(1, -0.251, 0) < 2);
}

/* ---- the public functions: what they say of odd questions ---- */

static int hit_of(double x, double to_x, double alpha, int timed) {
    const double row[10] = {alpha, 2, 1, 1, x, 0, 0, to_x, 0, 0};
    double time;
    int8_t hit;
    hypcheck_passage(1, row, &hit, timed ? &time : NULL);
    CHECK(!timed || (time == time) <= (hit == 1));
    return hit;
}

static void check_passages(void) {
    double upright[100 * 10];
    int8_t answers[100];
    int i;
    CHECK(hit_of(5, 6, 2, 1) == 0 && hit_of(5, 4, 2, 0) == 0 && hit_of(5, 0, 2, 1) == 1 && hit_of(5, 0, 2, 0) == 1 && hit_of(3, 5, 2, 1) == 1);
    CHECK(hit_of(two(150), 5, 2, 1) == 2 && hit_of(two(150), 0, 2, 1) == 1 && hit_of(two(149), 0, 2, 0) == 1);
    CHECK(hit_of(two(160), -two(160), 2, 1) == 2 && hit_of(5, -5, 2, 1) == 1 && hit_of(5, -5, 2, 0) == 1);
    CHECK(hit_of(0, 0.5, two(150), 1) == 2 && hit_of(NAN, 0, 2, 1) == 127);
    for (i = 0; i < 100; i++) {
        const double row[10] = {2, 2, 1, 1, 4, 0, 0, 0, 0, 1};
        memcpy(upright + 10 * i, row, sizeof row);
    }
    CHECK(hypcheck_ask_tilted(0, 100, upright, answers) == 0 && answers[0] == 1 && answers[99] == 1);
    CHECK(hc_exact_tilted_position(upright) == 1);
}

static void check_questions(void) {
    enum { MANY = (1 << 19) + 4096 + 70 };
    static double x[MANY], y[MANY], z[MANY];
    static int8_t answers[MANY];
    const double sizes[4] = {2, 3, 1, 0.5}, none[4] = {2, 3, 0, 0.5}, axis[3] = {1, 2, 3}, upward[3] = {0, 0, -2}, nowhere[3] = {0, 0, 0};
    const char *const level = hypcheck_level();
    int i, question;
    for (i = 0; i < MANY; i++) x[i] = 10, z[i] = i % 3 - 1, y[i] = 0;
    for (question = -1; question < 5; question++) {
        const int right = question == 2 || question == 3 ? 0 : 1;
        CHECK(hypcheck_ask_scene(question, sizes, 2000, x, y, z, answers) == 0 && answers[0] == right && answers[1999] == right);
        CHECK(hypcheck_ask_tilted_scene(question, sizes, axis, 2000, x, y, z, answers) == 0 && answers[0] == right && answers[1999] == right);
    }
    CHECK(hypcheck_ask_scene(0, sizes, MANY, x, y, z, answers) == 0 && answers[MANY - 1] == 1);
    CHECK(hypcheck_ask_tilted_scene(0, sizes, axis, MANY, x, y, z, answers) == 0 && answers[MANY - 1] == 1);
    CHECK(hypcheck_ask_scene(3, sizes, 100, x, y, z, answers) == 0 && answers[99] == 0);
    CHECK(hypcheck_ask_tilted_scene(3, sizes, axis, 100, x, y, z, answers) == 0 && answers[99] == 0);
    CHECK(hypcheck_ask_scene(0, none, 2000, x, y, z, answers) == 2000 && answers[0] == 127 && answers[1999] == 127);
    CHECK(hypcheck_ask_tilted_scene(0, none, axis, 2000, x, y, z, answers) == 2000 && answers[1999] == 127);
    CHECK(hypcheck_ask_tilted_scene(0, sizes, nowhere, 2000, x, y, z, answers) == 2000 && answers[1999] == 127);
    CHECK(hypcheck_ask_tilted_scene(0, sizes, upward, 2000, x, y, z, answers) == 0 && answers[1999] == 1);
    CHECK(hypcheck_ask_scene(0, sizes, 0, x, y, z, answers) == 0 && hypcheck_ask(0, 0, x, answers) == 0);
    x[77] = NAN, y[1500] = INFINITY;
    CHECK(hypcheck_ask_scene(0, sizes, 2000, x, y, z, answers) == 2 && answers[77] == 127 && answers[1500] == 127 && answers[78] == 1);
    CHECK(hypcheck_ask_tilted_scene(0, sizes, axis, 2000, x, y, z, answers) == 2 && answers[77] == 127 && answers[1500] == 127);
    CHECK(!hypcheck_use_level("no such level") && strcmp(hypcheck_level(), level) == 0 && hypcheck_use_level(level));
    for (i = 0; i < 2000; i++) x[i] = 2.25, y[i] = z[i] = 0; /* contact, near the border: the half planes of one kind leave them */
    x[0] = 50, z[0] = 40;
    CHECK(hypcheck_ask_tilted_scene(0, sizes, axis, 2000, x, y, z, answers) == 0 && answers[1] == 0);
}

static void check_guards(void) {
    check_single();
    check_valid();
    check_tilted_limits();
    check_axes();
    check_tangents();
    check_chords();
    check_scenes();
    check_balls();
    check_planes();
    check_tilted_tangents();
    check_ways();
    check_passages();
    check_questions();
}
