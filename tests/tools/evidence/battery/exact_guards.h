/* The guards of the exact stages, of clearances, of prepared scenes and of the processor, at their limits; CHECK and two() are
   those of guards.h. What is right follows from the geometry, or from the limit that a guard has. */

/* ---- fixed point and tangencies ---- */

static double double_root(int k, int grown) {
    hc_fixed_cubic cubic;
    memset(&cubic, 0, sizeof cubic);
    cubic.k = k, cubic.grown = grown;
    cubic.h1.high = cubic.h2.high = (uint64_t)1 << 60;
    return hc_fixed_double_root(&cubic);
}

static void check_double_roots(void) {
    hc_fixed_cubic cubic;
    CHECK(double_root(0, 0) == -0.5 && double_root(1000, 0) == -0.5 * two(1000) && double_root(-1000, 0) == -0.5 * two(-1000));
    CHECK(double_root(1001, 0) == 0 && double_root(-1001, 0) == 0 && double_root(0, 100) == -0.5 && double_root(0, 101) == 0);
    memset(&cubic, 0, sizeof cubic);
    cubic.h1.low = 64, cubic.h2.high = cubic.N.high = (uint64_t)1 << 60, cubic.n2.high = (uint64_t)3 << 60;
    CHECK(hc_fixed_double_root(&cubic) == -1); /* a triple root: -n2 / (3 N) */
    cubic.h1.low = 65;
    CHECK(hc_fixed_double_root(&cubic) < -two(100)); /* -h2 / (2 h1) */
}

static int by(const uint64_t lengths[7], double about, int most_bits) {
    return most_bits > 23 ? hc_touches_by(lengths, about) : hc_touches_by_short(lengths, about);
}

/* A guess is none, or beyond what fits, and nothing is proved. A right one proves the tangency alone. */
static void check_guesses(int bits) {
    const uint64_t outer[7] = {1, 2, 1, 1, 2, 0, 0}, inner[7] = {4, 4, 1, 1, 3, 0, 0}, none[7] = {1, 2, 1, 1, 3, 0, 0};
    const uint64_t beyond[7] = {2, 1, 2, 2, 0, 0, 3}, long_ones[7] = {(uint64_t)1 << 61, (uint64_t)1 << 61, 1, 1, 0, 0, 1};
    const double no_guess[] = {0, -0.0, NAN, INFINITY, -INFINITY, 1e300, -1e300, 1e-300, -1e-300, DBL_MAX, DBL_MIN};
    int i;
    for (i = 0; i < (int)(sizeof no_guess / sizeof *no_guess); i++)
        CHECK(by(outer, no_guess[i], bits) == 2 && by(inner, no_guess[i], bits) == 2 && by(none, no_guess[i], bits) == 2);
    CHECK(by(outer, 1, bits) == 1 && by(inner, -4, bits) == -1 && by(none, 1, bits) == 2 && by(none, -1, bits) == 2);
    CHECK(by(outer, -1, bits) == 2 && by(inner, 4, bits) == 2);
    if (bits > 23) {
        CHECK(by(long_ones, two(124), bits) == 2 && by(long_ones, two(126), bits) == 2 && by(long_ones, two(-10), bits) == 2);
        CHECK(by(outer, 1.25, bits) == 1 && by(inner, -5, bits) == -1); /* Newton's method finds it */
    } else {
        CHECK(by(outer, two(46), bits) == 2 && by(outer, 1 / two(46), bits) == 2);
    }
    CHECK(by(beyond, 1, bits) == 2);
}

/* D = 1, and M e = K as of a double root M, but one of n2 and n1 is another. */
static void check_third_equation(void) {
    uint64_t found = 0, others = 0; /* of which n2 agrees alone, and n1 alone */
    uint64_t lengths[7] = {1, 2, 1, 1, 0, 0, 0};
    for (lengths[0] = 1; lengths[0] < 9; lengths[0]++)
        for (lengths[1] = 1; lengths[1] < 9; lengths[1]++)
            for (lengths[4] = 0; lengths[4] < 20; lengths[4]++)
                for (lengths[6] = 1; lengths[6] < 9; lengths[6]++) {
                    const uint64_t p = lengths[0] * lengths[0], s = lengths[1] * lengths[1], K = lengths[0] * lengths[1];
                    const uint64_t R = lengths[4] * lengths[4], S = lengths[6] * lengths[6];
                    uint64_t M;
                    for (M = 1; M <= K; M++) {
                        const uint64_t e = K / M;
                        const int n2 = p + 1 + 2 * M + e * e == R + s + S, n1 = p + s * R == p * (s + S) + s + M * M + 2 * K * e;
                        if (M * e != K || n2 == n1) continue;
                        found += (uint64_t)n2, others += (uint64_t)n1;
                        CHECK(hc_touches_by(lengths, (double)M) == 2 && hc_touches_by_short(lengths, (double)M) == 2);
                    }
                }
    CHECK(found > 10 && others > 10);
}

