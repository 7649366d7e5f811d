/* Asks hypcheck.h everything that a file of questions holds and compares the answers with the file's. Ends with 1 and the
   first row that is answered wrong; else it prints how much each stage decided, which a weaker bound would lower.

   The file has batches: kind, rounding modes as bits, rows, numbers a row; the rows; and an answer for each. */

#include <fenv.h>
#include <float.h>
#include <stdio.h>
#include <stdlib.h>

#define HYPCHECK_IMPLEMENTATION
#include "hypcheck.h"
#include "guards.h"
#include "exact_guards.h"
#include "limits.h"
#include "ended_guards.h"
#include "ended_sweep_guards.h"

enum { ROWS, LEANING, SCENE, LEANING_SCENE, WAYS, CLEARANCES = 6, ENDED };
enum { MODES = 4 };
static const int modes[MODES] = {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};

typedef struct {
    int32_t kind, modes, n, width;
    double *rows;
    int8_t *right;
} batch;

static long counts[24];
static const char *const names[] = {"single", "certified", "fixed point", "tangencies", "roots in 128 bits", "roots in 256 bits",
                                    "in the plane", "one line", "two lines", "tilted", "one plane", "two planes",
                                    "ways", "times", "clearances", "touches", "distances", "gaps",
                                    "rows beside ends", "ways beside ends", "times beside ends", "near times"};
enum { SINGLE, CERTIFIED, FIXED, TANGENCIES, IN_128, IN_256, IN_PLANE, ONE_LINE, TWO_LINES, TILTED, ONE_PLANE, TWO_PLANES,
       DECIDED_WAYS, TIMES, NARROW, TOUCHES, DISTANCES, GAPS, ENDED_ROWS, ENDED_WAYS, ENDED_TIMES, NEAR_TIMES, ALL };

static void wrong(const batch *b, int mode, int i, const char *what, int found) {
    int k;
    fesetround(FE_TONEAREST);
    printf("wrong: kind %d, mode %d, %s: %d, right is %d:", (int)b->kind, mode, what, found, b->right[i]);
    for (k = 0; k < b->width; k++) printf(" %a", b->rows[b->width * i + k]);
    printf("\n");
    exit(1);
}

static long ones(uint64_t bits) {
    long count = 0;
    for (; bits; bits &= bits - 1) count++;
    return count;
}

static int answer_of(int question, int position) {
    if (position == 127) return 127;
    return question == 1 ? position > 0 : question == 2 ? position < 0 : question == 3 ? position == 0 : position;
}

static void no_other(const batch *b, int mode, int i, const char *what, int found) {
    if (found != 2 && found != b->right[i]) wrong(b, mode, i, what, found);
}

/* The exact stages one by one, those too that an earlier stage spares: each says what is right, or that it does not tell. Few of
   their numbers are floats: once, rounding to nearest, is enough. */
static void ask_exact_stages(const batch *b, int mode, int i) {
    const double *const r = b->rows + b->width * i;
    const hc_fixed_terms terms = hc_fixed_terms_of(r);
    const hc_fixed_cubic cubic = hc_fixed_cubic_of(&terms);
    uint64_t lengths[7];
    double about;
    const int fixed = hc_fixed_position(r, &about), bits = hc_short_lengths(r, lengths);
    const double guess = hc_fixed_double_root(&cubic);
    const int beside = hc_position_beside_tangency(r, guess), integers = hc_position_by_integers(r);
    no_other(b, mode, i, "fixed point", fixed);
    no_other(b, mode, i, "beside a tangency", beside);
    if (integers != b->right[i]) wrong(b, mode, i, "integers", integers);
    counts[FIXED] += fixed != 2;
    counts[TANGENCIES] += fixed == 2 && hc_position_beside_tangency(r, about) != 2;
    if (bits > HC_TANGENCY_BITS) return;
    if (hc_touches_by(lengths, guess) != 2) counts[IN_256]++, no_other(b, mode, i, "a double root in 256 bits", 0);
    if (bits <= 23 && hc_touches_by_short(lengths, guess) != 2) counts[IN_128]++, no_other(b, mode, i, "a double root", 0);
    if (r[6] != 0) return;
    no_other(b, mode, i, "the plane of the waist", hc_position_in_plane(lengths));
    counts[IN_PLANE] += hc_position_in_plane(lengths) != 2;
}

