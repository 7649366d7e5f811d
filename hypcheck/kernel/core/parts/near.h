/* ---- clearances, distances and nearest points ---- */

/* The next number farther from 0 (step 1), or nearer (-1), than a positive finite one. */
static double hc_next(double number, int step) {
    uint64_t word;
    memcpy(&word, &number, sizeof word);
    word += (uint64_t)(int64_t)step;
    memcpy(&number, &word, sizeof number);
    return number;
}

/* b and d times a factor, rounded away from 0 (step 1) or towards it (-1). Returns 0 where one leaves the range. */
static int hc_grow(const double sizes[4], double factor, int step, double grown[2]) {
    int k;
    for (k = 0; k < 2; k++) {
        grown[k] = sizes[2 + k] * factor;
        if (!(grown[k] > HC_least_grown && grown[k] < HC_greatest_grown)) return 0;
        if (factor != 1) grown[k] = hc_next(grown[k], step);
    }
    return 1;
}

static int hc_position_grown(const double row[7], const double grown[2]) {
    double other[7];
    memcpy(other, row, sizeof other);
    other[2] = grown[0], other[3] = grown[1];
    return hc_position_of(other);
}

/* Halves what is known of 1 + clearance, by exact decisions, until it is HC_width wide or nothing more is proved. Each turn halves
   the exponents from `least` to `most`, or what lies between the two: some 45 turns at most, as these are in 2^±1100. Where x87 is
   set to 24 bits, the middle of two near numbers may round to beyond either. */
static void hc_halve_factor(const double row[7], double *low, double *high) {
    const double largest = HC_greatest_grown / HC_MAX_OF(row[2], row[3]) / 2;
    while (*high - *low > HC_width * HC_MAX_OF(*low, 1)) {
        const double least = HC_MAX_OF(*low, HC_width / 2), most = HC_MIN_OF(*high, largest);
        double grown[2];
        HC_STORED middle;
        middle = most > 2 * least ? hc_fine_root(least) * hc_fine_root(most) : least + 0.5 * (most - least);
        if (!(middle > *low && middle < *high)) return;
        if (hc_grow(row, middle, 1, grown) && hc_position_grown(row, grown) != 0) *low = middle;
        else if (hc_grow(row, middle, -1, grown) && hc_position_grown(row, grown) == 0) *high = middle;
        else return;
    }
}

/* The same for a distance, by spheroids that hold all points so near: `width` is the half width along the gap. Each turn halves
   high - low, which ends at the least at HC_width low, far above the last places of both. */
static double hc_halve_distance(const double row[7], double low, double high, double width) {
    while (high - low > HC_width * (low + width)) {
        const HC_STORED middle = low + 0.5 * (high - low);
        double grown[2];
        int k, clear = 1;
        for (k = 0; k < 2; k++) {
            grown[k] = HC_outward * hc_fine_root((width + middle) * (row[2 + k] * row[2 + k] / width + middle));
            clear = clear && grown[k] > HC_least_grown; /* a root is below 2^513, or NaN */
        }
        if (clear && hc_position_grown(row, grown) != 0) low = middle;
        else high = middle;
    }
    return low;
}

/* factor - 1, moved towards a side by more than its rounding; 0 stays. */
static double hc_less_one(double factor, int up) {
    const double less = factor - 1;
    if (less == 0 || !(less < HC_greatest_grown)) return less;
    return hc_next(less, (less > 0) == up ? 1 : -1);
}

/* Whether the bounds of errors hold for a row: ordinary lengths, and a direction from the axis that is known. */
static int hc_ordinary(const double row[7]) {
    const double x = row[4], y = row[5], z = row[6], far = HC_greatest, off = HC_least_offset;
    const int on_axis = (x == 0) & (y == 0), beside = (x >= off) | (x <= -off) | (y >= off) | (y <= -off);
    int k, ordinary = HC_FLOATS_DECIDE & (on_axis | beside); /* no branch: what a row is like is not foreseen */
    ordinary = ordinary & (x <= far) & (x >= -far) & (y <= far) & (y >= -far) & (z <= far) & (z >= -far);
    for (k = 0; k < 4; k++) ordinary = ordinary & (row[k] >= HC_least) & (row[k] <= HC_greatest);
    return ordinary & (row[2] <= HC_greatest_ratio * row[3]) & (row[3] <= HC_greatest_ratio * row[2]);
}

/* What is known of the rows of one block. */
typedef struct {
    const double *rows[HC_BLOCK];
    double columns[7 * HC_BLOCK], sides[HC_BLOCK], low[HC_BLOCK], high[HC_BLOCK];
    int ordinary[HC_BLOCK];
    hc_touches touches;
    hc_gaps gaps;
} hc_near;

/* The positions of all rows of a block with other b and d. */
static void hc_settle_grown(const hc_level_functions *level, hc_near *near, const double *b, const double *d, int8_t *positions) {
    hc_bits found;
    uint64_t left;
    memcpy(near->columns + 2 * HC_BLOCK, b, HC_BLOCK * sizeof *b);
    memcpy(near->columns + 3 * HC_BLOCK, d, HC_BLOCK * sizeof *d);
    found = level->certified(near->columns, HC_BLOCK, HC_BLOCK);
    level->spread(positions, found.plus, found.minus);
    for (left = HC_FLOATS_DECIDE ? ~found.decided : ~(uint64_t)0; left; left &= left - 1) {
        const int i = hc_lowest_bit(left);
        const double row[7] = {near->rows[i][0], near->rows[i][1], b[i], d[i], near->rows[i][4], near->rows[i][5], near->rows[i][6]};
        positions[i] = (int8_t)(hc_valid(row) ? hc_exact_position(row) : 127);
    }
}