static int product_is(uint64_t left_low, uint64_t left_high, uint64_t right_low, uint64_t right_high, const uint64_t words[4]) {
    const hc_fixed left = {left_low, left_high}, right = {right_low, right_high};
    return memcmp(hc_long_product(left, right).words, words, 4 * sizeof *words) == 0;
}

/* Carries into each word, and where numbers no longer fit; the products are those of Python. */
static void check_long_numbers(void) {
    const uint64_t all = ~(uint64_t)0, square[4] = {1, 0, all - 1, all}, first[4] = {0xe141cd02bd3caa1f, 0xe141cd02bd3caa1e, 0, 1};
    const uint64_t second[4] = {0x100000000, 0xfffffffe00000002, 0xfffffffb, 2};
    const double longest[7] = {two(61), 1, 1, 1, 0, 0, 0}, longer[7] = {two(62), 1, 1, 1, 0, 0, 0};
    const hc_fixed high = {0, (uint64_t)1 << 62};
    uint64_t lengths[7];
    CHECK(product_is(all, all, all, all, square) && product_is(1, 1, 0xe141cd02bd3caa1f, all, first));
    CHECK(product_is(0x100000000, 2, 1, all - 1, second));
    CHECK(hc_fixed_nearest(two(52) + 1).low == ((uint64_t)1 << 52) + 1 && hc_fixed_nearest(two(51) + 1).low == ((uint64_t)1 << 51) + 1);
    CHECK(hc_fixed_nearest(-3).low == all - 2 && hc_fixed_nearest(-3).high == all && hc_fixed_nearest(two(100)).high == (uint64_t)1 << 36);
    CHECK(hc_fixed_down(high, 126).low == 1 && hc_fixed_down(high, 127).low == 0 && hc_fixed_down(high, 1000).low == 0);
    CHECK(hc_short_lengths(longest, lengths) == 62 && lengths[0] == (uint64_t)1 << 61 && hc_short_lengths(longer, lengths) == 63);
}

/* Newton's method leaves what fits each way, by a large M or e of either sign; where it begins tells nothing of the row. */
static void check_steps_beyond(void) {
    const uint64_t rows[5][7] = {
        {0x7b, 0x352762823de5480, 0x1f17, 0x23d1272e8c643600, 0x175d5a23e, 0xcbb, 0xa2},
        {0xbf48, 0x1392eb84, 0x6f4282bf85400, 0x1fce774c766, 0xaf, 0xfa5238db8b80, 0x3b1},
        {0x17, 0xabc4175639, 0x656cadc1330, 0x421, 0x65de3b1976bb400, 0, 0x3b918a172f00},
        {0x75, 0xd, 0x1968999db3d3, 0x194c32, 0, 0xa3a47201fa56d, 0xf595c66455274},
        {0x3d042f4, 0x35, 0x67bb26e117967c00, 0x3b24218f9fd57d00, 0x18a8d9fce, 0xd7b54d38e2, 0x4f701a1d0e3b},
    };
    const double guesses[5] = {0x1.a0945f8560ca9p-7, 0x1.09cf35ee7be23p-32, -0x1.1dbd7b944ab39p-6, 0x1.226d543e5898ap-34, -0x1.a68d9887cdd91p-60};
    int i;
    for (i = 0; i < 5; i++) CHECK(hc_touches_by(rows[i], guesses[i]) == 2);
}

/* A guess of which only a rest modulo 2^128 is right: 2^128 times the double root of a touch from within, whose e is found by one
   step. It is not about the root. And nothing is converted to a whole number that does not fit: that would be invalid. */
