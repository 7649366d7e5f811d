
/* ---- tilted spheroids: the public functions ---- */

typedef struct {
    double columns[10 * HC_BLOCK];
    size_t places[HC_BLOCK];
    hc_signs *kept; /* as in hc_waiting */
    int count;
} hc_tilted_waiting;

/* An axis of any length as one for which floats have room: times a power of two, where no number becomes subnormal by it.
   A number of exponent field 0 may be 2^52 smaller than that says. NaN stays. The integers need none of it, and x87 may be
   set to 24 bits, where these products are rounded. */
static void hc_scale_axis(double axis[3]) {
    int i, most = 0, least = 4096;
    if (!HC_FLOATS_DECIDE) return;
    for (i = 0; i < 3; i++) {
        const int top = (int)(hc_word(axis[i]) << 1 >> 53);
        most = top > most ? top : most;
    }
    if (most > 1023 - 40 && most < 1023 + 40) return; /* nearly always; no branch depends on which number is greatest */
    for (i = 0; i < 3; i++) {
        const uint64_t word = hc_word(axis[i]) << 1;
        if (word != 0) least = hc_least(least, (int)(word >> 53));
    }
    if (least == 4096 || most == 2047 || most - least > (least ? 1020 : 960)) return;
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
        if (waiting->kept != NULL) hc_note(waiting->kept, waiting->places[i], answer);
        else answers[waiting->places[i]] = answer;
    }
    waiting->count = 0;
    return refused;
}

/* Rows begin with the ten numbers, and are `width` doubles apart. */
static size_t hc_ask_rows(int question, size_t n, size_t width, const double *rows, int8_t *answers) {
    const hc_level_functions *level = hc_level();
    hc_tilted_waiting tilted;
    hc_waiting upright;
    size_t refused = 0, i;
    int k;
    memset(&tilted, 0, sizeof tilted);
    memset(&upright, 0, sizeof upright);
    for (i = 0; i < n; i++) {
        const double *const row = rows + width * i;
        if (hc_is_upright(row) && hc_has_direction(row + 7)) {
            for (k = 0; k < 7; k++) upright.columns[k * HC_BLOCK + upright.count] = row[k];
            upright.places[upright.count++] = i;
            if (upright.count == HC_BLOCK) refused += hc_settle(level, question, &upright, answers);
        } else {
            double axis[3] = {row[7], row[8], row[9]};
            hc_scale_axis(axis);
            for (k = 0; k < 7; k++) tilted.columns[k * HC_BLOCK + tilted.count] = row[k];
            for (k = 7; k < 10; k++) tilted.columns[k * HC_BLOCK + tilted.count] = axis[k - 7];
            tilted.places[tilted.count++] = i;
            if (tilted.count == HC_BLOCK) refused += hc_tilted_settle(level, question, &tilted, answers);
        }
    }
    refused += hc_settle(level, question, &upright, answers);
    return refused + hc_tilted_settle(level, question, &tilted, answers);
}