static void ask_rows(const batch *b, int mode) {
    int8_t *answers = malloc((size_t)b->n);
    int i, leaning = b->kind == LEANING;
    if (leaning) hypcheck_classify_columns((size_t)b->n, 10, b->rows, answers);
    else hypcheck_classify_columns((size_t)b->n, 7, b->rows, answers);
    for (i = 0; i < b->n; i++) {
        const double *r = b->rows + b->width * i;
        if (answers[i] != b->right[i]) wrong(b, mode, i, "an answer", answers[i]);
        if (leaning) {
            counts[TILTED] += (long)(hc_tilted_plain(r, 1, 1).decided & 1);
            if (mode == 0 && b->right[i] != 127 && hc_exact_tilted_position(r) != b->right[i]) wrong(b, mode, i, "tilted integers", 3);
            continue;
        }
        if (b->right[i] != 127 && mode == 0) ask_exact_stages(b, mode, i);
        counts[SINGLE] += hc_single(r) != 2;
        counts[CERTIFIED] += (long)(hc_certified_plain(r, 1, 1).decided & 1);
        if (hypcheck_position(r[0], r[1], r[2], r[3], r[4], r[5], r[6]) != b->right[i]) wrong(b, mode, i, "one row", 3);
    }
    free(answers);
}

/* Counts what is decided, and compares it with what is right. */
static void check_blocks(const batch *b, int mode, int question, const hc_signs *signs, const uint64_t *left, long *count) {
    int block, i;
    for (block = 0; block < b->n / HC_BLOCK; block++) {
        *count += 64 - ones(left[block]);
        for (i = 0; i < 64; i++) {
            const int row = 64 * block + i, found = (int)(signs[block].plus >> i & 1) - (int)(signs[block].minus >> i & 1);
            if (!(left[block] >> i & 1) && found != answer_of(question, b->right[row])) wrong(b, mode, row, "half planes", found);
        }
    }
}

static void ask_lines(const batch *b, int mode, const double *x, const double *y, const double *z, hc_signs *signs, uint64_t *left) {
    hc_scene scene;
    int question, lines, fetch;
    if (!hc_make_scene(&scene, b->rows, (size_t)b->n, z)) return;
    for (question = 0; question < 4; question++)
        for (lines = 0; lines < 2; lines++)
            for (fetch = 0; fetch < 2; fetch++) {
                const hc_lines_function ask = lines ? hc_level()->two_lines[question] : hc_level()->one_line[question];
                ask(&scene, b->n / HC_BLOCK, x, y, z, fetch, signs, left);
                check_blocks(b, mode, question, signs, left, counts + ONE_LINE + lines);
            }
}

static void ask_planes(const batch *b, int mode, const double *x, const double *y, const double *z, hc_signs *signs, uint64_t *left) {
    hc_tilted_scene scene;
    double axis[3];
    int planes, fetch;
    memcpy(axis, b->rows + 7, sizeof axis);
    if (!hc_make_tilted_scene(&scene, b->rows, axis, (size_t)b->n, x, y, z)) return;
    for (planes = 0; planes < 2; planes++) {
        if (planes) hc_make_planes(&scene, 1, 2);
        for (fetch = 0; fetch < 2; fetch++) {
            (planes ? hc_level()->two_planes : hc_level()->one_plane)(&scene, b->n / HC_BLOCK, x, y, z, fetch, signs, left);
            check_blocks(b, mode, 0, signs, left, counts + ONE_PLANE + planes);
        }
    }
}