static void check_guesses_modulo(void) {
    const uint64_t within[7] = {(uint64_t)1 << 30, 1, 1, (uint64_t)1 << 31, ((uint64_t)1 << 30) - 1, 0, 0}, outer[7] = {1, 2, 1, 1, 2, 0, 0};
    CHECK(hc_touches_by(within, -two(30)) == -1 && hc_touches_by(within, -two(158)) == 2);
    feclearexcept(FE_ALL_EXCEPT);
    CHECK(hc_touches_by_short(outer, 1e300) == 2 && !fetestexcept(FE_INVALID));
    CHECK(hc_touches_by_short(outer, 1e-300) == 2 && !fetestexcept(FE_INVALID));
}

/* M = alpha d and e = b gamma of touches in the waist; one of them is 100, and the guess 0.4 from it. */
static void check_nearest_guesses(void) {
    const uint64_t inner[7] = {100, 1, 1, 1, 99, 0, 0}, outer[7] = {1, 100, 1, 1, 2, 0, 0};
    CHECK(hc_touches_by_short(inner, -99.6) == -1 && hc_touches_by_short(inner, -100.4) == -1);
    CHECK(hc_touches_by_short(outer, 100 / 99.6) == 1 && hc_touches_by_short(outer, 100 / 100.4) == 1);
}

/* A coordinate that is a hair beside the other kind's length alone is none, and the row without it, which touches, says nothing. */
static void check_hairs(void) {
    const double within[7] = {4096, two(70), 1, two(60), 512, 4095, 0}, turned[7] = {4096, two(70), 1, two(60), 4095, 512, 0};
    const double raised[7] = {two(90), 2, two(90), 1, two(91), 0, two(20)}, beside[7] = {4096, two(70), 1, two(60), 1e-19, 4095, 0};
    const int moved = hc_position_beside_tangency(within, -4096), other = hc_position_beside_tangency(turned, -4096);
    const int inside = hc_position_beside_tangency(raised, 1);
    CHECK((moved == 1 || moved == 2) && (other == 1 || other == 2)); /* some 30 b away from the surface, which is nearly a cylinder */
    CHECK(inside == -1 || inside == 2);                              /* where the hyperboloid is 2^19 times as wide */
    CHECK(hc_position_beside_tangency(beside, -4096) == 0);          /* a hair more leads from within into contact */
}

/* ---- integers ---- */

static hc_integer whole(hc_limb *limb, int value) {
    hc_integer number;
    *limb = (hc_limb)(value < 0 ? -value : value);
    number.limbs = limb, number.length = value != 0, number.sign = (value > 0) - (value < 0);
    return number;
}

static void check_integers(void) {
    static hc_limb memory[4096];
    hc_limb around[64], limbs[5];
    const hc_integer f[5] = {whole(limbs, 1), whole(limbs + 1, 0), whole(limbs + 2, 0), whole(limbs + 3, 0), whole(limbs + 4, 1)};
    hc_pool pool = {memory};
    hc_integer none = {0};
    memset(around, 0, sizeof around);
    around[0] = around[1] = 1;
    none.limbs = around + 1;
    CHECK(hc_bits_of(&none) == 0);
    hc_in_units(&none, hc_parts_of(0), 2000);
    CHECK(none.sign == 0 && none.length == 0 && around[1] == 1); /* 0 has no limbs, and none is written */
    /* 4 I^3 - J^2 of l^4 - 1 is 27 times its discriminant, -256: 13 bits */
    CHECK(hc_discriminant_sign(pool, f, 0) == -1 && hc_discriminant_sign(pool, f, 12) == -1 && hc_discriminant_sign(pool, f, 13) == 0);
}

/* U + V root(D) with U = 0: of u + v m at m = 3 and m = -1, the roots of m^2 = 2 m + 3. */
static void check_signs_with_root(void) {
    static hc_limb memory[4096];
    hc_limb limbs[4];
    const hc_integer n = whole(limbs, 3), u = whole(limbs + 1, -1), v = whole(limbs + 2, 1);
    hc_pool pool = {memory};
    hc_quartic pair;
    memset(&pair, 0, sizeof pair);
    pair.k1 = whole(limbs + 3, 2);
    CHECK(hc_sign_with_root(pool, &pair, &n, u, v, 1) == 1 && hc_sign_with_root(pool, &pair, &n, u, v, -1) == -1);
}

