/* libFuzzer's target: an input is a kind of question, a choice (level, rounding mode, question) and doubles. The answers of
   hypcheck.h are compared with oracle.h; where they differ, the input is printed and the program aborts.

   Kinds: rows of 7 and of 10, one scene of each, ways, ways with an axis, clearances. */

#include <fenv.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define HYPCHECK_IMPLEMENTATION
#include "hypcheck.h"
#include "oracle.h"

enum { ROWS, LEANING, SCENE, LEANING_SCENE, WAYS, LEANING_WAYS, CLEARANCES, KINDS };
enum { MOST_ROWS = 8, TILED = 1024 + 70 };

static const int WIDTHS[KINDS] = {7, 10, 7, 10, 10, 13, 7};

typedef struct {
    int kind, question, count; /* of rows; in a scene the sizes are those of the first */
    double rows[MOST_ROWS][13];
} input;

static void fail(const input *in, int row, const char *what, double found, double right) {
    int k;
    fesetround(FE_TONEAREST);
    printf("WRONG: kind %d, level %s, question %d, row %d: %s: found %.17g, right is %.17g:", in->kind, hypcheck_level(),
           in->question, row, what, found, right);
    for (k = 0; k < WIDTHS[in->kind]; k++) printf(" %a", in->rows[row][k]);
    printf("\n");
    fflush(stdout);
    abort();
}

/* ---- exact positions of what is asked ---- */

static int usable(const double *row, int leaning) {
    int i, some = !leaning;
    for (i = 0; i < (leaning ? 10 : 7); i++)
        if (!isfinite(row[i]) || (i < 4 && !(row[i] > 0))) return 0;
    for (i = 7; leaning && i < 10; i++) some |= row[i] != 0;
    return some;
}

typedef struct {
    mpq_t row[10];
} place;

static void make_place(place *at, const double *row, const double *axis) {
    int i;
    for (i = 0; i < 10; i++) {
        mpq_init(at->row[i]);
        if (i < 7) mpq_set_d(at->row[i], row[i]);
        else if (axis) mpq_set_d(at->row[i], axis[i - 7]);
        else mpq_set_si(at->row[i], i == 9, 1);
    }
}

static void unmake_place(place *at) {
    int i;
    for (i = 0; i < 10; i++) mpq_clear(at->row[i]);
}

static int truth(const double *row, const double *axis) {
    place at;
    int found;
    make_place(&at, row, axis);
    found = true_position((const mpq_t *)at.row);
    unmake_place(&at);
    return found;
}

static int answer_of(int question, int position) {
    return question == 1 ? position > 0 : question == 2 ? position < 0 : question == 3 ? position == 0 : position;
}

/* ---- the kinds ---- */

static void ask_rows(input *in, int leaning) {
    const int width = leaning ? 10 : 7;
    double rows[10 * MOST_ROWS];
    int8_t answers[MOST_ROWS];
    size_t refused, invalid = 0;
    int i, k;
    for (i = 0; i < in->count; i++)
        for (k = 0; k < width; k++) rows[width * i + k] = in->rows[i][k];
    refused = leaning ? hypcheck_ask_tilted(in->question, (size_t)in->count, rows, answers)
                      : hypcheck_ask(in->question, (size_t)in->count, rows, answers);
    for (i = 0; i < in->count; i++) {
        const double *const row = in->rows[i];
        const int valid = usable(row, leaning), right = valid ? truth(row, leaning ? row + 7 : NULL) : 127;
        const int asked = valid ? answer_of(in->question, right) : 127;
        invalid += !valid;
        if (answers[i] != asked) fail(in, i, "the answer", answers[i], asked);
        if (!leaning) {
            const int one = hypcheck_position(row[0], row[1], row[2], row[3], row[4], row[5], row[6]);
            if (one != right) fail(in, i, "hypcheck_position", one, right);
        }
    }
    if (refused != invalid) fail(in, 0, "the number of invalid rows", (double)refused, (double)invalid);
}

