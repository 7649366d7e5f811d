
/* ---- spheroids whose axis leans: the public functions ---- */

typedef struct {
    double columns[10 * HC_BLOCK];
    size_t places[HC_BLOCK];
    int count;
} hc_tilted_waiting;

/* An axis of any length as one for which floats have room: times a power of two, where no number becomes subnormal by it.
   A number of exponent field 0 may be 2^52 smaller than that says. NaN stays. */
static void hc_scale_axis(double axis[3]) {
    int i, most = -4096, least = 4096;
    for (i = 0; i < 3; i++) {
        const uint64_t word = hc_word(axis[i]) << 1;
        const int top = (int)(word >> 53);
        if (word == 0) continue;
        if (top > most) most = top;
        if (top < least) least = top;
    }
    if (most < 0 || most == 2047 || (most > 1023 - 40 && most < 1023 + 40) || most - least > (least ? 1020 : 960)) return;
    for (i = 0; i < 3; i++) {
        const hc_parts parts = hc_parts_of(axis[i]);
        uint64_t power;
        double unit;
        if (parts.sign == 0) continue;
        power = (uint64_t)(parts.exponent + 52 + 1023 + 1023 - most) << 52;
        memcpy(&unit, &power, sizeof unit);
        axis[i] = (double)parts.sign * ((double)parts.mantissa * 2.220446049250313e-16 /* 2^-52 */ * unit);
    }
}

/* The floats, and the integers for what they leave. Returns the number of invalid rows. */
static size_t hc_tilted_settle(const hc_level_functions *level, int question, hc_tilted_waiting *waiting, int8_t *answers) {
    const hc_bits found = level->tilted(waiting->columns, HC_BLOCK, waiting->count);
    int8_t positions[HC_BLOCK];
    size_t refused = 0;
    int i, k;
    level->spread(positions, found.plus, found.minus);
    for (i = 0; i < waiting->count; i++) {
        int8_t answer = hc_answer(question, positions[i]);
        if (!(HC_FLOATS_DECIDE && found.decided >> i & 1)) {
            double row[10];
            for (k = 0; k < 10; k++) row[k] = waiting->columns[k * HC_BLOCK + i];
            if (hc_valid(row) && hc_has_direction(row + 7)) answer = hc_answer(question, hc_exact_tilted_position(row));
            else answer = 127, refused++;
        }
        answers[waiting->places[i]] = answer;
    }
    waiting->count = 0;
    return refused;
}

size_t hypcheck_ask_tilted(int question, size_t n, const double *rows10, int8_t *answers) {
    const hc_level_functions *level = hc_level();
    hc_tilted_waiting leaning;
    hc_waiting upright;
    size_t refused = 0, i;
    int k;
    memset(&leaning, 0, sizeof leaning);
    memset(&upright, 0, sizeof upright);
    for (i = 0; i < n; i++) {
        const double *const row = rows10 + 10 * i;
        if (hc_is_upright(row) && hc_has_direction(row + 7)) {
            for (k = 0; k < 7; k++) upright.columns[k * HC_BLOCK + upright.count] = row[k];
            upright.places[upright.count++] = i;
            if (upright.count == HC_BLOCK) refused += hc_settle(level, question, &upright, answers);
        } else {
            double axis[3] = {row[7], row[8], row[9]};
            hc_scale_axis(axis);
            for (k = 0; k < 7; k++) leaning.columns[k * HC_BLOCK + leaning.count] = row[k];
            for (k = 7; k < 10; k++) leaning.columns[k * HC_BLOCK + leaning.count] = axis[k - 7];
            leaning.places[leaning.count++] = i;
            if (leaning.count == HC_BLOCK) refused += hc_tilted_settle(level, question, &leaning, answers);
        }
    }
    refused += hc_settle(level, question, &upright, answers);
    return refused + hc_tilted_settle(level, question, &leaning, answers);
}

static size_t hc_tilted_wait(const hc_level_functions *level, int question, hc_tilted_waiting *waiting, size_t place,
                             double x, double y, double z, int8_t *answers) {
    const int at = waiting->count++;
    waiting->columns[4 * HC_BLOCK + at] = x;
    waiting->columns[5 * HC_BLOCK + at] = y;
    waiting->columns[6 * HC_BLOCK + at] = z;
    waiting->places[at] = place;
    return waiting->count == HC_BLOCK ? hc_tilted_settle(level, question, waiting, answers) : 0;
}

size_t hypcheck_ask_tilted_scene(int question, const double sizes[4], const double axis[3], size_t n, const double *x,
                                 const double *y, const double *z, int8_t *answers) {
    double probe[10] = {sizes[0], sizes[1], sizes[2], sizes[3], 0, 0, 0, axis[0], axis[1], axis[2]};
    const hc_level_functions *level = hc_level();
    hc_planes_function planes = level->one_plane;
    hc_tilted_waiting waiting;
    hc_tilted_scene scene;
    uint64_t left[HC_STRIP / HC_BLOCK];
    size_t refused = 0, start, i;
    int has_planes, block, k;
    if (!(hc_valid(probe) && hc_has_direction(axis))) {
        memset(answers, 127, n);
        return n;
    }
    if (hc_is_upright(probe)) return hypcheck_ask_scene(question, sizes, n, x, y, z, answers);
    hc_scale_axis(probe + 7);
    memset(&waiting, 0, sizeof waiting);
    for (k = 0; k < 10 * HC_BLOCK; k++) waiting.columns[k] = probe[k / HC_BLOCK];
    has_planes = n >= HC_LINES_FROM && hc_make_tilted_scene(&scene, sizes, probe + 7, n, x, y, z);
    for (start = 0; start < n; start += HC_STRIP) {
        const size_t end = n - start < HC_STRIP ? n : start + HC_STRIP;
        const int blocks = has_planes ? (int)((end - start) / HC_BLOCK) : 0;
        const size_t beyond = start + (size_t)(HC_BLOCK * blocks);
        int lefts = 0;
        if (blocks) planes(&scene, blocks, x + start, y + start, z + start, n >= HC_FAR_FROM, answers + start, left);
        if (question != HYPCHECK_POSITION)
            for (i = start; i < beyond; i++) answers[i] = hc_answer(question, answers[i]);
        for (block = 0; block < blocks; block++)
            for (; left[block]; left[block] &= left[block] - 1, lefts++) {
                i = start + (size_t)(HC_BLOCK * block + hc_lowest_bit(left[block]));
                refused += hc_tilted_wait(level, question, &waiting, i, x[i], y[i], z[i], answers);
            }
        if (lefts > HC_TOO_MANY_BY_PLANES && planes != level->two_planes) {
            hc_make_planes(&scene, 1, 2);
            planes = level->two_planes;
        }
        for (i = beyond; i < end; i++) refused += hc_tilted_wait(level, question, &waiting, i, x[i], y[i], z[i], answers);
    }
    return refused + hc_tilted_settle(level, question, &waiting, answers);
}

void hypcheck_classify_tilted(size_t n, const double *rows10, int8_t *positions) {
    hypcheck_ask_tilted(HYPCHECK_POSITION, n, rows10, positions);
}

void hypcheck_classify_tilted_scene(const double sizes[4], const double axis[3], size_t n, const double *x,
                                    const double *y, const double *z, int8_t *positions) {
    hypcheck_ask_tilted_scene(HYPCHECK_POSITION, sizes, axis, n, x, y, z, positions);
}