/* Of a level axis, A1 = p/q, A2 = p/t and B = s/q: what is said by the product is so in whole numbers. */
static void check_products_of_roots(void) {
    static hc_limb memory[4096];
    hc_limb limbs[7];
    hc_pool pool = {memory};
    hc_quartic pair;
    int p, q, s, t, said[3] = {0, 0, 0};
    memset(&pair, 0, sizeof pair);
    pair.k0 = whole(limbs, 1), pair.k1 = whole(limbs + 1, 0), pair.k2 = whole(limbs + 2, 1 << 20); /* A2 = B = 2^-10 */
    CHECK(hc_between_poles(pool, &pair, 1, -11) == 1 && hc_between_poles(pool, &pair, 1, -9) == -1);
    CHECK(hc_between_poles(pool, &pair, -1, -11) == 1 && hc_between_poles(pool, &pair, -1, -9) == -1);
    for (p = 1; p < 50; p++)
        for (q = 1; q < 16; q++)
            for (s = 1; s < 16; s += 3)
                for (t = 1; t < 16; t++) {
                    int outer, inner;
                    if (q == t) continue;
                    pair.p = whole(limbs + 3, p), pair.q = whole(limbs + 4, q), pair.s = whole(limbs + 5, s), pair.t = whole(limbs + 6, t);
                    pair.k0 = whole(limbs, p * s), pair.k1 = whole(limbs + 1, s * t - p * q), pair.k2 = whole(limbs + 2, q * t);
                    pair.oblate = q > t;
                    outer = hc_product_too_small(pool, &pair, 1), inner = hc_product_too_small(pool, &pair, -1);
                    said[0] += outer, said[pair.oblate ? 1 : 2] += inner;
                    CHECK(!outer || (s * s > p * q && s * s * t > p * q * q)); /* B^2 > A1, A2 */
                    CHECK(!inner || (pair.oblate ? p * t > q * q : p * q > t * t)); /* A1^2 > A2, or A2^2 > A1 */
                }
    CHECK(said[0] > 100 && said[1] > 100 && said[2] > 100);
    /* Of an axis that leans A1 = 15/16, A2 > 1.59 and B < 1.1: at 1.1 it is below 0, and A2 B = 225/128. */
    pair.p = whole(limbs + 3, 15), pair.q = whole(limbs + 4, 16), pair.s = whole(limbs + 5, 15), pair.t = whole(limbs + 6, 8);
    pair.k0 = whole(limbs, 6750), pair.k1 = whole(limbs + 1, -1920), pair.k2 = whole(limbs + 2, 3840);
    pair.oblate = 1;
    CHECK(!hc_product_too_small(pool, &pair, 1));
}

static void check_uprights(void) {
    const double upright[10] = {1, 1, 1, 2, 9, 0, 0, 0, -0.0, 3}, leaning[10] = {1, 1, 1, 2, 9, 0, 0, 0, 1, 3};
    const double leaning_by_x[10] = {1, 1, 1, 2, 9, 0, 0, 1, 0, 3}, sphere[10] = {1, 1, 2, 2, 9, 0, 0, 1, 2, 3};
    CHECK(hc_is_upright(upright) && hc_is_upright(sphere) && !hc_is_upright(leaning) && !hc_is_upright(leaning_by_x));
}

/* ---- clearances ---- */

static int grows(double b, double d, double factor) {
    const double sizes[4] = {1, 1, b, d};
    double grown[2];
    return hc_grow(sizes, factor, 1, grown);
}

static int ordinary_with(int place, double value) {
    double row[7] = {1, 1, 1, 1, 3, 0, 0};
    row[place] = value;
    return hc_ordinary(row);
}