/* The centres are repeated until there are enough for half planes. */
static void ask_scene(input *in, int leaning) {
    static double x[TILED], y[TILED], z[TILED];
    static int8_t answers[TILED];
    const double *const first = in->rows[0];
    int i, right[MOST_ROWS];
    size_t refused, invalid = 0;
    for (i = 0; i < TILED; i++) {
        const double *const row = in->rows[i % in->count];
        x[i] = row[4], y[i] = row[5], z[i] = row[6];
    }
    refused = leaning ? hypcheck_ask_tilted_scene(in->question, first, first + 7, TILED, x, y, z, answers)
                      : hypcheck_ask_scene(in->question, first, TILED, x, y, z, answers);
    for (i = 0; i < in->count; i++) {
        memcpy(in->rows[i], first, 4 * sizeof *first);
        memcpy(in->rows[i] + 7, first + 7, 3 * sizeof *first);
        right[i] = !usable(in->rows[i], leaning) ? 127
                                                 : answer_of(in->question, truth(in->rows[i], leaning ? first + 7 : NULL));
    }
    for (i = 0; i < TILED; i++) {
        invalid += right[i % in->count] == 127;
        if (answers[i] != right[i % in->count]) fail(in, i % in->count, "the scene's answer", answers[i], right[i % in->count]);
    }
    if (refused != invalid) fail(in, 0, "the number of invalid centres", (double)refused, (double)invalid);
}

/* The exact position at a time of a way, b and d multiplied. */
static int truth_on_way(const double *row, const double *axis, const mpq_t time, const mpq_t scale) {
    place at;
    mpq_t end, part;
    int k, found;
    make_place(&at, row, axis);
    mpq_inits(end, part, NULL);
    for (k = 0; k < 3; k++) {
        mpq_set_d(end, row[7 + k]);
        mpq_sub(part, end, at.row[4 + k]);
        mpq_mul(part, part, time);
        mpq_add(at.row[4 + k], at.row[4 + k], part);
    }
    for (k = 2; k < 4; k++) mpq_mul(at.row[k], at.row[k], scale);
    found = true_position((const mpq_t *)at.row);
    mpq_clears(end, part, NULL);
    unmake_place(&at);
    return found;
}

/* What is said of a way, at seven of its places: a clear way is clear there, with one position; before the time of a hit
   the way is clear, and at it the spheroid, so much larger as the header says, has contact. */
static void check_way(const input *in, int i, int hit, double time, const double *axis) {
    const double *const row = in->rows[i];
    mpq_t at, scale, part;
    int k, first = 0, touched = 0;
    mpq_inits(at, scale, part, NULL);
    mpq_set_ui(scale, 1, 1);
    for (k = 0; k <= 6; k++) {
        int found;
        mpq_set_ui(at, (unsigned long)k, 6);
        mpq_canonicalize(at);
        found = truth_on_way(row, axis, at, scale);
        if (k == 0) first = found;
        if (found != first || found == 0) touched = 1;
        if (hit == 1 && time > 0 && k < 6) {
            mpq_set_d(part, time);
            mpq_mul(at, at, part);
            found = truth_on_way(row, axis, at, scale);
            if (found == 0 || found != first) fail(in, i, "contact before the time", time, k);
        }
    }
    if (touched && hit == 0) fail(in, i, "a way with contact is called clear", hit, 1);
    if (hit == 1 && time >= 0) {
        const double least = row[2] < row[3] ? row[2] : row[3];
        mpq_set_ui(scale, 1, 1);
        for (k = 4; k < 10; k++) {
            mpq_set_d(at, fabs(row[k]));
            mpq_set_d(part, axis ? least : row[k % 3 == 0 ? 3 : 2]);
            mpq_div(at, at, part);
            mpq_add(scale, scale, at);
        }
        mpq_div_2exp(scale, scale, 43);
        mpq_set_ui(part, 1, 1);
        mpq_add(scale, scale, part);
        mpq_set_d(at, time);
        if (truth_on_way(row, axis, at, scale) != 0 && truth_on_way(row, axis, at, scale) == first)
            fail(in, i, "no contact at the time, of a larger spheroid", time, 0);
    }
    mpq_clears(at, scale, part, NULL);
}

