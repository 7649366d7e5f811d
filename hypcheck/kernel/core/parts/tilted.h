
/* ---- spheroids whose axis leans: the public functions ---- */

typedef struct {
    double columns[10 * HC_BLOCK];
    size_t places[HC_BLOCK];
    int count;
} hc_tilted_waiting;

/* The floats, and the integers for what they leave. */
static void hc_tilted_settle(const hc_level_functions *level, hc_tilted_waiting *waiting, int8_t *positions) {
    const hc_bits found = level->tilted(waiting->columns, HC_BLOCK, waiting->count);
    int8_t answers[HC_BLOCK];
    int i, k;
    level->spread(answers, found.plus, found.minus);
    for (i = 0; i < waiting->count; i++) {
        int8_t answer = answers[i];
        if (!(HC_FLOATS_DECIDE && found.decided >> i & 1)) {
            double row[10];
            for (k = 0; k < 10; k++) row[k] = waiting->columns[k * HC_BLOCK + i];
            answer = (int8_t)(hc_tilted_valid(row) ? hc_exact_tilted_position(row) : 127);
        }
        positions[waiting->places[i]] = answer;
    }
    waiting->count = 0;
}

void hypcheck_classify_tilted(size_t n, const double *rows10, int8_t *positions) {
    const hc_level_functions *level = hc_level();
    hc_tilted_waiting leaning;
    hc_waiting upright;
    size_t i;
    int k;
    memset(&leaning, 0, sizeof leaning);
    memset(&upright, 0, sizeof upright);
    for (i = 0; i < n; i++) {
        const double *const row = rows10 + 10 * i;
        if (hc_is_upright(row) && hc_tilted_valid(row)) {
            for (k = 0; k < 7; k++) upright.columns[k * HC_BLOCK + upright.count] = row[k];
            upright.places[upright.count++] = i;
            if (upright.count == HC_BLOCK) hc_settle(level, HYPCHECK_POSITION, &upright, positions);
        } else {
            for (k = 0; k < 10; k++) leaning.columns[k * HC_BLOCK + leaning.count] = row[k];
            leaning.places[leaning.count++] = i;
            if (leaning.count == HC_BLOCK) hc_tilted_settle(level, &leaning, positions);
        }
    }
    hc_settle(level, HYPCHECK_POSITION, &upright, positions);
    hc_tilted_settle(level, &leaning, positions);
}

void hypcheck_classify_tilted_scene(const double sizes[4], const double axis[3], size_t n, const double *x,
                                    const double *y, const double *z, int8_t *positions) {
    const double probe[10] = {sizes[0], sizes[1], sizes[2], sizes[3], 0, 0, 0, axis[0], axis[1], axis[2]};
    const hc_level_functions *level = hc_level();
    hc_tilted_waiting leaning;
    size_t i;
    int k;
    if (!hc_tilted_valid(probe)) {
        memset(positions, 127, n);
        return;
    }
    if (hc_is_upright(probe)) {
        hypcheck_classify_scene(sizes, n, x, y, z, positions);
        return;
    }
    memset(&leaning, 0, sizeof leaning);
    for (k = 0; k < 10 * HC_BLOCK; k++) leaning.columns[k] = probe[k / HC_BLOCK];
    for (i = 0; i < n; i++) {
        leaning.columns[4 * HC_BLOCK + leaning.count] = x[i];
        leaning.columns[5 * HC_BLOCK + leaning.count] = y[i];
        leaning.columns[6 * HC_BLOCK + leaning.count] = z[i];
        leaning.places[leaning.count++] = i;
        if (leaning.count == HC_BLOCK) hc_tilted_settle(level, &leaning, positions);
    }
    hc_tilted_settle(level, &leaning, positions);
}