static void check_clearances(void) {
    const double sizes[4] = {1, 1, 1, 2};
    double grown[2];
    int i;
    CHECK(hc_grow(sizes, 1, 1, grown) && grown[0] == 1 && grown[1] == 2);
    CHECK(hc_grow(sizes, 1.5, 1, grown) && grown[0] == hc_next(1.5, 1) && grown[1] == hc_next(3, 1));
    CHECK(hc_grow(sizes, 1.5, -1, grown) && grown[0] == hc_next(1.5, -1) && grown[1] < 3);
    CHECK(!grows(two(-900), 1, 1) && !grows(1, two(-900), 1) && grows(two(-899), 1, 1) && grows(1, two(-899), 1));
    CHECK(!grows(two(900), 1, 1) && !grows(1, two(900), 1) && grows(two(899), 1, 1) && grows(1, two(899), 1));
    CHECK(hc_less_one(1, 0) == 0 && hc_less_one(1, 1) == 0 && hc_less_one(3, 0) < 2 && hc_less_one(3, 1) > 2);
    CHECK(hc_less_one(0.5, 0) < -0.5 && hc_less_one(0.5, 1) > -0.5 && hc_less_one(DBL_MAX, 1) == DBL_MAX);
    CHECK(hc_next(1, 1) == 1 + DBL_EPSILON && hc_next(2, -1) < 2);
    for (i = 0; i < 7; i++) {
        const double far = HC_greatest;
        CHECK(!ordinary_with(i, NAN) && !ordinary_with(i, INFINITY) && !ordinary_with(i, two(101)));
        if (i < 4) CHECK(!ordinary_with(i, two(-101)) && !ordinary_with(i, 0) && !ordinary_with(i, -1));
        if (i < 2) CHECK(ordinary_with(i, HC_least) && ordinary_with(i, far));
        if (i >= 4) CHECK(ordinary_with(i, far) && ordinary_with(i, -far) && !ordinary_with(i, -2 * far) && ordinary_with(i, 0));
    }
    CHECK(ordinary_with(2, HC_greatest_ratio) && !ordinary_with(2, 2 * HC_greatest_ratio));
    CHECK(ordinary_with(3, HC_greatest_ratio) && !ordinary_with(3, 2 * HC_greatest_ratio));
    CHECK(ordinary_with(4, HC_least_offset) && !ordinary_with(4, HC_least_offset / 2) && !ordinary_with(4, -HC_least_offset / 2));
    CHECK(ordinary_with(4, -HC_least_offset));
}

static double halved(double b, double d, double low, double high, double width) {
    const double row[7] = {1, 8, b, d, 5, 0, 0};
    return hc_halve_distance(row, low, high, width);
}

/* From alpha = 1, gamma = 8 at x = 5 to a sphere of radius 1 it is 3. A width that cannot be one loses the bound, and proves nothing. */
static void check_distances(void) {
    const double odd[] = {0, NAN, INFINITY, two(-1070), two(1023)};
    int i;
    CHECK(halved(1, 1, 0, 4, 1) <= 3 && halved(1, 1, 0, 4, 1) > 3 - 1e-8 && halved(1, 1, 0, 1e18, 1) > 3 - 1e-8);
    CHECK(halved(1, 1, 0, 2, 1) > 2 - 1e-8 && halved(1, 1, 2, 2, 1) == 2);
    for (i = 0; i < (int)(sizeof odd / sizeof *odd); i++) CHECK(halved(1, 1, 0, 4, odd[i]) <= 3);
    CHECK(halved(two(500), two(500), 0, 4, two(-990)) == 0 && halved(two(-950), two(-950), 0, two(-949), two(-950)) == 0);
}

/* Rows that are clear where nothing is known of the gap, and where the bounds of the clearance are lost. */
static void check_lost_gaps(void) {
    static hc_near near;
    static const double row[7] = {1, 8, 1, 1, 5, 0, 0}, tiny = 0x1p-1000;
    const double small[7] = {tiny, 8 * tiny, tiny, tiny, 5 * tiny, 0, 0};
    hypcheck_near found;
    memset(&found, 0, sizeof found);
    near.rows[0] = row, near.ordinary[0] = 1;
    near.gaps.most[0] = near.gaps.tried[0] = near.gaps.width[0] = NAN;
    found.lower = 3, found.upper = HC_NEVER;
    hc_distance(&near, 0, 1, &found);
    CHECK(found.distance_lower <= 3 && found.distance_lower > 2.999 && found.distance_upper == HC_NEVER);
    near.gaps.most[0] = 3, near.gaps.tried[0] = 2.9999, near.gaps.width[0] = 1;
    found.lower = 2.5;
    hc_distance(&near, 0, 1, &found);
    CHECK(found.distance_lower == 2.9999 && found.distance_upper == 3);
    hc_distance(&near, 0, -1, &found);
    CHECK(found.distance_lower == 2.9999);
    hc_distance(&near, 0, 0, &found); /* contact: what was tried is not proved */
    CHECK(found.distance_lower <= 3 && found.distance_lower != 2.9999 && found.distance_lower > 3 - 1e-8);
    near.gaps.tried[0] = 2;
    hc_distance(&near, 0, 1, &found);
    CHECK(found.distance_lower > 3 - 1e-8);
    near.rows[0] = small, near.ordinary[0] = 0;
    found.lower = found.upper = 3;
    hc_distance(&near, 0, 1, &found);
    CHECK(found.distance_lower == 0 && found.distance_upper == HC_NEVER);
}