static void ask_ways(input *in, int leaning) {
    const int width = leaning ? 13 : 10, mode = fegetround();
    double rows[13 * MOST_ROWS], times[MOST_ROWS];
    int8_t hits[MOST_ROWS], alone[MOST_ROWS];
    int i, k;
    for (i = 0; i < in->count; i++)
        for (k = 0; k < width; k++) rows[width * i + k] = in->rows[i][k];
    (leaning ? hypcheck_passage_tilted : hypcheck_passage)((size_t)in->count, rows, hits, times);
    (leaning ? hypcheck_passage_tilted : hypcheck_passage)((size_t)in->count, rows, alone, NULL);
    fesetround(FE_TONEAREST);
    for (i = 0; i < in->count; i++) {
        double start[10];
        int valid, ends;
        memcpy(start, in->rows[i], sizeof start);
        for (k = 7; leaning && k < 10; k++) start[k] = in->rows[i][k + 3];
        valid = usable(start, leaning);
        for (ends = 7; ends < 10; ends++) valid &= isfinite(in->rows[i][ends]) != 0;
        if ((hits[i] == 127) != !valid) fail(in, i, "whether the row is invalid", hits[i], valid);
        if (hits[i] != alone[i] && (hits[i] == 127 || alone[i] == 127 || hits[i] + alone[i] == 1))
            fail(in, i, "the hit without a time", alone[i], hits[i]);
        if ((hits[i] != 1 && !isnan(times[i])) || times[i] < 0 || times[i] > 1) fail(in, i, "the time", times[i], 0);
        if (valid) check_way(in, i, hits[i], isnan(times[i]) ? -1 : times[i], leaning ? start + 7 : NULL);
    }
    fesetround(mode);
}

/* The position of the spheroid, b and d multiplied by (1 + number) more or less a little. */
static int truth_grown(const double *row, double number, int little) {
    place at;
    mpq_t factor, part;
    int k, found = 0;
    make_place(&at, row, NULL);
    mpq_inits(factor, part, NULL);
    mpq_set_d(factor, number);
    mpq_set_ui(part, 1, 1);
    mpq_add(factor, factor, part);
    mpq_set_si(part, little, 1);
    mpq_div_2exp(part, part, 100);
    mpq_add(factor, factor, part);
    if (mpq_sgn(factor) > 0) {
        for (k = 2; k < 4; k++) mpq_mul(at.row[k], at.row[k], factor);
        found = true_position((const mpq_t *)at.row);
    } else found = 2; /* a point, or nothing */
    mpq_clears(factor, part, NULL);
    unmake_place(&at);
    return found;
}

static void ask_clearances(input *in) {
    const int mode = fegetround();
    double rows[7 * MOST_ROWS];
    int8_t positions[MOST_ROWS];
    hypcheck_near found[MOST_ROWS];
    int i, k;
    for (i = 0; i < in->count; i++)
        for (k = 0; k < 7; k++) rows[7 * i + k] = in->rows[i][k];
    hypcheck_clearance((size_t)in->count, rows, positions, found);
    fesetround(FE_TONEAREST);
    for (i = 0; i < in->count; i++) {
        const double *const row = in->rows[i];
        const int right = usable(row, 0) ? truth(row, NULL) : 127;
        const hypcheck_near *const near = found + i;
        const double least = fmin(row[2], row[3]), most = fmax(row[2], row[3]);
        if (positions[i] != right) fail(in, i, "the position beside a clearance", positions[i], right);
        if (right == 127) {
            if (!isnan(near->lower) || !isnan(near->nearest[2])) fail(in, i, "an invalid row's clearance", near->lower, NAN);
            continue;
        }
        if (!(near->lower <= near->upper && near->lower >= -1)) fail(in, i, "the order of the bounds", near->lower, near->upper);
        if (right ? !(near->lower >= 0) : !(near->upper <= 0)) fail(in, i, "the sign of the bounds", near->lower, near->upper);
        if (truth_grown(row, near->lower, -1) == 0) fail(in, i, "clear of contact up to the lower bound", near->lower, 0);
        if (near->upper < DBL_MAX && truth_grown(row, near->upper, 1) != 0) fail(in, i, "contact at the upper bound", near->upper, 0);
        if (!(near->distance_lower >= 0 && near->distance_lower <= near->distance_upper))
            fail(in, i, "the order of the distances", near->distance_lower, near->distance_upper);
        if (right == 0 && near->distance_upper != 0) fail(in, i, "the distance in contact", near->distance_upper, 0);
        if (right && near->distance_upper < near->lower * least * (1 - 1e-12)) fail(in, i, "the upper distance", near->distance_upper, near->lower * least);
        if (right && near->distance_lower > near->upper * most * (1 + 1e-12) + DBL_MIN) fail(in, i, "the lower distance", near->distance_lower, near->upper * most);
    }
    fesetround(mode);
}