size_t hypcheck_ask_tilted(int question, size_t n, const double *rows10, int8_t *answers) {
    return hc_ask_rows(question, n, 10, rows10, answers);
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

/* As hc_upright_parts: sizes and an axis with a direction, scaled, that is not upright, are valid. The question is the
   position where answers are kept. The second half spaces are made when they are needed. */
typedef struct {
    const hc_level_functions *level;
    int question, fetch, lefts, has_planes;
    hc_planes_function planes;
    hc_signs *kept;
    int8_t *answers;
    hc_tilted_waiting waiting;
    hc_tilted_scene scene;
} hc_tilted_parts;

/* `probe` has sizes and axis as a row. `known` has the half spaces, or is NULL where the first stage is left out. */
static void hc_begin_tilted(hc_tilted_parts *run, int question, const double probe[10], const hc_tilted_scene *known, size_t n,
                             int8_t *answers, hc_signs *kept) {
    int k;
    run->level = hc_level();
    run->question = question;
    run->fetch = n >= HC_FAR_FROM;
    run->lefts = 0;
    run->has_planes = known != NULL;
    run->planes = run->level->one_plane;
    run->kept = kept;
    run->answers = answers;
    if (known != NULL) run->scene = *known;
    memset(&run->waiting, 0, sizeof run->waiting);
    run->waiting.kept = kept;
    for (k = 0; k < 10 * HC_BLOCK; k++) run->waiting.columns[k] = probe[k / HC_BLOCK];
}

/* As hc_upright_part. */
static size_t hc_tilted_part(hc_tilted_parts *run, size_t start, size_t count, const double *x, const double *y, const double *z) {
    const int blocks = run->has_planes ? (int)(count / HC_BLOCK) : 0;
    const size_t beyond = (size_t)(HC_BLOCK * blocks);
    hc_signs own[HC_STRIP / HC_BLOCK], *const signs = run->kept != NULL ? run->kept + start / HC_BLOCK : own;
    uint64_t left[HC_STRIP / HC_BLOCK];
    int8_t *const answers = run->answers;
    size_t refused = 0, i;
    int block;
    if (blocks) run->planes(&run->scene, blocks, x, y, z, run->fetch, signs, left);
    if (run->kept == NULL) run->level->spread_all(answers + start, signs, (size_t)blocks);
    else if (beyond < count) memset(signs + blocks, 0, hc_blocks(count - beyond) * sizeof *signs);
    if (run->kept == NULL && run->question != HYPCHECK_POSITION)
        for (i = start; i < start + beyond; i++) answers[i] = hc_answer(run->question, answers[i]);
    for (block = 0; block < blocks; block++)
        for (; left[block]; left[block] &= left[block] - 1, run->lefts++) {
            i = (size_t)(HC_BLOCK * block + hc_lowest_bit(left[block]));
            refused += hc_tilted_wait(run->level, run->question, &run->waiting, start + i, x[i], y[i], z[i], answers);
        }
    if (run->lefts > HC_TOO_MANY_BY_PLANES && run->planes != run->level->two_planes) {
        if (!run->scene.has_two) hc_make_planes(&run->scene, 1, 2);
        run->planes = run->level->two_planes;
    }
    if ((start + count) % HC_STRIP == 0) run->lefts = 0;
    for (i = beyond; i < count; i++)
        refused += hc_tilted_wait(run->level, run->question, &run->waiting, start + i, x[i], y[i], z[i], answers);
    return refused;
}

static size_t hc_end_tilted(hc_tilted_parts *run) {
    return hc_tilted_settle(run->level, run->question, &run->waiting, run->answers);
}

static size_t hc_ask_tilted(int question, const double probe[10], const hc_tilted_scene *known, size_t n, const double *x,
                             const double *y, const double *z, int8_t *answers, hc_signs *kept) {
    hc_tilted_parts run;
    size_t refused = 0, start;
    hc_begin_tilted(&run, question, probe, known, n, answers, kept);
    for (start = 0; start < n; start += HC_STRIP)
        refused += hc_tilted_part(&run, start, n - start < HC_STRIP ? n - start : HC_STRIP, x + start, y + start, z + start);
    return refused + hc_end_tilted(&run);
}

size_t hypcheck_ask_tilted_scene(int question, const double sizes[4], const double axis[3], size_t n, const double *x,
                                 const double *y, const double *z, int8_t *answers) {
    double probe[10] = {sizes[0], sizes[1], sizes[2], sizes[3], 0, 0, 0, axis[0], axis[1], axis[2]};
    hc_tilted_scene scene;
    int has_planes;
    if (!(hc_valid(probe) && hc_has_direction(axis))) return hc_refuse_all(n, answers);
    if (hc_is_upright(probe)) return hypcheck_ask_scene(question, sizes, n, x, y, z, answers);
    hc_scale_axis(probe + 7);
    has_planes = n >= HC_PLANES_FROM && hc_make_tilted_scene(&scene, sizes, probe + 7, n, x, y, z);
    return hc_ask_tilted(question, probe, has_planes ? &scene : NULL, n, x, y, z, answers, NULL);
}

void hypcheck_classify_tilted(size_t n, const double *rows10, int8_t *positions) {
    hypcheck_ask_tilted(HYPCHECK_POSITION, n, rows10, positions);
}

void hypcheck_classify_tilted_scene(const double sizes[4], const double axis[3], size_t n, const double *x,
                                    const double *y, const double *z, int8_t *positions) {
    hypcheck_ask_tilted_scene(HYPCHECK_POSITION, sizes, axis, n, x, y, z, positions);
}

/* ---- a scene that is prepared once ---- */

/* What a hypcheck_scene holds. `lines` and `planes` say whether the first stage has its half planes, or half spaces. */
typedef struct {
    double probe[10];
    int valid, upright, lines, planes;
    union {
        hc_scene upright;
        hc_tilted_scene tilted;
    } of;
} hc_prepared;

typedef char hc_prepared_fits[sizeof(hc_prepared) <= sizeof(hypcheck_scene) ? 1 : -1];

/* Heights for a scene of which no centre is known: as far up as the hyperboloid is about twice as wide as at its waist. */
static void hc_prepare_lines(hc_prepared *made, size_t n, const double *x, const double *y, const double *z) {
    const double *const sizes = made->probe;
    const double usual_x[2] = {0, sizes[0]}, usual_y[2] = {0, 0}, usual_z[2] = {0, 1.75 * sizes[1]};
    if (n == 0) n = 2, x = usual_x, y = usual_y, z = usual_z;
    if (made->upright) {
        made->lines = hc_make_scene(&made->of.upright, sizes, n, z);
    } else {
        made->planes = hc_make_tilted_scene(&made->of.tilted, sizes, made->probe + 7, n, x, y, z);
        if (made->planes) hc_make_planes(&made->of.tilted, 1, 2), made->of.tilted.has_two = 1;
    }
}

void hypcheck_prepare(hypcheck_scene *scene, const double sizes[4], const double axis[3], size_t n, const double *x,
                      const double *y, const double *z) {
    hc_prepared made;
    memset(&made, 0, sizeof made);
    memcpy(made.probe, sizes, 4 * sizeof *sizes);
    made.probe[9] = 1;
    if (axis != NULL) memcpy(made.probe + 7, axis, 3 * sizeof *axis);
    made.valid = hc_valid(made.probe) && hc_has_direction(made.probe + 7);
    made.upright = hc_is_upright(made.probe);
    if (!made.upright) hc_scale_axis(made.probe + 7);
    if (made.valid) hc_prepare_lines(&made, n, x, y, z);
    memset(scene, 0, sizeof *scene);
    memcpy(scene, &made, sizeof made);
}

static size_t hc_ask_kept(int question, const hc_prepared *made, size_t n, const double *x, const double *y, const double *z,
                          int8_t *answers, hc_signs *kept) {
    if (made->upright)
        return hc_ask_upright(question, made->probe, made->lines ? &made->of.upright : NULL, n, x, y, z, answers, kept);
    return hc_ask_tilted(question, made->probe, made->planes ? &made->of.tilted : NULL, n, x, y, z, answers, kept);
}

size_t hypcheck_ask_prepared(int question, const hypcheck_scene *scene, size_t n, const double *x, const double *y,
                             const double *z, int8_t *answers) {
    hc_prepared made;
    memcpy(&made, scene, sizeof made);
    return made.valid ? hc_ask_kept(question, &made, n, x, y, z, answers, NULL) : hc_refuse_all(n, answers);
}