/* ---- scenes ---- */

static int all_are(const int8_t *answers, int n, int right) {
    while (n > 0 && answers[n - 1] == right) n--;
    return n == 0;
}

static void check_prepared(void) {
    enum { MANY = 3 * HC_STRIP + 70 };
    static double x[MANY], y[MANY], z[MANY];
    static int8_t answers[MANY];
    const double sizes[4] = {2, 3, 1, 0.5}, none[4] = {2, 3, 0, 0.5}, axis[3] = {1, 2, 3}, upward[3] = {0, 0, -2}, nowhere[3] = {0, 0, 0};
    const double huge[4] = {2 * two(101), 3 * two(101), two(101), two(100)}, *const axes[4] = {NULL, upward, axis, nowhere};
    int i, k, question;
    /* Contact: upright up to 3, leaning up to 0x1.7cc...p+1, as the oracle says. Each 16th is there, and too many for one plane a
       side; more would take the exact stage long. */
    for (i = 0; i < MANY; i++) x[i] = i % 16 ? 2.25 : 0x1.7cc0b4a7c85bcp+1, y[i] = z[i] = 0;
    for (k = 0; k < 4; k++) {
        const int valid = k < 3;
        hypcheck_scene scene;
        for (question = 0; question < 4; question++) {
            const int right = question == 3;
            hypcheck_prepare(&scene, sizes, axes[k], 0, NULL, NULL, NULL);
            CHECK(hypcheck_ask_prepared(question, &scene, MANY, x, y, z, answers) == (valid ? 0 : MANY) && all_are(answers, MANY, valid ? right : 127));
            hypcheck_prepare(&scene, sizes, axes[k], 100, x, y, z);
            CHECK(hypcheck_ask_prepared(question, &scene, MANY, x, y, z, answers) == (valid ? 0 : MANY) && all_are(answers, MANY, valid ? right : 127));
        }
        hypcheck_prepare(&scene, none, axes[k], 0, NULL, NULL, NULL);
        CHECK(hypcheck_ask_prepared(0, &scene, 9, x, y, z, answers) == 9 && all_are(answers, 9, 127));
    }
    for (question = 0; question < 4; question++) {
        CHECK(hypcheck_ask_tilted_scene(question, sizes, axis, MANY, x, y, z, answers) == 0 && all_are(answers, MANY, question == 3));
        CHECK(hypcheck_ask_scene(question, sizes, MANY, x, y, z, answers) == 0 && all_are(answers, MANY, question == 3));
    }
    for (i = 0; i < 1000; i++) x[i] = two(105);
    CHECK(hypcheck_ask_tilted_scene(0, huge, axis, 1000, x, y, z, answers) == 0 && all_are(answers, 1000, 1)); /* no half spaces there */
    CHECK(hypcheck_ask_scene(0, huge, 1000, x, y, z, answers) == 0 && all_are(answers, 1000, 1));
}