/* How far apart the exponents are. A row of the whole range of float64 takes the kernel's integers milliseconds: it is asked
   as a row, not a thousand times as a scene, nor a hundred times for its clearance. */
enum { MOST_SPREAD = 400 };

static int spread(const input *in) {
    int i, k, exponent, least = 0, most = 0;
    for (i = 0; i < in->count; i++)
        for (k = 0; k < WIDTHS[in->kind]; k++)
            if (in->rows[i][k] != 0 && isfinite(in->rows[i][k])) {
                frexp(in->rows[i][k], &exponent);
                if (exponent < least) least = exponent;
                if (exponent > most) most = exponent;
            }
    return most - least;
}

/* ---- libFuzzer's functions ---- */

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const char *const levels[4] = {"plain", "sse2", "avx2", "avx512"};
    static const int modes[4] = {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
    input in;
    int width, most;
    memset(&in, 0, sizeof in);
    if (size < 2) return 0;
    in.kind = data[0] % KINDS;
    width = WIDTHS[in.kind];
    in.question = in.kind < WAYS ? data[1] & 3 : 0;
    most = in.kind == ROWS || in.kind == SCENE ? MOST_ROWS : in.kind < WAYS ? 4 : 2;
    for (data += 2, size -= 2; in.count < most && size >= 8 * (size_t)width; in.count++) {
        memcpy(in.rows[in.count], data, 8 * (size_t)width);
        data += 8 * (size_t)width, size -= 8 * (size_t)width;
    }
    data -= 2 + 8 * (size_t)width * (size_t)in.count; /* back to the head */
    if (in.count == 0) return 0;
    if (in.kind >= SCENE && spread(&in) > MOST_SPREAD) return 0;
    if (!hypcheck_use_level(levels[data[1] >> 2 & 3])) hypcheck_use_level("plain");
    fesetround(modes[data[1] >> 4 & 3]);
    if (in.kind < SCENE) ask_rows(&in, in.kind);
    else if (in.kind < WAYS) ask_scene(&in, in.kind == LEANING_SCENE);
    else if (in.kind < CLEARANCES) ask_ways(&in, in.kind == LEANING_WAYS);
    else ask_clearances(&in);
    fesetround(FE_TONEAREST);
    return 0;
}

size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t most);

/* Half of the changes are such as numbers have: a few units in the last place, powers of two, another number's value, sums
   that make bodies touch, and special values. */
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed) {
    static const double special[] = {0, -0.0, 1, -1, 2, 0.5, 3, 5e-324, 2.2250738585072014e-308, DBL_MAX, 1e-150, 1e150, 1e-60, 1e60};
    const unsigned what = seed >> 4 & 7, a = seed >> 8, b = seed >> 16;
    const size_t count = size < 10 ? 0 : (size - 2) / 8;
    double number, other;
    uint64_t bits;
    if (seed & 1 || count == 0) return LLVMFuzzerMutate(data, size, most);
    memcpy(&number, data + 2 + 8 * (a % count), 8);
    memcpy(&other, data + 2 + 8 * (b % count), 8);
    memcpy(&bits, &number, 8);
    switch (what) {
    case 0: bits += (b & 15) - 8u; break;
    case 1: number = ldexp(number, (int)(b % 41) - 20), memcpy(&bits, &number, 8); break;
    case 2: memcpy(&bits, &other, 8); break;
    case 3: number = number + other, memcpy(&bits, &number, 8); break;
    case 4: number = number - other, memcpy(&bits, &number, 8); break;
    case 5: memcpy(&bits, special + b % (sizeof special / sizeof *special), 8); break;
    case 6: bits &= ~(uint64_t)0 << (b % 53); break;
    default: data[a & 1] = (uint8_t)(b >> 3); return size;
    }
    memcpy(data + 2 + 8 * (a % count), &bits, 8);
    return size;
}