/* Positions of valid rows, and what factors of growth keep them clear, or bring them into contact: low and high. */
static void hc_factors(const hc_level_functions *level, hc_near *near, int count, int8_t *positions) {
    const hc_touches *const touches = &near->touches;
    int8_t inner[HC_BLOCK], outer[HC_BLOCK];
    int i;
    hc_settle_grown(level, near, touches->inner_b, touches->inner_d, inner);
    hc_settle_grown(level, near, touches->outer_b, touches->outer_d, outer);
    for (i = 0; i < count; i++) {
        const double low = touches->low[i], high = touches->high[i];
        const int clear = near->ordinary[i] & ((inner[i] == 1) | (inner[i] == -1)), meets = near->ordinary[i] & (outer[i] == 0);
        const int surely_clear = clear & (low >= 1), known = surely_clear | (meets & (high <= 1));
        const int position = known ? surely_clear * inner[i] : hc_position_of(near->rows[i]);
        positions[i] = (int8_t)position;
        near->sides[i] = position;
        near->low[i] = clear && low > (position ? 1 : 0) ? low : (position ? 1 : 0);
        near->high[i] = meets && high < (position ? HC_NEVER : 1) ? high : (position ? HC_NEVER : 1);
        if (near->high[i] - near->low[i] > HC_width * HC_MAX_OF(near->low[i], 1)) hc_halve_factor(near->rows[i], near->low + i, near->high + i);
    }
}

/* The distance of a row that is clear, and the nearest point; `layer` is the position of the spheroid that was tried. */
static void hc_distance(const hc_near *near, int i, int layer, hypcheck_near *found) {
    const double *const row = near->rows[i], tried = near->gaps.tried[i], width = near->gaps.width[i];
    double least = found->lower * HC_MIN_OF(row[2], row[3]) * HC_less_than;
    double most = found->upper * HC_MAX_OF(row[2], row[3]) * HC_more_than;
    if (!(least > HC_least_grown)) least = 0;
    if (!(most > HC_least_grown && most < HC_greatest_grown)) most = HC_NEVER;
    if (near->ordinary[i]) {
        if (near->gaps.most[i] <= most) {
            most = near->gaps.most[i];
            found->nearest[0] = near->gaps.radius[i] * near->touches.cosine[i];
            found->nearest[1] = near->gaps.radius[i] * near->touches.sine[i];
            found->nearest[2] = near->touches.sign[i] * near->gaps.height[i];
        }
        if (tried > least && (layer == 1 || layer == -1)) least = tried;
        else if (most < HC_NEVER) least = hc_halve_distance(row, least, most, width);
    }
    found->distance_lower = least;
    found->distance_upper = most;
}

static void hc_near_block(const hc_level_functions *level, hc_near *near, int count, int8_t *positions, hypcheck_near *found) {
    const hc_touches *const touches = &near->touches;
    int8_t layers[HC_BLOCK];
    int i;
    level->touches(near->columns, HC_BLOCK, HC_BLOCK, &near->touches);
    hc_factors(level, near, count, positions);
    for (i = 0; i < HC_BLOCK; i++) {
        near->columns[2 * HC_BLOCK + i] = near->rows[i][2];
        near->columns[3 * HC_BLOCK + i] = near->rows[i][3];
    }
    level->gaps(near->columns, HC_BLOCK, HC_BLOCK, near->sides, &near->touches, &near->gaps);
    hc_settle_grown(level, near, near->gaps.inner_b, near->gaps.inner_d, layers);
    for (i = 0; i < count; i++) {
        const double lower = hc_less_one(near->low[i], 0), sign = touches->sign[i];
        found[i].lower = lower > -1 ? lower : -1;
        found[i].upper = hc_less_one(near->high[i], 1);
        found[i].touch[0] = touches->radius[i] * touches->cosine[i];
        found[i].touch[1] = touches->radius[i] * touches->sine[i];
        found[i].touch[2] = sign * touches->height[i];
        found[i].touch_error = near->ordinary[i] && touches->error[i] < HC_NEVER ? touches->error[i] : HC_NEVER;
        memcpy(found[i].nearest, found[i].touch, sizeof found[i].nearest);
        found[i].distance_lower = found[i].distance_upper = 0;
        if (positions[i]) hc_distance(near, i, layers[i], found + i);
    }
}

size_t hypcheck_clearance(size_t n, const double *rows, int8_t *positions, hypcheck_near *found) {
    const hc_level_functions *level = hc_level();
    const double benign[7] = {1, 1, 1, 1, 3, 0, 0};
    size_t refused = 0, start;
    hc_near near;
    int i, k;
    for (start = 0; start < n; start += HC_BLOCK) {
        const int count = n - start < HC_BLOCK ? (int)(n - start) : HC_BLOCK;
        uint64_t invalid = 0;
        for (i = 0; i < HC_BLOCK; i++) {
            const double *row = i < count ? rows + 7 * (start + (size_t)i) : benign;
            near.ordinary[i] = hc_ordinary(row);
            if (!near.ordinary[i] && !hc_valid(row)) {
                row = benign;
                invalid |= (uint64_t)1 << i;
            }
            near.sides[i] = 1;
            near.rows[i] = row;
            for (k = 0; k < 7; k++) near.columns[k * HC_BLOCK + i] = row[k];
        }
        hc_near_block(level, &near, count, positions + start, found + start);
        for (; invalid; invalid &= invalid - 1, refused++) {
            const size_t place = start + (size_t)hc_lowest_bit(invalid);
            double *const numbers = &found[place].lower;
            for (k = 0; k < HYPCHECK_NEAR_NUMBERS; k++) numbers[k] = hc_nothing_known();
            positions[place] = 127;
        }
    }
    return refused;
}