/* Scenes prepared with and without their centres, the answers written and kept as bits. */
static void ask_prepared(const batch *b, int mode, int question, const double *x, const double *y, const double *z, int8_t *answers) {
    const size_t n = (size_t)b->n;
    const double *const axis = b->kind == LEANING_SCENE ? b->rows + 7 : NULL;
    hc_signs *const kept = malloc((n / HC_BLOCK + 1) * sizeof *kept);
    size_t i, known;
    for (known = 0; known < 2; known++) {
        hypcheck_scene scene;
        hc_prepared made;
        hypcheck_prepare(&scene, b->rows, axis, known ? n : 0, x, y, z);
        hypcheck_ask_prepared(question, &scene, n, x, y, z, answers);
        for (i = 0; i < n; i++)
            if (answers[i] != answer_of(question, b->right[i])) wrong(b, mode, (int)i, "a prepared scene's answer", answers[i]);
        memcpy(&made, &scene, sizeof made);
        if (!made.valid) continue;
        memset(kept, 0xff, (n / HC_BLOCK + 1) * sizeof *kept);
        hc_ask_kept(HYPCHECK_POSITION, &made, n, x, y, z, NULL, kept);
        for (i = 0; i < n; i++) {
            const int plus = (int)(kept[i / HC_BLOCK].plus >> i % HC_BLOCK & 1), minus = (int)(kept[i / HC_BLOCK].minus >> i % HC_BLOCK & 1);
            const int right = b->right[i] == 127 ? 0 : b->right[i];
            if (plus - minus != right || (plus && minus)) wrong(b, mode, (int)i, "a kept answer", plus - minus);
        }
    }
    free(kept);
}

static void ask_scene(const batch *b, int mode) {
    const int leaning = b->kind == LEANING_SCENE;
    double *x = malloc(8 * (size_t)b->n), *y = malloc(8 * (size_t)b->n), *z = malloc(8 * (size_t)b->n);
    int8_t *answers = malloc((size_t)b->n);
    uint64_t *left = calloc((size_t)b->n / HC_BLOCK + 1, 8);
    hc_signs *signs = calloc((size_t)b->n / HC_BLOCK + 1, sizeof *signs);
    int i, question;
    for (i = 0; i < b->n; i++) {
        const double *r = b->rows + b->width * i;
        x[i] = r[4], y[i] = r[5], z[i] = r[6];
    }
    for (question = 0; question < 4; question += 1 + mode) {
        if (leaning) hypcheck_ask_tilted_scene(question, b->rows, b->rows + 7, (size_t)b->n, x, y, z, answers);
        else hypcheck_ask_scene(question, b->rows, (size_t)b->n, x, y, z, answers);
        for (i = 0; i < b->n; i++)
            if (answers[i] != answer_of(question, b->right[i])) wrong(b, mode, i, "a scene's answer", answers[i]);
        ask_prepared(b, mode, question, x, y, z, answers);
    }
    if (leaning) ask_planes(b, mode, x, y, z, signs, left);
    else ask_lines(b, mode, x, y, z, signs, left);
    free(x), free(y), free(z), free(answers), free(left), free(signs);
}

/* A row has two times behind it: before the first a spheroid that is a little larger is clear, as hypcheck.h says, and by the
   second there is contact. */
static void ask_ways(const batch *b, int mode) {
    const size_t n = (size_t)b->n, width = (size_t)b->width - 2;
    double *rows = malloc(8 * n * width), *times = malloc(8 * n);
    int8_t *hits = malloc(n), *alone = malloc(n);
    int i;
    for (i = 0; i < b->n; i++) memcpy(rows + width * (size_t)i, b->rows + b->width * i, 8 * width);
    hypcheck_passage_columns(n, width, rows, hits, times);
    if (width == 10) hypcheck_passage(n, rows, alone, NULL);
    else if (width == 13) hypcheck_passage_tilted(n, rows, alone, NULL);
    else hypcheck_passage_columns(n, width, rows, alone, NULL);
    for (i = 0; i < b->n; i++) {
        const double *const within = b->rows + b->width * i + width;
        if (hits[i] != b->right[i] && (hits[i] != 2 || b->right[i] == 127)) wrong(b, mode, i, "a hit", hits[i]);
        if (alone[i] != b->right[i] && (alone[i] != 2 || b->right[i] == 127)) wrong(b, mode, i, "a hit alone", alone[i]);
        if (times[i] == times[i] && !(hits[i] == 1 && times[i] >= within[0] && times[i] <= within[1])) wrong(b, mode, i, "a time", hits[i]);
        counts[width == 16 ? ENDED_WAYS : DECIDED_WAYS] += (hits[i] != 2) + (alone[i] != 2);
        counts[width == 16 ? ENDED_TIMES : TIMES] += times[i] == times[i];
        counts[NEAR_TIMES] += times[i] >= within[1] * (1 - 0x1p-51);
    }
    free(rows), free(times), free(hits), free(alone);
}