static void check_wrappers(void) {
    const double rows[14] = {2, 2, 1, 1, 9, 0, 0, 2, 2, 1, 1, 3, 0, 0}, leaning[20] = {2, 2, 1, 1, 9, 0, 0, 1, 2, 3, 2, 2, 1, 1, 3, 0, 0, 0, 0, 1};
    const double sizes[4] = {2, 2, 1, 1}, axis[3] = {1, 2, 3}, x[2] = {9, 3}, none[2] = {0, 0};
    const double flat[4] = {2, 2, 1, 0.5}, level[3] = {1, 0, 0}, odd[7] = {2, 2, 1, 1, NAN, 0, 0};
    const double beside[7] = {1, 1, 1, 1, 0, HC_least_offset, 0}, other_side[7] = {1, 1, 1, 1, 0, -HC_least_offset, 0};
    const double too_near[7] = {1, 1, 1, 1, 0, HC_least_offset / 2, 0}, far[7] = {1, 1, 1, 1, 1e300, 0, 0};
    hypcheck_scene scene;
    hypcheck_near near;
    int8_t answers[2];
    CHECK(strcmp(hypcheck_version(), HYPCHECK_VERSION) == 0);
    hypcheck_prepare(&scene, flat, level, 0, NULL, NULL, NULL);
    CHECK(hypcheck_ask_prepared(0, &scene, 1, x, none, none, answers) == 0 && answers[0] == 1);
    CHECK(hypcheck_clearance(1, odd, answers, &near) == 1 && answers[0] == 127 && near.lower != near.lower);
    CHECK(hc_ordinary(beside) && hc_ordinary(other_side) && !hc_ordinary(too_near));
    CHECK(hypcheck_clearance(1, far, answers, &near) == 0 && answers[0] == 1 && near.lower > two(890)); /* the largest that is asked about */
    hypcheck_classify(2, rows, answers);
    CHECK(answers[0] == 1 && answers[1] == 0);
    hypcheck_classify_tilted(2, leaning, answers);
    CHECK(answers[0] == 1 && answers[1] == 0);
    hypcheck_classify_scene(sizes, 2, x, none, none, answers);
    CHECK(answers[0] == 1 && answers[1] == 0);
    hypcheck_classify_tilted_scene(sizes, axis, 2, x, none, none, answers);
    CHECK(answers[0] == 1 && answers[1] == 0);
}

/* Chords below the least constant, and half spaces over a single height; a multiplier where a square has become infinite. */
static void check_ends_of_chords(void) {
    const hc_tilted_scene scene = upright_poles(16, 4, 4), narrow = upright_poles(two(-2), two(-2), 4), flush = upright_poles(1, 1, 4);
    CHECK(chord_of(0, 0, 1, 0, -1).K == 0 && chord_of(0, two(-301), 1, two(-301), -1).K == HC_least_constant);
    CHECK(hc_tilted_chord(&scene, 0, 0, -1).M <= two(-40));
    CHECK(hc_tilted_chord(&flush, 0, 0, -1).M <= two(-40) && hc_tilted_chord(&flush, 0, 1, -1).K > 0 && hc_tilted_chord(&narrow, 0, 0, -1).M <= two(-40) && hc_tilted_chord(&narrow, 0, 1, -1).K != 0);
    CHECK(hc_best_multiplier(0, 1, 1, 1) == 0 && hc_best_multiplier(1, two(-600), 1, 1) == 0);
}

/* ---- the processor ---- */

static void check_levels(void) {
#if HC_X86
    const unsigned fma = 1u << 12, avx2 = 1u << 5, bmi2 = 1u << 8, all[4] = {1u << 16, 1u << 17, 1u << 30, 1u << 31};
    const unsigned avx512 = avx2 | bmi2 | all[0] | all[1] | all[2] | all[3];
    int i;
    CHECK(hc_level_of(fma, avx512, 0xe6) == 3 && hc_level_of(fma, avx2 | bmi2, 0x06) == 2 && hc_level_of(fma, avx2 | bmi2, 0xe6) == 2);
    CHECK(hc_level_of(0, avx512, 0xe6) == 1 && hc_level_of(~fma, avx512, 0xe6) == 1 && hc_level_of(fma, 0, 0xe6) == 1);
    CHECK(hc_level_of(fma, avx512, 0x06) == 2 && hc_level_of(fma, avx512, 0) == 1 && hc_level_of(fma, avx2 | bmi2, 0) == 1);
    CHECK(hc_level_of(fma, avx2, 0xe6) == 1 && hc_level_of(fma, bmi2, 0xe6) == 1 && hc_level_of(fma, avx2 | bmi2, 0x04) == 1);
    for (i = 0; i < 4; i++) CHECK(hc_level_of(fma, avx512 & ~all[i], 0xe6) == 2);
    for (i = 5; i < 8; i++) CHECK(hc_level_of(fma, avx512, 0xe6 & ~(1u << i)) == 2);
#endif
}

static void check_exact_guards(void) {
    check_double_roots();
    check_guesses(23);
    check_guesses(62);
    check_third_equation();
    check_long_numbers();
    check_steps_beyond();
    check_guesses_modulo();
    check_nearest_guesses();
    check_hairs();
    check_integers();
    check_signs_with_root();
    check_products_of_roots();
    check_uprights();
    check_clearances();
    check_distances();
    check_lost_gaps();
    check_prepared();
    check_wrappers();
    check_ends_of_chords();
    check_levels();
}
