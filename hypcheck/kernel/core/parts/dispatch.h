/* ---- which instruction set, and the public functions ---- */

typedef void (*hc_lines_function)(const hc_scene *, int, const double *, const double *, const double *, int,
                                  hc_signs *, uint64_t *);

typedef void (*hc_planes_function)(const hc_tilted_scene *, int, const double *, const double *, const double *, int,
                                   hc_signs *, uint64_t *);

typedef struct {
    const char *name;
    hc_bits (*certified)(const double *, size_t, int), (*tilted)(const double *, size_t, int);
    void (*spread)(int8_t *, uint64_t, uint64_t);
    void (*spread_all)(int8_t *, const hc_signs *, size_t);
    hc_lines_function one_line[4], two_lines[4]; /* by question */
    hc_planes_function one_plane, two_planes;
    void (*touches)(const double *, size_t, int, hc_touches *);
    void (*gaps)(const double *, size_t, int, const double *, const hc_touches *, hc_gaps *);
} hc_level_functions;

#define HC_QUESTIONS(lines, level) \
    { hc_##lines##_position_##level, hc_##lines##_exterior_##level, hc_##lines##_interior_##level, hc_##lines##_contact_##level }
#define HC_LEVEL_FUNCTIONS(level) \
    { #level, hc_certified_##level, hc_tilted_##level, hc_spread_##level, hc_spread_all_##level, \
      HC_QUESTIONS(one_line, level), HC_QUESTIONS(two_lines, level), hc_one_plane_##level, hc_two_planes_##level, \
      hc_touches_##level, hc_gaps_##level }

static const hc_level_functions hc_levels[] = {
    HC_LEVEL_FUNCTIONS(plain),
#if HC_X86
    HC_LEVEL_FUNCTIONS(sse2),
    HC_LEVEL_FUNCTIONS(avx2),
    HC_LEVEL_FUNCTIONS(avx512),
#elif HC_NEON
    HC_LEVEL_FUNCTIONS(neon),
#endif
};

#if HC_X86
/* The level of a processor with these bits of leaf 1, ecx, and leaf 7, ebx, where the system saves these registers. */
static int hc_level_of(unsigned leaf_1, unsigned leaf_7, unsigned saved) {
    const unsigned fma = 1u << 12, avx2 = 1u << 5 | 1u << 8; /* with bmi2 */
    const unsigned avx512 = avx2 | 1u << 16 | 1u << 17 | 1u << 30 | 1u << 31; /* f, dq, bw, vl */
    const unsigned of_avx = 0x06, of_avx512 = 0xe6;
    if (!(leaf_1 & fma)) return 1;
    if ((leaf_7 & avx512) == avx512 && (saved & of_avx512) == of_avx512) return 3;
    return (leaf_7 & avx2) == avx2 && (saved & of_avx) == of_avx ? 2 : 1;
}

/* What the processor has and the system saves. __builtin_cpu_supports would say it too, but not with every compiler:
   zig's runtime says no to everything. */
static int hc_best_level(void) {
    const unsigned system_saves = 1u << 27;
    unsigned a, b, c, d, leaf_1, saved, saved_high;
    if (__get_cpuid_max(0, NULL) < 7) return 1;
    __cpuid(1, a, b, leaf_1, d);
    if (!(leaf_1 & system_saves)) return 1; /* xgetbv would end the program */
    __asm__ volatile("xgetbv" : "=a"(saved), "=d"(saved_high) : "c"(0));
    __cpuid_count(7, 0, a, b, c, d);
    (void)a, (void)c, (void)d, (void)saved_high;
    return hc_level_of(leaf_1, b, saved);
}
#else
static int hc_best_level(void) { return HC_NEON; } /* every aarch64 has it */
#endif

static volatile int hc_level_in_use = -1;

static const hc_level_functions *hc_level(void) {
    if (hc_level_in_use < 0) hc_level_in_use = hc_best_level();
    return hc_levels + hc_level_in_use;
}

const char *hypcheck_level(void) { return hc_level()->name; }

int hypcheck_use_level(const char *name) {
    int level;
    for (level = hc_best_level(); level >= 0; level--)
        if (strcmp(hc_levels[level].name, name) == 0) {
            hc_level_in_use = level;
            return 1;
        }
    return 0;
}

const char *hypcheck_version(void) { return HYPCHECK_VERSION; }

static int8_t hc_answer(int question, int position) {
    switch (question) {
    case HYPCHECK_EXTERIOR: return position > 0;
    case HYPCHECK_INTERIOR: return position < 0;
    case HYPCHECK_CONTACT: return position == 0;
    default: return (int8_t)position;
    }
}

/* Rows that wait for the second stage, by columns, and where their answers go. */
typedef struct {
    double columns[7 * HC_BLOCK];
    size_t places[HC_BLOCK];
    hc_signs *kept; /* where answers are kept as bits; NULL: they are written as bytes */
    int count;
} hc_waiting;

static void hc_note(hc_signs *kept, size_t place, int answer) {
    hc_signs *const signs = kept + place / HC_BLOCK;
    const uint64_t bit = (uint64_t)1 << place % HC_BLOCK;
    signs->plus = answer == 1 ? signs->plus | bit : signs->plus & ~bit;
    signs->minus = answer == -1 ? signs->minus | bit : signs->minus & ~bit;
}

/* The later stages for all that wait. Returns the number of invalid rows. */
static size_t hc_settle(const hc_level_functions *level, int question, hc_waiting *waiting, int8_t *answers) {
    const hc_bits found = level->certified(waiting->columns, HC_BLOCK, waiting->count);
    int8_t positions[HC_BLOCK];
    size_t refused = 0;
    int i, k;
    level->spread(positions, found.plus, found.minus);
    for (i = 0; i < waiting->count; i++) {
        int8_t answer = hc_answer(question, positions[i]);
        if (!(HC_FLOATS_DECIDE && found.decided >> i & 1)) {
            double row[7];
            for (k = 0; k < 7; k++) row[k] = waiting->columns[k * HC_BLOCK + i];
            if (hc_valid(row)) answer = hc_answer(question, hc_exact_position(row));
            else answer = 127, refused++;
        }
        if (waiting->kept != NULL) hc_note(waiting->kept, waiting->places[i], answer);
        else answers[waiting->places[i]] = answer;
    }
    waiting->count = 0;
    return refused;
}

size_t hypcheck_ask(int question, size_t n, const double *rows, int8_t *answers) {
    const hc_level_functions *level = hc_level();
    hc_waiting waiting;
    size_t refused = 0, i;
    int k;
    memset(&waiting, 0, sizeof waiting);
    for (i = 0; i < n; i++) {
        for (k = 0; k < 7; k++) waiting.columns[k * HC_BLOCK + waiting.count] = rows[7 * i + (size_t)k];
        waiting.places[waiting.count++] = i;
        if (waiting.count == HC_BLOCK) refused += hc_settle(level, question, &waiting, answers);
    }
    return refused + hc_settle(level, question, &waiting, answers);
}

static size_t hc_wait(const hc_level_functions *level, int question, hc_waiting *waiting, size_t place, double x,
                      double y, double z, int8_t *answers) {
    const int at = waiting->count++;
    waiting->columns[4 * HC_BLOCK + at] = x;
    waiting->columns[5 * HC_BLOCK + at] = y;
    waiting->columns[6 * HC_BLOCK + at] = z;
    waiting->places[at] = place;
    return waiting->count == HC_BLOCK ? hc_settle(level, question, waiting, answers) : 0;
}

static size_t hc_blocks(size_t rows) { return (rows + HC_BLOCK - 1) / HC_BLOCK; }

/* Makes place for n rows of one scene, or for a block of them. What a vector reads behind the last row is a number, too. */
static void hc_begin(hc_waiting *waiting, const double sizes[4], size_t n, hc_signs *kept) {
    const int rows = n < HC_BLOCK ? ((int)n + HC_WIDEST - 1) / HC_WIDEST * HC_WIDEST : HC_BLOCK;
    int k, i;
    for (k = 0; k < 7; k++)
        for (i = 0; i < rows; i++) waiting->columns[k * HC_BLOCK + i] = k < 4 ? sizes[k] : 0;
    waiting->count = 0;
    waiting->kept = kept;
}

/* Centres of one scene that come part by part. */
typedef struct {
    const hc_level_functions *level;
    const hc_scene *scene; /* its half planes, or NULL where the first stage is left out */
    int question, asked, fetch, lefts; /* `asked` is `question`, or HYPCHECK_POSITION for a number that is none */
    hc_lines_function lines;
    hc_signs *kept; /* where answers are kept as bits: one hc_signs for each block of rows, and 0 for invalid ones; or NULL */
    int8_t *answers;
    hc_waiting waiting;
} hc_upright_parts;

static void hc_begin_upright(hc_upright_parts *run, int question, const double sizes[4], const hc_scene *scene, size_t n,
                             int8_t *answers, hc_signs *kept) {
    run->asked = question >= HYPCHECK_POSITION && question <= HYPCHECK_CONTACT ? question : HYPCHECK_POSITION;
    run->level = hc_level();
    run->scene = scene;
    run->question = question;
    run->fetch = n >= HC_FAR_FROM;
    run->lefts = 0;
    run->lines = run->level->one_line[run->asked];
    run->kept = kept;
    run->answers = answers;
    hc_begin(&run->waiting, sizes, n, kept);
}

/* Rows `start` to `start` + `count`, HC_STRIP at most; all parts but the last are whole blocks. Returns the number of
   invalid ones that it came upon. */
static size_t hc_upright_part(hc_upright_parts *run, size_t start, size_t count, const double *x, const double *y, const double *z) {
    const int blocks = run->scene != NULL ? (int)(count / HC_BLOCK) : 0;
    const size_t beyond = (size_t)(HC_BLOCK * blocks);
    hc_signs own[HC_STRIP / HC_BLOCK], *const signs = run->kept != NULL ? run->kept + start / HC_BLOCK : own;
    uint64_t left[HC_STRIP / HC_BLOCK];
    size_t refused = 0, i;
    int block;
    if (blocks) run->lines(run->scene, blocks, x, y, z, run->fetch, signs, left);
    if (run->kept == NULL) run->level->spread_all(run->answers + start, signs, (size_t)blocks);
    else if (beyond < count) memset(signs + blocks, 0, hc_blocks(count - beyond) * sizeof *signs);
    for (block = 0; block < blocks; block++)
        for (; left[block]; left[block] &= left[block] - 1, run->lefts++) {
            i = (size_t)(HC_BLOCK * block + hc_lowest_bit(left[block]));
            refused += hc_wait(run->level, run->question, &run->waiting, start + i, x[i], y[i], z[i], run->answers);
        }
    if (run->lefts > HC_TOO_MANY_LEFT) run->lines = run->level->two_lines[run->asked];
    if ((start + count) % HC_STRIP == 0) run->lefts = 0;
    for (i = beyond; i < count; i++)
        refused += hc_wait(run->level, run->question, &run->waiting, start + i, x[i], y[i], z[i], run->answers);
    return refused;
}

static size_t hc_end_upright(hc_upright_parts *run) {
    return hc_settle(run->level, run->question, &run->waiting, run->answers);
}

/* Answers for valid sizes, written or kept as bits. */
static size_t hc_ask_upright(int question, const double sizes[4], const hc_scene *scene, size_t n, const double *x,
                             const double *y, const double *z, int8_t *answers, hc_signs *kept) {
    hc_upright_parts run;
    size_t refused = 0, start;
    hc_begin_upright(&run, question, sizes, scene, n, answers, kept);
    for (start = 0; start < n; start += HC_STRIP)
        refused += hc_upright_part(&run, start, n - start < HC_STRIP ? n - start : HC_STRIP, x + start, y + start, z + start);
    return refused + hc_end_upright(&run);
}

static size_t hc_refuse_all(size_t n, int8_t *answers) {
    memset(answers, 127, n);
    return n;
}

size_t hypcheck_ask_scene(int question, const double sizes[4], size_t n, const double *x, const double *y,
                          const double *z, int8_t *answers) {
    const double probe[7] = {sizes[0], sizes[1], sizes[2], sizes[3], 0, 0, 0};
    hc_scene scene;
    int has_lines;
    if (!hc_valid(probe)) return hc_refuse_all(n, answers);
    has_lines = n >= HC_LINES_FROM && hc_make_scene(&scene, sizes, n, z);
    return hc_ask_upright(question, sizes, has_lines ? &scene : NULL, n, x, y, z, answers, NULL);
}

void hypcheck_classify(size_t n, const double *rows, int8_t *positions) {
    hypcheck_ask(HYPCHECK_POSITION, n, rows, positions);
}

void hypcheck_classify_scene(const double sizes[4], size_t n, const double *x, const double *y, const double *z,
                             int8_t *positions) {
    hypcheck_ask_scene(HYPCHECK_POSITION, sizes, n, x, y, z, positions);
}

int hypcheck_position(double alpha, double gamma, double b, double d, double x, double y, double z) {
    const double row[7] = {alpha, gamma, b, d, x, y, z};
    return hc_position_of(row);
}