/* Rows with heights, where the bounds may leave an answer open. */
static void ask_ended(const batch *b, int mode) {
    const size_t n = (size_t)b->n;
    int8_t *answers = malloc(n), *by_width = malloc(n);
    int i;
    hypcheck_classify_ended(n, b->rows, answers);
    hypcheck_classify_columns(n, 13, b->rows, by_width);
    for (i = 0; i < b->n; i++) {
        if (answers[i] != b->right[i] && (answers[i] != 2 || b->right[i] == 127)) wrong(b, mode, i, "a position beside ends", answers[i]);
        if (by_width[i] != answers[i]) wrong(b, mode, i, "a position by its width", by_width[i]);
        counts[ENDED_ROWS] += answers[i] != 2;
    }
    free(answers), free(by_width);
}

/* The 8th number of a row is its clearance, within 2^-50 of 1 + its size; NaN for an invalid row. */
static void ask_clearances(const batch *b, int mode) {
    double *rows = malloc(56 * (size_t)b->n);
    int8_t *positions = malloc((size_t)b->n);
    hypcheck_near *found = malloc(sizeof *found * (size_t)b->n);
    int i, k;
    for (i = 0; i < b->n; i++)
        for (k = 0; k < 7; k++) rows[7 * i + k] = b->rows[8 * i + k];
    hypcheck_clearance((size_t)b->n, rows, positions, found);
    fesetround(FE_TONEAREST);
    for (i = 0; i < b->n; i++) {
        const hypcheck_near *const near = found + i;
        const double clearance = b->rows[8 * i + 7], off = 8.9e-16 * (1 + hc_size(clearance)), width = near->upper - near->lower;
        if (positions[i] != b->right[i]) wrong(b, mode, i, "the position of a clearance", positions[i]);
        if (positions[i] == 127) continue;
        if (!(near->lower <= clearance + off) || !(near->upper >= clearance - off)) wrong(b, mode, i, "a clearance", 0);
        if (positions[i] ? !(near->lower >= 0) : !(near->upper <= 0)) wrong(b, mode, i, "a clearance's sign", 0);
        if (!(near->distance_lower <= near->distance_upper)) wrong(b, mode, i, "a distance", 0);
        counts[NARROW] += width <= 9.3132257461547852e-10 /* 2^-30 */ * (1 + HC_MAX_OF(clearance, 0));
        counts[TOUCHES] += near->touch_error < DBL_MAX;
        counts[DISTANCES] += near->distance_upper - near->distance_lower <= 1e-6 * near->distance_upper;
        counts[GAPS] += near->nearest[0] == near->touch[0] && near->nearest[2] == near->touch[2];
    }
    fesetround(modes[mode]);
    free(rows), free(positions), free(found);
}

int main(int argc, char **argv) {
    FILE *file = argc > 1 ? fopen(argv[1], "rb") : NULL;
    batch b;
    int mode, i;
    if (!file) return 2;
#ifdef HC_MUTANTS
    if (argc > 2) hc_mutant = atoi(argv[2]);
#endif
    if (argc > 3 && !hypcheck_use_level(argv[3])) return 3;
    check_guards();
    check_exact_guards();
    check_limits();
    check_ended();
    check_ended_sweeps();
    while (fread(&b, 4, 4, file) == 4) {
        const size_t n = (size_t)b.n, width = (size_t)b.width;
        b.rows = malloc(8 * n * width);
        b.right = malloc(n);
        if (fread(b.rows, 8 * width, n, file) != n || fread(b.right, 1, n, file) != n) return 2;
        for (mode = 0; mode < MODES; mode++) {
            if (!(b.modes >> mode & 1)) continue;
            fesetround(modes[mode]);
            if (b.kind < SCENE) ask_rows(&b, mode);
            else if (b.kind < WAYS) ask_scene(&b, mode);
            else if (b.kind < CLEARANCES) ask_ways(&b, mode);
            else if (b.kind == ENDED) ask_ended(&b, mode);
            else ask_clearances(&b, mode);
            fesetround(FE_TONEAREST);
        }
        free(b.rows);
        free(b.right);
    }
    for (i = 0; i < ALL; i++) printf("%s%s: %ld", i ? ", " : "", names[i], counts[i]);
    printf("\n");
    return 0;
}
