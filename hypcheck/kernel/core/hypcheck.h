/* The position of a spheroid relative to a circular hyperboloid of one sheet: exact answers.

   The hyperboloid x²/alpha² + y²/alpha² - z²/gamma² = 1 is centred at the origin; the spheroid has semi-axes b, b, d and
   centre (x, y, z). The position of the two surfaces is

       +1  exterior    0  contact, a tangency included    -1  interior    127  the row is invalid

   and it is the exact one of the given doubles, in every regime and over all of float64: subnormal, huge, tangent, on
   the ring where discriminants vanish. A row is valid where its four sizes are finite and > 0 and its centre is finite.

   How to use it. One C file of the program says

       #define HYPCHECK_IMPLEMENTATION
       #include "hypcheck.h"

   and the others include the header alone. C99 or C++11, no library, not even libm. Before it, that file may define

       HYPCHECK_SELF "other.h"   where the header has another name: it includes itself once for each instruction set
       HYPCHECK_PLAIN            to leave the instruction sets of x86-64 and aarch64 out
       HYPCHECK_SMALL_LIMBS      to do without 128-bit integers

   Sizes       n is any number of rows, 0 included. Rows are 7 doubles: alpha, gamma, b, d, x, y, z; or 10, for an axis
               that may be tilted: axis_x, axis_y, axis_z besides.
   Alignment   that of double. Nothing has to be padded.
   Aliasing    inputs may overlap each other. The output must not overlap an input.
   NaN         and infinities, and sizes <= 0 or -0.0, make a row invalid; it is answered 127 and harms no other row.
               So does an axis that is 0, 0, 0 or not finite. A scene with invalid sizes, or such an axis, answers 127
               everywhere. -0.0 is 0 as a coordinate and in an axis.
   Memory      nothing is allocated. The stack holds up to 114 kilobytes, 156 for axes that are tilted.
   Threads     every function may be called from any number of threads at once. There is one global variable, the
               instruction set in use (below): it is written once with one value, or by hypcheck_use_level.
   Arithmetic  answers do not depend on the rounding mode, on flushing subnormals to zero, or on contraction into FMA;
               floating-point flags may be raised. -ffast-math breaks the proofs and is refused.

   Every statement of floating-point arithmetic below between "printed" and "end of" is printed from the straight-line
   programs that hypcheck proves to be the formulas they are named after, as are the steps of the exact integers. What
   their bounds are and why they hold: docs/kernel.md of hypcheck. Made by: python -m hypcheck.kernel.core.generate */

#ifndef HYPCHECK_H
#define HYPCHECK_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What is asked. HYPCHECK_POSITION, and any number not here, is answered by a position, the others by 1 (yes) or 0 (no). */
enum { HYPCHECK_POSITION = 0, HYPCHECK_EXTERIOR = 1, HYPCHECK_INTERIOR = 2, HYPCHECK_CONTACT = 3 };

/* The position of each of n rows of 7 doubles. */
void hypcheck_classify(size_t n, const double *rows, int8_t *positions);

/* The position of one spheroid at n centres; sizes are alpha, gamma, b, d. */
void hypcheck_classify_scene(const double sizes[4], size_t n, const double *x, const double *y, const double *z,
                             int8_t *positions);

/* The answer to a question for each row, or each centre. Returns the number of invalid ones, which are answered 127. */
size_t hypcheck_ask(int question, size_t n, const double *rows, int8_t *answers);
size_t hypcheck_ask_scene(int question, const double sizes[4], size_t n, const double *x, const double *y,
                          const double *z, int8_t *answers);

/* The same for a spheroid whose axis of revolution is any vector: rows of 10 doubles, ..., axis_x, axis_y, axis_z, and one
   orientation for a scene. The axis is finite and not 0; its length and its sign mean nothing. (0, 0, s) is upright. */
void hypcheck_classify_tilted(size_t n, const double *rows10, int8_t *positions);
void hypcheck_classify_tilted_scene(const double sizes[4], const double axis[3], size_t n, const double *x,
                                    const double *y, const double *z, int8_t *positions);
size_t hypcheck_ask_tilted(int question, size_t n, const double *rows10, int8_t *answers);
size_t hypcheck_ask_tilted_scene(int question, const double sizes[4], const double axis[3], size_t n, const double *x,
                                 const double *y, const double *z, int8_t *answers);

/* One scene, prepared once and asked many times: what can be computed before centres are known is kept. Answers are those
   of hypcheck_ask_tilted_scene; only time differs, most of all in batches of 64 to some thousand rows. `axis` NULL is
   upright. x, y, z are n centres like those that will be asked about; n = 0, where none is known, takes heights about the
   waist. Invalid sizes, or such an axis, are answered 127 everywhere. A hypcheck_scene holds 576 bytes and no pointer: it may
   be copied, kept anywhere, and asked by any number of threads at once. Only hypcheck_prepare writes it, and only the build
   of this header that wrote it reads it. */
typedef struct {
    double kept[72];
} hypcheck_scene;
void hypcheck_prepare(hypcheck_scene *scene, const double sizes[4], const double axis[3], size_t n, const double *x,
                      const double *y, const double *z);
size_t hypcheck_ask_prepared(int question, const hypcheck_scene *scene, size_t n, const double *x, const double *y,
                             const double *z, int8_t *answers);

/* One position. */
int hypcheck_position(double alpha, double gamma, double b, double d, double x, double y, double z);

/* Whether a spheroid whose centre goes straight from one place to another meets contact, both ends included: rows
   of 10 doubles, alpha, gamma, b, d, the centre at the start and at the end. A hit is

       1  contact somewhere on the sweep    0  clear all along    2  the bounds do not tell    127  the row is invalid

   and 1 and 0 are exact. 2 is said of sweeps that graze the surface, or end in tangency, and of sizes beyond 2^±100 and
   coordinates beyond 2^150; hypcheck.passage of Python decides these. `times` may be NULL; else it gets a time from 0 to
   1 for each hit: before it the sweep is clear, and at it there is contact of the spheroid with b and d larger by
   2^-43 (1 + S), S being the sum of |x| and |y| in units of b and of |z| in units of d, of both ends; all are in units of
   the smaller of b and d where the axis is tilted. NaN where there is no hit, or where the bounds do not tell when. Rows of 13
   have axis_x, axis_y, axis_z behind these, which stay the same on the sweep. */
void hypcheck_passage(size_t n, const double *rows10, int8_t *hits, double *times);
void hypcheck_passage_tilted(size_t n, const double *rows13, int8_t *hits, double *times);

/* The position where the hyperboloid ends: rows of 13 doubles, alpha, gamma, b, d, x, y, z, axis_x, axis_y, axis_z, and
   z_min, z_max, solid. It ends at the heights z_min < z_max, of which one or both may be infinite. solid is 0 where the
   wall alone is there: contact is contact with the wall, else 1 or -1 says whether the centre lies within the wall and
   between the ends. solid is 1 where flat ends belong to it. A position is 1, 0 or -1, exact; 2 where neither bounds nor
   integers tell, which is said of pairs within about 2^-46 of contact, most of them tilted, and of lengths beyond 2^±100;
   127 where the row is invalid. hypcheck.classify of Python decides all. */
void hypcheck_classify_ended(size_t n, const double *rows13, int8_t *positions);

/* Rows of any of these widths. Positions: 7, 10 with an axis, 13 with z_min, z_max, solid behind it, as the functions above
   answer them. Sweeps: 10, 13 with an axis, 16 with z_min, z_max, solid behind it; contact is then that of
   hypcheck_classify_ended, so that a sweep may lead through an opening without any. 2 is also said of sweeps that miss, or meet,
   a rim, the wall or a flat end by less than about 2^-42 of the sizes. Of a time what is said above holds. Rows of another
   width are answered 127. */
void hypcheck_classify_columns(size_t n, size_t width, const double *rows, int8_t *positions);
void hypcheck_passage_columns(size_t n, size_t width, const double *rows, int8_t *hits, double *times);

/* The clearance, the distance and the nearest points of each of n rows of 7 doubles. Positions are as above.

       lower <= clearance <= upper      the clearance: 1 + clearance times as large, the spheroid first touches. It is
                                        negative in contact, 0 in a tangency; its bounds agree with the position in sign
       touch                            where it then touches; the exact place is within touch_error, DBL_MAX if unknown
       distance_lower, distance_upper   the Euclidean distance of the bodies lies between them; 0 in contact
       nearest                          a point of the hyperboloid that is distance_upper away at most, but for the
                                        rounding of its coordinates; `touch` where no shorter gap was measured

   Every bound is proved by exact decisions. upper - lower is 2^-30 of 1 + clearance at most, or of 1, where sizes are
   within 2^-100 and 2^100, coordinates below 2^100 and b/d within 2^-20 and 2^20. Elsewhere bounds hold, and may be wide;
   DBL_MAX says no bound. Invalid rows have NaN. Returns how many these are. docs/kernel.md of hypcheck says how wide a
   distance is. */
typedef struct {
    double lower, upper, touch_error, distance_lower, distance_upper, touch[3], nearest[3];
} hypcheck_near;
enum { HYPCHECK_NEAR_NUMBERS = 11 };
size_t hypcheck_clearance(size_t n, const double *rows, int8_t *positions, hypcheck_near *found);

/* The instruction set in use: "avx512", "avx2", "sse2", "neon" or "plain". The best that this machine has, unless
   hypcheck_use_level chose another; that returns 0, and changes nothing, where this machine or build lacks it. */
const char *hypcheck_level(void);
int hypcheck_use_level(const char *name);

/* The version of this header, and that of the one the program was linked with. */
#define HYPCHECK_VERSION "1.0.0"
const char *hypcheck_version(void);

#ifdef __cplusplus
}
#endif

#endif

#if defined(HYPCHECK_IMPLEMENTATION) && !defined(HC_LEVEL) && !defined(HC_IMPLEMENTED)
#define HC_IMPLEMENTED

/* ---- what is asked of the compiler ---- */

#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || defined(_M_FP_FAST)
#error "hypcheck: compile without -ffast-math and its parts: they void the error bounds, and answers would be wrong"
#endif
#if defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__
#error "hypcheck: compile without -ffinite-math-only: NaN and infinities must be seen"
#endif
/* Compile without -fsingle-precision-constant: it changes the numbers that are written here. */
typedef char hc_constants_are_double[sizeof(1.0) == sizeof(double) ? 1 : -1];

#include <float.h>
#include <string.h>

/* Clang defines no macro for the parts of -ffast-math, such as -funsafe-math-optimizations: they are taken back where it can. */
#if defined(__clang__) && ((defined(__x86_64__) && __clang_major__ >= 12) || (defined(__aarch64__) && __clang_major__ >= 15))
#define HC_PRECISE 1
#pragma float_control(precise, on, push)
#else
#define HC_PRECISE 0
#endif

/* The bounds ask for one rounding to double in each operation. Where the machine rounds otherwise (x87), floats decide
   nothing and the integers everything: right, and slow. 16 is said of machines with _Float16, and is 0 for double. GCC's
   <float.h> says it only to C99 and C++11, the compiler to all; a machine that says nothing gets the integers. */
#if defined(FLT_EVAL_METHOD)
#define HC_EVALUATION FLT_EVAL_METHOD
#elif defined(__FLT_EVAL_METHOD__)
#define HC_EVALUATION __FLT_EVAL_METHOD__
#else
#define HC_EVALUATION (-1)
#endif
#if HC_EVALUATION == 0 || HC_EVALUATION == 1 || HC_EVALUATION == 16
#define HC_FLOATS_DECIDE 1
#define HC_STORED double
#else
#define HC_FLOATS_DECIDE 0
#define HC_STORED volatile double
#endif

/* What x87 does to clearances, where exact decisions about grown spheroids are all that decides there. With a control word of
   53 bits or 64, a product is rounded to that many as the mode says, and once more to double where it is stored. To nearest
   the two are off by 2^-64 + 2^-53 (1 + 2^-64) < 2^-52, less than the last place; in a directed mode, both going the same
   way, they are the one rounding to double. So hc_next reaches past the exact product, and a bound that counts 2^-52 for an
   operation holds. But one step may see a value as stored and another as it was in its register: a factor that is proved is
   HC_STORED, so that it is the one that is returned. */

#if (defined(__GNUC__) || defined(__clang__)) && defined(__x86_64__) && !defined(HYPCHECK_PLAIN)
#define HC_X86 1
#include <cpuid.h>
#include <immintrin.h>
#else
#define HC_X86 0
#endif
#if (defined(__GNUC__) || defined(__clang__)) && defined(__aarch64__) && !defined(HYPCHECK_PLAIN)
#define HC_NEON 1
#include <arm_neon.h>
#else
#define HC_NEON 0
#endif

/* There a product of 128 bits is a call into the compiler's library. */
#if defined(__wasm__) && !defined(HYPCHECK_SMALL_LIMBS)
#define HYPCHECK_SMALL_LIMBS
#endif

#define HC_BLOCK 64  /* rows that share one word of bits */
#define HC_STRIP 4096 /* rows whose undecided ones are collected before the next stage looks at them */
#define HC_TOO_MANY_LEFT 40 /* of a strip, by one line a side: then it is two */
#define HC_TOO_MANY_BY_PLANES 120 /* the same for one orientation, where two planes cost more */
#define HC_FAR_FROM ((size_t)1 << 19) /* rows that no cache holds: then they are fetched HC_AHEAD rows before their turn */
#define HC_AHEAD 512
#define HC_TURNS 8 /* of Newton's method, at most, for a multiplier */
#define HC_settled 1e-6 /* its last relative change */
#define HC_LINES_FROM 256 /* rows from which the constants of the lines are worth their making, */
#define HC_PLANES_FROM 512 /* and those of the planes, which cost more to make and save more */
#define HC_WIDEST 8 /* doubles in the widest vector of any level */

#define HC_u_4 8.881792667330725e-16 /* 0x1.0000100000000p-50 */
#define HC_u_8 1.776358533466145e-15 /* 0x1.0000100000000p-49 */
#define HC_u_12 2.6645378001992175e-15 /* 0x1.8000180000000p-49 */
#define HC_u_16 3.55271706693229e-15 /* 0x1.0000100000000p-48 */
#define HC_slack 1.0000009536743164 /* 0x1.0000100000000p+0 */
#define HC_least 7.888609052210118e-31 /* 0x1.0000000000000p-100 */
#define HC_greatest 1.2676506002282294e+30 /* 0x1.0000000000000p+100 */
#define HC_farthest 1.6069380442589903e+60 /* 0x1.0000000000000p+200 */
#define HC_u_p_l 1.776358533466145e-15 /* 0x1.0000100000000p-49 */
#define HC_u_k 6.2172548671315074e-15 /* 0x1.c0001c0000000p-48 */
#define HC_u_d_l 7.993613400597652e-15 /* 0x1.2000120000000p-47 */
#define HC_u_F 8.881792667330725e-15 /* 0x1.4000140000000p-47 */
#define HC_u_psi 1.5987226801195305e-14 /* 0x1.2000120000000p-46 */
#define HC_less_sure 0.9999990463256836 /* 0x1.ffffe00000000p-1 */
#define HC_least_b 4.909093465297727e-91 /* 0x1.0000000000000p-300 */
#define HC_greatest_b 2.037035976334486e+90 /* 0x1.0000000000000p+300 */
#define HC_least_square 5.551115123125783e-17 /* 0x1.0000000000000p-54 */
#define HC_greatest_square 1.8014398509481984e+16 /* 0x1.0000000000000p+54 */
#define HC_farthest_square 3.2451855365842673e+32 /* 0x1.0000000000000p+108 */
#define HC_least_axis 7.888609052210118e-31 /* 0x1.0000000000000p-100 */
#define HC_greatest_axis 1.2676506002282294e+30 /* 0x1.0000000000000p+100 */
#define HC_greatest_l 1.152921504606847e+18 /* 0x1.0000000000000p+60 */
#define HC_unit 2.220446049250313e-16 /* 0x1.0000000000000p-52 */
#define HC_more_than 1.0000000000009095 /* 0x1.0000000001000p+0 */
#define HC_lost 9.332636185032189e-302 /* 0x1.0000000000000p-1000 */
#define HC_least_ratio 9.5367431640625e-07 /* 0x1.0000000000000p-20 */
#define HC_greatest_ratio 1048576.0 /* 0x1.0000000000000p+20 */
#define HC_greatest_zeta 0.0009765625 /* 0x1.0000000000000p-10 */
#define HC_u_1536 3.4106083842549983e-13 /* 0x1.8000180000000p-42 */
#define HC_more 1.000000000000007 /* 0x1.0000000000020p+0 */
#define HC_less 0.9999999999999929 /* 0x1.fffffffffffc0p-1 */
#define HC_cap 2.5822498780869086e+120 /* 0x1.0000000000000p+400 */
#define HC_least_constant 4.909093465297727e-91 /* 0x1.0000000000000p-300 */
#define HC_greatest_slope 2.5822498780869086e+120 /* 0x1.0000000000000p+400 */
#define HC_least_size 7.888609052210118e-31 /* 0x1.0000000000000p-100 */
#define HC_greatest_size 1.2676506002282294e+30 /* 0x1.0000000000000p+100 */
#define HC_least_height 7.006492321624085e-46 /* 0x1.0000000000000p-150 */
#define HC_greatest_height 1.42724769270596e+45 /* 0x1.0000000000000p+150 */
#define HC_guess 2.3283064365386963e-10 /* 0x1.0000000000000p-32 */
#define HC_width 9.313225746154785e-10 /* 0x1.0000000000000p-30 */
#define HC_outward 1.0000000000000036 /* 0x1.0000000000010p+0 */
#define HC_inward 0.9999999999999964 /* 0x1.fffffffffffe0p-1 */
#define HC_points 1.4210854715202004e-14 /* 0x1.0000000000000p-46 */
#define HC_least_grown 1.1830521861667747e-271 /* 0x1.0000000000000p-900 */
#define HC_greatest_grown 8.452712498170644e+270 /* 0x1.0000000000000p+900 */
#define HC_less_than 0.9999999999990905 /* 0x1.fffffffffe000p-1 */
#define HC_rounded 1.4210854715202004e-14 /* 0x1.0000000000000p-46 */
#define HC_tiny 3.054936363499605e-151 /* 0x1.0000000000000p-500 */
#define HC_least_tau 9.332636185032189e-302 /* 0x1.0000000000000p-1000 */
#define HC_least_share 8.470329472543003e-22 /* 0x1.0000000000000p-70 */
#define HC_touch_settled 1.4901161193847656e-08 /* 0x1.0000000000000p-26 */
#define HC_gap_settled 3.814697265625e-06 /* 0x1.0000000000000p-18 */
#define HC_least_offset 9.332636185032189e-302 /* 0x1.0000000000000p-1000 */
#define HC_NEVER DBL_MAX
#define HC_MAX_OF(a, b) ((a) > (b) ? (a) : (b))
#define HC_MIN_OF(a, b) ((a) < (b) ? (a) : (b))
#define HC_TOUCH_TURNS 12 /* of Newton's method, at most, for a place of touch */
#define HC_GAP_TURNS 12   /* and for a shortest gap */

/* Rows as bits: exterior (or "yes"), interior, decided. */
typedef struct {
    uint64_t plus, minus, decided;
} hc_bits;

/* The answers of a block as bits: exterior (or "yes"), interior. A quarter of the bytes: so answers are kept that must not
   be written before all rows are known to be valid. */
typedef struct {
    uint64_t plus, minus;
} hc_signs;

/* The half planes R > K + M T, R < K + M T, R < K + M T, R >= K + M T of one scene, three of each. */
typedef struct {
    double K, M;
} hc_line;

typedef struct {
    hc_line beyond[3], within[3], under[3], above[3];
    double reach;
} hc_scene;

/* A number known to lie within e of v. */
typedef struct {
    double v, e;
} hc_ball;

/* P1 + a P2 against K + M Q */
typedef struct {
    double a, K, M;
} hc_plane;

typedef struct {
    double r1_x, r1_y, r2_x, r2_y, r2_z, r3_x, r3_y, r3_z; /* the rows of the basis, as they are used */
    hc_plane beyond[3], within[3], under[3], above[3];
    double reach, heights[3];
    hc_ball A1, A2, B;
    int has_two; /* whether the half spaces 1 and 2 are made */
    double zeta; /* a computed square is within zeta (P1 + P2 + Q) of the exact one */
} hc_tilted_scene;

/* By columns: factors a little below and above the one by which a spheroid first touches, spheroids at least and at most so
   large, where it touches in the half plane of its centre, the direction of that, and how far the exact place is at most. */
typedef struct {
    double low[HC_BLOCK], high[HC_BLOCK], inner_b[HC_BLOCK], inner_d[HC_BLOCK], outer_b[HC_BLOCK], outer_d[HC_BLOCK];
    double radius[HC_BLOCK], height[HC_BLOCK], cosine[HC_BLOCK], sine[HC_BLOCK], sign[HC_BLOCK], error[HC_BLOCK];
} hc_touches;

/* By columns: the end of the shortest gap on the hyperboloid, its length at most, the spheroid's half width along it, a
   distance that is about to be proved, and the spheroid that holds all points so near. */
typedef struct {
    double radius[HC_BLOCK], height[HC_BLOCK], most[HC_BLOCK], width[HC_BLOCK], tried[HC_BLOCK];
    double inner_b[HC_BLOCK], inner_d[HC_BLOCK];
} hc_gaps;

/* A hint; the place may lie behind the end of the array, hence no pointer arithmetic. */
#if defined(__GNUC__) || defined(__clang__)
#define HC_FETCH(array, row) __builtin_prefetch((const void *)((uintptr_t)(array) + 8 * (uintptr_t)(row)))
#else
#define HC_FETCH(array, row) ((void)(row))
#endif

static int hc_lowest_bit(uint64_t bits) {
#if defined(__GNUC__) || defined(__clang__)
    return __builtin_ctzll(bits);
#else
    int at = 0, step;
    for (step = 32; step; step /= 2)
        if (!(bits & (((uint64_t)1 << step) - 1))) {
            bits >>= step;
            at += step;
        }
    return at;
#endif
}

/* The place of the highest bit of a number that is not 0. */
static int hc_highest_bit(uint64_t bits) {
#if defined(__GNUC__) || defined(__clang__)
    return 63 - __builtin_clzll(bits);
#else
    int at = 0, step;
    for (step = 32; step; step /= 2)
        if (bits >> step) {
            bits >>= step;
            at += step;
        }
    return at;
#endif
}

/* A root for choosing places: good to a few digits, no libm. */
static double hc_rough_root(double square) {
    uint64_t bits;
    double root;
    int i;
    if (!(square > 0)) return 0;
    memcpy(&bits, &square, sizeof bits);
    bits = (bits >> 1) + ((uint64_t)0x1ff8 << 48); /* half the exponent */
    memcpy(&root, &bits, sizeof root);
    for (i = 0; i < 3; i++) root = 0.5 * (root + square / root);
    return root;
}

/* The root within three units in the last place. */
static double hc_fine_root(double square) {
    const double root = hc_rough_root(square);
    return root > 0 ? 0.5 * (root + square / root) : 0;
}

/* ---- exact integers: the last stage ---- */

#if defined(__SIZEOF_INT128__) && !defined(HYPCHECK_SMALL_LIMBS)
typedef uint64_t hc_limb;
__extension__ typedef unsigned __int128 hc_wide;
#define HC_LIMB_BITS 64
#else
typedef uint32_t hc_limb;
typedef uint64_t hc_wide;
#define HC_LIMB_BITS 32
#endif

/* sign is -1, 0 or 1; the size is limbs[0] + limbs[1] 2^HC_LIMB_BITS + ..., limbs[length - 1] being no zero. */
typedef struct {
    int sign;
    int length;
    hc_limb *limbs;
} hc_integer;

/* Room for a number of so many bits, and for the limb by which the limbs of two factors exceed those of the product. */
#define HC_INTEGER(name, bits)                                          \
    hc_limb name##_limbs[((bits) + HC_LIMB_BITS - 1) / HC_LIMB_BITS + 1]; \
    hc_integer name = {0, 0, name##_limbs}

static int hc_compare_sizes(const hc_integer *left, const hc_integer *right) {
    int i;
    if (left->length != right->length) return left->length < right->length ? -1 : 1;
    for (i = left->length - 1; i >= 0; i--)
        if (left->limbs[i] != right->limbs[i]) return left->limbs[i] < right->limbs[i] ? -1 : 1;
    return 0;
}

static void hc_add_sizes(hc_integer *sum, const hc_integer *longer, const hc_integer *shorter) {
    hc_wide carry = 0;
    int i;
    for (i = 0; i < longer->length; i++) {
        carry += longer->limbs[i];
        if (i < shorter->length) carry += shorter->limbs[i];
        sum->limbs[i] = (hc_limb)carry;
        carry >>= HC_LIMB_BITS;
    }
    if (carry) sum->limbs[i++] = (hc_limb)carry;
    sum->length = i;
}

static void hc_subtract_sizes(hc_integer *difference, const hc_integer *larger, const hc_integer *smaller) {
    hc_limb borrow = 0;
    int i, length = 0;
    for (i = 0; i < larger->length; i++) {
        const hc_limb from = larger->limbs[i], taken = i < smaller->length ? smaller->limbs[i] : 0;
        const hc_limb rest = from - taken, left = rest - borrow;
        borrow = (hc_limb)((from < taken) | (rest < borrow));
        difference->limbs[i] = left;
        if (left) length = i + 1;
    }
    difference->length = length;
}

/* sum = left + sign right */
static void hc_combine(hc_integer *sum, const hc_integer *left, const hc_integer *right, int sign) {
    const int right_sign = sign * right->sign;
    if (left->sign * right_sign >= 0) {
        const int right_is_longer = left->length < right->length;
        hc_add_sizes(sum, right_is_longer ? right : left, right_is_longer ? left : right);
        sum->sign = left->sign ? left->sign : right_sign;
    } else {
        const int order = hc_compare_sizes(left, right);
        hc_subtract_sizes(sum, order < 0 ? right : left, order < 0 ? left : right);
        sum->sign = order < 0 ? right_sign : order > 0 ? left->sign : 0;
    }
}

static void hc_add(hc_integer *sum, const hc_integer *left, const hc_integer *right) {
    hc_combine(sum, left, right, 1);
}

static void hc_subtract(hc_integer *difference, const hc_integer *left, const hc_integer *right) {
    hc_combine(difference, left, right, -1);
}

/* to += factor from, or to = factor from for the first one; returns the limb behind the last. */
static hc_limb hc_add_row(hc_limb *to, const hc_limb *from, int length, hc_limb factor, int first) {
    hc_wide carry = 0;
    int i;
    if (first) {
        for (i = 0; i < length; i++) {
            carry += (hc_wide)from[i] * factor;
            to[i] = (hc_limb)carry;
            carry >>= HC_LIMB_BITS;
        }
    } else {
        for (i = 0; i < length; i++) {
            carry += (hc_wide)from[i] * factor + to[i];
            to[i] = (hc_limb)carry;
            carry >>= HC_LIMB_BITS;
        }
    }
    return (hc_limb)carry;
}

static void hc_multiply(hc_integer *product, const hc_integer *left, const hc_integer *right) {
    const hc_integer *const longer = left->length < right->length ? right : left;
    const hc_integer *const shorter = left->length < right->length ? left : right;
    hc_limb *const limbs = product->limbs;
    const int length = longer->length;
    int j;
    product->sign = left->sign * right->sign;
    product->length = 0;
    if (product->sign == 0) return;
    for (j = 0; j < shorter->length; j++)
        limbs[length + j] = hc_add_row(limbs + j, longer->limbs, length, shorter->limbs[j], j == 0);
    product->length = length + shorter->length;
    if (limbs[product->length - 1] == 0) product->length--;
}

/* product = factor number, 0 < factor */
static void hc_scale(hc_integer *product, hc_limb factor, const hc_integer *number) {
    hc_wide carry = 0;
    int i;
    for (i = 0; i < number->length; i++) {
        carry += (hc_wide)number->limbs[i] * factor;
        product->limbs[i] = (hc_limb)carry;
        carry >>= HC_LIMB_BITS;
    }
    if (carry) product->limbs[i++] = (hc_limb)carry;
    product->length = i;
    product->sign = number->sign;
}

/* A finite double is sign mantissa 2^exponent, the mantissa odd, or 0 with an exponent above all others, so that it does
   not choose the unit: any exponent would give right answers, a lower one longer integers. */
typedef struct {
    int sign;
    int exponent;
    uint64_t mantissa;
} hc_parts;

static hc_parts hc_parts_of(double value) {
    hc_parts parts;
    uint64_t bits;
    int biased;
    memcpy(&bits, &value, sizeof bits);
    biased = (int)(bits >> 52 & 0x7ff);
    parts.mantissa = (bits & 0xfffffffffffffu) | (biased ? (uint64_t)1 << 52 : 0);
    parts.exponent = (biased ? biased : 1) - 1075;
    parts.sign = parts.mantissa == 0 ? 0 : bits >> 63 ? -1 : 1;
    if (parts.mantissa == 0) parts.exponent = 2048;
    if (parts.mantissa) {
        const int zeros = hc_lowest_bit(parts.mantissa);
        parts.mantissa >>= zeros;
        parts.exponent += zeros;
    }
    return parts;
}

/* number = the parts in units of 2^unit; unit is at most their exponent, unless they are 0 */
static void hc_in_units(hc_integer *number, hc_parts parts, int unit) {
    uint64_t rest;
    int i = 0, shift;
    number->sign = parts.sign;
    number->length = 0;
    if (parts.sign == 0) return;
    for (shift = parts.exponent - unit; shift >= HC_LIMB_BITS; shift -= HC_LIMB_BITS) number->limbs[i++] = 0;
    number->limbs[i++] = (hc_limb)(parts.mantissa << shift);
    rest = shift ? parts.mantissa >> (HC_LIMB_BITS - shift) : parts.mantissa >> HC_LIMB_BITS / 2 >> HC_LIMB_BITS / 2;
    for (; rest; rest = rest >> HC_LIMB_BITS / 2 >> HC_LIMB_BITS / 2) number->limbs[i++] = (hc_limb)rest;
    number->length = i;
}

static int hc_least(int left, int right) { return left < right ? left : right; }

/* The position of a valid row, by the rule for all regimes (kernel/integers.py of hypcheck, docs/kernel.md). */
static int hc_position_by_integers(const double row[7]) {
    const hc_parts alpha_parts = hc_parts_of(row[0]), gamma_parts = hc_parts_of(row[1]), b_parts = hc_parts_of(row[2]),
                   d_parts = hc_parts_of(row[3]), x_parts = hc_parts_of(row[4]), y_parts = hc_parts_of(row[5]),
                   z_parts = hc_parts_of(row[6]);
    const int radial_unit = hc_least(hc_least(alpha_parts.exponent, b_parts.exponent),
                                     hc_least(x_parts.exponent, y_parts.exponent));
    const int axial_unit = hc_least(hc_least(gamma_parts.exponent, d_parts.exponent), z_parts.exponent);
    /* printed from the program "integers", the bits counted from it */
    HC_INTEGER(alpha, 2098);
    HC_INTEGER(gamma, 2098);
    HC_INTEGER(b, 2098);
    HC_INTEGER(d, 2098);
    HC_INTEGER(x, 2098);
    HC_INTEGER(y, 2098);
    HC_INTEGER(z, 2098);
    hc_in_units(&alpha, alpha_parts, radial_unit);
    hc_in_units(&b, b_parts, radial_unit);
    hc_in_units(&x, x_parts, radial_unit);
    hc_in_units(&y, y_parts, radial_unit);
    hc_in_units(&gamma, gamma_parts, axial_unit);
    hc_in_units(&d, d_parts, axial_unit);
    hc_in_units(&z, z_parts, axial_unit);
    {
        HC_INTEGER(p, 4196); hc_multiply(&p, &alpha, &alpha);
        HC_INTEGER(q, 4196); hc_multiply(&q, &b, &b);
        HC_INTEGER(s, 4196); hc_multiply(&s, &gamma, &gamma);
        HC_INTEGER(t, 4196); hc_multiply(&t, &d, &d);
        HC_INTEGER(xx, 4196); hc_multiply(&xx, &x, &x);
        HC_INTEGER(yy, 4196); hc_multiply(&yy, &y, &y);
        HC_INTEGER(R, 4197); hc_add(&R, &xx, &yy);
        HC_INTEGER(S, 4196); hc_multiply(&S, &z, &z);
        HC_INTEGER(N, 8392); hc_multiply(&N, &q, &t);
        HC_INTEGER(p_plus_q, 4197); hc_add(&p_plus_q, &p, &q);
        HC_INTEGER(p_q_R, 4198); hc_subtract(&p_q_R, &p_plus_q, &R);
        HC_INTEGER(s_plus_S, 4197); hc_add(&s_plus_S, &s, &S);
        HC_INTEGER(radial_2, 8394); hc_multiply(&radial_2, &p_q_R, &t);
        HC_INTEGER(axial_2, 8393); hc_multiply(&axial_2, &s_plus_S, &q);
        HC_INTEGER(n2, 8395); hc_subtract(&n2, &radial_2, &axial_2);
        HC_INTEGER(t_minus_s, 4197); hc_subtract(&t_minus_s, &t, &s);
        HC_INTEGER(t_s_S, 4198); hc_subtract(&t_s_S, &t_minus_s, &S);
        HC_INTEGER(R_minus_q, 4198); hc_subtract(&R_minus_q, &R, &q);
        HC_INTEGER(axial_1, 8394); hc_multiply(&axial_1, &t_s_S, &p);
        HC_INTEGER(radial_1, 8394); hc_multiply(&radial_1, &R_minus_q, &s);
        HC_INTEGER(n1, 8395); hc_add(&n1, &axial_1, &radial_1);
        HC_INTEGER(ps, 8392); hc_multiply(&ps, &p, &s);
        HC_INTEGER(n2_n2, 16790); hc_multiply(&n2_n2, &n2, &n2);
        HC_INTEGER(N_n1, 16787); hc_multiply(&N_n1, &N, &n1);
        HC_INTEGER(N_n1_3, 16789); hc_scale(&N_n1_3, 3, &N_n1);
        HC_INTEGER(h1, 16791); hc_subtract(&h1, &n2_n2, &N_n1_3);
        HC_INTEGER(n2_n1, 16790); hc_multiply(&n2_n1, &n2, &n1);
        HC_INTEGER(N_ps, 16784); hc_multiply(&N_ps, &N, &ps);
        HC_INTEGER(N_ps_9, 16788); hc_scale(&N_ps_9, 9, &N_ps);
        HC_INTEGER(h2, 16791); hc_add(&h2, &n2_n1, &N_ps_9);
        HC_INTEGER(n1_n1, 16790); hc_multiply(&n1_n1, &n1, &n1);
        HC_INTEGER(n2_ps, 16787); hc_multiply(&n2_ps, &n2, &ps);
        HC_INTEGER(n2_ps_3, 16789); hc_scale(&n2_ps_3, 3, &n2_ps);
        HC_INTEGER(h3, 16791); hc_add(&h3, &n1_n1, &n2_ps_3);
        HC_INTEGER(h1_h3, 33582); hc_multiply(&h1_h3, &h1, &h3);
        HC_INTEGER(h1_h3_4, 33585); hc_scale(&h1_h3_4, 4, &h1_h3);
        HC_INTEGER(h2_h2, 33582); hc_multiply(&h2_h2, &h2, &h2);
        HC_INTEGER(delta, 33586); hc_subtract(&delta, &h1_h3_4, &h2_h2);
        /* A sign that is 0 decides nothing here. Where delta > 0, n2 and n1 are not 0 beside n1 > 0 and n2 < 0: with c0 < 0,
           c1 = 0 makes 4 c2³ + 27 c0 of the sign of delta, negative for c2 < 0, and c2 = 0 makes it -4 c1³ - 27 c0². And no
           slope is 0 on the side of the inflection that is asked for: there it would be the local maximum of g, which is
           positive between two of three roots, and g(B) and g(-A) are not. At the inflection itself the slope is < 0. */
        if (delta.sign > 0 && n2.sign < 0 && n1.sign > 0) { /* three positive roots: are they all beyond B? */
            HC_INTEGER(N_s, 12588); hc_multiply(&N_s, &N, &s);
            HC_INTEGER(N_s_3, 12590); hc_scale(&N_s_3, 3, &N_s);
            HC_INTEGER(n2_t, 12591); hc_multiply(&n2_t, &n2, &t);
            HC_INTEGER(offset_at_B, 12592); hc_add(&offset_at_B, &N_s_3, &n2_t);
            HC_INTEGER(offset_and_n2_t, 12593); hc_add(&offset_and_n2_t, &offset_at_B, &n2_t);
            HC_INTEGER(rise_at_B, 16789); hc_multiply(&rise_at_B, &offset_and_n2_t, &s);
            HC_INTEGER(n1_t, 12591); hc_multiply(&n1_t, &n1, &t);
            HC_INTEGER(n1_tt, 16787); hc_multiply(&n1_tt, &n1_t, &t);
            HC_INTEGER(slope_at_B, 16790); hc_add(&slope_at_B, &rise_at_B, &n1_tt);
            return offset_at_B.sign < 0 && slope_at_B.sign > 0 ? 0 : 1;
        }
        if (delta.sign > 0) { /* two negative roots: do they lie above -A? */
            HC_INTEGER(N_p, 12588); hc_multiply(&N_p, &N, &p);
            HC_INTEGER(N_p_3, 12590); hc_scale(&N_p_3, 3, &N_p);
            HC_INTEGER(n2_q, 12591); hc_multiply(&n2_q, &n2, &q);
            HC_INTEGER(offset_at_A, 12592); hc_subtract(&offset_at_A, &N_p_3, &n2_q);
            HC_INTEGER(offset_less_n2_q, 12593); hc_subtract(&offset_less_n2_q, &offset_at_A, &n2_q);
            HC_INTEGER(rise_at_A, 16789); hc_multiply(&rise_at_A, &offset_less_n2_q, &p);
            HC_INTEGER(n1_q, 12591); hc_multiply(&n1_q, &n1, &q);
            HC_INTEGER(n1_qq, 16787); hc_multiply(&n1_qq, &n1_q, &q);
            HC_INTEGER(slope_at_A, 16790); hc_add(&slope_at_A, &rise_at_A, &n1_qq);
            return offset_at_A.sign > 0 && slope_at_A.sign > 0 ? -1 : 0;
        }
        if (delta.sign == 0 && z.sign == 0) { /* the ring: B is a double root, and the simple one lies below it */
            HC_INTEGER(N_s, 12588); hc_multiply(&N_s, &N, &s);
            HC_INTEGER(N_s_3, 12590); hc_scale(&N_s_3, 3, &N_s);
            HC_INTEGER(n2_t, 12591); hc_multiply(&n2_t, &n2, &t);
            HC_INTEGER(offset_at_B, 12592); hc_add(&offset_at_B, &N_s_3, &n2_t);
            HC_INTEGER(offset_and_n2_t, 12593); hc_add(&offset_and_n2_t, &offset_at_B, &n2_t);
            HC_INTEGER(rise_at_B, 16789); hc_multiply(&rise_at_B, &offset_and_n2_t, &s);
            HC_INTEGER(n1_t, 12591); hc_multiply(&n1_t, &n1, &t);
            HC_INTEGER(n1_tt, 16787); hc_multiply(&n1_tt, &n1_t, &t);
            HC_INTEGER(slope_at_B, 16790); hc_add(&slope_at_B, &rise_at_B, &n1_tt);
            HC_INTEGER(p_t, 8392); hc_multiply(&p_t, &p, &t);
            HC_INTEGER(p_tt, 12588); hc_multiply(&p_tt, &p_t, &t);
            HC_INTEGER(q_s, 8392); hc_multiply(&q_s, &q, &s);
            HC_INTEGER(q_ss, 12588); hc_multiply(&q_ss, &q_s, &s);
            HC_INTEGER(ring_excess, 12589); hc_subtract(&ring_excess, &q_ss, &p_tt);
            return slope_at_B.sign == 0 && ring_excess.sign > 0 ? 1 : 0;
        }
    }
    /* end of the program "integers" */
    return 0;
}

static int hc_valid(const double row[7]) {
    int i;
    for (i = 0; i < 7; i++) {
        uint64_t bits;
        memcpy(&bits, row + i, sizeof bits);
        if ((bits >> 52 & 0x7ff) == 0x7ff) return 0;          /* infinite or NaN */
        if (i < 4 && (bits >> 63 || bits == 0)) return 0; /* a size that is negative, -0.0 or 0 */
    }
    return 1;
}


/* ---- fixed point: the rule in 128 bits, before the exact integers ---- */

/* What is cut at most, in units (programs/fixed.py of hypcheck): of n2 and n1, of offsets and slopes at the poles, and of delta
   and `middle` for each 2^grown. */
#define HC_fixed_coefficient 8
#define HC_fixed_pole 22
#define HC_fixed_delta 31
#define HC_fixed_middle 39
#define HC_MOST_GROWN 100

/* A number in two's complement, of units that are told beside it. */
typedef struct {
    uint64_t low, high;
} hc_fixed;

/* The 128 bits of a product. */
static inline hc_fixed hc_fixed_full(uint64_t left, uint64_t right) {
    hc_fixed product;
#if HC_LIMB_BITS == 64
    const hc_wide wide = (hc_wide)left * right;
    product.low = (uint64_t)wide;
    product.high = (uint64_t)(wide >> 64);
#else
    const uint64_t half = 0xffffffffu, low = (left & half) * (right & half);
    const uint64_t mixed = (left >> 32) * (right & half) + (low >> 32);
    const uint64_t other = (left & half) * (right >> 32) + (mixed & half);
    product.low = other << 32 | (low & half);
    product.high = (left >> 32) * (right >> 32) + (mixed >> 32) + (other >> 32);
#endif
    return product;
}

/* The same of a number in two's complement and one >= 0. */
static inline hc_fixed hc_fixed_full_signed(uint64_t left, uint64_t right) {
    hc_fixed product = hc_fixed_full(left, right);
    product.high -= right & (0 - (left >> 63));
    return product;
}

static inline hc_fixed hc_fixed_plus(hc_fixed left, hc_fixed right) {
    hc_fixed sum;
    sum.low = left.low + right.low;
    sum.high = left.high + right.high + (sum.low < left.low);
    return sum;
}

static inline hc_fixed hc_fixed_minus(hc_fixed left, hc_fixed right) {
    hc_fixed difference;
    difference.low = left.low - right.low;
    difference.high = left.high - right.high - (left.low < right.low);
    return difference;
}

/* All bits of a number < 0, none of another. */
static inline uint64_t hc_fixed_negative(hc_fixed number) { return 0 - (number.high >> 63); }

/* The highest 128 of the 256 bits of a product of numbers >= 0, less than 3 units too low. */
static inline hc_fixed hc_fixed_product(hc_fixed left, hc_fixed right) {
    const uint64_t mixed = hc_fixed_full(left.high, right.low).high, other = hc_fixed_full(left.low, right.high).high;
    hc_fixed product = hc_fixed_full(left.high, right.high);
    product.low += mixed;
    product.high += product.low < mixed;
    product.low += other;
    product.high += product.low < other;
    return product;
}

/* The same where the first factor, or both, may be < 0: 2^128 more of it than is meant gave so much of the other too much. */
static inline hc_fixed hc_fixed_signed_product(hc_fixed left, hc_fixed right) {
    const uint64_t mask = hc_fixed_negative(left);
    hc_fixed excess;
    excess.low = right.low & mask;
    excess.high = right.high & mask;
    return hc_fixed_minus(hc_fixed_product(left, right), excess);
}

static inline hc_fixed hc_fixed_both_signed_product(hc_fixed left, hc_fixed right) {
    const uint64_t mask = hc_fixed_negative(right);
    hc_fixed excess;
    excess.low = left.low & mask;
    excess.high = left.high & mask;
    return hc_fixed_minus(hc_fixed_signed_product(left, right), excess);
}

static inline hc_fixed hc_fixed_square(hc_fixed number) {
    const uint64_t mask = hc_fixed_negative(number), low = (number.low ^ mask) - mask;
    const uint64_t high = (number.high ^ mask) + (mask & (low == 0)), mixed = hc_fixed_full(high, low).high;
    hc_fixed square = hc_fixed_full(high, high);
    square.high += mixed >> 63;
    square.low += mixed << 1;
    square.high += square.low < mixed << 1;
    return square;
}

/* number 2^by, by being 0 .. 127 */
static inline hc_fixed hc_fixed_up(hc_fixed number, int by) {
    const int rest = by & 63;
    const uint64_t low = number.low << rest, high = number.high << rest | number.low >> 1 >> (63 - rest);
    hc_fixed moved;
    moved.low = by & 64 ? 0 : low;
    moved.high = by & 64 ? low : high;
    return moved;
}

/* number / 2^by rounded down; beyond 127, as for 127, 0 or -1 */
static inline hc_fixed hc_fixed_down(hc_fixed number, int by) {
    const uint64_t mask = hc_fixed_negative(number);
    const int most = by < 127 ? by : 127, rest = most & 63;
    const uint64_t low = number.low >> rest | number.high << 1 << (63 - rest), high = number.high >> rest | mask << 1 << (63 - rest);
    hc_fixed moved;
    moved.low = most & 64 ? high : low;
    moved.high = most & 64 ? mask : high;
    return moved;
}

/* 2, 3, 4 or 9 times the number */
static inline hc_fixed hc_fixed_times(int factor, hc_fixed number) {
    const hc_fixed most = hc_fixed_up(number, factor == 9 ? 3 : factor == 4 ? 2 : 1);
    return factor & 1 ? hc_fixed_plus(most, number) : most;
}

/* The bits of the size of a number, 1 for 0 and -1. */
static inline int hc_fixed_bits(hc_fixed number) {
    const uint64_t mask = hc_fixed_negative(number), high = number.high ^ mask, low = number.low ^ mask;
    return high ? 65 + hc_highest_bit(high) : 1 + hc_highest_bit(low | 1);
}

/* The sign of a number that is farther from 0 than `error` 2^grown, else 0. */
static inline int hc_fixed_sign(hc_fixed number, uint64_t error, int grown) {
    const uint64_t mask = hc_fixed_negative(number), high = number.high ^ mask, low = number.low ^ mask;
    hc_fixed limit = {0, 0};
    limit.low = error;
    limit = hc_fixed_up(limit, grown);
    return high > limit.high || (high == limit.high && low > limit.low) ? (mask ? -1 : 1) : 0;
}

/* A finite double as mantissa 2^(exponent - 1075), the mantissa having 53 bits, or as 0 with an exponent below all others. */
static inline hc_parts hc_fixed_parts_of(double value) {
    const uint64_t leading = (uint64_t)1 << 52;
    hc_parts parts;
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    parts.sign = 1;
    parts.exponent = (int)(bits >> 52 & 0x7ff);
    parts.mantissa = bits & (leading - 1);
    if (parts.exponent) {
        parts.mantissa |= leading;
    } else if (parts.mantissa) {
        const int zeros = 52 - hc_highest_bit(parts.mantissa);
        parts.mantissa <<= zeros;
        parts.exponent = 1 - zeros;
    } else {
        parts.exponent = -4096;
    }
    return parts;
}

/* The square of the mantissa, 1/4 at least and less than 1, in units of 2^-126. */
static inline hc_fixed hc_fixed_whole(hc_parts parts) { return hc_fixed_full(parts.mantissa << 10, parts.mantissa << 10); }

/* What the rule is made of, in the units of the program "fixed-terms" (programs/fixed.py of hypcheck). What has a factor b²
   was divided by 2^by_q besides, and what has d² by 2^by_t; n2 is so 2^small times as large. */
typedef struct {
    hc_fixed p, q, s, t, S, R, whole_q, whole_t, N, n2, n1, ps;
    int by_q, by_t, small;
    int top_N, top_ps; /* N is below 2^top_N, ps below 2^top_ps */
} hc_fixed_terms;

static hc_fixed_terms hc_fixed_terms_of(const double row[7]) {
    const hc_parts alpha = hc_fixed_parts_of(row[0]), gamma = hc_fixed_parts_of(row[1]), b = hc_fixed_parts_of(row[2]),
                   d = hc_fixed_parts_of(row[3]), x = hc_fixed_parts_of(row[4]), y = hc_fixed_parts_of(row[5]),
                   z = hc_fixed_parts_of(row[6]);
    const int radial = HC_MAX_OF(HC_MAX_OF(alpha.exponent, b.exponent), HC_MAX_OF(x.exponent, y.exponent));
    const int axial = HC_MAX_OF(HC_MAX_OF(gamma.exponent, d.exponent), z.exponent);
    const int small_p = 2 * (radial - alpha.exponent), small_q = 2 * (radial - b.exponent);
    const int small_s = 2 * (axial - gamma.exponent), small_t = 2 * (axial - d.exponent);
    const int small = HC_MIN_OF(small_q, small_t), by_q = small_q - small, by_t = small_t - small;
    const hc_fixed whole_p = hc_fixed_whole(alpha), whole_q = hc_fixed_whole(b), whole_s = hc_fixed_whole(gamma),
                   whole_t = hc_fixed_whole(d);
    const hc_fixed p = hc_fixed_down(whole_p, small_p), q = hc_fixed_down(whole_q, small_q),
                   s = hc_fixed_down(whole_s, small_s), t = hc_fixed_down(whole_t, small_t),
                   xx = hc_fixed_down(hc_fixed_whole(x), 2 * (radial - x.exponent)),
                   yy = hc_fixed_down(hc_fixed_whole(y), 2 * (radial - y.exponent)),
                   S = hc_fixed_down(hc_fixed_whole(z), 2 * (axial - z.exponent));
    hc_fixed_terms terms;
    /* printed from the program "fixed-terms" */
    const hc_fixed R = hc_fixed_plus(xx, yy);
    const hc_fixed p_plus_q = hc_fixed_plus(p, q);
    const hc_fixed p_q_R = hc_fixed_minus(p_plus_q, R);
    const hc_fixed radial_2 = hc_fixed_signed_product(p_q_R, whole_t);
    const hc_fixed s_plus_S = hc_fixed_plus(s, S);
    const hc_fixed axial_2 = hc_fixed_product(s_plus_S, whole_q);
    const hc_fixed t_minus_s = hc_fixed_minus(t, s);
    const hc_fixed t_s_S = hc_fixed_minus(t_minus_s, S);
    const hc_fixed axial_1 = hc_fixed_signed_product(t_s_S, p);
    const hc_fixed R_minus_q = hc_fixed_minus(R, q);
    const hc_fixed radial_1 = hc_fixed_signed_product(R_minus_q, s);
    const hc_fixed n1 = hc_fixed_plus(axial_1, radial_1);
    const hc_fixed N = hc_fixed_product(whole_q, whole_t);
    const hc_fixed ps = hc_fixed_product(whole_p, whole_s);
    /* end of the program "fixed-terms" */
    terms.p = p, terms.q = q, terms.s = s, terms.t = t, terms.S = S, terms.R = R;
    terms.whole_q = whole_q, terms.whole_t = whole_t;
    terms.N = N, terms.n1 = n1, terms.ps = ps;
    terms.n2 = hc_fixed_minus(hc_fixed_down(radial_2, by_t), hc_fixed_down(axial_2, by_q));
    terms.by_q = by_q, terms.by_t = by_t, terms.small = small;
    terms.top_N = -small_q - small_t, terms.top_ps = -small_p - small_s;
    return terms;
}

/* Numbers of the program "fixed-discriminant", whose errors are multiples of 2^grown units, of roots divided by 2^k. */
typedef struct {
    hc_fixed delta, middle, h1, h2, N, n2;
    int grown, k;
} hc_fixed_cubic;

static hc_fixed_cubic hc_fixed_cubic_of(const hc_fixed_terms *terms) {
    const int bits_2 = hc_fixed_bits(terms->n2), bits_1 = hc_fixed_bits(terms->n1);
    const int top_2 = bits_2 - 124 - terms->small, top_1 = bits_1 - 124, top_0 = terms->top_ps, top_3 = terms->top_N;
    /* 2^k is about |n1 / n2|, but not where one of them has vanished: then the others tell the size of the roots. */
    const int least = HC_MAX_OF(top_1 - top_2, (top_0 - top_2) / 2), most = HC_MAX_OF((top_1 - top_3) / 2, (top_0 - top_3) / 3);
    const int k = HC_MIN_OF(least, most);
    const int top = HC_MAX_OF(HC_MAX_OF(top_3 + 3 * k, top_2 + 2 * k), HC_MAX_OF(top_1 + k, top_0));
    const int down_3 = top - top_3 - 3 * k, down_2 = top - top_2 - 2 * k, down_1 = top - top_1 - k, down_0 = top - top_0;
    const int up_2 = 126 - bits_2, up_1 = 126 - bits_1;
    const hc_fixed N = hc_fixed_down(hc_fixed_up(terms->N, 1), down_3), ps = hc_fixed_down(hc_fixed_up(terms->ps, 1), down_0),
                   n2 = hc_fixed_down(hc_fixed_up(terms->n2, up_2), down_2 + 1),
                   n1 = hc_fixed_down(hc_fixed_up(terms->n1, up_1), down_1 + 1);
    hc_fixed_cubic cubic;
    /* printed from the program "fixed-discriminant" */
    const hc_fixed n2_n2 = hc_fixed_square(n2);
    const hc_fixed N_n1 = hc_fixed_signed_product(n1, N);
    const hc_fixed N_n1_3 = hc_fixed_times(3, N_n1);
    const hc_fixed h1 = hc_fixed_minus(n2_n2, N_n1_3);
    const hc_fixed n2_n1 = hc_fixed_both_signed_product(n2, n1);
    const hc_fixed N_ps = hc_fixed_product(N, ps);
    const hc_fixed N_ps_9 = hc_fixed_times(9, N_ps);
    const hc_fixed h2 = hc_fixed_plus(n2_n1, N_ps_9);
    const hc_fixed n1_n1 = hc_fixed_square(n1);
    const hc_fixed n2_ps = hc_fixed_signed_product(n2, ps);
    const hc_fixed n2_ps_3 = hc_fixed_times(3, n2_ps);
    const hc_fixed h3 = hc_fixed_plus(n1_n1, n2_ps_3);
    const hc_fixed h1_h3 = hc_fixed_both_signed_product(h1, h3);
    const hc_fixed h1_h3_4 = hc_fixed_times(4, h1_h3);
    const hc_fixed h2_h2 = hc_fixed_square(h2);
    const hc_fixed delta = hc_fixed_minus(h1_h3_4, h2_h2);
    const hc_fixed n2_h1 = hc_fixed_both_signed_product(n2, h1);
    const hc_fixed n2_h1_2 = hc_fixed_times(2, n2_h1);
    const hc_fixed N_h2 = hc_fixed_signed_product(h2, N);
    const hc_fixed N_h2_3 = hc_fixed_times(3, N_h2);
    const hc_fixed middle = hc_fixed_minus(n2_h1_2, N_h2_3);
    /* end of the program "fixed-discriminant" */
    cubic.delta = delta;
    cubic.middle = middle;
    cubic.h1 = h1, cubic.h2 = h2, cubic.N = N, cubic.n2 = n2, cubic.k = k;
    cubic.grown = HC_MAX_OF(0, HC_MAX_OF(up_2 - down_2, up_1 - down_1) - 1);
    return cubic;
}

/* The signs of 3B + c2 and of g'(B), 0 where they are not certain. */
static void hc_fixed_at_B(const hc_fixed_terms *terms, int *offset, int *slope) {
    const hc_fixed p = terms->p, s = terms->s, t = terms->t, S = terms->S, R = terms->R, n2 = terms->n2;
    const hc_fixed whole_q = terms->whole_q, whole_t = terms->whole_t;
    /* printed from the program "fixed-poles" */
    const hc_fixed p_t = hc_fixed_down(hc_fixed_product(p, whole_t), terms->by_t);
    const hc_fixed s_t = hc_fixed_down(hc_fixed_product(s, whole_t), terms->by_t);
    const hc_fixed q_s = hc_fixed_down(hc_fixed_product(s, whole_q), terms->by_q);
    const hc_fixed q_s_3 = hc_fixed_times(3, q_s);
    const hc_fixed offset_at_B = hc_fixed_plus(q_s_3, n2);
    const hc_fixed p_t_q_s = hc_fixed_plus(p_t, q_s);
    const hc_fixed t_plus_s = hc_fixed_plus(t, s);
    const hc_fixed rise_at_B = hc_fixed_product(p_t_q_s, t_plus_s);
    const hc_fixed q_s_2 = hc_fixed_times(2, q_s);
    const hc_fixed p_t_q_s_2 = hc_fixed_plus(p_t, q_s_2);
    const hc_fixed axial_fall = hc_fixed_product(p_t_q_s_2, S);
    const hc_fixed radial_fall = hc_fixed_product(s_t, R);
    const hc_fixed rise_less_axial = hc_fixed_minus(rise_at_B, axial_fall);
    const hc_fixed slope_at_B = hc_fixed_minus(rise_less_axial, radial_fall);
    /* end of the program "fixed-poles" */
    *offset = hc_fixed_sign(offset_at_B, HC_fixed_pole, 0);
    *slope = hc_fixed_sign(slope_at_B, HC_fixed_pole, 0);
}

/* The signs of 3A - c2 and of g'(-A). */
static void hc_fixed_at_A(const hc_fixed_terms *terms, int *offset, int *slope) {
    const hc_fixed p = terms->p, q = terms->q, s = terms->s, S = terms->S, R = terms->R, n2 = terms->n2;
    const hc_fixed whole_q = terms->whole_q, whole_t = terms->whole_t;
    /* printed from the program "fixed-poles" */
    const hc_fixed p_t = hc_fixed_down(hc_fixed_product(p, whole_t), terms->by_t);
    const hc_fixed q_s = hc_fixed_down(hc_fixed_product(s, whole_q), terms->by_q);
    const hc_fixed p_q = hc_fixed_down(hc_fixed_product(p, whole_q), terms->by_q);
    const hc_fixed p_t_q_s = hc_fixed_plus(p_t, q_s);
    const hc_fixed p_t_3 = hc_fixed_times(3, p_t);
    const hc_fixed offset_at_A = hc_fixed_minus(p_t_3, n2);
    const hc_fixed p_t_2 = hc_fixed_times(2, p_t);
    const hc_fixed p_t_2_q_s = hc_fixed_plus(p_t_2, q_s);
    const hc_fixed radial_rise = hc_fixed_product(p_t_2_q_s, R);
    const hc_fixed axial_rise = hc_fixed_product(p_q, S);
    const hc_fixed p_less_q = hc_fixed_minus(p, q);
    const hc_fixed width_at_A = hc_fixed_signed_product(p_less_q, p_t_q_s);
    const hc_fixed rise_at_A = hc_fixed_plus(radial_rise, axial_rise);
    const hc_fixed slope_at_A = hc_fixed_plus(rise_at_A, width_at_A);
    /* end of the program "fixed-poles" */
    *offset = hc_fixed_sign(offset_at_A, HC_fixed_pole, 0);
    *slope = hc_fixed_sign(slope_at_A, HC_fixed_pole, 0);
}

/* About the number, as good as a guess has to be; a small number, such as the product of two short lengths, exactly. */
static inline double hc_fixed_value(hc_fixed number) {
    const double low = 2.0 * (double)(int64_t)(number.low >> 1) + (double)(int)(number.low & 1);
    return (double)(int64_t)number.high * 18446744073709551616.0 + low;
}

/* About the double root that the cubic has if delta is 0, or 0 where there is no guess. */
static double hc_fixed_double_root(const hc_fixed_cubic *cubic) {
    const int most = 1000;
    const uint64_t bits = (uint64_t)(cubic->k + 1023) << 52;
    double power;
    if (cubic->k < -most || cubic->k > most || cubic->grown > HC_MOST_GROWN) return 0;
    memcpy(&power, &bits, sizeof power);
    if (hc_fixed_sign(cubic->h1, 64, cubic->grown) == 0) /* a triple one */
        return hc_fixed_value(cubic->n2) / (-3 * hc_fixed_value(cubic->N)) * power;
    return -0.5 * hc_fixed_value(cubic->h2) / hc_fixed_value(cubic->h1) * power;
}

/* The position of a valid row; 2 where the bounds do not tell: then `about` is about the double root, if it is one. */
static int hc_fixed_position(const double row[7], double *about) {
    const hc_fixed_terms terms = hc_fixed_terms_of(row);
    const hc_fixed_cubic cubic = hc_fixed_cubic_of(&terms);
    const int delta = cubic.grown > HC_MOST_GROWN ? 0 : hc_fixed_sign(cubic.delta, HC_fixed_delta, cubic.grown);
    const int c2 = hc_fixed_sign(terms.n2, HC_fixed_coefficient, 0), c1 = hc_fixed_sign(terms.n1, HC_fixed_coefficient, 0);
    int offset, slope;
    *about = delta ? 0 : hc_fixed_double_root(&cubic);
    if (delta < 0) return 0;
    if (c2 < 0 && c1 > 0) { /* where delta > 0, three positive roots */
        hc_fixed_at_B(&terms, &offset, &slope);
        if (delta > 0 && (offset > 0 || slope < 0)) return 1;
        if (offset < 0 && slope > 0) return 0; /* whatever delta is */
        /* g > 0 at its inflection, which lies between 0 and B: the ring, or nearly so */
        return offset > 0 && cubic.grown <= HC_MOST_GROWN && hc_fixed_sign(cubic.middle, HC_fixed_middle, cubic.grown) > 0 ? 1 : 2;
    }
    if (c2 > 0 || c1 < 0) { /* where delta > 0, two negative roots; they lie above -A if alpha >= b */
        if (delta > 0 && row[0] >= row[2]) return -1;
        hc_fixed_at_A(&terms, &offset, &slope);
        if (offset < 0 || slope < 0) return 0; /* whatever delta is: on the ring all roots are positive */
        return delta > 0 && offset > 0 && slope > 0 ? -1 : 2;
    }
    return 2;
}


/* ---- exact tangencies: a double root that is proved in 256 bits ---- */

#define HC_TANGENCY_BITS 62 /* lengths in units of their lowest bit, for which all numbers here fit */
#define HC_TANGENCY_TURNS 4 /* of Newton's method */
#define HC_HAIR 1e-18       /* of b, or of gamma: a coordinate so short is looked at apart */

/* A whole number in two's complement, modulo 2^256. */
typedef struct {
    uint64_t words[4];
} hc_long;

static inline hc_long hc_long_product(hc_fixed left, hc_fixed right) {
    const hc_fixed low = hc_fixed_full(left.low, right.low), high = hc_fixed_full(left.high, right.high);
    const hc_fixed mixed = hc_fixed_full(left.low, right.high), other = hc_fixed_full(left.high, right.low);
    hc_long product;
    uint64_t carry;
    product.words[0] = low.low;
    product.words[1] = low.high + mixed.low;
    carry = product.words[1] < mixed.low;
    product.words[1] += other.low;
    carry += product.words[1] < other.low;
    product.words[2] = high.low + carry;
    product.words[3] = high.high + (product.words[2] < carry);
    product.words[2] += mixed.high;
    product.words[3] += product.words[2] < mixed.high;
    product.words[2] += other.high;
    product.words[3] += product.words[2] < other.high;
    return product;
}

/* left + right, or left - right */
static inline hc_long hc_long_sum(hc_long left, hc_long right, int minus) {
    const uint64_t mask = 0 - (uint64_t)minus;
    uint64_t carry = (uint64_t)minus;
    hc_long sum;
    int i;
    for (i = 0; i < 4; i++) {
        const uint64_t term = right.words[i] ^ mask, part = left.words[i] + term;
        sum.words[i] = part + carry;
        carry = (uint64_t)((part < term) | (sum.words[i] < carry));
    }
    return sum;
}

/* The product of a number of any sign and one >= 0 */
static inline hc_long hc_long_signed_product(hc_fixed left, hc_fixed right) {
    const uint64_t mask = hc_fixed_negative(left);
    hc_long product = hc_long_product(left, right), excess = {{0, 0, 0, 0}};
    excess.words[2] = right.low & mask;
    excess.words[3] = right.high & mask;
    return hc_long_sum(product, excess, 1);
}

static inline int hc_long_is_zero(hc_long number) {
    return (number.words[0] | number.words[1] | number.words[2] | number.words[3]) == 0;
}

static inline int hc_long_is_negative(hc_long number) { return (int)(number.words[3] >> 63); }

/* About the number: good for a guess. */
static inline double hc_long_value(hc_long number) {
    const hc_long none = {{0, 0, 0, 0}};
    const double unit = 18446744073709551616.0;
    const int negative = hc_long_is_negative(number);
    double value = 0;
    int i;
    if (negative) number = hc_long_sum(none, number, 1);
    for (i = 3; i >= 0; i--) value = value * unit + 2.0 * (double)(int64_t)(number.words[i] >> 1) + (double)(int)(number.words[i] & 1);
    return negative ? -value : value;
}

/* The whole number nearest to a value below 2^126 in size. */
static hc_fixed hc_fixed_nearest(double value) {
    const double size = value < 0 ? -value : value;
    hc_fixed number = {0, 0};
    if (size < 4503599627370496.0) { /* 2^52 */
        number.low = (uint64_t)(size + 0.5);
    } else {
        const hc_parts parts = hc_fixed_parts_of(size);
        number.low = parts.mantissa;
        number = hc_fixed_up(number, parts.exponent - 1075);
    }
    if (value < 0) {
        const hc_fixed none = {0, 0};
        number = hc_fixed_minus(none, number);
    }
    return number;
}

/* The lengths alpha, gamma, b, d, x, y, z in units of the lowest bits of their kind. Returns how many bits hold the longest;
   more than HC_TANGENCY_BITS, and no lengths, where it is too long. */
static int hc_short_lengths(const double row[7], uint64_t lengths[7]) {
    hc_parts parts[7];
    uint64_t all = 0;
    int i, unit[2] = {4096, 4096};
    for (i = 0; i < 7; i++) {
        parts[i] = hc_fixed_parts_of(row[i]);
        if (parts[i].mantissa) {
            int *const least = unit + (i == 1 || i == 3 || i == 6);
            *least = hc_least(*least, parts[i].exponent + hc_lowest_bit(parts[i].mantissa));
        }
    }
    for (i = 0; i < 7; i++) {
        const int up = parts[i].exponent - unit[i == 1 || i == 3 || i == 6];
        if (up > HC_TANGENCY_BITS - 53) return HC_TANGENCY_BITS + 1;
        lengths[i] = up >= 0 ? parts[i].mantissa << up : up > -64 ? parts[i].mantissa >> -up : 0;
        all |= lengths[i];
    }
    return 1 + hc_highest_bit(all);
}

#define HC_NAMED_LENGTHS(lengths)                                                                                                      \
    const uint64_t alpha = lengths[0], gamma = lengths[1], b = lengths[2], d = lengths[3], x = lengths[4], y = lengths[5];

/* 1 or -1 where the row touches from without or from within in a double root that is `about` this number, which is then
   proved: with D = b d and K = alpha gamma, N g is (D l - M)² (l - e²/D²) for whole numbers M and e of the same sign with

       M e = D K,  n2 = -(2 D M + e²),  n1 = M² + 2 K e

   (docs/kernel.md of hypcheck). 2 where it is not so. */
static int hc_touches_by(const uint64_t lengths[7], double about) {
    HC_NAMED_LENGTHS(lengths)
    const uint64_t z = lengths[6];
    /* printed from the program "tangency", what M and e do not change */
    const hc_fixed p = hc_fixed_full(alpha, alpha);
    const hc_fixed q = hc_fixed_full(b, b);
    const hc_fixed s = hc_fixed_full(gamma, gamma);
    const hc_fixed t = hc_fixed_full(d, d);
    const hc_fixed xx = hc_fixed_full(x, x);
    const hc_fixed yy = hc_fixed_full(y, y);
    const hc_fixed R = hc_fixed_plus(xx, yy);
    const hc_fixed S = hc_fixed_full(z, z);
    const hc_fixed p_plus_q = hc_fixed_plus(p, q);
    const hc_fixed p_q_R = hc_fixed_minus(p_plus_q, R);
    const hc_fixed s_plus_S = hc_fixed_plus(s, S);
    const hc_long radial_2 = hc_long_signed_product(p_q_R, t);
    const hc_long axial_2 = hc_long_product(s_plus_S, q);
    const hc_long n2 = hc_long_sum(radial_2, axial_2, 1);
    const int inner = about < 0;
    const hc_fixed D = hc_fixed_full(b, d);
    const hc_fixed K = hc_fixed_full(alpha, gamma);
    const hc_long D_K = hc_long_product(D, K);
    /* end of the program "tangency" */
    const double d_ = hc_fixed_value(D), k_ = hc_fixed_value(K), size = inner ? -about : about, most = 4.2535295865117308e37; /* 2^125 */
    double m_ = size * d_, e_ = k_ / size;
    hc_fixed M, e;
    int turn;
    if (!(size > 0 && m_ < most && e_ < most)) return 2;
    M = hc_fixed_nearest(m_);
    e = hc_fixed_nearest(e_);
    for (turn = 0; turn < HC_TANGENCY_TURNS; turn++) { /* M and e are the sizes here */
        /* printed from the program "tangency", two equations */
        const hc_long M_e = hc_long_product(M, e);
        const hc_long e_e = hc_long_product(e, e);
        const hc_long D_M = hc_long_product(D, M);
        const hc_long r1 = hc_long_sum(D_K, M_e, 1);
        const hc_long n2_e_e = hc_long_sum(n2, e_e, 0);
        const hc_long D_M_2 = hc_long_sum(D_M, D_M, 0);
        const hc_long r2_outer = hc_long_sum(n2_e_e, D_M_2, 0);
        const hc_long r2_inner = hc_long_sum(n2_e_e, D_M_2, 1);
        const hc_long r2 = inner ? r2_inner : r2_outer;
        /* end of the program "tangency" */
        double r1_, half, det, dM, de;
        if (hc_long_is_zero(r1) && hc_long_is_zero(r2)) {
            /* printed from the program "tangency", the third, and where the root lies */
            const hc_fixed t_minus_s = hc_fixed_minus(t, s);
            const hc_fixed t_s_S = hc_fixed_minus(t_minus_s, S);
            const hc_fixed R_minus_q = hc_fixed_minus(R, q);
            const hc_long axial_1 = hc_long_signed_product(t_s_S, p);
            const hc_long radial_1 = hc_long_signed_product(R_minus_q, s);
            const hc_long n1 = hc_long_sum(axial_1, radial_1, 0);
            const hc_long K_e = hc_long_product(K, e);
            const hc_long M_M = hc_long_product(M, M);
            const hc_long M_M_n1 = hc_long_sum(M_M, n1, 1);
            const hc_long K_e_2 = hc_long_sum(K_e, K_e, 0);
            const hc_long r3_outer = hc_long_sum(M_M_n1, K_e_2, 0);
            const hc_long r3_inner = hc_long_sum(M_M_n1, K_e_2, 1);
            const hc_long r3 = inner ? r3_inner : r3_outer;
            const hc_long p_D = hc_long_product(p, D);
            const hc_long M_q = hc_long_product(M, q);
            const hc_long room_within = hc_long_sum(p_D, M_q, 1);
            const hc_long beyond = hc_long_sum(e_e, D_M, 1);
            const hc_long s_D = hc_long_product(s, D);
            const hc_long M_t = hc_long_product(M, t);
            const hc_long room_without = hc_long_sum(s_D, M_t, 1);
            /* end of the program "tangency" */
            if (!hc_long_is_zero(r3)) return 2;
            /* within: -A <= M/D; without: M/D <= B, and the simple root is not below it */
            if (inner) return hc_long_is_negative(room_within) ? 2 : -1;
            return hc_long_is_negative(beyond) || hc_long_is_negative(room_without) ? 2 : 1;
        }
        r1_ = hc_long_value(r1), half = 0.5 * hc_long_value(r2);
        m_ = inner ? -hc_fixed_value(M) : hc_fixed_value(M), e_ = inner ? -hc_fixed_value(e) : hc_fixed_value(e);
        det = e_ * e_ - m_ * d_;
        dM = (e_ * r1_ + m_ * half) / det;
        de = -(e_ * half + d_ * r1_) / det;
        if (inner) dM = -dM, de = -de;
        if (!(dM < most && dM > -most && de < most && de > -most)) return 2;
        {
            const hc_fixed by_M = hc_fixed_nearest(dM), by_e = hc_fixed_nearest(de);
            if ((by_M.low | by_M.high | by_e.low | by_e.high) == 0) return 2;
            M = hc_fixed_plus(M, by_M);
            e = hc_fixed_plus(e, by_e);
            if ((M.high | e.high) >> 62) return 2;
        }
    }
    return 2;
}

/* The same where lengths have 23 bits at most, and M and e 46: those are guessed right, and 128 bits hold everything. */
static int hc_touches_by_short(const uint64_t lengths[7], double about) {
    HC_NAMED_LENGTHS(lengths)
    const uint64_t z = lengths[6];
    /* printed from the program "tangency", for short lengths */
    const int inner = about < 0;
    const uint64_t D = b * d;
    const uint64_t K = alpha * gamma;
    /* end of the program "tangency" */
    const double size = inner ? -about : about, m_ = size * (double)(int64_t)D, e_ = (double)(int64_t)K / size, most = 70368744177664.0; /* 2^46 */
    uint64_t M, e;
    if (!(size > 0 && m_ < most && e_ < most)) return 2;
    M = (uint64_t)(int64_t)(m_ + 0.5), e = (uint64_t)(int64_t)(e_ + 0.5);
    {
        /* printed from the program "tangency", the equations for short lengths */
        const uint64_t p = alpha * alpha;
        const uint64_t q = b * b;
        const uint64_t s = gamma * gamma;
        const uint64_t t = d * d;
        const uint64_t xx = x * x;
        const uint64_t yy = y * y;
        const uint64_t R = xx + yy;
        const uint64_t S = z * z;
        const uint64_t p_plus_q = p + q;
        const uint64_t p_q_R = p_plus_q - R;
        const uint64_t s_plus_S = s + S;
        const hc_fixed radial_2 = hc_fixed_full_signed(p_q_R, t);
        const hc_fixed axial_2 = hc_fixed_full(s_plus_S, q);
        const hc_fixed n2 = hc_fixed_minus(radial_2, axial_2);
        const uint64_t t_minus_s = t - s;
        const uint64_t t_s_S = t_minus_s - S;
        const uint64_t R_minus_q = R - q;
        const hc_fixed axial_1 = hc_fixed_full_signed(t_s_S, p);
        const hc_fixed radial_1 = hc_fixed_full_signed(R_minus_q, s);
        const hc_fixed n1 = hc_fixed_plus(axial_1, radial_1);
        const hc_fixed D_K = hc_fixed_full(D, K);
        const hc_fixed M_e = hc_fixed_full(M, e);
        const hc_fixed e_e = hc_fixed_full(e, e);
        const hc_fixed D_M = hc_fixed_full(D, M);
        const hc_fixed r1 = hc_fixed_minus(D_K, M_e);
        const hc_fixed n2_e_e = hc_fixed_plus(n2, e_e);
        const hc_fixed D_M_2 = hc_fixed_plus(D_M, D_M);
        const hc_fixed r2_outer = hc_fixed_plus(n2_e_e, D_M_2);
        const hc_fixed r2_inner = hc_fixed_minus(n2_e_e, D_M_2);
        const hc_fixed r2 = inner ? r2_inner : r2_outer;
        const hc_fixed K_e = hc_fixed_full(K, e);
        const hc_fixed M_M = hc_fixed_full(M, M);
        const hc_fixed M_M_n1 = hc_fixed_minus(M_M, n1);
        const hc_fixed K_e_2 = hc_fixed_plus(K_e, K_e);
        const hc_fixed r3_outer = hc_fixed_plus(M_M_n1, K_e_2);
        const hc_fixed r3_inner = hc_fixed_minus(M_M_n1, K_e_2);
        const hc_fixed r3 = inner ? r3_inner : r3_outer;
        const hc_fixed p_D = hc_fixed_full(p, D);
        const hc_fixed M_q = hc_fixed_full(M, q);
        const hc_fixed room_within = hc_fixed_minus(p_D, M_q);
        const hc_fixed beyond = hc_fixed_minus(e_e, D_M);
        const hc_fixed s_D = hc_fixed_full(s, D);
        const hc_fixed M_t = hc_fixed_full(M, t);
        const hc_fixed room_without = hc_fixed_minus(s_D, M_t);
        /* end of the program "tangency" */
        if (r1.low | r1.high | r2.low | r2.high | r3.low | r3.high) return 2;
        if (inner) return hc_fixed_negative(room_within) ? 2 : -1;
        return hc_fixed_negative(beyond) || hc_fixed_negative(room_without) ? 2 : 1;
    }
}

/* The position of a row in the plane of the waist, z = 0, or 2. There g is B - l times -(l² - w l + A), w = P - 1 - A: contact
   where w² <= 4A, exterior where w > 0 and the lower root is below B, interior where w < 0 and the mean -w/2 is above -A. */
static int hc_position_in_plane(const uint64_t lengths[7]) {
    HC_NAMED_LENGTHS(lengths)
    /* printed from the program "waist", W */
    const hc_fixed p = hc_fixed_full(alpha, alpha);
    const hc_fixed q = hc_fixed_full(b, b);
    const hc_fixed xx = hc_fixed_full(x, x);
    const hc_fixed yy = hc_fixed_full(y, y);
    const hc_fixed R = hc_fixed_plus(xx, yy);
    const hc_fixed R_less_q = hc_fixed_minus(R, q);
    const hc_fixed W = hc_fixed_minus(R_less_q, p);
    const hc_fixed p_plus_q = hc_fixed_plus(p, q);
    const hc_fixed opposite = hc_fixed_minus(p_plus_q, R);
    const hc_fixed p_2 = hc_fixed_plus(p, p);
    const hc_fixed q_2 = hc_fixed_plus(q, q);
    /* end of the program "waist" */
    const hc_fixed size = hc_fixed_negative(W) ? opposite : W;
    /* printed from the program "waist", the discriminant */
    const hc_long four_A = hc_long_product(p_2, q_2);
    const hc_long square = hc_long_product(size, size);
    const hc_long excess = hc_long_sum(four_A, square, 1);
    /* end of the program "waist" */
    if (!hc_long_is_negative(excess)) return 0;
    {
        /* printed from the program "waist", where the roots lie */
        const hc_fixed W_p_2 = hc_fixed_plus(W, p_2);
        const hc_fixed s = hc_fixed_full(gamma, gamma);
        const hc_fixed t = hc_fixed_full(d, d);
        const hc_long q_2_s = hc_long_product(q_2, s);
        const hc_long W_t = hc_long_signed_product(W, t);
        const hc_long room = hc_long_sum(q_2_s, W_t, 1);
        /* end of the program "waist" */
        /* W = -2p, where R = q - p >= 0, is not here: A <= 1 then, so that w² = 4A² is not above 4A. */
        if (hc_fixed_negative(W)) return hc_fixed_negative(W_p_2) ? 0 : -1;
        return hc_long_is_negative(room) ? 2 : 1;
    }
}

/* The position of a row in the plane of the waist, or of one that touches, but for coordinates of a hair's breadth; else 2. Where
   x² + y² grows, a tangency from without becomes exterior, and one from within contact; where z² grows, contact and interior. A
   hair is too short to lead through contact to the other side (docs/kernel.md of hypcheck). */
static int hc_position_beside_tangency(const double row[7], double about) {
    double bare[7];
    uint64_t lengths[7];
    int i, bits, side, radial = 0, axial = 0;
    memcpy(bare, row, sizeof bare);
    for (i = 4; i < 7; i++) {
        const double size = row[i] < 0 ? -row[i] : row[i];
        if (size > 0 && size < HC_HAIR * row[i == 6 ? 1 : 2]) {
            bare[i] = 0;
            if (i == 6) axial = 1;
            else radial = 1;
        }
    }
    bits = radial && axial ? 64 : hc_short_lengths(bare, lengths);
    if (bits > HC_TANGENCY_BITS) return 2;
    side = radial || axial || lengths[6] ? 2 : hc_position_in_plane(lengths);
    if (side != 2) return side;
    side = bits <= 23 ? hc_touches_by_short(lengths, about) : hc_touches_by(lengths, about);
    if (side == 2) return 2;
    return (side > 0 ? radial : axial) ? side : 0;
}

/* The position of a valid row. */
static int hc_exact_position(const double row[7]) {
    double about;
    int position = hc_fixed_position(row, &about);
    if (position == 2) position = hc_position_beside_tangency(row, about);
    return position == 2 ? hc_position_by_integers(row) : position;
}


/* ---- a tilted spheroid: exact integers ---- */

#define HC_CUT_BITS 128
#define HC_TILTED_LIMBS (1070318 / HC_LIMB_BITS + 154) /* counted from the programs */

/* Memory for integers: what is made takes the next limbs, as many as it can need. */
typedef struct {
    hc_limb *next;
} hc_pool;

static hc_integer hc_taken(hc_pool *pool, int limbs) {
    hc_integer number;
    number.sign = 0;
    number.length = 0;
    number.limbs = pool->next;
    pool->next += limbs;
    return number;
}

static hc_integer hc_product(hc_pool *pool, const hc_integer *left, const hc_integer *right) {
    hc_integer product = hc_taken(pool, left->length + right->length);
    hc_multiply(&product, left, right);
    return product;
}

static hc_integer hc_sum(hc_pool *pool, const hc_integer *left, const hc_integer *right, int sign) {
    hc_integer sum = hc_taken(pool, 1 + (left->length < right->length ? right->length : left->length));
    hc_combine(&sum, left, right, sign);
    return sum;
}

static hc_integer hc_multiple(hc_pool *pool, hc_limb factor, const hc_integer *number) {
    hc_integer product = hc_taken(pool, 1 + number->length);
    hc_scale(&product, factor, number);
    return product;
}

/* Moves a number to the pool's next limbs; the pool may have been set back before it, not beyond it. */
static void hc_keep(hc_pool *pool, hc_integer *number) {
    hc_limb *const to = pool->next;
    memmove(to, number->limbs, (size_t)number->length * sizeof *to);
    number->limbs = to;
    pool->next = to + number->length;
}

static int hc_bits_of(const hc_integer *number) {
    hc_limb top;
    int bits;
    if (number->length == 0) return 0;
    top = number->limbs[number->length - 1];
    for (bits = HC_LIMB_BITS * (number->length - 1); top; top >>= 1) bits++;
    return bits;
}

/* The number times 2^shift, cut towards zero. */
static hc_integer hc_shifted(hc_pool *pool, const hc_integer *number, int shift) {
    const int bits = hc_bits_of(number) + shift, length = bits > 0 ? (bits + HC_LIMB_BITS - 1) / HC_LIMB_BITS : 0;
    hc_integer result = hc_taken(pool, length);
    int i;
    for (i = 0; i < length; i++) {
        const int from = i * HC_LIMB_BITS - shift; /* the bit that becomes the lowest one of limb i; the number has more bits */
        const int limb = from < 0 ? -((HC_LIMB_BITS - 1 - from) / HC_LIMB_BITS) : from / HC_LIMB_BITS;
        const int off = from - limb * HC_LIMB_BITS;
        const hc_limb low = limb >= 0 ? number->limbs[limb] : 0;
        const hc_limb high = limb >= -1 && limb + 1 < number->length ? number->limbs[limb + 1] : 0;
        result.limbs[i] = off ? (hc_limb)(low >> off) | (hc_limb)(high << (HC_LIMB_BITS - off)) : low;
    }
    result.length = length;
    result.sign = length ? number->sign : 0;
    return result;
}

/* The bits of a number: those of positive doubles are in the order of the doubles, subnormal and flushed ones too. */
static uint64_t hc_word(double value) {
    uint64_t word;
    memcpy(&word, &value, sizeof word);
    return word;
}

/* Whether the spheroid of a valid row of ten is an upright one: its axis is not tilted, or it is a sphere. */
static int hc_is_upright(const double row[10]) {
    return ((hc_word(row[7]) | hc_word(row[8])) << 1 == 0) || hc_word(row[2]) == hc_word(row[3]);
}

static int hc_has_direction(const double axis[3]) {
    const uint64_t x = hc_word(axis[0]) << 1, y = hc_word(axis[1]) << 1, z = hc_word(axis[2]) << 1;
    const uint64_t infinite = (uint64_t)0x7ff << 53;
    return (x | y | z) != 0 && x < infinite && y < infinite && z < infinite;
}

/* The quartic F = f4 λ⁴ + f3 λ³ + f2 λ² + f1 λ - minus_f0 of a pair, its poles -p/q and the roots -A2 < 0 < B of
   k0 + k1 λ - k2 λ², and the squares s and t that -p s/(q t) = -A2 B is made of. */
typedef struct {
    hc_integer minus_f0, f1, f2, f3, f4, p, q, s, t, k0, k1, k2;
    int oblate;
} hc_quartic;

static hc_quartic hc_quartic_of(hc_pool *pool, const double row[10]) {
    hc_limb *const start = pool->next;
    hc_parts parts[10];
    hc_integer numbers[10];
    hc_quartic pair;
    int i, unit[2] = {4096, 4096};
    for (i = 0; i < 10; i++) {
        parts[i] = hc_parts_of(row[i]);
        unit[i >= 7] = hc_least(unit[i >= 7], parts[i].exponent);
    }
    for (i = 0; i < 10; i++) {
        numbers[i] = hc_taken(pool, parts[i].sign ? (parts[i].exponent - unit[i >= 7] + 64) / HC_LIMB_BITS + 2 : 1);
        hc_in_units(numbers + i, parts[i], unit[i >= 7]);
    }
    {
        const hc_integer alpha = numbers[0], gamma = numbers[1], b = numbers[2], d = numbers[3], x = numbers[4],
                         y = numbers[5], z = numbers[6], axis_x = numbers[7], axis_y = numbers[8], axis_z = numbers[9];
        /* printed from the program "tilted-quartic" */
        const hc_integer p = hc_product(pool, &alpha, &alpha);
        const hc_integer q = hc_product(pool, &b, &b);
        const hc_integer s = hc_product(pool, &gamma, &gamma);
        const hc_integer t = hc_product(pool, &d, &d);
        const hc_integer axis_xx = hc_product(pool, &axis_x, &axis_x);
        const hc_integer axis_yy = hc_product(pool, &axis_y, &axis_y);
        const hc_integer level = hc_sum(pool, &axis_xx, &axis_yy, 1);
        const hc_integer upward = hc_product(pool, &axis_z, &axis_z);
        const hc_integer w = hc_sum(pool, &level, &upward, 1);
        const hc_integer xx = hc_product(pool, &x, &x);
        const hc_integer yy = hc_product(pool, &y, &y);
        const hc_integer radius = hc_sum(pool, &xx, &yy, 1);
        const hc_integer height = hc_product(pool, &z, &z);
        const hc_integer distance = hc_sum(pool, &radius, &height, 1);
        const hc_integer axis_x_y = hc_product(pool, &axis_x, &y);
        const hc_integer axis_y_x = hc_product(pool, &axis_y, &x);
        const hc_integer cross = hc_sum(pool, &axis_x_y, &axis_y_x, -1);
        const hc_integer axis_x_x = hc_product(pool, &axis_x, &x);
        const hc_integer axis_y_y = hc_product(pool, &axis_y, &y);
        const hc_integer axis_z_z = hc_product(pool, &axis_z, &z);
        const hc_integer along_level = hc_sum(pool, &axis_x_x, &axis_y_y, 1);
        const hc_integer along = hc_sum(pool, &along_level, &axis_z_z, 1);
        const hc_integer t_minus_q = hc_sum(pool, &t, &q, -1);
        const hc_integer s_plus_p = hc_sum(pool, &s, &p, 1);
        const hc_integer scale_E = hc_product(pool, &t_minus_q, &s_plus_p);
        const hc_integer cross_cross = hc_product(pool, &cross, &cross);
        const hc_integer E = hc_product(pool, &scale_E, &cross_cross);
        const hc_integer s_radius = hc_product(pool, &s, &radius);
        const hc_integer p_height = hc_product(pool, &p, &height);
        const hc_integer slope = hc_sum(pool, &s_radius, &p_height, -1);
        const hc_integer G = hc_product(pool, &w, &slope);
        const hc_integer tw = hc_product(pool, &t, &w);
        const hc_integer tw_distance = hc_product(pool, &tw, &distance);
        const hc_integer along_along = hc_product(pool, &along, &along);
        const hc_integer along_part = hc_product(pool, &t_minus_q, &along_along);
        const hc_integer m = hc_sum(pool, &tw_distance, &along_part, -1);
        const hc_integer ps = hc_product(pool, &p, &s);
        const hc_integer k0 = hc_product(pool, &ps, &w);
        const hc_integer t_level = hc_product(pool, &t, &level);
        const hc_integer q_upward = hc_product(pool, &q, &upward);
        const hc_integer along_z = hc_sum(pool, &t_level, &q_upward, 1);
        const hc_integer t_upward = hc_product(pool, &t, &upward);
        const hc_integer q_level = hc_product(pool, &q, &level);
        const hc_integer across_z = hc_sum(pool, &t_upward, &q_level, 1);
        const hc_integer s_along_z = hc_product(pool, &s, &along_z);
        const hc_integer p_across_z = hc_product(pool, &p, &across_z);
        const hc_integer k1 = hc_sum(pool, &s_along_z, &p_across_z, -1);
        const hc_integer k2 = hc_product(pool, &q, &tw);
        const hc_integer p_plus_q = hc_sum(pool, &p, &q, 1);
        const hc_integer minus_f0 = hc_product(pool, &p, &k0);
        const hc_integer G_k1 = hc_sum(pool, &G, &k1, -1);
        const hc_integer p_G_k1 = hc_product(pool, &p, &G_k1);
        const hc_integer pq_k0 = hc_product(pool, &p_plus_q, &k0);
        const hc_integer f1 = hc_sum(pool, &p_G_k1, &pq_k0, -1);
        const hc_integer G_k0 = hc_sum(pool, &G, &k0, -1);
        const hc_integer q_G_k0 = hc_product(pool, &q, &G_k0);
        const hc_integer k2_m = hc_sum(pool, &k2, &m, -1);
        const hc_integer p_k2_m = hc_product(pool, &p, &k2_m);
        const hc_integer pq_k1 = hc_product(pool, &p_plus_q, &k1);
        const hc_integer E_q = hc_sum(pool, &E, &q_G_k0, 1);
        const hc_integer E_q_p = hc_sum(pool, &E_q, &p_k2_m, 1);
        const hc_integer f2 = hc_sum(pool, &E_q_p, &pq_k1, -1);
        const hc_integer m_k1 = hc_sum(pool, &m, &k1, 1);
        const hc_integer q_m_k1 = hc_product(pool, &q, &m_k1);
        const hc_integer pq_k2 = hc_product(pool, &p_plus_q, &k2);
        const hc_integer f3 = hc_sum(pool, &pq_k2, &q_m_k1, -1);
        const hc_integer f4 = hc_product(pool, &q, &k2);
        /* end of the program "tilted-quartic" */
        hc_integer *kept[12] = {&pair.p, &pair.q, &pair.s, &pair.t, &pair.k0, &pair.k1, &pair.k2, &pair.minus_f0, &pair.f1,
                                &pair.f2, &pair.f3, &pair.f4};
        pair.p = p, pair.q = q, pair.s = s, pair.t = t, pair.k0 = k0, pair.k1 = k1, pair.k2 = k2;
        pair.minus_f0 = minus_f0, pair.f1 = f1, pair.f2 = f2, pair.f3 = f3, pair.f4 = f4;
        pool->next = start;
        for (i = 0; i < 12; i++) hc_keep(pool, kept[i]); /* in the order in which they were made */
    }
    pair.oblate = hc_word(row[2]) > hc_word(row[3]);
    return pair;
}

/* The sign of the discriminant of f4 λ⁴ + ... - minus_f0; 0 also where its size is below 2^least_bits. */
static int hc_discriminant_sign(hc_pool pool, const hc_integer f[5], int least_bits) {
    hc_limb *const start = pool.next;
    const hc_integer minus_f0 = f[0], f1 = f[1], f2 = f[2], f3 = f[3], f4 = f[4];
    hc_integer kept_I, kept_J;
    {
        /* printed from the program "tilted-invariants" */
        const hc_integer f2_f2 = hc_product(&pool, &f2, &f2);
        const hc_integer f3_f1 = hc_product(&pool, &f3, &f1);
        const hc_integer f4_f0 = hc_product(&pool, &f4, &minus_f0);
        const hc_integer thrice_f3_f1 = hc_multiple(&pool, 3, &f3_f1);
        const hc_integer twelvefold_f4_f0 = hc_multiple(&pool, 12, &f4_f0);
        const hc_integer two_terms = hc_sum(&pool, &f2_f2, &thrice_f3_f1, -1);
        const hc_integer I = hc_sum(&pool, &two_terms, &twelvefold_f4_f0, -1);
        const hc_integer ninefold_f3_f1 = hc_multiple(&pool, 9, &f3_f1);
        const hc_integer many_f4_f0 = hc_multiple(&pool, 72, &f4_f0);
        const hc_integer twice_f2_f2 = hc_multiple(&pool, 2, &f2_f2);
        const hc_integer one_factor = hc_sum(&pool, &ninefold_f3_f1, &many_f4_f0, -1);
        const hc_integer factor = hc_sum(&pool, &one_factor, &twice_f2_f2, -1);
        const hc_integer middle = hc_product(&pool, &f2, &factor);
        const hc_integer f3_f3 = hc_product(&pool, &f3, &f3);
        const hc_integer f0_f3_f3 = hc_product(&pool, &minus_f0, &f3_f3);
        const hc_integer f1_f1 = hc_product(&pool, &f1, &f1);
        const hc_integer f4_f1_f1 = hc_product(&pool, &f4, &f1_f1);
        const hc_integer ends = hc_sum(&pool, &f0_f3_f3, &f4_f1_f1, -1);
        const hc_integer many_ends = hc_multiple(&pool, 27, &ends);
        const hc_integer J = hc_sum(&pool, &middle, &many_ends, 1);
        /* end of the program "tilted-invariants" */
        kept_I = I, kept_J = J;
    }
    pool.next = start;
    hc_keep(&pool, &kept_I);
    hc_keep(&pool, &kept_J);
    {
        const hc_integer I = kept_I, J = kept_J;
        /* printed from the program "tilted-discriminant" */
        const hc_integer I_I = hc_product(&pool, &I, &I);
        const hc_integer I_I_I = hc_product(&pool, &I_I, &I);
        const hc_integer fourfold_I = hc_multiple(&pool, 4, &I_I_I);
        const hc_integer J_J = hc_product(&pool, &J, &J);
        const hc_integer delta = hc_sum(&pool, &fourfold_I, &J_J, -1);
        /* end of the program "tilted-discriminant" */
        return hc_bits_of(&delta) > least_bits ? delta.sign : 0;
    }
}

/* The same from the coefficients cut to HC_CUT_BITS = n bits. With λ in units of a power of two that makes the first and
   the last alike, and all at most 2^n, each is off by less than 1. So I < 16 2^2n is off by less than 2^(n+6),
   J < 137 2^3n by less than 2^(2n+10), and 4 I³ - J² by less than 12 2^(4n+8) 2^(n+6) + 2^(3n+9) 2^(2n+10) < 2^(5n+20). */
static int hc_cut_discriminant_sign(hc_pool pool, const hc_integer f[5]) {
    const int step = (hc_bits_of(f) - hc_bits_of(f + 4)) / 4;
    hc_integer cut[5];
    int i, most = -(1 << 30);
    for (i = 0; i < 5; i++)
        if (f[i].sign && hc_bits_of(f + i) + i * step > most) most = hc_bits_of(f + i) + i * step;
    for (i = 0; i < 5; i++) cut[i] = hc_shifted(&pool, f + i, i * step + HC_CUT_BITS - most);
    return hc_discriminant_sign(pool, cut, 5 * HC_CUT_BITS + 20);
}

/* The sign of k0 + k1 λ - k2 λ² at λ = side 2^power: > 0 between -A2 and B, < 0 outside. */
static int hc_between_poles(hc_pool pool, const hc_quartic *pair, int side, int power) {
    const int up = power > 0 ? power : 0, down = power < 0 ? -power : 0;
    const hc_integer first = hc_shifted(&pool, &pair->k0, 2 * down), second = hc_shifted(&pool, &pair->k1, up + down);
    const hc_integer third = hc_shifted(&pool, &pair->k2, 2 * up), two = hc_sum(&pool, &first, &second, side);
    const hc_integer all = hc_sum(&pool, &two, &third, -1);
    return all.sign;
}

/* Whether three roots of one sign cannot all lie beyond the pole of that side, by their product: the roots' is
   -A1 A2 B, and the fourth root lies beyond the other pole. So three beyond B ask for B² <= max(A1, A2), three beyond
   -min(A1, A2) for min(A1, A2)² <= max(A1, A2). The exponents below are 2^j > √A1 and so on. */
static int hc_product_too_small(hc_pool pool, const hc_quartic *pair, int side) {
    const int A1 = hc_bits_of(&pair->p) - hc_bits_of(&pair->q); /* 2^(A1-1) < p/q < 2^(A1+1) */
    const int A2_B = A1 + hc_bits_of(&pair->s) - hc_bits_of(&pair->t); /* p s/(q t) < 2^(A2_B+2) */
    const int root = A1 + 1 > 0 ? (A1 + 2) / 2 : (A1 + 1) / 2, third = A2_B + 2 > 0 ? (A2_B + 4) / 3 : (A2_B + 2) / 3;
    if (side > 0) return hc_between_poles(pool, pair, 1, root > third ? root : third) > 0; /* B² > A1, B³ > A2 B */
    if (pair->oblate) return hc_between_poles(pool, pair, -1, 2 * A1 - 2) < 0;            /* A2 < 2^j < A1² */
    return hc_between_poles(pool, pair, -1, root) > 0;                                     /* A2² > A1 */
}

/* The sign of U + V √D for U = 2u + v k1, V = side v, D = k1² + 4 n: of u + v μ at a root μ of μ² = k1 μ + n, n > 0. */
static int hc_sign_with_root(hc_pool pool, const hc_quartic *pair, const hc_integer *n, hc_integer u, hc_integer v, int side) {
    const hc_integer twice_u = hc_multiple(&pool, 2, &u), v_k1 = hc_product(&pool, &v, &pair->k1);
    const hc_integer U = hc_sum(&pool, &twice_u, &v_k1, 1);
    const int V_sign = side * v.sign;
    if (U.sign * V_sign >= 0) return U.sign ? U.sign : V_sign;
    {
        const hc_integer U_U = hc_product(&pool, &U, &U), v_v = hc_product(&pool, &v, &v);
        const hc_integer k1_k1 = hc_product(&pool, &pair->k1, &pair->k1), n_4 = hc_multiple(&pool, 4, n);
        const hc_integer D = hc_sum(&pool, &k1_k1, &n_4, 1), v_v_D = hc_product(&pool, &v_v, &D);
        const hc_integer difference = hc_sum(&pool, &U_U, &v_v_D, -1);
        return U.sign * difference.sign;
    }
}

/* The sign of the i-th coefficient of F about a pole: about B or -A2 (side 1 or -1) with μ = k2 λ, or about -p/q (side 0)
   with μ = q λ. As f4 = q k2, k2³ F = q μ⁴ + f3 μ³ + k2 f2 μ² + ..., and likewise q³ F; Horner's values are u + v μ. */
static int hc_coefficient_sign(hc_pool pool, const hc_quartic *pair, int i, int side) {
    static const int binomials[4][5] = {{1, 1, 1, 1, 1}, {0, 1, 2, 3, 4}, {0, 0, 1, 3, 6}, {0, 0, 0, 1, 4}};
    const hc_integer f[4] = {pair->minus_f0, pair->f1, pair->f2, pair->f3};
    const hc_integer *const scale = side ? &pair->k2 : &pair->q, *const first = side ? &pair->q : &pair->k2;
    const hc_integer n = hc_product(&pool, &pair->k0, &pair->k2);
    hc_limb *const start = pool.next;
    hc_integer u = hc_multiple(&pool, (hc_limb)binomials[i][4], first), v = hc_taken(&pool, 0), power = hc_taken(&pool, 1);
    int j;
    power.sign = power.length = 1;
    power.limbs[0] = 1;
    for (j = 3; j >= i; j--) {
        const hc_integer term = hc_product(&pool, f + j, &power);
        hc_integer added = hc_multiple(&pool, (hc_limb)binomials[i][j], &term), next_u, next_v, next_power;
        if (j == 0) added.sign = -added.sign;
        if (side) { /* (u + v μ) μ = v n + (u + v k1) μ */
            const hc_integer v_n = hc_product(&pool, &v, &n), v_k1 = hc_product(&pool, &v, &pair->k1);
            next_u = hc_sum(&pool, &v_n, &added, 1);
            next_v = hc_sum(&pool, &u, &v_k1, 1);
        } else { /* μ = -p */
            const hc_integer u_p = hc_product(&pool, &u, &pair->p);
            next_u = hc_sum(&pool, &added, &u_p, -1);
            next_v = hc_taken(&pool, 0);
        }
        next_power = hc_product(&pool, &power, scale);
        u = next_u, v = next_v, power = next_power;
        pool.next = start;
        hc_keep(&pool, &u);
        hc_keep(&pool, &v);
        hc_keep(&pool, &power);
    }
    return side ? hc_sign_with_root(pool, pair, &n, u, v, side) : u.sign;
}

/* F has a multiple root. Clear is then only what has a pole for a double root, with F > 0 on its inner side. */
static int hc_clear_at_double_pole(hc_pool pool, const hc_quartic *pair, int side) {
    const int pole = side < 0 && pair->oblate ? 0 : side;
    return hc_coefficient_sign(pool, pair, 0, pole) == 0 && hc_coefficient_sign(pool, pair, 1, pole) == 0 &&
           hc_coefficient_sign(pool, pair, 2, pole) > 0;
}

/* Whether two of three roots of one sign lie beyond the pole of that side: by Descartes' rule, exact for real roots. */
static int hc_roots_beyond_pole(hc_pool pool, const hc_quartic *pair, int side) {
    const int pole = side < 0 && pair->oblate ? 0 : side;
    int i, changes = 0, before = 1; /* f4 > 0 */
    for (i = 3; i >= 0; i--) {
        const int found = hc_coefficient_sign(pool, pair, i, pole), sign = side < 0 && i % 2 ? -found : found;
        if (sign && sign != before) changes++, before = sign;
    }
    return changes > 1;
}

/* The position of a valid row of ten: kernel/tilted_integers.py of hypcheck says why. */
static int hc_exact_tilted_position(const double row[10]) {
    hc_limb limbs[HC_TILTED_LIMBS];
    hc_pool pool;
    hc_quartic pair;
    int delta, changes = 0, before = -1, i, side;
    if (hc_is_upright(row)) return hc_exact_position(row);
    pool.next = limbs;
    pair = hc_quartic_of(&pool, row);
    {
        const hc_integer f[5] = {pair.minus_f0, pair.f1, pair.f2, pair.f3, pair.f4};
        delta = hc_cut_discriminant_sign(pool, f);
        if (delta == 0) delta = hc_discriminant_sign(pool, f, 0);
        for (i = 1; i < 5; i++)
            if (f[i].sign && f[i].sign != before) changes++, before = f[i].sign;
    }
    if (delta < 0) return 0;
    if (delta == 0) return hc_clear_at_double_pole(pool, &pair, 1) - hc_clear_at_double_pole(pool, &pair, -1);
    side = changes == 3 ? 1 : -1;
    if (hc_product_too_small(pool, &pair, side)) return side;
    return hc_roots_beyond_pole(pool, &pair, side) ? 0 : side;
}

/* ---- the instruction sets: this file, once for each ---- */

/* The file includes itself by the name that HYPCHECK_SELF has. Another file of that name, an earlier edition of this one
   among them, does not define what this text is known by. */
#ifndef HYPCHECK_SELF
#define HYPCHECK_SELF "hypcheck.h"
#endif
#define HC_LEVEL 0
#ifdef __has_include
#if __has_include(HYPCHECK_SELF)
#include HYPCHECK_SELF
#endif
#else
#include HYPCHECK_SELF
#endif
#undef HC_LEVEL
#ifndef HC_EDITION_f18846c138270e11
#error "hypcheck: HYPCHECK_SELF does not name this file: where it is not called hypcheck.h, define it as the file's name, in quotation marks"
#else
#if HC_X86
#define HC_LEVEL 1
#include HYPCHECK_SELF
#undef HC_LEVEL
#define HC_LEVEL 2
#include HYPCHECK_SELF
#undef HC_LEVEL
#define HC_LEVEL 3
#include HYPCHECK_SELF
#undef HC_LEVEL
#endif
#if HC_NEON
#define HC_LEVEL 4
#include HYPCHECK_SELF
#undef HC_LEVEL
#endif

/* ---- one row ---- */

/* A cheaper bound for the common case, c² > a > 1; 2 where it cannot say. */
static int hc_single(const double row[7]) {
    const double alpha = row[0], gamma = row[1], b = row[2], d = row[3], x = row[4], y = row[5], z = row[6];
    const double u_8 = HC_u_8, u_12 = HC_u_12, u_1536 = HC_u_1536;
    /* printed from the program "single" */
    const double alpha_over_b = alpha / b;
    const double A = alpha_over_b * alpha_over_b;
    const double gamma_over_d = gamma / d;
    const double B = gamma_over_d * gamma_over_d;
    const double AB = A * B;
    const double c0 = -AB;
    const double c0_plus_A = c0 + A;
    const double C = c0_plus_A - B;
    const double xx = x * x;
    const double yy = y * y;
    const double rr = xx + yy;
    const double bb = b * b;
    const double P = rr / bb;
    const double z_over_d = z / d;
    const double Q = z_over_d * z_over_d;
    const double BP = B * P;
    const double C_plus_BP = C + BP;
    const double AQ = A * Q;
    const double c1 = C_plus_BP - AQ;
    const double A_minus_B = A - B;
    const double K = A_minus_B + 1.0;
    const double K_minus_P = K - P;
    const double c2 = K_minus_P - Q;
    const double c2_squared = c2 * c2;
    const double three_c1 = 3.0 * c1;
    const double h1 = c2_squared - three_c1;
    const double c2c1 = c2 * c1;
    const double nine_c0 = 9.0 * c0;
    const double h2 = c2c1 - nine_c0;
    const double c1_squared = c1 * c1;
    const double c2c0 = c2 * c0;
    const double three_c2c0 = 3.0 * c2c0;
    const double h3 = c1_squared - three_c2c0;
    const double h1h3 = h1 * h3;
    const double h1h3_4 = 4.0 * h1h3;
    const double h2_squared = h2 * h2;
    const double delta_3 = h1h3_4 - h2_squared;
    const double P_plus_Q = P + Q;
    const double A_plus_B = A + B;
    const double sizes_2 = A_plus_B + 1.0;
    const double M2 = sizes_2 + P_plus_Q;
    const double BP_plus_AQ = BP + AQ;
    const double sizes_1 = A_plus_B + AB;
    const double M1 = sizes_1 + BP_plus_AQ;
    const double product = M2 * M1;
    const double product_squared = product * product;
    const double E = u_1536 * product_squared;
    const double e1 = u_12 * M1;
    const double e2 = u_8 * M2;
    const double BB = B * B;
    /* end of the program "single" */
    /* Without a branch for each comparison: which side it is no processor can foresee, and a wrong guess costs as much as
       half of the arithmetic. P + Q beyond `farthest` is left: products overflow there, and rounded towards zero they would
       look finite. */
    const int sizes_fit = (alpha > 0) & (gamma > 0) & (b > HC_least) & (b < HC_greatest) & (d > HC_least) & (d < HC_greatest);
    const int ratios_fit = (A > HC_slack) & (A < HC_greatest) & (B > HC_least) & (B < HC_greatest) & (BB > HC_slack * A);
    const int contact = delta_3 < -E, apart = delta_3 > E;
    const int outside = (c2 < -e2) & (c1 > e1), inside = (c2 > e2) | (c1 < -e1);
    if (!(sizes_fit & ratios_fit & (P_plus_Q < HC_farthest) & (contact | (apart & (outside | inside))))) return 2;
    return apart * (outside - inside);
}

static int hc_position_of(const double row[7]) {
    const int quick = HC_FLOATS_DECIDE ? hc_single(row) : 2;
    hc_bits found;
    if (quick != 2) return quick;
    found = hc_certified_plain(row, 1, 1);
    if (HC_FLOATS_DECIDE && found.decided) return (int)found.plus - (int)found.minus;
    return hc_valid(row) ? hc_exact_position(row) : 127;
}

/* ---- one scene: the half planes of the first stage ---- */

/* The value cut to 26 significant bits, so that its square is exact; `up` takes the next such number. */
static double hc_short(double value, int up) {
    const uint64_t low = ((uint64_t)1 << 27) - 1;
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    bits = (up ? bits + low : bits) & ~low;
    memcpy(&value, &bits, sizeof bits);
    return value;
}

/* Where (A+λ)(1 + 1/λ) + Q (A+λ)/(B−λ) is least over λ in (0, B), for side 1, and where (A−μ)(1 − 1/μ) + Q (A−μ)/(B+μ)
   is greatest over μ in (0, A), for side -1: Newton's method for A/λ² = 1 + Q (A+B)/(B∓λ)². Any result is safe; a good
   one leaves fewer rows to the next stage. */
static double hc_best_multiplier(double A, double B, double Q, int side) {
    const double weight = Q * (A + B);
    double at = hc_rough_root(A / (1 + weight / (B * B)));
    int i;
    if (side > 0 && at > 0.99 * B) at = 0.99 * B;
    for (i = 0; i < 4; i++) {
        const double inverse = 1 / at, other = 1 / (B - side * at);
        const double first = A * inverse * inverse, second = weight * other * other;
        const double step = (first - 1 - second) / (2 * (first * inverse + side * second * other));
        const double moved = at + step;
        if (!(moved > 0.25 * at)) break; /* NaN: a step is shorter than half of `at` otherwise */
        at = side > 0 && moved > 0.5 * (at + B) ? 0.5 * (at + B) : moved;
    }
    return at;
}

/* About the P at which the bodies touch from that side at height Q. */
static double hc_edge(double A, double B, double Q, int side) {
    const double at = hc_best_multiplier(A, B, Q, side);
    return (A + side * at) * (1 + side / at) + Q * (A + side * at) / (B - side * at);
}

static void hc_tangent_beyond(const double sizes[4], double lambda_, hc_line *line) {
    const double alpha = sizes[0], gamma = sizes[1], b = sizes[2], d = sizes[3];
    const double u_8 = HC_u_8, more = HC_more;
    /* printed from the program "tangent-beyond" */
    const double p = alpha * alpha;
    const double q = b * b;
    const double q_lambda = q * lambda_;
    const double across = p + q_lambda;
    const double one_plus_lambda = 1.0 + lambda_;
    const double product = across * one_plus_lambda;
    const double K = product / lambda_;
    const double K_most = more * K;
    const double s = gamma * gamma;
    const double t = d * d;
    const double t_lambda = t * lambda_;
    const double gap = s - t_lambda;
    const double gap_terms = s + t_lambda;
    const double gap_error = u_8 * gap_terms;
    const double gap_least = gap - gap_error;
    const double M = across / gap_least;
    const double M_most = more * M;
    /* end of the program "tangent-beyond" */
    const int proves = lambda_ > 0 && gap_least > 0 && K_most >= HC_least_constant && M_most <= HC_greatest_slope;
    line->K = proves ? K_most : HC_NEVER;
    line->M = proves ? M_most : 0;
}

static void hc_tangent_within(const double sizes[4], double mu, hc_line *line) {
    const double alpha = sizes[0], gamma = sizes[1], b = sizes[2], d = sizes[3];
    const double u_8 = HC_u_8, less = HC_less;
    /* printed from the program "tangent-within" */
    const double p = alpha * alpha;
    const double q = b * b;
    const double q_mu = q * mu;
    const double across = p - q_mu;
    const double across_terms = p + q_mu;
    const double across_error = u_8 * across_terms;
    const double across_least = across - across_error;
    const double mu_minus_one = mu - 1.0;
    const double product = across_least * mu_minus_one;
    const double K = product / mu;
    const double K_least = less * K;
    const double s = gamma * gamma;
    const double t = d * d;
    const double t_mu = t * mu;
    const double along = s + t_mu;
    const double M = across_least / along;
    const double M_least = less * M;
    /* end of the program "tangent-within" */
    const int proves = mu > 1 && across_least > 0 && K_least >= HC_least_constant && M_least <= HC_greatest_slope;
    line->K = proves ? K_least : -1;
    line->M = proves ? M_least : 0;
}

/* A place (z, x) where the position is known not to be `side`, near the edge P at that height; R = -1 if none was found. */
typedef struct {
    double T, R;
} hc_point;

static hc_point hc_known_point(const double sizes[4], double z, double P, int side) {
    static const double steps[3] = {9.3132257461547852e-10 /* 2^-30 */, 1.52587890625e-05 /* 2^-16 */, 0.00390625 /* 2^-8 */};
    double row[7];
    hc_point point;
    int i;
    memcpy(row, sizes, 4 * sizeof *row);
    row[5] = 0;
    row[6] = z;
    point.T = z * z;
    for (i = 0; i < 3; i++) {
        row[4] = P > 0 ? hc_short(sizes[2] * hc_rough_root(P * (1 - side * steps[i])), side < 0) : 0;
        point.R = row[4] * row[4];
        /* The cap spares work alone: beyond it R may overflow, and then no slope below is within its limit. */
        if (point.R < HC_cap && hc_position_of(row) != side) return point;
    }
    point.R = -1;
    return point;
}

/* A line below (side 1) or above (side -1) the chord of two points, checked at both; else one that proves nothing. */
static void hc_chord(hc_point from, hc_point to, int side, hc_line *line) {
    const double more = HC_more, less = HC_less, T_0 = from.T, R_0 = from.R, T_1 = to.T, R_1 = to.R;
    const double slope = T_1 > T_0 ? (R_1 - R_0) / (T_1 - T_0) : 0;
    const double M = side < 0 && R_0 - slope * T_0 < 0 ? R_1 / T_1 * (1 + 9.3132257461547852e-10) : slope;
    const double start = (side > 0 && R_1 < R_0 ? R_1 : R_0) - M * T_0;
    const double moved = start * (1 - side * 9.3132257461547852e-10);
    const double K = side < 0 && (M > 0 || moved > 0) && !(moved >= HC_least_constant) ? HC_least_constant : moved;
    /* printed from the program "chord" */
    const double rise_0 = M * T_0;
    const double line_0 = K + rise_0;
    const double rise_1 = M * T_1;
    const double line_1 = K + rise_1;
    const double lowered_0 = less * R_0;
    const double lowered_1 = less * R_1;
    const double raised_0 = more * R_0;
    const double raised_1 = more * R_1;
    const int below_0 = line_0 <= lowered_0;
    const int below_1 = line_1 <= lowered_1;
    const int above_0 = line_0 >= raised_0;
    const int above_1 = line_1 >= raised_1;
    const int below = below_0 & below_1;
    const int above = above_0 & above_1;
    /* end of the program "chord" */
    const int known = R_0 >= 0 && R_1 >= 0 && M >= 0 && M <= HC_greatest_slope;
    const int beyond = side > 0 ? below : above, proves = known && beyond && (side < 0 || K >= HC_least_constant);
    line->K = proves ? K : side > 0 ? -1 : HC_NEVER;
    line->M = proves ? M : 0;
}

/* The heights that the centres have, from a sample of them. */
static void hc_sample_heights(size_t n, const double *z, double *least, double *greatest) {
    const size_t step = n / 64 + 1;
    size_t i;
    *least = HC_NEVER;
    *greatest = 0;
    for (i = 0; i < n; i += step) {
        const double height = z[i] < 0 ? -z[i] : z[i];
        if (height < *least) *least = height;
        if (height > *greatest && height < HC_greatest_height) *greatest = height;
    }
}

/* Chooses and proves the half planes of a scene. Returns 0, and the first stage is left out, where its sizes are too
   large or small for the margins. */
static int hc_make_scene(hc_scene *scene, const double sizes[4], size_t n, const double *z) {
    const double A = sizes[0] / sizes[2] * (sizes[0] / sizes[2]), B = sizes[1] / sizes[3] * (sizes[1] / sizes[3]);
    double least, greatest, heights[3], Q[3];
    hc_point under[3], above[3];
    int i;
    for (i = 0; i < 4; i++)
        if (!(sizes[i] > HC_least_size && sizes[i] < HC_greatest_size)) return 0;
    hc_sample_heights(n, z, &least, &greatest);
    /* Three heights: 0, one below most of the sample, one above nearly all of it. Not 0 itself: T <= reach must not hold
       for heights whose squares have underflowed. */
    heights[0] = 0;
    heights[2] = greatest > HC_least_height ? hc_short(1.0625 * greatest, 1) : HC_least_height;
    heights[1] = hc_short(least < greatest && least > 0.55 * heights[2] ? 0.999 * least : 0.55 * heights[2], 0);
    for (i = 0; i < 3; i++) {
        Q[i] = heights[i] / sizes[3] * (heights[i] / sizes[3]);
        under[i] = hc_known_point(sizes, heights[i], hc_edge(A, B, Q[i], 1), 1);
        above[i] = hc_known_point(sizes, heights[i], hc_edge(A, B, Q[i], -1), -1);
    }
    for (i = 0; i < 3; i++) { /* line 0 over all heights, 1 over the lower, 2 over the upper ones */
        const int from = i == 2, to = i == 1 ? 1 : 2;
        const double Q_middle = i == 0 ? Q[1] : 0.5 * (Q[from] + Q[to]);
        hc_tangent_beyond(sizes, hc_best_multiplier(A, B, Q_middle, 1), scene->beyond + i);
        hc_tangent_within(sizes, hc_best_multiplier(A, B, Q_middle, -1), scene->within + i);
        hc_chord(under[from], under[to], 1, scene->under + i);
        hc_chord(above[from], above[to], -1, scene->above + i);
    }
    scene->reach = under[2].T * HC_less;
    return HC_FLOATS_DECIDE;
}


/* ---- the half spaces of one orientation: which they are, and that they prove ---- */

/* Numbers with bounds of their errors, both NaN where nothing is known. The bounds hold in any rounding mode: each operation
   adds HC_unit |v| for its own rounding, a 2^-40th of e for those of e, and HC_lost for what underflows. */
static double hc_size(double value) { return value < 0 ? -value : value; }

static double hc_nothing_known(void) {
    const uint64_t bits = (uint64_t)0x7ff8 << 48;
    double nan;
    memcpy(&nan, &bits, sizeof nan);
    return nan;
}

static hc_ball hc_exactly(double value) {
    hc_ball ball;
    ball.v = value;
    ball.e = 0;
    return ball;
}

static hc_ball hc_ball_of(double v, double e) {
    hc_ball ball;
    ball.v = v;
    ball.e = (e + HC_unit * hc_size(v)) * HC_more_than + HC_lost;
    if (!(hc_size(v) < HC_cap && e < HC_cap)) ball.v = ball.e = hc_nothing_known();
    return ball;
}

static hc_ball hc_plus(hc_ball a, hc_ball b) { return hc_ball_of(a.v + b.v, a.e + b.e); }
static hc_ball hc_minus(hc_ball a, hc_ball b) { return hc_ball_of(a.v - b.v, a.e + b.e); }
static hc_ball hc_times(hc_ball a, hc_ball b) {
    return hc_ball_of(a.v * b.v, hc_size(a.v) * b.e + a.e * (hc_size(b.v) + b.e));
}

/* a/b - a'/b' = ((a - a') + (a'/b') (b' - b))/b */
static hc_ball hc_over(hc_ball a, hc_ball b) {
    const double least = (hc_size(b.v) - b.e * HC_more_than) / HC_more_than, v = a.v / b.v;
    return hc_ball_of(v, least > 0 ? (a.e + hc_size(v) * HC_more_than * b.e) / least : hc_nothing_known());
}

/* |√a - r| = |a - r²|/(√a + r) <= |a - r²|/r */
static hc_ball hc_root(hc_ball a) {
    double root = hc_rough_root(a.v);
    hc_ball rest;
    if (!(root > 0 && a.v > a.e)) return hc_ball_of(hc_nothing_known(), 0);
    root = 0.5 * (root + a.v / root);
    root = 0.5 * (root + a.v / root);
    rest = hc_minus(a, hc_times(hc_exactly(root), hc_exactly(root)));
    return hc_ball_of(root, (hc_size(rest.v) + rest.e) / root);
}

static double hc_at_most(hc_ball a) { return (a.v + a.e) * (a.v + a.e > 0 ? HC_more : HC_less); }
static double hc_at_least(hc_ball a) { return (a.v - a.e) * (a.v - a.e > 0 ? HC_less : HC_more); }

/* The rows of the basis in units of 1/b: the horizontal one across the axis, and those of the plane of both axes, where
   D = diag(1/p, -1/s), M = (c + h/t, (1/t - 1)√(hc); ., h + c/t). With D y = y M y's eigenvalue, a row is M y of unit
   length, and y is taken from the line of D - M/A2, or of D + M/B, in which nothing cancels. */
static void hc_basis(hc_tilted_scene *scene, hc_ball rows[3][3], const double sizes[4], const double axis[3]) {
    const hc_ball one = hc_exactly(1), b = hc_exactly(sizes[2]);
    const hc_ball alpha = hc_over(hc_exactly(sizes[0]), b), gamma = hc_over(hc_exactly(sizes[1]), b);
    const hc_ball d = hc_over(hc_exactly(sizes[3]), b), vx = hc_exactly(axis[0]), vy = hc_exactly(axis[1]);
    const hc_ball vz = hc_exactly(axis[2]), level = hc_plus(hc_times(vx, vx), hc_times(vy, vy));
    const hc_ball w = hc_plus(level, hc_times(vz, vz)), h = hc_over(level, w), c = hc_over(hc_times(vz, vz), w);
    const hc_ball p = hc_times(alpha, alpha), s = hc_times(gamma, gamma), t = hc_times(d, d), k0 = hc_times(p, s);
    const hc_ball along = hc_plus(hc_times(t, h), c), across = hc_plus(hc_times(t, c), h);
    const hc_ball k1 = hc_minus(hc_times(s, along), hc_times(p, across));
    const hc_ball root = hc_root(hc_plus(hc_times(k1, k1), hc_times(hc_exactly(4), hc_times(k0, t))));
    const hc_ball larger = hc_times(hc_exactly(0.5), k1.v < 0 ? hc_minus(root, k1) : hc_plus(root, k1));
    const hc_ball one_pole = hc_over(larger, t), other_pole = hc_over(k0, larger);
    const hc_ball length = hc_root(level), east = hc_over(vx, length), north = hc_over(vy, length);
    const hc_ball M11 = hc_over(across, t), M22 = hc_over(along, t); /* c + h/t, h + c/t */
    const hc_ball M12 = hc_times(hc_minus(hc_over(one, t), one), hc_over(hc_times(length, vz), w));
    int i, k;
    scene->A1 = p;
    scene->A2 = k1.v < 0 ? one_pole : other_pole;
    scene->B = k1.v < 0 ? other_pole : one_pole;
    rows[0][0] = hc_over(hc_minus(hc_exactly(0), north), b);
    rows[0][1] = hc_over(east, b);
    rows[0][2] = hc_exactly(0);
    for (i = 1; i < 3; i++) {
        const hc_ball pole = i == 1 ? scene->A2 : scene->B, mixed = hc_over(hc_minus(hc_exactly(0), M12), pole);
        const hc_ball whole = hc_plus(hc_over(one, i == 1 ? s : p), hc_over(i == 1 ? M22 : M11, pole));
        const hc_ball y1 = i == 1 ? whole : mixed, y2 = i == 1 ? mixed : whole;
        const hc_ball m1 = hc_plus(hc_times(M11, y1), hc_times(M12, y2)), m2 = hc_plus(hc_times(M12, y1), hc_times(M22, y2));
        const hc_ball unit = hc_times(hc_root(hc_plus(hc_times(y1, m1), hc_times(y2, m2))), b);
        rows[i][0] = hc_over(hc_times(m1, east), unit);
        rows[i][1] = hc_over(hc_times(m1, north), unit);
        rows[i][2] = hc_over(m2, unit);
    }
    scene->zeta = 0;
    for (i = 0; i < 3; i++) {
        double eta = 0;
        for (k = 0; k < 3; k++) eta += 4 * HC_unit * hc_size(rows[i][k].v) + rows[i][k].e;
        eta *= (sizes[2] > sizes[3] ? sizes[2] : sizes[3]) * HC_more_than;
        eta = (2 * eta + eta * eta + 2 * HC_unit) * HC_more_than;
        if (!(eta < 1)) eta = 1;
        if (eta > scene->zeta) scene->zeta = eta;
    }
}

static const hc_plane hc_never_above = {1, HC_NEVER, 0}, hc_never_below = {1, -1, 0};

/* z of the margins: more than (1 + a + M) zeta for all a and M that may come of it. */
static double hc_margin(const hc_tilted_scene *scene, double a, double M) { return 2 * (1 + a + M) * scene->zeta; }

/* A plane for comparisons > or >= (side 1), < (side -1), if its constants and its margin allow. */
static hc_plane hc_proper(const hc_tilted_scene *scene, double a, double K, double M, double z, int greater) {
    hc_plane plane;
    const int proper = a > HC_least_ratio && a < HC_greatest_ratio && K >= HC_least_constant && K < HC_cap && M >= 0 &&
                       M <= HC_greatest_slope && (1 + a + M) * scene->zeta * HC_more <= z && z < 0.125 && z < 0.125 * a;
    plane.a = a * (greater ? HC_less : HC_more);
    plane.K = K * (greater ? HC_more : HC_less);
    plane.M = M * (greater ? HC_more : HC_less);
    return proper ? plane : greater ? hc_never_above : hc_never_below;
}

/* The plane of one λ: exterior beyond it for λ > 0, interior within it for λ < 0. */
static hc_plane hc_tilted_tangent(const hc_tilted_scene *scene, double l, int side) {
    const hc_ball at = hc_exactly(l), from_A1 = hc_plus(scene->A1, at), from_A2 = hc_plus(scene->A2, at);
    const hc_ball from_B = hc_minus(scene->B, at), beta = hc_over(from_A1, from_A2), nu = hc_over(from_A1, from_B);
    const hc_ball kappa = hc_times(from_A1, hc_plus(hc_exactly(1), hc_over(hc_exactly(1), at)));
    const double z = hc_margin(scene, beta.v, nu.v);
    const int inside = hc_at_least(from_A1) > 0 && hc_at_least(from_A2) > 0 && hc_at_least(from_B) > 0 && side * l > 0;
    if (!inside) return side > 0 ? hc_never_above : hc_never_below;
    if (side > 0)
        return hc_proper(scene, hc_at_least(beta) - z, hc_at_most(kappa) * (1 + z), hc_at_most(nu) * (1 + z) + z, z, 1);
    return hc_proper(scene, hc_at_most(beta) + z, hc_at_least(kappa) * (1 - z), hc_at_least(nu) * (1 - z) - z, z, 0);
}

/* Whether the tangent at λ = l of φ = λ (P/(A+λ) - Q/(B-λ)) - 1 - λ is below 0 between 0 and the pole of that side: then
   so is φ, and the place (P, Q) is not exterior (side 1), or not interior (side -1). */
static int hc_below_tangent(hc_ball A, hc_ball B, double P, double Q, double l, int side) {
    const hc_ball one = hc_exactly(1), at = hc_exactly(l), p = hc_exactly(P), q = hc_exactly(Q);
    const hc_ball from_A = hc_plus(A, at), from_B = hc_minus(B, at), part_P = hc_over(p, from_A), part_Q = hc_over(q, from_B);
    const hc_ball phi = hc_minus(hc_times(at, hc_minus(part_P, part_Q)), hc_plus(one, at));
    const hc_ball rise = hc_times(hc_over(A, from_A), part_P), fall = hc_times(hc_over(B, from_B), part_Q);
    const hc_ball slope = hc_minus(hc_minus(rise, fall), one), at_0 = hc_minus(phi, hc_times(slope, at));
    const hc_ball to_pole = side > 0 ? from_B : hc_minus(hc_exactly(0), from_A), at_pole = hc_plus(phi, hc_times(slope, to_pole));
    return hc_at_least(from_A) > 0 && hc_at_least(from_B) > 0 && hc_at_most(at_0) < 0 && hc_at_most(at_pole) < 0;
}

/* The same with the best λ, which Newton's method finds for φ' = 0, and with λ = 0. */
static int hc_not_on_side(hc_ball A, hc_ball B, double P, double Q, int side) {
    double l = side * hc_best_multiplier(A.v, B.v, Q, side);
    int i;
    for (i = 0; i < 4; i++) {
        const double a = 1 / (A.v + l), b = 1 / (B.v - l), rise = A.v * P * a * a, fall = B.v * Q * b * b;
        const double moved = l + (rise - fall - 1) / (2 * (rise * a + fall * b));
        if (!(moved > -A.v && moved < B.v && side * moved > 0)) break;
        l = moved;
    }
    return hc_below_tangent(A, B, P, Q, l, side) || hc_below_tangent(A, B, P, Q, 0, side);
}

/* A plane over Q in [from, to] whose corners are no exterior ones (side 1), or no interior ones (side -1). */
static hc_plane hc_tilted_chord(const hc_tilted_scene *scene, double from, double to, int side) {
    static const double steps[3] = {9.3132257461547852e-10 /* 2^-30 */, 1.52587890625e-05 /* 2^-16 */, 0.00390625 /* 2^-8 */};
    const hc_ball A[2] = {scene->A1, scene->A2}, B = scene->B;
    const double ends[2] = {from, to};
    double edge[2][2], at[2];
    int i, k, step;
    for (i = 0; i < 2; i++)
        for (k = 0; k < 2; k++) {
            edge[i][k] = hc_edge(A[i].v, B.v, ends[k], side);
            if (!(edge[i][k] > 0)) edge[i][k] = 0;
        }
    for (step = 0; step < 3; step++) {
        const double a = edge[1][1] > 0 ? edge[0][1] / edge[1][1] : 1;
        double K, M, z;
        int proved = 1;
        for (k = 0; k < 2; k++) {
            const double first = edge[0][k], second = a * edge[1][k];
            at[k] = (side * (first - second) < 0 ? first : second) * (1 - side * steps[step]);
        }
        M = to > from ? (at[1] - at[0]) / (to - from) : 0;
        K = at[0] - M * from;
        if (side < 0 && K < 2 * HC_least_constant) {
            M = to > 0 ? at[1] / to * (1 + steps[0]) : 0;
            K = 2 * HC_least_constant;
        }
        z = hc_margin(scene, a, M);
        for (i = 0; i < 2; i++)
            for (k = 0; k < 2; k++) {
                const hc_ball line = hc_plus(hc_exactly(K), hc_times(hc_exactly(M), hc_exactly(ends[k])));
                const hc_ball corner = i ? hc_over(line, hc_exactly(a)) : line;
                const double P = side > 0 ? hc_at_most(corner) : hc_at_least(corner);
                proved = proved && P >= 0 && hc_not_on_side(A[i], B, P, ends[k], side);
            }
        if (proved && side > 0) return hc_proper(scene, a * (1 - z) + z, K * (1 - z), M * (1 - z) - z, z, 0);
        if (proved) return hc_proper(scene, a * (1 + z) - z, K * (1 + z), M * (1 + z) + z, z, 1);
    }
    return side > 0 ? hc_never_below : hc_never_above;
}

/* The greatest and the least Q that the centres have, from a sample of them. */
static void hc_sample_Q(const hc_tilted_scene *scene, size_t n, const double *x, const double *y, const double *z,
                        double *least, double *greatest) {
    const size_t step = n / 64 + 1;
    size_t i;
    *least = HC_NEVER;
    *greatest = 0;
    for (i = 0; i < n; i += step) {
        const double c3 = scene->r3_x * x[i] + scene->r3_y * y[i] + scene->r3_z * z[i], Q = c3 * c3;
        if (Q < *least) *least = Q;
        if (Q > *greatest && Q < HC_greatest) *greatest = Q;
    }
}

/* Chooses and proves the half spaces number `first` to `last`: 0 is over all heights, 1 over the lower, 2 over the upper ones. */
static void hc_make_planes(hc_tilted_scene *scene, int first, int last) {
    const double *const Q = scene->heights, A = 0.5 * (scene->A1.v + scene->A2.v), B = scene->B.v;
    double most = 0;
    int i;
    for (i = first; i <= last; i++) {
        const int from = i == 2, to = i == 1 ? 1 : 2;
        const double middle = i == 0 ? Q[1] : 0.5 * (Q[from] + Q[to]);
        const hc_plane *const under = scene->under + i;
        double P;
        scene->beyond[i] = hc_tilted_tangent(scene, hc_best_multiplier(A, B, middle, 1), 1);
        scene->within[i] = hc_tilted_tangent(scene, -hc_best_multiplier(A, B, middle, -1), -1);
        scene->under[i] = hc_tilted_chord(scene, Q[from], Q[to], 1);
        scene->above[i] = hc_tilted_chord(scene, Q[from], Q[to], -1);
        P = 8 * (under->K + (1 + under->M) * Q[2]) * (1 + 1 / under->a);
        if (under->K > 0 && P > most) most = P;
    }
    /* A computed Q up to `reach` and what "under" leaves of P say that the exact Q is at most Q[2]: with z < a/8 < 1/8 they
       bound N = P1 + P2 + Q by Q + 1.15 (K + (M + 1/8) Q)(1 + 1.25/a), and Q exceeds the computed one by zeta N at most. */
    scene->reach = (Q[2] - scene->zeta * (most + 2 * Q[2])) * HC_less;
}

/* Returns 0, and the first stage is left out, where the sizes are too large or small for the margins. */
static int hc_make_tilted_scene(hc_tilted_scene *scene, const double sizes[4], const double axis[3], size_t n,
                                const double *x, const double *y, const double *z) {
    hc_ball rows[3][3];
    double least, greatest, *const Q = scene->heights;
    int i;
    for (i = 0; i < 4; i++)
        if (!(sizes[i] > HC_least_size && sizes[i] < HC_greatest_size)) return 0;
    hc_basis(scene, rows, sizes, axis);
    if (!(scene->zeta < HC_greatest_zeta)) return 0;
    scene->r1_x = rows[0][0].v, scene->r1_y = rows[0][1].v;
    scene->r2_x = rows[1][0].v, scene->r2_y = rows[1][1].v, scene->r2_z = rows[1][2].v;
    scene->r3_x = rows[2][0].v, scene->r3_y = rows[2][1].v, scene->r3_z = rows[2][2].v;
    hc_sample_Q(scene, n, x, y, z, &least, &greatest);
    Q[0] = 0;
    Q[2] = greatest > HC_least ? 1.125 * greatest : HC_least;
    Q[1] = least < greatest && least > 0.3 * Q[2] ? 0.999 * least : 0.3 * Q[2];
    hc_make_planes(scene, 0, 0);
    scene->has_two = 0;
    return HC_FLOATS_DECIDE;
}

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

/* ---- sweeps: straight motions ---- */

#define HC_SWEEP_STEPS 128
#define HC_SHORTEST 7.1054273576010019e-15 /* 2^-47: a shorter step says that steps come to nothing here */
#define HC_FARTHEST_SWEEP 1.4272476927059599e+45 /* 2^150, limit of coordinates: R and T stay below the cap */
#define HC_GREATEST_SLACK 0.25
#define HC_SEEN 64 /* slacks by which a spheroid grown has contact at the time that is called its first */

/* A sweep from a float centre: `change` is the rounded difference of both ends. At a computed centre, and along `change`
   from there up to the end of the sweep, the exact centre lies within `slack` of the computed one, in radii. For each
   coordinate the change is rounded once, and so are its product with the time and the sum: each by u (|from| + |to|) at
   most, up to second order, which makes 3u (1 + 4u) (|from| + |to|). slack = 4u (1 + the sum of these in radii), with
   the rest for its own rounding and that of b (1 + slack) and b (1 - slack). Where the axis is tilted, the smaller of b and d
   is the radius. */
typedef struct {
    double sizes[4], from[3], change[3], slack;
    double v;           /* where the multiplier was found last */
    const double *axis; /* NULL where it is vertical */
    hc_tilted_scene poles; /* of the spheroid larger by the slack, where it is tilted, as the basis is */
    hc_ball basis[3][3], along[3];
} hc_sweep;

/* The components of a place in the basis. */
static void hc_components(hc_ball components[3], hc_ball basis[3][3], const double place[3]) {
    int i, k;
    for (i = 0; i < 3; i++) {
        components[i] = hc_times(basis[i][0], hc_exactly(place[0]));
        for (k = 1; k < 3; k++) components[i] = hc_plus(components[i], hc_times(basis[i][k], hc_exactly(place[k])));
    }
}

/* Returns 0 where the numbers are too large or small for the bounds. */
static int hc_make_sweep(hc_sweep *sweep, const double row[10], const double *axis) {
    const double least = row[2] < row[3] ? row[2] : row[3];
    double sum = 0, larger[4];
    int k;
    for (k = 0; k < 4; k++) {
        sweep->sizes[k] = row[k];
        if (!(row[k] > HC_least_size && row[k] < HC_greatest_size)) return 0;
    }
    for (k = 0; k < 3; k++) {
        const double from = row[4 + k], to = row[7 + k], reach = hc_size(from) + hc_size(to);
        if (!(reach < HC_FARTHEST_SWEEP)) return 0;
        sweep->from[k] = from;
        sweep->change[k] = to - from;
        sum += reach / (axis ? least : row[k == 2 ? 3 : 2]);
    }
    sweep->slack = HC_u_4 * (1 + sum);
    sweep->v = 0;
    sweep->axis = axis;
    if (!(HC_FLOATS_DECIDE && sweep->slack < HC_GREATEST_SLACK)) return 0;
    if (axis) {
        for (k = 0; k < 4; k++) larger[k] = k < 2 ? row[k] : row[k] * (1 + sweep->slack);
        hc_basis(&sweep->poles, sweep->basis, larger, axis);
        hc_components(sweep->along, sweep->basis, sweep->change);
    }
    return 1;
}

/* The spheroid at a time, b and d multiplied. */
static void hc_sweep_at(const hc_sweep *sweep, double time, double scale, double row[7]) {
    int k;
    for (k = 0; k < 4; k++) row[k] = k < 2 ? sweep->sizes[k] : sweep->sizes[k] * scale;
    for (k = 0; k < 3; k++) row[4 + k] = sweep->from[k] + time * sweep->change[k];
}

/* The exact position of a valid row of seven, with an axis if it is tilted. */
static int hc_position_with(const double row[7], const double *axis) {
    double ten[10];
    hc_bits found;
    if (!axis) return hc_position_of(row);
    memcpy(ten, row, 7 * sizeof *row);
    memcpy(ten + 7, axis, 3 * sizeof *axis);
    found = hc_tilted_plain(ten, 1, 1);
    return HC_FLOATS_DECIDE && found.decided ? (int)found.plus - (int)found.minus : hc_exact_tilted_position(ten);
}

/* Whether the spheroid, b and d multiplied, has contact at a computed centre. With less than its slack that is contact of
   the spheroid itself at the exact centre. */
static int hc_sweep_touches(const hc_sweep *sweep, double time, double scale) {
    double row[7];
    hc_sweep_at(sweep, time, scale, row);
    return hc_position_with(row, sweep->axis) == 0;
}

/* About the multiplier at which a half plane of that side lies farthest from a centre of height Q: the root of
   A/m² = 1 + Q (A+B)/(B - side m)². With m = B v/(1 + side v) that is E(v) = v² (B²/(1 + side v)² + W) = A; Newton's method
   between bounds, from where it was before. Any result is safe. */
static double hc_sweep_multiplier(double A, double B, double Q, int side, double *before) {
    const double W = Q * (A + B), root = hc_rough_root(A), room = B - side * root;
    double low = 0, high = room > 0 ? root / room : HC_cap, v;
    int i;
    if (W * high * high > A) high = hc_rough_root(A / W) * (1 + HC_settled);
    if (high > 1 / HC_settled) high = 1 / HC_settled;
    v = *before > 0 && *before < high ? *before : side > 0 && high > 1 ? 1 : high;
    for (i = 0; i < 24; i++) {
        const double inverse = 1 / (1 + side * v), square = B * inverse * (B * inverse) + W;
        const double off = v * v * square - A, rise = 2 * v * (B * inverse * (B * inverse) * inverse + W);
        double moved = v - off / rise;
        if (off > 0) high = v;
        else low = v;
        if (!(moved > low && moved < high)) moved = low > 0 && high > 4 * low ? hc_rough_root(low * high) : 0.5 * (low + high);
        if (hc_size(moved - v) < HC_settled * HC_settled * v) break;
        v = moved;
    }
    *before = v;
    v = B * v / (1 + side * v);
    return side < 0 && v > A * (1 - HC_settled) ? A * (1 - HC_settled) : v;
}

static void hc_tangent_high(const double sizes[4], double mu, hc_line *line) {
    const double alpha = sizes[0], gamma = sizes[1], b = sizes[2], d = sizes[3];
    const double u_8 = HC_u_8, more = HC_more, less = HC_less;
    /* printed from the program "tangent-high" */
    const double p = alpha * alpha;
    const double q = b * b;
    const double q_mu = q * mu;
    const double across = p - q_mu;
    const double across_terms = p + q_mu;
    const double across_error = u_8 * across_terms;
    const double across_least = across - across_error;
    const double across_most = across + across_error;
    const double one_minus_mu = 1.0 - mu;
    const double product = across_most * one_minus_mu;
    const double fall = product / mu;
    const double fall_most = more * fall;
    const double s = gamma * gamma;
    const double t = d * d;
    const double t_mu = t * mu;
    const double along = s + t_mu;
    const double M = across_least / along;
    const double M_least = less * M;
    /* end of the program "tangent-high" */
    const int proves = mu > 0 && mu < 1 && across_least > 0 && fall_most >= HC_least_constant && M_least <= HC_greatest_slope;
    line->K = proves ? -fall_most : -1;
    line->M = proves ? M_least : 0;
}

/* A number below the first root of here + 2 slope s + bend s², here > 0; 2 where there is none in [0, 1]. The root is
   here/(√D - slope), D = slope² - here bend. D is off by 3u of its terms' sizes at most, hence 4u; Heron's step is not
   below the root of what it is asked, but for its 4 roundings. What underflows in D is below 2^-1020, so 2^-500 covers it;
   that costs nothing where `here` is not below 2^-402; it is 0 or more than that beside half planes. */
static double hc_sweep_root(double here, double slope, double bend) {
    const double square = slope * slope, product = here * bend, size = hc_size(product);
    const double most = square - product + HC_u_4 * (square + size);
    double root = 3.0549363634996047e-151 /* 2^-500 */, bottom;
    if (!(here > 9.6817414919811262e-122 /* 2^-402 */)) return 0;
    if (most < 0) return 2;
    if (most > 1e-290) {
        const double rough = hc_rough_root(most);
        root += 0.5 * (rough + most / rough) * (1 + HC_u_8);
    }
    bottom = root - slope;
    return bottom > 0 && here < 2 * bottom ? here / bottom * HC_less : 2;
}

/* The same for a tilted spheroid: the m at which side (P1/(A1+l) + P2/(A2+l) - Q/(B-l) - 1 - 1/l), l = side m, is
   greatest: P1 (m/(A1+l))² + P2 (m/(A2+l))² + Q (m/(B-l))² = 1, which rises with m, m = pole v/(1 + v). */
static double hc_tilted_sweep_multiplier(const hc_sweep *sweep, const hc_ball at[3], int side, double *before) {
    const double poles[3] = {sweep->poles.A1.v, sweep->poles.A2.v, sweep->poles.B.v};
    const double nearer = poles[0] < poles[1] ? poles[0] : poles[1], pole = side > 0 ? poles[2] : nearer;
    double low = 0, high = 1 / HC_settled, v = *before > 0 ? *before : 1; /* below `high`: each one kept was, and lost HC_settled² */
    int i, k;
    for (i = 0; i < 48; i++) {
        const double inverse = 1 / (1 + v), m = pole * v * inverse;
        double off = -1, rise = 0, moved;
        for (k = 0; k < 3; k++) {
            const double from = 1 / (poles[k] + (k < 2 ? side : -side) * m), part = m * from * at[k].v * at[k].v;
            off += part * m * from;
            rise += 2 * part * poles[k] * from * from * pole * inverse * inverse;
        }
        if (off > 0) high = v;
        else low = v;
        moved = v - off / rise;
        if (!(moved > low && moved < high)) moved = low > 0 && high > 4 * low ? hc_rough_root(low * high) : 0.5 * (low + high);
        if (hc_size(moved - v) < HC_settled * HC_settled * v) break;
        v = moved;
    }
    *before = v;
    return side * pole * v / (1 + v);
}

/* As hc_sweep_reach, for a tilted spheroid. With l fixed, side (P1/(A1+l) + P2/(A2+l) - Q/(B-l) - 1 - 1/l) > 0 proves the
   side, and is quadratic along the sweep; numbers with bounds compute it. */
static double hc_tilted_sweep_reach(hc_sweep *sweep, const double place[3], int position) {
    const hc_ball *const poles[3] = {&sweep->poles.A1, &sweep->poles.A2, &sweep->poles.B};
    const hc_ball one = hc_exactly(1), nothing = hc_exactly(0);
    hc_ball at[3], sums[3], l;
    double lower[3];
    int i, k;
    hc_components(at, sweep->basis, place);
    l = hc_exactly(hc_tilted_sweep_multiplier(sweep, at, position, &sweep->v));
    sums[0] = hc_minus(nothing, hc_plus(one, hc_over(one, l)));
    sums[1] = sums[2] = nothing;
    for (i = 0; i < 3; i++) {
        const hc_ball from = i < 2 ? hc_plus(*poles[i], l) : hc_minus(*poles[i], l), weight = hc_over(one, from);
        const hc_ball here = hc_times(at[i], at[i]), slope = hc_times(at[i], sweep->along[i]);
        const hc_ball parts[3] = {here, slope, hc_times(sweep->along[i], sweep->along[i])};
        if (!(hc_at_least(from) > 0)) return 0;
        for (k = 0; k < 3; k++) {
            const hc_ball part = hc_times(parts[k], weight);
            sums[k] = i < 2 ? hc_plus(sums[k], part) : hc_minus(sums[k], part);
        }
    }
    for (k = 0; k < 3; k++) {
        lower[k] = hc_at_least(position > 0 ? sums[k] : hc_minus(nothing, sums[k]));
        if (!(hc_size(lower[k]) < HC_cap)) return 0; /* as where nothing is known */
    }
    return position * l.v > 0 ? hc_sweep_root(lower[0], lower[1], lower[2]) : 0;
}

/* How far from a time the spheroid is proved to stay on that side: a part of the whole sweep, 2 to its end, 0 where
   nothing is proved. */
static double hc_sweep_reach(hc_sweep *sweep, double time, int position) {
    const double u_8 = HC_u_8, side = position;
    double row[7];
    hc_line half_plane;
    hc_sweep_at(sweep, time, 1 + sweep->slack, row);
    if (sweep->axis) return hc_tilted_sweep_reach(sweep, row + 4, position);
    {
        const double a = row[0] / row[2], c = row[1] / row[3], q = row[6] / row[3];
        const double at = hc_sweep_multiplier(a * a, c * c, q * q, position, &sweep->v);
        if (position > 0) hc_tangent_beyond(row, at, &half_plane);
        else if (at > 1) hc_tangent_within(row, at, &half_plane);
        else hc_tangent_high(row, at, &half_plane);
    }
    if (half_plane.K == HC_NEVER || half_plane.K == -1) return 0;
    {
        const double x = row[4], y = row[5], z = row[6], K = half_plane.K, M = half_plane.M;
        const double u = sweep->change[0], v = sweep->change[1], w = sweep->change[2];
        /* printed from the program "piece" */
        const double xx = x * x;
        const double yy = y * y;
        const double R = xx + yy;
        const double T = z * z;
        const double rise = M * T;
        const double line = K + rise;
        const double gap = R - line;
        const double size_K = hc_size(K);
        const double size_line = size_K + rise;
        const double size_here = R + size_line;
        const double error_here = u_8 * size_here;
        const double side_gap = side * gap;
        const double here = side_gap - error_here;
        const double xu = x * u;
        const double yv = y * v;
        const double R_slope = xu + yv;
        const double zw = z * w;
        const double rise_slope = M * zw;
        const double gap_slope = R_slope - rise_slope;
        const double size_xu = hc_size(xu);
        const double size_yv = hc_size(yv);
        const double size_R_slope = size_xu + size_yv;
        const double size_rise_slope = hc_size(rise_slope);
        const double size_slope = size_R_slope + size_rise_slope;
        const double error_slope = u_8 * size_slope;
        const double side_gap_slope = side * gap_slope;
        const double slope = side_gap_slope - error_slope;
        const double uu = u * u;
        const double vv = v * v;
        const double R_bend = uu + vv;
        const double ww = w * w;
        const double rise_bend = M * ww;
        const double gap_bend = R_bend - rise_bend;
        const double size_bend = R_bend + rise_bend;
        const double error_bend = u_8 * size_bend;
        const double side_gap_bend = side * gap_bend;
        const double bend = side_gap_bend - error_bend;
        const double size_ends = size_here + size_bend;
        const double size = size_ends + size_slope;
        /* end of the program "piece" */
        return size < HC_cap ? hc_sweep_root(here, slope, bend) : 0;
    }
}

/* A time of contact not long after one from which steps come to nothing; 2 where none is found. */
static double hc_sweep_look(const hc_sweep *sweep, double time) {
    double ahead;
    for (ahead = HC_SHORTEST; time + ahead < 1; ahead *= 8)
        if (hc_sweep_touches(sweep, time + ahead, 1 - sweep->slack)) return time + ahead;
    return 2;
}

static double hc_nearest_time(hc_sweep *sweep, const double row[10], int side, double clear, double contact); /* sweep_times.h */

/* 1, 0, or 2 where the bounds do not tell, for a valid row, with an axis if it is tilted; the time is NULL where it is not
   wanted. */
static int hc_passage_of(const double row[10], const double *axis, double *time) {
    double end_row[7], contact, now = 0;
    int start, end, step;
    hc_sweep sweep;
    memcpy(end_row, row, 4 * sizeof *row);
    memcpy(end_row + 4, row + 7, 3 * sizeof *row);
    start = hc_position_with(row, axis);
    end = hc_position_with(end_row, axis);
    if (start == 0) {
        if (time) *time = 0;
        return 1;
    }
    contact = end == start ? 2 : 1; /* a time of contact, 2 while none is known: between unlike positions there is one */
    if (contact < 2 && !time) return 1;
    if (!hc_make_sweep(&sweep, row, axis)) return contact < 2 ? 1 : 2;
    for (step = 0; step < HC_SWEEP_STEPS; step++) {
        const double reach = hc_sweep_reach(&sweep, now, start);
        if (reach * HC_less >= 1 - now) return 0;
        if (!(reach > HC_SHORTEST)) break;
        now += reach - 2 * HC_u_4; /* rounding adds 2^-52 at most */
        if (now + 0.5 * reach < contact && now + 0.5 * reach < 1 && hc_sweep_touches(&sweep, now + 0.5 * reach, 1 - sweep.slack)) {
            contact = now + 0.5 * reach;
            if (!time) return 1;
        }
    }
    if (contact == 2) contact = hc_sweep_look(&sweep, now);
    if (contact == 2) return 2;
    if (time) {
        now = hc_nearest_time(&sweep, row, start, now, contact);
        if (hc_sweep_touches(&sweep, now, 1 + HC_SEEN * sweep.slack)) *time = now;
    }
    return 1;
}

/* ---- numbers of two doubles ---- */

/* high + low. Every operation below is right within 2^-100 of its result, a sum of the sizes of its operands, in each rounding
   mode, where products of halves neither overflow nor lose more than a negligible part (the sizes of hc_make_sections).

   A sum of two doubles, the larger first: their rounded sum minus the larger is a double in any mode that rounds to one of
   the two neighbours, and what is left is rounded by 2u of itself. A product: each factor is cut behind 26 bits, towards 0.
   In units where 1 <= a, b < 2 the parts are multiples of 2^-25 and 2^-52, and all but the last step below are exact: p
   within 2^-51 of ab, top·top - p a multiple of 2^-52 below 2^-22, the next two multiples of 2^-77 below 2^-24; the last
   product, of 27 bits twice, may lose one bit of 2^-104. Contraction into FMA changes no exact step. */
typedef struct {
    double high, low;
} hc_twin;

static hc_twin hc_twin_of(double value) {
    hc_twin made;
    made.high = value;
    made.low = 0;
    return made;
}

static hc_twin hc_two_sum(double one, double other) {
    const int less = hc_size(one) < hc_size(other);
    const double large = less ? other : one, small = less ? one : other, sum = large + small, kept = sum - large;
    hc_twin made;
    made.high = sum;
    made.low = small - kept;
    return made;
}

static double hc_top_half(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    bits &= ~(uint64_t)0x7ffffff;
    memcpy(&value, &bits, sizeof bits);
    return value;
}

static hc_twin hc_two_product(double one, double other) {
    const double top = hc_top_half(one), rest = one - top, over = hc_top_half(other), under = other - over, p = one * other;
    double error = top * over - p;
    hc_twin made;
    error += top * under;
    error += rest * over;
    error += rest * under;
    made.high = p;
    made.low = error;
    return made;
}

static hc_twin hc_twin_sum(hc_twin one, hc_twin other) {
    const hc_twin high = hc_two_sum(one.high, other.high);
    return hc_two_sum(high.high, high.low + (one.low + other.low));
}

static hc_twin hc_twin_minus(hc_twin one) {
    one.high = -one.high;
    one.low = -one.low;
    return one;
}

static hc_twin hc_twin_difference(hc_twin one, hc_twin other) { return hc_twin_sum(one, hc_twin_minus(other)); }

static hc_twin hc_twin_product(hc_twin one, hc_twin other) {
    const hc_twin high = hc_two_product(one.high, other.high);
    return hc_two_sum(high.high, high.low + (one.high * other.low + one.low * other.high));
}

static hc_twin hc_twin_square(hc_twin value) { return hc_twin_product(value, value); }

static hc_twin hc_twin_quotient(hc_twin one, hc_twin other) {
    const double first = one.high / other.high;
    const hc_twin left = hc_twin_difference(one, hc_twin_product(other, hc_twin_of(first)));
    return hc_two_sum(first, left.high / other.high);
}

/* hc_fine_root is right within 2^-50, its error is halved and squared by one more step of Newton's method. */
static hc_twin hc_twin_root(hc_twin square) {
    const double root = hc_fine_root(square.high);
    const hc_twin left = hc_twin_difference(square, hc_two_product(root, root));
    return root > 0 ? hc_two_sum(root, left.high / (2 * root)) : hc_twin_of(0);
}

/* ---- first contacts on sweeps by numbers of two doubles ---- */

#define HC_TIME_UNIT 3.1554436208840472e-30 /* 2^-98: each operation is right within 2^-100 (twins.h), and room */
#define HC_TIME_STEPS 64
#define HC_POLE_STEPS 96
#define HC_NEAREST_POLE 1.1805916207174113e+21 /* 2^70 */

/* Numbers of two doubles with bounds of their errors, as hc_ball is one of doubles: each operation adds HC_TIME_UNIT of its
   result (a sum: of its operands), a 2^-40th of e for what e and sizes are rounded by, and HC_lost for what underflows. */
typedef struct {
    hc_twin v;
    double e;
} hc_fine_ball;

static hc_fine_ball hc_fine_ball_of(hc_twin v, double size, double e) {
    hc_fine_ball made;
    made.v = v;
    made.e = (e + HC_TIME_UNIT * size) * HC_more_than + HC_lost;
    if (!(size < HC_cap && e < HC_cap)) made.v.high = made.v.low = made.e = hc_nothing_known();
    return made;
}

static hc_fine_ball hc_finely(hc_twin v) {
    hc_fine_ball made;
    made.v = v;
    made.e = 0;
    return made;
}

static hc_fine_ball hc_fine(double v) { return hc_finely(hc_twin_of(v)); }

static hc_fine_ball hc_fine_plus(hc_fine_ball a, hc_fine_ball b) {
    return hc_fine_ball_of(hc_twin_sum(a.v, b.v), hc_size(a.v.high) + hc_size(b.v.high), a.e + b.e);
}

static hc_fine_ball hc_fine_minus(hc_fine_ball a, hc_fine_ball b) {
    b.v = hc_twin_minus(b.v);
    return hc_fine_plus(a, b);
}

static hc_fine_ball hc_fine_times(hc_fine_ball a, hc_fine_ball b) {
    const hc_twin v = hc_twin_product(a.v, b.v);
    return hc_fine_ball_of(v, hc_size(v.high), hc_size(a.v.high) * b.e + a.e * (hc_size(b.v.high) + b.e));
}

/* As hc_over; what underflows in the quotient is divided by b. */
static hc_fine_ball hc_fine_over(hc_fine_ball a, hc_fine_ball b) {
    const double least = (hc_size(b.v.high) - b.e * HC_more_than) / HC_more_than;
    const hc_twin v = hc_twin_quotient(a.v, b.v);
    const double e = (a.e + hc_size(v.high) * HC_more_than * b.e + HC_lost) / least;
    return hc_fine_ball_of(v, hc_size(v.high), least > 0 ? e : hc_nothing_known());
}

/* e is more than 2^-99 |v|, so that a second e covers what low - 2e is rounded by. For results of operations alone. */
static double hc_fine_at_least(hc_fine_ball a) {
    const double least = a.v.high + (a.v.low - 2 * a.e);
    return least * (least > 0 ? HC_less : HC_more);
}

/* A sweep in the directions across the axis, along its horizontal part h, each times |h|, and upwards. E^-1, the matrix b² +
   (d² - b²) v v^T of the unit axis v, is b², `across` and T on its diagonal there, and `mixed` |h| between the last two.
   `square` is |h|². The spheroid is as it is: no slack. */
typedef struct {
    hc_fine_ball from[3], moved[3], alpha2, gamma2, b2, across, T, mixed, square;
    hc_twin pole; /* of the side: the l > 0, or -l > 0, nearest to 0 at which E^-1 l + H^-1 is singular */
    int side;
} hc_fine_sweep;

/* The pole of the side, of a sweep whose squares are made. The roots of b² d² l² + p l = alpha² gamma², of which one is > 0,
   and -alpha²/b². */
static hc_twin hc_fine_pole(const hc_fine_sweep *made, hc_fine_ball d2) {
    const hc_fine_ball ends = hc_fine_times(made->alpha2, made->gamma2), axes = hc_fine_times(made->b2, d2);
    const hc_fine_ball p = hc_fine_minus(hc_fine_times(made->alpha2, made->T), hc_fine_times(made->gamma2, made->across));
    const hc_fine_ball squares = hc_fine_plus(hc_fine_times(p, p), hc_fine_times(hc_fine(4), hc_fine_times(axes, ends)));
    const hc_twin size = p.v.high < 0 ? hc_twin_minus(p.v) : p.v, sum = hc_twin_sum(hc_twin_root(squares.v), size);
    const hc_twin half = hc_twin_product(sum, hc_twin_of(0.5)), other = hc_twin_quotient(made->alpha2.v, made->b2.v);
    const hc_twin root = (made->side > 0) == (p.v.high < 0) ? hc_twin_quotient(half, axes.v) : hc_twin_quotient(ends.v, half);
    return made->side < 0 && other.high < root.high ? other : root;
}

/* h is scaled by a power of two, so that no square of it is lost where the axis is tilted by a hair, and all lengths by the one
   that makes b about 1, so that no product of them is too large. */
static void hc_make_fine_sweep(hc_fine_sweep *made, const double row[10], const double *axis, int side) {
    const uint64_t power = (2046 - (hc_word(row[2]) >> 52)) << 52;
    double h[3] = {1, 0, 0}, scale = 0, unit;
    hc_fine_ball lengths[10], b, d, d2, h0, h1, places[2][3];
    int k;
    memcpy(&unit, &power, sizeof unit);
    for (k = 0; k < 10; k++) lengths[k] = hc_fine_times(hc_fine(row[k]), hc_fine(unit));
    b = lengths[2], d = lengths[3];
    made->alpha2 = hc_fine_times(lengths[0], lengths[0]);
    made->gamma2 = hc_fine_times(lengths[1], lengths[1]);
    made->b2 = hc_fine_times(b, b);
    d2 = hc_fine_times(d, d);
    made->side = side;
    if (axis) {
        h[0] = axis[0], h[1] = axis[1];
        hc_scale_axis(h);
        scale = hc_size(h[0]) > hc_size(h[1]) ? axis[0] / h[0] : axis[1] / h[1];
    }
    h0 = hc_fine(h[0]), h1 = hc_fine(h[1]);
    made->square = hc_fine_plus(hc_fine_times(h0, h0), hc_fine_times(h1, h1));
    for (k = 0; k < 2; k++) {
        hc_fine_ball place[3];
        int i;
        for (i = 0; i < 3; i++) place[i] = k ? hc_fine_minus(lengths[7 + i], lengths[4 + i]) : lengths[4 + i];
        places[k][0] = hc_fine_minus(hc_fine_times(place[0], h1), hc_fine_times(place[1], h0));
        places[k][1] = hc_fine_plus(hc_fine_times(place[0], h0), hc_fine_times(place[1], h1));
        places[k][2] = place[2];
    }
    memcpy(made->from, places[0], sizeof made->from);
    memcpy(made->moved, places[1], sizeof made->moved);
    if (axis) {
        const hc_fine_ball up = hc_fine(axis[2]), s = hc_fine(scale), up2 = hc_fine_times(up, up);
        const hc_fine_ball flat = hc_fine_times(made->square, hc_fine_times(s, s)), length = hc_fine_plus(flat, up2);
        const hc_fine_ball more = hc_fine_times(hc_fine_minus(d, b), hc_fine_plus(d, b));
        made->across = hc_fine_over(hc_fine_plus(hc_fine_times(made->b2, up2), hc_fine_times(d2, flat)), length);
        made->T = hc_fine_over(hc_fine_plus(hc_fine_times(made->b2, flat), hc_fine_times(d2, up2)), length);
        made->mixed = hc_fine_over(hc_fine_times(hc_fine_times(more, up), s), length);
    } else {
        made->across = made->b2;
        made->T = d2;
        made->mixed = hc_fine(0);
    }
    made->pole = hc_fine_pole(made, d2);
}

/* As hc_tilted_sweep_multiplier, v itself: l = side pole v/(1 + v), where v may be so large that l is next to its pole. */
static double hc_share_of_pole(const double poles[3], const double at[3], int side, double before) {
    const double nearer = poles[0] < poles[1] ? poles[0] : poles[1], pole = side > 0 ? poles[2] : nearer;
    double low = 0, high = HC_NEAREST_POLE, v = before > 0 && before < high ? before : 1;
    int i, k;
    for (i = 0; i < HC_POLE_STEPS; i++) {
        const double inverse = 1 / (1 + v), m = pole * v * inverse, rest = pole * inverse;
        double off = -1, rise = 0, moved;
        for (k = 0; k < 3; k++) {
            const double from = (k < 2) == (side > 0) ? poles[k] + m : poles[k] - pole + rest, part = m / from * at[k];
            off += part * part;
            rise += 2 * part * at[k] * (poles[k] / from) * (rest / from) * inverse;
        }
        if (off > 0) high = v;
        else low = v;
        moved = v - off / rise;
        if (!(moved > low && moved < high)) {
            if (low == 0) moved = v / 1024;
            else moved = high > 4 * low ? hc_rough_root(low) * hc_rough_root(high) : 0.5 * (low + high);
        }
        if (hc_size(moved - v) < HC_settled * HC_settled * v) break;
        v = moved;
    }
    return v;
}

/* As hc_sweep_reach, for the exact spheroid. With H of the hyperboloid, c^T (E^-1 l + H^-1)^-1 c - 1 - 1/l, times the side,
   is > 0 beside contact, if l E^-1 + H^-1 has two eigenvalues > 0 and one < 0, as it has at l = 0 and up to the poles. It is
   a sum of three squares over their pivots, the one that vanishes at the pole eliminated last. */
static double hc_fine_reach(const hc_fine_sweep *made, hc_twin multiplier, double now) {
    const hc_fine_ball one = hc_fine(1), l = hc_finely(multiplier), time = hc_fine(now), crossed = hc_fine_times(l, made->mixed);
    const hc_fine_ball beside = hc_fine_plus(made->alpha2, hc_fine_times(l, made->b2));
    const hc_fine_ball level = hc_fine_plus(made->alpha2, hc_fine_times(l, made->across));
    const hc_fine_ball upward = hc_fine_minus(hc_fine_times(l, made->T), made->gamma2);
    const int outside = made->side > 0, first = outside ? 1 : 2, last = 3 - first;
    const hc_fine_ball pivot = outside ? level : upward;
    const hc_fine_ball part = hc_fine_over(outside ? crossed : hc_fine_times(crossed, made->square), pivot);
    const hc_fine_ball lost = hc_fine_times(part, outside ? hc_fine_times(crossed, made->square) : crossed);
    const hc_fine_ball left = hc_fine_minus(outside ? upward : level, lost), nothing = hc_fine_minus(one, one);
    const hc_fine_ball pivots[3] = {hc_fine_times(beside, made->square), outside ? hc_fine_times(pivot, made->square) : pivot,
                                    outside ? left : hc_fine_times(left, made->square)};
    hc_fine_ball at[3], squares[3][2], sums[3];
    double lower[3];
    int i, k;
    if (!(hc_fine_at_least(beside) > 0)) return 0;
    for (k = 0; k < 2; k++) {
        const double sign = (k == 0) == outside ? 1 : -1;
        const hc_fine_ball asked = k ? left : pivot;
        if (!(hc_fine_at_least(hc_fine_times(hc_fine(sign), asked)) > 0)) return 0;
    }
    for (i = 0; i < 3; i++) at[i] = hc_fine_plus(made->from[i], hc_fine_times(time, made->moved[i]));
    squares[0][0] = at[0], squares[0][1] = made->moved[0];
    squares[1][0] = at[first], squares[1][1] = made->moved[first];
    squares[2][0] = hc_fine_minus(at[last], hc_fine_times(part, at[first]));
    squares[2][1] = hc_fine_minus(made->moved[last], hc_fine_times(part, made->moved[first]));
    sums[0] = hc_fine_minus(nothing, hc_fine_plus(one, hc_fine_over(one, l)));
    sums[1] = sums[2] = nothing;
    for (i = 0; i < 3; i++) {
        const hc_fine_ball here = hc_fine_over(squares[i][0], pivots[i]), change = hc_fine_over(squares[i][1], pivots[i]);
        sums[0] = hc_fine_plus(sums[0], hc_fine_times(here, squares[i][0]));
        sums[1] = hc_fine_plus(sums[1], hc_fine_times(here, squares[i][1]));
        sums[2] = hc_fine_plus(sums[2], hc_fine_times(change, squares[i][1]));
    }
    for (k = 0; k < 3; k++) {
        lower[k] = hc_fine_at_least(hc_fine_times(hc_fine(made->side), sums[k]));
        if (!(hc_size(lower[k]) < HC_cap)) return 0;
    }
    return hc_sweep_root(lower[0], lower[1], lower[2]);
}

/* A time up to which the sweep is clear, as near to its first contact as steps by numbers of two doubles come; `clear` is such
   a time and `contact` one of contact. Each step ends below a root, rounded down. */
static double hc_nearest_time(hc_sweep *sweep, const double row[10], int side, double clear, double contact) {
    const double a = row[0] / row[2], c = row[1] / row[3];
    double poles[3] = {a * a, a * a, c * c}, v = 0;
    hc_fine_sweep made;
    int step, k;
    if (sweep->axis) poles[0] = sweep->poles.A1.v, poles[1] = sweep->poles.A2.v, poles[2] = sweep->poles.B.v;
    hc_make_fine_sweep(&made, row, sweep->axis, side);
    for (step = 0; step < HC_TIME_STEPS; step++) {
        double place[3], at[3], reach, next;
        hc_twin l, sum;
        for (k = 0; k < 3; k++) place[k] = sweep->from[k] + clear * sweep->change[k];
        if (sweep->axis) {
            hc_ball components[3];
            hc_components(components, sweep->basis, place);
            for (k = 0; k < 3; k++) at[k] = components[k].v;
        } else {
            for (k = 0; k < 3; k++) at[k] = place[k] / row[k < 2 ? 2 : 3];
        }
        v = hc_share_of_pole(poles, at, side, v);
        l = hc_twin_product(made.pole, hc_twin_quotient(hc_twin_of(v), hc_two_sum(1, v)));
        reach = hc_fine_reach(&made, side > 0 ? l : hc_twin_minus(l), clear);
        sum = hc_two_sum(clear, reach);
        next = sum.high;
        if (sum.low < 0) { /* rounded down in any mode */
            uint64_t bits;
            memcpy(&bits, &next, sizeof bits);
            bits--;
            memcpy(&next, &bits, sizeof next);
        }
        if (!(next > clear && next < contact)) break;
        clear = next;
    }
    return clear;
}

/* ---- a pair's sections by numbers of two doubles ---- */

#define HC_FINE_ERROR 8.0779356694631609e-28 /* 2^-90: 128u of numbers of two doubles, u = 2^-100, and room */

/* hc_sections of ended.h without roots: eta = E/sqrt(F), xi = (X - kappa t)/sqrt(F), F the square of
   the horizontal part of the axis. `alpha2` is alpha², `rise2` alpha²/gamma², b2 is 1/mu1, c2 is 1/mu2. */
typedef struct {
    hc_twin alpha2, rise2, z, T, b2, c2, E, X, kappa, F;
    double v[2]; /* the horizontal part of the axis */
} hc_fine_sections;

static void hc_place_fine(hc_fine_sections *made, hc_twin x, hc_twin y, hc_twin z) {
    const hc_twin v0 = hc_twin_of(made->v[0]), v1 = hc_twin_of(made->v[1]);
    made->E = hc_twin_difference(hc_twin_product(x, v1), hc_twin_product(y, v0));
    made->X = hc_twin_sum(hc_twin_product(x, v0), hc_twin_product(y, v1));
    made->z = z;
}

/* b² and d² are multiplied by 1 + more. */
static hc_fine_sections hc_make_fine(const double row[10], double more) {
    const hc_twin one = hc_twin_of(1), share = hc_two_sum(1, more), d2 = hc_twin_product(hc_two_product(row[3], row[3]), share);
    hc_fine_sections made;
    double v[3];
    memcpy(v, row + 7, sizeof v);
    hc_scale_axis(v);
    made.alpha2 = hc_two_product(row[0], row[0]);
    made.rise2 = hc_twin_quotient(made.alpha2, hc_two_product(row[1], row[1]));
    made.b2 = hc_twin_product(hc_two_product(row[2], row[2]), share);
    made.v[0] = v[0], made.v[1] = v[1];
    if (v[0] == 0 && v[1] == 0) {
        made.T = d2;
        made.c2 = made.b2;
        made.kappa = hc_twin_of(0);
        made.F = one;
        made.v[0] = 1;
    } else {
        const hc_twin flat = hc_twin_sum(hc_two_product(v[0], v[0]), hc_two_product(v[1], v[1])), up = hc_twin_of(v[2]);
        const hc_twin length = hc_twin_sum(flat, hc_twin_square(up)), sum = hc_two_sum(row[2], row[3]);
        const hc_twin wide = hc_twin_product(hc_twin_product(hc_two_sum(row[2], -row[3]), sum), share);
        const hc_twin all = hc_twin_sum(hc_twin_product(made.b2, flat), hc_twin_product(d2, hc_twin_square(up)));
        made.T = hc_twin_quotient(all, length);
        made.c2 = hc_twin_quotient(hc_twin_product(made.b2, d2), made.T);
        made.kappa = hc_twin_quotient(hc_twin_product(hc_twin_product(up, flat), wide), all);
        made.F = flat;
    }
    hc_place_fine(&made, hc_twin_of(row[4]), hc_twin_of(row[5]), hc_twin_of(row[6]));
    return made;
}

static hc_twin hc_fine_square_of_radius(const hc_fine_sections *fine, double w) {
    return hc_twin_sum(fine->alpha2, hc_twin_product(fine->rise2, hc_two_product(w, w)));
}

/* t²/T - 1 at a height. */
static hc_twin hc_fine_share(const hc_fine_sections *fine, hc_twin t) {
    return hc_twin_difference(hc_twin_quotient(hc_twin_square(t), fine->T), hc_twin_of(1));
}

/* phi at a height, f being lambda/(1 + lambda/mu); the error is as in hc_phi_about, of doubles of 100 bits. */
static double hc_fine_phi(const hc_fine_sections *fine, double lambda_, double w) {
    const hc_twin t = hc_twin_difference(hc_twin_of(w), fine->z), l = hc_twin_of(lambda_), one = hc_twin_of(1);
    const hc_twin aside = hc_twin_difference(fine->X, hc_twin_product(fine->kappa, t));
    const hc_twin n1 = hc_twin_sum(one, hc_twin_product(l, fine->b2)), n2 = hc_twin_sum(one, hc_twin_product(l, fine->c2));
    const hc_twin parts = hc_twin_sum(hc_twin_quotient(hc_twin_square(fine->E), n1), hc_twin_quotient(hc_twin_square(aside), n2));
    const hc_twin off = hc_twin_difference(hc_twin_quotient(parts, fine->F), hc_fine_square_of_radius(fine, w));
    return hc_twin_sum(hc_fine_share(fine, t), hc_twin_product(l, off)).high;
}

/* What hc_point_within compares, by numbers of two doubles. */
static double hc_fine_point(const hc_fine_sections *fine, double w, double a, double c) {
    const hc_twin t = hc_twin_difference(hc_twin_of(w), fine->z), length = hc_twin_sum(hc_two_product(a, a), hc_two_product(c, c));
    const hc_twin scale = hc_twin_root(hc_twin_quotient(hc_twin_product(fine->F, hc_fine_square_of_radius(fine, w)), length));
    const hc_twin off = hc_twin_difference(hc_twin_product(scale, hc_twin_of(a)), fine->E);
    const hc_twin xi = hc_twin_difference(fine->X, hc_twin_product(fine->kappa, t));
    const hc_twin aside = hc_twin_difference(hc_twin_product(scale, hc_twin_of(c)), xi);
    const hc_twin sum = hc_twin_sum(hc_twin_quotient(hc_twin_square(off), fine->b2), hc_twin_quotient(hc_twin_square(aside), fine->c2));
    return hc_twin_sum(hc_twin_quotient(sum, fine->F), hc_fine_share(fine, t)).high;
}

/* ---- hyperboloids that end: exact integers beside an end, upright ---- */

#define HC_END_BITS 256 /* of a length in its unit, at most */
#define HC_END_LIMBS (40960 / HC_LIMB_BITS + 64) /* the numbers below have 35,700 bits together */

/* At a height w the circle has r² = alpha² (1 + w²/gamma²), the spheroid's disc s² = b² (1 - (w - z)²/d²), and R = x² + y².
   `misses`: the circle misses the closed disc, Q = r² - s² + R > 0 and Q² > 4 R r². `reached` is the sign of s², `off` that
   of R - r². All are multiplied by gamma² d². */
typedef struct {
    int known, misses, reached, off;
} hc_end;

static hc_integer hc_length(hc_pool *pool, hc_parts parts, int unit) {
    hc_integer number = hc_taken(pool, HC_END_BITS / HC_LIMB_BITS + 2);
    hc_in_units(&number, parts, unit);
    return number;
}

static int hc_spread(const hc_parts *parts, int count, int *unit) {
    int most = -4096, k;
    *unit = 4096;
    for (k = 0; k < count; k++) {
        *unit = hc_least(*unit, parts[k].exponent);
        if (parts[k].sign && parts[k].exponent > most) most = parts[k].exponent;
    }
    return most + 53 - *unit;
}

static hc_end hc_exact_end(const double row[13], double w) {
    const hc_parts radial[4] = {hc_parts_of(row[0]), hc_parts_of(row[2]), hc_parts_of(row[4]), hc_parts_of(row[5])};
    const hc_parts axial[4] = {hc_parts_of(row[1]), hc_parts_of(row[3]), hc_parts_of(row[6]), hc_parts_of(w)};
    hc_limb limbs[HC_END_LIMBS];
    hc_pool pool;
    hc_end end = {0, 0, 0, 0};
    int across, along;
    pool.next = limbs;
    if (hc_spread(radial, 4, &across) > HC_END_BITS || hc_spread(axial, 4, &along) > HC_END_BITS) return end;
    {
        const hc_integer a = hc_length(&pool, radial[0], across), b = hc_length(&pool, radial[1], across);
        const hc_integer x = hc_length(&pool, radial[2], across), y = hc_length(&pool, radial[3], across);
        const hc_integer g = hc_length(&pool, axial[0], along), d = hc_length(&pool, axial[1], along);
        const hc_integer z = hc_length(&pool, axial[2], along), h = hc_length(&pool, axial[3], along);
        const hc_integer t = hc_sum(&pool, &h, &z, -1), t2 = hc_product(&pool, &t, &t), h2 = hc_product(&pool, &h, &h);
        const hc_integer a2 = hc_product(&pool, &a, &a), b2 = hc_product(&pool, &b, &b);
        const hc_integer x2 = hc_product(&pool, &x, &x), y2 = hc_product(&pool, &y, &y);
        const hc_integer g2 = hc_product(&pool, &g, &g), d2 = hc_product(&pool, &d, &d);
        const hc_integer up = hc_sum(&pool, &g2, &h2, 1), room = hc_sum(&pool, &d2, &t2, -1), R = hc_sum(&pool, &x2, &y2, 1);
        const hc_integer R_g2 = hc_product(&pool, &R, &g2), a2_up = hc_product(&pool, &a2, &up), off = hc_sum(&pool, &R_g2, &a2_up, -1);
        const hc_integer wide = hc_sum(&pool, &R_g2, &a2_up, 1), wide_d2 = hc_product(&pool, &wide, &d2);
        const hc_integer b2_g2 = hc_product(&pool, &b2, &g2), s = hc_product(&pool, &b2_g2, &room);
        const hc_integer Q = hc_sum(&pool, &wide_d2, &s, -1), Q2 = hc_product(&pool, &Q, &Q);
        const hc_integer both = hc_product(&pool, &R_g2, &a2_up), d4 = hc_product(&pool, &d2, &d2);
        const hc_integer product = hc_product(&pool, &both, &d4), four = hc_multiple(&pool, 4, &product);
        const hc_integer F = hc_sum(&pool, &Q2, &four, -1);
        end.known = 1;
        end.misses = Q.sign > 0 && F.sign > 0;
        end.reached = room.sign;
        end.off = off.sign;
    }
    return end;
}

/* ---- hyperboloids that end ---- */

#define HC_MOST_PIECES 48
#define HC_ENDED_STEPS 14 /* of Newton's method for a multiplier; any result is safe */
#define HC_ENDED_ERROR 1.4210854715202004e-14 /* 2^-46 = 128u */
#define HC_MOST_ASKED 160 /* pieces that are looked at, of which HC_MOST_PIECES wait */
#define HC_ENDED_AIMS 4
#define HC_ENDED_NEAREST 9e-13 /* below 2^-40: how near lambda may come to -mu, in mu */
#define HC_ENDED_LEAST 8.6361685550944446e-78 /* 2^-256 */
#define HC_ENDED_GREATEST 1.157920892373162e+77 /* 2^256 */

/* A pair in the directions of the horizontal ellipses that planes cut from the spheroid (truth/sections.py of hypcheck
   has the rule). At a height w, with t = w - z, the ellipse is mu1 (X - eta)² + mu2 (Y - xi)² <= 1 - t²/T, xi = xi0 - k t,
   and the circle has r² = alpha² (1 + w²/gamma²). For one lambda > -min(mu1, mu2) the circle misses the ellipse where

       phi(w) = t²/T - 1 - lambda r² + f1 eta² + f2 xi² > 0,    f = lambda mu/(mu + lambda),

   a quadratic in w. (c, s) is the horizontal direction of the axis. `across` is |x| + |y|, which eta and xi0 are below. */
typedef struct {
    double alpha, ratio, z, T, mu1, mu2, eta, xi0, k, c, s, across;
} hc_sections;

static void hc_place_sections(hc_sections *made, const double center[3]) {
    made->xi0 = center[0] * made->c + center[1] * made->s;
    made->eta = center[0] * made->s - center[1] * made->c;
    made->z = center[2];
    made->across = hc_size(center[0]) + hc_size(center[1]);
}

/* Returns 0 where the numbers are too large or small for the bounds: mu, T, r² and their products stay normal. */
static int hc_make_sections(hc_sections *made, const double row[10]) {
    const double b = row[2], d = row[3];
    double v[3], s2, c2, away, flat, length;
    int k;
    memcpy(v, row + 7, sizeof v);
    hc_scale_axis(v);
    flat = v[0] * v[0] + v[1] * v[1];
    length = flat + v[2] * v[2];
    for (k = 0; k < 7; k++) {
        const double size = hc_size(row[k]);
        if (size > 1.2676506002282294e+30 /* 2^100 */ || (k < 4 && size < 7.8886090522101181e-31 /* 2^-100 */)) return 0;
    }
    if (!(length > HC_ENDED_LEAST && length < HC_ENDED_GREATEST) || (flat != 0 && flat < HC_ENDED_LEAST)) return 0;
    s2 = flat / length;
    c2 = v[2] * v[2] / length;
    away = flat == 0 ? 0 : 1 / hc_fine_root(flat);
    made->alpha = row[0];
    made->ratio = 1 / row[1];
    made->T = b * b * s2 + d * d * c2;
    made->mu1 = 1 / (b * b);
    made->mu2 = made->T / (b * b * (d * d));
    made->c = flat == 0 ? 1 : v[0] * away;
    made->s = v[1] * away;
    made->k = v[2] * flat * away / length * ((b - d) * (b + d)) / made->T;
    hc_place_sections(made, row + 4);
    return 1;
}

static double hc_radius(const hc_sections *pair, double w) {
    const double slope = w * pair->ratio;
    return pair->alpha * hc_fine_root(1 + slope * slope);
}

/* About the lambda at which phi(w) is greatest: the root of mu1² eta²/(mu1+l)² + mu2² xi²/(mu2+l)² = r². In n = l + the
   smaller mu the left side falls from infinity; Newton's method for its inverse root, between bounds. */
static double hc_ended_multiplier(const hc_sections *pair, double r, double xi) {
    const double p = pair->mu1 * hc_size(pair->eta), q = pair->mu2 * hc_size(xi);
    const double least = pair->mu1 < pair->mu2 ? pair->mu1 : pair->mu2, most = p + q;
    double low = least * 9.0949470177292824e-13 /* 2^-40 */, high = most / r > low ? most / r : low, n = high;
    int i;
    for (i = 0; i < HC_ENDED_STEPS; i++) {
        const double one = 1 / (n + (pair->mu1 - least)), two = 1 / (n + (pair->mu2 - least));
        const double sum = p * one * (p * one) + q * two * (q * two), root = hc_rough_root(sum);
        const double fall = (p * one * (p * one) * one + q * two * (q * two) * two);
        double moved;
        if (!(sum > 0)) return low - least;
        if (root > r) low = n;
        else high = n;
        moved = n + (root / r - 1) * sum / fall;
        if (hc_size(moved - n) < 1e-9 * n) return moved - least; /* at the root itself it may be out of bounds by an ulp */
        if (!(moved > low && moved < high)) moved = high > 4 * low ? hc_rough_root(low * high) : 0.5 * (low + high);
        n = moved;
    }
    return n - least;
}

/* The least slope v + bend v² for 0 <= v <= reach. */
static double hc_least_of(double slope, double bend, double reach) {
    const double end = (slope + bend * reach) * reach;
    if (bend > 0 && slope < 0 && -slope < 2 * bend * reach) return -slope * slope / (4 * bend);
    return end < 0 ? end : 0;
}

static double hc_least_between(double slope, double bend, double pull, double below, double above) {
    const double up = hc_least_of(slope - pull, bend, above), down = hc_least_of(-slope - pull, bend, below);
    return up < down ? up : down;
}

static double hc_kept_within(double at, double low, double high) { return !(at > low) ? low : at < high ? at : high; }

/* phi about a height w for one lambda, value + slope v + bend v². Over a piece its parts are right within 32u of `size`, f
   within 32u mu/(mu + lambda) of itself, since mu + lambda may cancel; the slope and the bend, times what v is at most,
   within 32u of `pull` times that. `safe`: lambda is not too near -mu. */
typedef struct {
    double value, slope, bend, size, pull;
    int safe;
} hc_phi;

static hc_phi hc_phi_about(const hc_sections *pair, double lambda_, double w, double reach) {
    const double n1 = pair->mu1 + lambda_, n2 = pair->mu2 + lambda_;
    const double f1 = lambda_ * pair->mu1 / n1, f2 = lambda_ * pair->mu2 / n2, t = w - pair->z, xi = pair->xi0 - pair->k * t;
    const double g = pair->ratio * pair->alpha, l2 = lambda_ * (g * g), top = hc_size(t) + reach, wide = hc_size(w) + reach;
    const double along = pair->across + hc_size(pair->k) * top, loose = hc_size(f2) * (1 + pair->mu2 / n2);
    hc_phi phi;
    phi.value = t * t / pair->T - 1 - lambda_ * (pair->alpha * pair->alpha) - l2 * (w * w) + f1 * (pair->eta * pair->eta) + f2 * (xi * xi);
    phi.slope = 2 * (t / pair->T - l2 * w - f2 * (xi * pair->k));
    phi.bend = 1 / pair->T - l2 + f2 * (pair->k * pair->k);
    phi.size = 1 + top * top / pair->T + hc_size(lambda_) * (pair->alpha * pair->alpha) + hc_size(l2) * (wide * wide) +
               hc_size(f1) * (pair->across * pair->across) * (1 + pair->mu1 / n1) + loose * (along * along);
    phi.pull = 4 * (top / pair->T + hc_size(l2) * wide + loose * (along * hc_size(pair->k)));
    phi.safe = n1 > pair->mu1 * HC_ENDED_NEAREST && n2 > pair->mu2 * HC_ENDED_NEAREST;
    return phi;
}

/* The size of the terms of a point of the circle. */
static double hc_point_size(const hc_sections *pair, double r, double w) {
    const double t = w - pair->z, across = r + pair->across, along = across + hc_size(pair->k * t);
    return pair->mu1 * (across * across) + pair->mu2 * (along * along) + t * t / pair->T + 1;
}

/* Whether the point of the circle at height w in the direction (a, c) of eta and xi surely lies inside the spheroid. */
static int hc_point_within(const hc_sections *pair, double r, double w, double xi, double a, double c) {
    const double length = hc_fine_root(a * a + c * c), t = w - pair->z;
    double off, aside;
    if (!(length > 0)) return 0;
    off = r * (a / length) - pair->eta;
    aside = r * (c / length) - xi;
    return pair->mu1 * (off * off) + pair->mu2 * (aside * aside) + t * t / pair->T - 1 < -HC_ENDED_ERROR * hc_point_size(pair, r, w);
}

/* The same by numbers of two doubles. */
static int hc_point_surely_within(const hc_sections *pair, const hc_fine_sections *fine, double w, double a, double c) {
    const double length = a * a + c * c;
    if (!(length > HC_ENDED_LEAST && length < HC_ENDED_GREATEST)) return 0;
    return hc_fine_point(fine, w, a, c) < -HC_FINE_ERROR * hc_point_size(pair, hc_radius(pair, w), w);
}

/* The direction of the point of the circle at which phi for this lambda is taken, scaled to r where lambda is as near to -mu
   as it comes: there the share of that axis is what is left. */
static void hc_direction_of(const hc_sections *pair, double lambda_, double r, double xi, double *a, double *c) {
    double left;
    *a = pair->eta * (pair->mu1 / (pair->mu1 + lambda_));
    *c = xi * (pair->mu2 / (pair->mu2 + lambda_));
    left = r * r - *a * *a - *c * *c;
    if (!(left > 1e-6 * (r * r))) return;
    if (pair->mu1 < pair->mu2) *a = (pair->eta < 0 ? -1 : 1) * hc_fine_root(*a * *a + left);
    else *c = (xi < 0 ? -1 : 1) * hc_fine_root(*c * *c + left);
}

/* Moves a height of a piece to about where max phi over lambda is least, by Newton's method: its slope is that of phi, its
   bend greater by what a lambda that follows adds. Any result is safe. Returns lambda there. */
static double hc_aim_at_least(const hc_sections *pair, double low, double high, double *height) {
    double w = *height;
    int i;
    for (i = 0;; i++) {
        const double xi = pair->xi0 - pair->k * (w - pair->z), lambda_ = hc_ended_multiplier(pair, hc_radius(pair, w), xi);
        const double n1 = pair->mu1 + lambda_, n2 = pair->mu2 + lambda_, s1 = pair->mu1 / n1, s2 = pair->mu2 / n2;
        const double all = s1 * s1 * (pair->eta * pair->eta) / n1 + s2 * s2 * (xi * xi) / n2, g = pair->ratio * pair->alpha;
        const double follow = g * g * w + s2 * s2 * (xi * pair->k);
        const hc_phi phi = hc_phi_about(pair, lambda_, w, 0);
        const double bend = all > 0 ? phi.bend + follow * follow / all : phi.bend;
        double at;
        *height = w;
        if (i == HC_ENDED_AIMS) return lambda_;
        at = hc_kept_within(bend > 0 ? w - phi.slope / (2 * bend) : phi.slope < 0 ? high : low, low, high);
        if (at == w) return lambda_;
        w = at;
    }
}

/* 0 where the wall between two heights surely meets the spheroid, 1 where it surely misses it, 2 where neither is known.
   Numbers of two doubles are asked where doubles leave the sign open of the least that is found in a piece. */
static int hc_wall_misses(const hc_sections *pair, const double row[10], double low, double high) {
    double lows[HC_MOST_PIECES], highs[HC_MOST_PIECES];
    hc_fine_sections fine;
    int left = 1, asked = 0, made = 0;
    lows[0] = low, highs[0] = high;
    while (left) {
        double w, middle, reach, xi, r, lambda_, a, c, below, above, lowest;
        hc_phi phi;
        left--;
        low = lows[left], high = highs[left];
        w = middle = hc_kept_within(low + 0.5 * (high - low), low, high);
        reach = (high - low) * (1 + HC_u_8);
        r = hc_radius(pair, w);
        xi = pair->xi0 - pair->k * (w - pair->z);
        lambda_ = hc_ended_multiplier(pair, r, xi);
        below = (w - low) * (1 + HC_u_8), above = (high - w) * (1 + HC_u_8);
        phi = hc_phi_about(pair, lambda_, w, below > above ? below : above);
        if (phi.safe && phi.value + hc_least_between(phi.slope, phi.bend, 0, below, above) > HC_ENDED_ERROR * phi.size) continue;
        hc_direction_of(pair, lambda_, r, xi, &a, &c);
        if (hc_point_within(pair, r, w, xi, a, c) || hc_point_within(pair, r, w, xi, 1, 0) || hc_point_within(pair, r, w, xi, -1, 0) ||
            hc_point_within(pair, r, w, xi, 0, 1) || hc_point_within(pair, r, w, xi, 0, -1))
            return 0;
        lambda_ = hc_aim_at_least(pair, low, high, &w);
        r = hc_radius(pair, w);
        xi = pair->xi0 - pair->k * (w - pair->z);
        below = (w - low) * (1 + HC_u_8), above = (high - w) * (1 + HC_u_8);
        phi = hc_phi_about(pair, lambda_, w, reach);
        lowest = phi.value + hc_least_between(phi.slope, phi.bend, 0, below, above);
        if (phi.safe && lowest > HC_ENDED_ERROR * phi.size) continue;
        hc_direction_of(pair, lambda_, r, xi, &a, &c);
        if (hc_point_within(pair, r, w, xi, a, c)) return 0;
        if (phi.value <= 2 * HC_ENDED_ERROR * phi.size && -phi.value <= 2 * HC_ENDED_ERROR * (phi.size + hc_point_size(pair, r, w))) {
            if (!made) fine = hc_make_fine(row, 0);
            made = 1;
            if (hc_point_surely_within(pair, &fine, w, a, c)) return 0;
            if (phi.safe) {
                const double value = hc_fine_phi(&fine, lambda_, w), error = HC_FINE_ERROR * phi.size;
                if (value + hc_least_between(phi.slope, phi.bend, HC_ENDED_ERROR * phi.pull, below, above) > error) continue;
                if (hc_size(value) <= error) return 2;
            }
        }
        if (++asked > HC_MOST_ASKED || left + 2 > HC_MOST_PIECES || !(middle > low && middle < high)) return 2;
        if (w - low > 0.125 * (high - low) && high - w > 0.125 * (high - low)) middle = w;
        lows[left] = low, highs[left++] = middle;
        lows[left] = middle, highs[left++] = high;
    }
    return 1;
}

/* The same of the disc at a height, whose rim is known to miss the spheroid. */
static int hc_disc_misses(const hc_sections *pair, double w) {
    const double t = w - pair->z, share = t * t / pair->T, r = hc_radius(pair, w), xi = pair->xi0 - pair->k * t;
    const double off = pair->eta * pair->eta + xi * xi - r * r, along = pair->across + hc_size(pair->k * t);
    const double size = along * along + pair->across * pair->across + r * r;
    if (share - 1 > HC_ENDED_ERROR * (share + 1) || off > HC_ENDED_ERROR * size) return 1;
    return 1 - share > HC_ENDED_ERROR * (share + 1) && off < -HC_ENDED_ERROR * size ? 0 : 2;
}

/* The same by numbers of two doubles. */
static int hc_disc_surely_misses(const hc_sections *pair, const double row[10], double w) {
    const hc_fine_sections fine = hc_make_fine(row, 0);
    const hc_twin t = hc_twin_difference(hc_twin_of(w), fine.z), xi = hc_twin_difference(fine.X, hc_twin_product(fine.kappa, t));
    const hc_twin center = hc_twin_quotient(hc_twin_sum(hc_twin_square(fine.E), hc_twin_square(xi)), fine.F);
    const double share = hc_fine_share(&fine, t).high, off = hc_twin_difference(center, hc_fine_square_of_radius(&fine, w)).high;
    const double high = w - pair->z, r = hc_radius(pair, w), along = pair->across + hc_size(pair->k * high);
    const double most = HC_FINE_ERROR * (along * along + pair->across * pair->across + r * r), error = HC_FINE_ERROR * (high * high / pair->T + 1);
    if (share > error || off > most) return 1;
    return share < -error && off < -most ? 0 : 2;
}

/* Whether the centre lies in the body, 2 where bounds do not tell: rounding leaves each side right within 8u. */
static int hc_center_inside(const double row[13]) {
    const double x = row[4] / row[0], y = row[5] / row[0], up = row[6] / row[1];
    const double out = x * x + y * y, in = up * up + 1;
    if (!(row[6] >= row[10] && row[6] <= row[11]) || out > in * (1 + HC_ENDED_ERROR)) return 0;
    return out * (1 + HC_ENDED_ERROR) < in ? 1 : 2;
}

/* Whether the spheroid, which is upright, surely meets the circle at a height: with R = x² + y² and the squares r² and s² of
   the radii of both circles there, (√R - r)² < s². */
static int hc_upright_met(const double row[13], double w) {
    const double t = (w - row[6]) / row[3], up = w / row[1], share = t * t;
    const double R = row[4] * row[4] + row[5] * row[5], r = row[0] * row[0] * (1 + up * up), s = row[2] * row[2] * (1 - share);
    const double size = HC_ENDED_ERROR * (R + r + row[2] * row[2] * (1 + share)), off = R + r - s;
    const double most = off + size; /* at or below 0 both circles have points within each other */
    if (!(s > size && most < HC_cap)) return 0;
    return most < 0 || (size > HC_ENDED_LEAST && most * most < 4 * R * r * (1 - HC_ENDED_ERROR));
}

/* Whether F(w) = Q² - 4 R r² surely grows with every step away from an end, for so far into the body: `side` is 1 at the
   upper end. F is a quartic, F' = 2 Q Q' - 4 R (r²)', and |F''| has a bound of the sizes of its terms. Where the circle at
   the end misses the spheroid, so do all those. */
static int hc_grows_from_end(const double row[13], double w, double far, int side) {
    const double g = row[0] / row[1], e = row[2] / row[3], t = w - row[6], R = row[4] * row[4] + row[5] * row[5];
    const double wide = hc_size(w) + far, top = hc_size(t) + far, r2 = 2 * (g * g), s2 = 2 * (e * e);
    const double Q = row[0] * row[0] + 0.5 * r2 * (w * w) + R - row[2] * row[2] + 0.5 * s2 * (t * t);
    const double most = row[0] * row[0] + 0.5 * r2 * (wide * wide) + R + row[2] * row[2] + 0.5 * s2 * (top * top);
    const double rise = r2 * w + s2 * t, steep = r2 * wide + s2 * top;
    const double slope = -side * (2 * Q * rise - 4 * R * (r2 * w));
    const double size = 2 * most * steep + 4 * R * (r2 * wide), bend = 2 * (steep * steep) + 2 * most * (r2 + s2) + 4 * R * r2;
    if (!(size < HC_cap && bend < HC_cap && size > HC_ENDED_LEAST)) return 0;
    return slope > 4 * HC_ENDED_ERROR * size + bend * far * (1 + HC_ENDED_ERROR);
}

#define HC_BESIDE_END 6.103515625e-05 /* 2^-14 of d, which is left out beside an end that is looked at in integers */

/* hc_wall_misses of an upright spheroid where bounds tell nothing: the ends in integers, what is next to them by the slope
   there, and the rest by bounds. */
static int hc_upright_wall_misses(const hc_sections *pair, const double row[13], double bottom, double top) {
    double low = bottom, high = top, far = HC_BESIDE_END * row[3];
    int k;
    if (far > 0.25 * (top - bottom)) far = 0.25 * (top - bottom);
    for (k = 0; k < 2; k++) {
        const double w = row[10 + k];
        hc_end end;
        if (w != (k ? top : bottom)) continue; /* the spheroid does not reach this end */
        end = hc_exact_end(row, w);
        if (!end.known) return 2;
        if (!end.misses) return 0;
        if (!hc_grows_from_end(row, w, 1.0625 * far, k ? 1 : -1)) continue; /* bounds may do */
        if (k) high = w - far;
        else low = w + far;
    }
    return low < high ? hc_wall_misses(pair, row, low, high) : 2;
}

/* 0 where the wall between the ends surely meets the spheroid, 1 where it surely misses it, 2 where neither is known; the
   spheroid meets the surface without ends, and reaches from z - more to z + more at most. */
static int hc_ended_wall_misses(const hc_sections *pair, const double row[13], double more, int upright) {
    const double z = row[6], bottom = row[10] > z - more ? row[10] : z - more, top = row[11] < z + more ? row[11] : z + more;
    int misses;
    if (bottom > top) return 1; /* z - more and z + more lie beyond the spheroid, though rounded */
    misses = hc_wall_misses(pair, row, bottom, top);
    if (misses == 2 && (bottom > z - more ? hc_wall_misses(pair, row, z - more, bottom) == 1 : 1) &&
        (top < z + more ? hc_wall_misses(pair, row, top, z + more) == 1 : 1))
        return 0; /* it meets the surface, but not beyond the ends */
    return misses == 2 && upright ? hc_upright_wall_misses(pair, row, bottom, top) : misses;
}

/* hc_disc_misses, where its bounds do not tell in integers of an upright spheroid, by numbers of two doubles of others. */
static int hc_ended_disc_misses(const hc_sections *pair, const double row[13], double w, int upright) {
    const int misses = hc_disc_misses(pair, w);
    hc_end end;
    if (misses != 2) return misses;
    if (!upright) return hc_disc_surely_misses(pair, row, w);
    end = hc_exact_end(row, w);
    return !end.known ? 2 : end.misses && (end.reached < 0 || end.off > 0);
}

/* The position of a valid row of 13 whose position without ends is `whole`; 2 where the bounds do not tell. */
static int hc_ended_position(const double row[13], int whole) {
    const int upright = hc_is_upright(row), solid = row[12] != 0;
    const double z = row[6], reach = row[2] > row[3] && !upright ? row[2] : row[3], low = row[10], high = row[11];
    const double slack = HC_u_8 * (hc_size(z) + reach), below = z - low, above = high - z;
    const double more = reach + slack, under = hc_size(low) <= HC_ENDED_GREATEST ? HC_u_8 * hc_size(low) : 0;
    const double over = hc_size(high) <= HC_ENDED_GREATEST ? HC_u_8 * hc_size(high) : 0;
    const double level = z < low ? low : z > high ? high : z;
    hc_sections pair;
    int misses, inside, k;
    if (below > more + under && above > more + over) return whole;
    if (-below > more + under || -above > more + over || (solid && whole == 1)) return 1;
    if (whole != 0 && !solid) return whole == -1 && z >= low && z <= high ? -1 : 1;
    if (!HC_FLOATS_DECIDE) return 2;
    if (whole == 0 && upright && hc_upright_met(row, level)) return 0; /* most contacts */
    if (!hc_make_sections(&pair, row)) return 2;
    misses = 1;
    if (whole == 0) {
        const double t = level - z, xi = pair.xi0 - pair.k * t;
        if (hc_point_within(&pair, hc_radius(&pair, level), level, xi, pair.eta, xi)) return 0;
        misses = hc_ended_wall_misses(&pair, row, more, upright);
    }
    for (k = 10; solid && k < 12 && misses == 1; k++)
        if (hc_size(row[k]) <= HC_ENDED_GREATEST) misses = hc_ended_disc_misses(&pair, row, row[k], upright);
    if (misses != 1) return misses;
    if (whole != 0) return z >= low && z <= high ? whole : 1; /* without ends inside, and the discs missed */
    inside = hc_center_inside(row);
    if (inside == 2) {
        const hc_end end = hc_exact_end(row, z);
        if (!end.known) return 2;
        inside = end.off <= 0;
    }
    return inside ? -1 : 1;
}

#define HC_ENDED_TOGETHER 2048 /* rows that are still in the cache when their ends are looked at */

void hypcheck_classify_ended(size_t n, const double *rows13, int8_t *positions) {
    size_t i, k;
    for (i = 0; i < n; i += HC_ENDED_TOGETHER) {
        const size_t count = n - i < HC_ENDED_TOGETHER ? n - i : HC_ENDED_TOGETHER;
        const double *row = rows13 + 13 * i;
        int8_t *const some = positions + i;
        hc_ask_rows(HYPCHECK_POSITION, count, 13, row, some);
        for (k = 0; k < count; k++, row += 13) {
            const double more = 1.5 * (row[2] + row[3]), low = row[10], high = row[11];
            const int valid = row[12] == 0 || row[12] == 1;
            if (valid && row[6] - low > more && high - row[6] > more) continue; /* between the ends: as without them */
            if (!(valid && low < high)) some[k] = 127;
            else if (some[k] != 127) some[k] = (int8_t)hc_ended_position(row, some[k]);
        }
    }
}

/* ---- straight sweeps beside hyperboloids that end ---- */

#define HC_MOST_RECTANGLES 1024 /* that are looked at before a stretch is given up */
#define HC_RECTANGLES_KEPT 64
#define HC_AIMS 3
#define HC_SMALL 9.5367431640625e-07 /* 2^-20 */
#define HC_TIMES 60 /* halvings of the time before a contact, of which so many, one after the other, may tell nothing */
#define HC_MOST_UNKNOWN 12
#define HC_FINE_SLACK 2.8421709430404007e-14 /* 2^-45, of the sweep's slack: 2^-96 (1 + the sum in radii) */
#define HC_NEAR_CONTACT 8 /* errors of a form, within which numbers of two doubles are asked */
#define HC_SIMPLE_TIMES 1048576.0 /* 2^20: times that are asked exactly are whole numbers over this */

/* A sweep, and the sections of the spheroid larger by its slack, which holds the exact one at all times, and of the one
   smaller by it, which the exact one holds. `rise`, `off` and `aside` are what z, eta and xi0 change in a unit of time.

   `outer` and `inner` are the same by numbers of two doubles: from + t (to - from) is right within 2^-98 (|from| + |to|),
   which makes a slack of 2^-96 (1 + the sum in radii), and squares are multiplied by 1 + 4 slack and 1 - 4 slack. `between`
   are the sections of the spheroid as it is, for slopes. `wide` is |x| + |y| of both ends, `tall` |z| of both. */
typedef struct {
    hc_sweep sweep;
    hc_sections larger, smaller, between;
    hc_fine_sections outer, inner;
    hc_twin moved[3];
    double rise, off, aside, swift, reach, low, high, wide, tall;
    const double *row, *axis;
    int solid, wall, fine, clear[2]; /* `clear`: that there is no contact at the start, at the end */
} hc_ended_sweep;

/* Heights and times. */
typedef struct {
    double low, high, first, last;
} hc_rectangle;

/* phi about a height and a time, for one lambda: value + rise x + fall y + xx x² + 2 xy x y + yy y². */
typedef struct {
    double value, by_height, by_time, xx, xy, yy;
} hc_form;

static int hc_make_ended_sweep(hc_ended_sweep *made, const double row[16], const double *axis) {
    double shape[10] = {0};
    if (!hc_make_sweep(&made->sweep, row, axis)) return 0;
    hc_sweep_at(&made->sweep, 0, 1 + made->sweep.slack, shape);
    if (axis) memcpy(shape + 7, axis, 3 * sizeof *axis);
    else shape[9] = 1;
    shape[4] = shape[5] = shape[6] = 0;
    if (!hc_make_sections(&made->larger, shape)) return 0;
    hc_sweep_at(&made->sweep, 0, 1 - made->sweep.slack, shape);
    shape[4] = shape[5] = shape[6] = 0;
    if (!hc_make_sections(&made->smaller, shape)) return 0;
    hc_place_sections(&made->larger, made->sweep.change);
    made->rise = made->sweep.change[2];
    made->off = made->larger.eta;
    made->aside = made->larger.xi0;
    made->swift = made->larger.across;
    made->reach = hc_fine_root(made->larger.T) * (1 + HC_ENDED_ERROR);
    made->low = row[13];
    made->high = row[14];
    made->solid = row[15] != 0;
    made->wide = hc_size(row[4]) + hc_size(row[5]) + hc_size(row[7]) + hc_size(row[8]);
    made->tall = hc_size(row[6]) + hc_size(row[9]);
    made->wall = 1;
    made->row = row;
    made->axis = axis;
    made->fine = 0;
    return 1;
}

/* What only numbers of two doubles need. */
static void hc_make_finer(hc_ended_sweep *made) {
    const double more = 4 * HC_FINE_SLACK * made->sweep.slack;
    double shape[10] = {0};
    int k;
    if (made->fine) return;
    memcpy(shape, made->row, 4 * sizeof *shape);
    if (made->axis) memcpy(shape + 7, made->axis, 3 * sizeof *shape);
    else shape[9] = 1;
    (void)hc_make_sections(&made->between, shape); /* it is made: so is the larger one */
    made->outer = hc_make_fine(shape, more);
    made->inner = hc_make_fine(shape, -more);
    for (k = 0; k < 3; k++) made->moved[k] = hc_two_sum(made->row[7 + k], -made->row[4 + k]);
    made->fine = 1;
}

static void hc_center_at(const hc_ended_sweep *made, double time, double center[3]) {
    int k;
    for (k = 0; k < 3; k++) center[k] = made->sweep.from[k] + time * made->sweep.change[k];
}

/* The form of the sections that are placed at a time, about a height w. */
static hc_form hc_form_about(const hc_ended_sweep *made, const hc_sections *pair, double lambda_, double w) {
    const double f1 = lambda_ * pair->mu1 / (pair->mu1 + lambda_), f2 = lambda_ * pair->mu2 / (pair->mu2 + lambda_);
    const double t = w - pair->z, xi = pair->xi0 - pair->k * t, drift = made->aside + pair->k * made->rise;
    const double g = pair->ratio * pair->alpha, l2 = lambda_ * (g * g);
    hc_form form;
    form.value = t * t / pair->T - 1 - lambda_ * (pair->alpha * pair->alpha) - l2 * (w * w) + f1 * (pair->eta * pair->eta) + f2 * (xi * xi);
    form.by_height = 2 * (t / pair->T - l2 * w - f2 * (xi * pair->k));
    form.by_time = 2 * (f1 * (pair->eta * made->off) + f2 * (xi * drift) - t * made->rise / pair->T);
    form.xx = 1 / pair->T - l2 + f2 * (pair->k * pair->k);
    form.xy = -made->rise / pair->T - f2 * (pair->k * drift);
    form.yy = made->rise * made->rise / pair->T + f1 * (made->off * made->off) + f2 * (drift * drift);
    return form;
}

/* A bound of the errors of the form's terms together within these distances from its height and its time: each is right
   within 32u of its terms, f within 32u mu/(mu + lambda) of itself. Huge where numbers are too large. */
static double hc_form_error(const hc_ended_sweep *made, const hc_sections *pair, double lambda_, double w, double x, double y) {
    const double n1 = pair->mu1 + lambda_, n2 = pair->mu2 + lambda_, g = pair->ratio * pair->alpha;
    const double top = hc_size(w - pair->z) + x + hc_size(made->rise) * y, wide = hc_size(w) + x;
    const double side = pair->across + made->swift * y, along = side + hc_size(pair->k) * top;
    const double size = 1 + top * top / pair->T + hc_size(lambda_) * (pair->alpha * pair->alpha + g * g * (wide * wide)) +
                        hc_size(lambda_ * pair->mu1 / n1) * (side * side) * (1 + pair->mu1 / n1) +
                        hc_size(lambda_ * pair->mu2 / n2) * (along * along) * (1 + pair->mu2 / n2);
    if (!(n1 > pair->mu1 * HC_ENDED_NEAREST && n2 > pair->mu2 * HC_ENDED_NEAREST && size < HC_cap * HC_cap)) return DBL_MAX;
    return 4 * HC_ENDED_ERROR * size;
}

/* A number that the form is not below on a rectangle, but for its error. A form that bends upwards everywhere lies above
   its tangent plane; else the mixed term counts as a pull away from the height, or from the time. */
static double hc_form_least(const hc_form *form, const hc_rectangle *in, double w, double time) {
    const double below = w - in->low, above = in->high - w, before = time - in->first, after = in->last - time;
    const double x = below > above ? below : above, y = before > after ? before : after, mixed = 2 * hc_size(form->xy);
    const double first = hc_least_between(form->by_height, form->xx, mixed * y, below, above) +
                         hc_least_between(form->by_time, form->yy, 0, before, after);
    const double second = hc_least_between(form->by_height, form->xx, 0, below, above) +
                          hc_least_between(form->by_time, form->yy, mixed * x, before, after);
    double least = first > second ? first : second;
    if (form->xx > 0 && form->yy > 0 && form->xx * form->yy * (1 - HC_SMALL) > form->xy * form->xy) {
        const double plane = hc_least_between(form->by_height, 0, 0, below, above) + hc_least_between(form->by_time, 0, 0, before, after);
        if (plane > least) least = plane;
    }
    return form->value + least;
}

/* Moves a height and a time in a rectangle to about where max phi over lambda is least: the form with the bends that a
   lambda that follows adds to it. Any result is safe. */
static double hc_aim(const hc_ended_sweep *made, hc_sections *pair, const hc_rectangle *in, double *height, double *time) {
    double w = *height, at = *time, center[3];
    int i;
    for (i = 0;; i++) {
        const double drift = made->aside + pair->k * made->rise;
        double xi, lambda_, s1, s2, all, by_height, by_time, denominator, x, y;
        hc_form form;
        hc_center_at(made, at, center);
        hc_place_sections(pair, center);
        xi = pair->xi0 - pair->k * (w - pair->z);
        lambda_ = hc_ended_multiplier(pair, hc_radius(pair, w), xi);
        if (i == HC_AIMS) {
            *height = w, *time = at;
            return lambda_;
        }
        form = hc_form_about(made, pair, lambda_, w);
        s1 = pair->mu1 / (pair->mu1 + lambda_), s2 = pair->mu2 / (pair->mu2 + lambda_);
        all = 2 * (s1 * s1 * (pair->eta * pair->eta) / (pair->mu1 + lambda_) + s2 * s2 * (xi * xi) / (pair->mu2 + lambda_));
        by_height = -2 * (pair->ratio * pair->alpha * (pair->ratio * pair->alpha) * w + s2 * s2 * (xi * pair->k));
        by_time = 2 * (s1 * s1 * (pair->eta * made->off) + s2 * s2 * (xi * drift));
        if (all > 0) {
            form.xx += by_height * by_height / (2 * all);
            form.xy += by_height * by_time / (2 * all);
            form.yy += by_time * by_time / (2 * all);
        }
        denominator = form.xx * form.yy - form.xy * form.xy;
        if (denominator > 0 && form.xx > 0) {
            x = w - (form.by_height * form.yy - form.by_time * form.xy) / (2 * denominator);
            y = at - (form.by_time * form.xx - form.by_height * form.xy) / (2 * denominator);
            if (!(x >= in->low && x <= in->high)) {
                x = hc_kept_within(x, in->low, in->high);
                y = at - (form.by_time + 2 * form.xy * (x - w)) / (2 * form.yy);
            }
            if (!(y >= in->first && y <= in->last)) {
                y = hc_kept_within(y, in->first, in->last);
                x = w - (form.by_height + 2 * form.xy * (y - at)) / (2 * form.xx);
            }
        } else {
            x = form.by_height < 0 ? in->high : in->low;
            y = form.by_time < 0 ? in->last : in->first;
        }
        w = hc_kept_within(x, in->low, in->high), at = hc_kept_within(y, in->first, in->last);
    }
}

/* Whether a point of the circle at a height surely lies inside the smaller spheroid at a time. */
static int hc_surely_met(hc_ended_sweep *made, double lambda_, double w, double time) {
    static const double across[4] = {1, -1, 0, 0}, along[4] = {0, 0, 1, -1};
    hc_sections *const pair = &made->smaller;
    double center[3], r, xi;
    int k;
    hc_center_at(made, time, center);
    hc_place_sections(pair, center);
    r = hc_radius(pair, w);
    xi = pair->xi0 - pair->k * (w - pair->z);
    if (hc_point_within(pair, r, w, xi, pair->eta * pair->mu1 / (pair->mu1 + lambda_), xi * pair->mu2 / (pair->mu2 + lambda_))) return 1;
    for (k = 0; k < 4; k++)
        if (hc_point_within(pair, r, w, xi, across[k], along[k])) return 1;
    return 0;
}

/* hc_form_least less what the slopes and bends are off by, `height` and `time` of what each distance is at most. A form that
   bends upwards everywhere is not below the sum of two squares, each less a share |xy|/sqrt(xx yy) of its own. */
static double hc_form_least_surely(const hc_form *form, const hc_rectangle *in, double w, double time, const double pulls[2]) {
    const double below = w - in->low, above = in->high - w, before = time - in->first, after = in->last - time;
    const double x = below > above ? below : above, y = before > after ? before : after, mixed = 2 * hc_size(form->xy);
    const double first = hc_least_between(form->by_height, form->xx, mixed * y + pulls[0], below, above) +
                         hc_least_between(form->by_time, form->yy, pulls[1], before, after);
    const double second = hc_least_between(form->by_height, form->xx, pulls[0], below, above) +
                          hc_least_between(form->by_time, form->yy, mixed * x + pulls[1], before, after);
    double least = first > second ? first : second;
    if (form->xx > 0 && form->yy > 0) {
        const double root = hc_fine_root(form->xx) * hc_fine_root(form->yy), share = hc_size(form->xy) * (1 + HC_SMALL) / root;
        if (root > 0 && share < 1) {
            const double both = hc_least_between(form->by_height, form->xx * (1 - share), pulls[0], below, above) +
                                hc_least_between(form->by_time, form->yy * (1 - share), pulls[1], before, after);
            if (both > least) least = both;
        }
    }
    return least;
}

/* Whether there is contact at a time that is a whole number over HC_SIMPLE_TIMES, and at which the centre is three doubles:
   an exact position shows it. The time comes first in the product, so that what is left of it is 0 where it is exact. */
static int hc_touched_at(const hc_ended_sweep *made, double at, double *contact) {
    double row[13] = {0};
    int k;
    memcpy(row, made->row, 4 * sizeof *row);
    for (k = 0; k < 3; k++) {
        const hc_twin part = hc_two_product(at, made->moved[k].high), center = hc_two_sum(made->row[4 + k], part.high);
        if (made->moved[k].low != 0 || part.low != 0 || center.low != 0) return 0;
        if (at != 0 && made->moved[k].high != 0 && hc_size(part.high) < HC_ENDED_LEAST) return 0; /* it may lose bits */
        row[4 + k] = center.high;
    }
    if (made->axis) memcpy(row + 7, made->axis, 3 * sizeof *row);
    else row[9] = 1;
    row[10] = made->low, row[11] = made->high, row[12] = made->solid;
    if (hc_ended_position(row, hc_position_with(row, made->axis)) != 0) return 0;
    *contact = at;
    return 1;
}

/* The time from one to another that has the fewest bits behind the point; where it would have more than those of
   HC_SIMPLE_TIMES, the next that has so many. */
static double hc_simplest_time(double first, double last) {
    double unit = 1, at = 1;
    for (; unit <= HC_SIMPLE_TIMES; unit *= 2) {
        at = (double)(int64_t)(first * unit) / unit;
        if (at < first) at += 1 / unit;
        if (at <= last) break;
    }
    return at;
}

/* The same at the simplest time of a rectangle and at the one next to a time, if these are not after the last that is asked
   about; `asked` is the one that was asked last. */
static int hc_touched_about(const hc_ended_sweep *made, const hc_rectangle *in, double time, double last, double *asked, double *contact) {
    const double simplest = hc_simplest_time(in->first, in->last);
    const double next = (double)(int64_t)(time * HC_SIMPLE_TIMES + 0.5) / HC_SIMPLE_TIMES;
    const double before = *asked;
    *asked = simplest;
    return (simplest != before && simplest <= last && hc_touched_at(made, simplest, contact)) ||
           (next != simplest && next <= last && hc_touched_at(made, next, contact));
}

/* A rectangle by numbers of two doubles, about a height, a time and a lambda: 1 where it is surely clear, 0 where there is
   contact at *contact, 2 where neither is known, 3 where smaller rectangles may tell. */
static int hc_finely_missed(hc_ended_sweep *made, double lambda_, double w, double time, const hc_rectangle *in, double *contact) {
    const double x = in->high - in->low;
    hc_sections *const pair = &made->between;
    double center[3], a, c, r, xi, value, error, pulls[2];
    hc_form form;
    int k;
    hc_make_finer(made);
    hc_center_at(made, time, center);
    hc_place_sections(pair, center);
    {
        hc_twin at[3];
        for (k = 0; k < 3; k++) at[k] = hc_twin_sum(hc_twin_of(made->row[4 + k]), hc_twin_product(hc_twin_of(time), made->moved[k]));
        hc_place_fine(&made->outer, at[0], at[1], at[2]);
        hc_place_fine(&made->inner, at[0], at[1], at[2]);
    }
    r = hc_radius(pair, w);
    xi = pair->xi0 - pair->k * (w - pair->z);
    {
        const double n1 = pair->mu1 + lambda_, n2 = pair->mu2 + lambda_, g = pair->ratio * pair->alpha, g2 = g * g;
        const double top = hc_size(w) + x + made->tall, high = hc_size(w) + x, drift = made->swift + hc_size(pair->k * made->rise);
        const double along = made->wide + hc_size(pair->k) * top, one = hc_size(lambda_ * pair->mu1 / n1) * (1 + pair->mu1 / n1);
        const double two = hc_size(lambda_ * pair->mu2 / n2) * (1 + pair->mu2 / n2), across = r + along, l2 = hc_size(lambda_);
        const double size = 1 + top * top / pair->T + l2 * (pair->alpha * pair->alpha + g2 * (high * high)) +
                            one * (made->wide * made->wide) + two * (along * along);
        const double point = (pair->mu1 + pair->mu2) * (across * across) + top * top / pair->T + 1;
        if (!(n1 > pair->mu1 * HC_ENDED_NEAREST && n2 > pair->mu2 * HC_ENDED_NEAREST && size < HC_cap && point < HC_cap)) return 3;
        pulls[0] = 8 * HC_ENDED_ERROR * (top / pair->T + l2 * (g2 * high) + two * (along * hc_size(pair->k)));
        pulls[1] = 8 * HC_ENDED_ERROR * (one * (made->wide * made->swift) + two * (along * drift) + top * hc_size(made->rise) / pair->T);
        form = hc_form_about(made, pair, lambda_, w);
        value = hc_fine_phi(&made->outer, lambda_, w);
        error = HC_FINE_ERROR * size;
        if (value + hc_form_least_surely(&form, in, w, time, pulls) > error) return 1;
        hc_direction_of(pair, lambda_, r, xi, &a, &c);
        if (a * a + c * c > HC_ENDED_LEAST && a * a + c * c < HC_ENDED_GREATEST &&
            hc_fine_point(&made->inner, w, a, c) < -HC_FINE_ERROR * point) {
            *contact = time;
            return 0;
        }
        return hc_size(value) > 4 * (error + 4 * HC_FINE_SLACK * made->sweep.slack * size) ? 3 : 2;
    }
}

/* Cuts off the heights of a rectangle that the larger spheroid never reaches. Returns 0 where none is left. */
static int hc_cut_to_reach(const hc_ended_sweep *made, hc_rectangle *of) {
    double center[3], bottom, top;
    hc_center_at(made, of->first, center);
    bottom = top = center[2];
    hc_center_at(made, of->last, center);
    if (center[2] < bottom) bottom = center[2];
    if (center[2] > top) top = center[2];
    bottom -= made->reach + HC_u_8 * (hc_size(bottom) + made->reach);
    top += made->reach + HC_u_8 * (hc_size(top) + made->reach);
    if (of->low < bottom) of->low = bottom;
    if (of->high > top) of->high = top;
    return of->low <= of->high;
}

/* Whether the wall is surely missed from a time to another: 1; 0 where there is contact at *contact; else 2. */
static int hc_wall_missed_between(hc_ended_sweep *made, double first, double last, double *contact) {
    hc_rectangle kept[HC_RECTANGLES_KEPT];
    double asked = -1;
    int left = 1, seen = 0, unknown = 0;
    kept[0].low = made->low, kept[0].high = made->high, kept[0].first = first, kept[0].last = last;
    while (left) {
        hc_rectangle in = kept[--left];
        double w, time, lambda_, error, by_height, by_time, half;
        hc_form form;
        if (!hc_cut_to_reach(made, &in)) continue;
        w = hc_kept_within(in.low + 0.5 * (in.high - in.low), in.low, in.high);
        time = hc_kept_within(in.first + 0.5 * (in.last - in.first), in.first, in.last);
        lambda_ = hc_aim(made, &made->larger, &in, &w, &time);
        form = hc_form_about(made, &made->larger, lambda_, w);
        error = hc_form_error(made, &made->larger, lambda_, w, in.high - in.low, in.last - in.first);
        if (hc_form_least(&form, &in, w, time) > error) continue;
        if (hc_surely_met(made, lambda_, w, time)) {
            *contact = time;
            return 0;
        }
        if (hc_size(form.value) <= HC_NEAR_CONTACT * error * (1 + made->sweep.slack / HC_ENDED_ERROR)) {
            const int finely = hc_finely_missed(made, lambda_, w, time, &in, contact);
            if (finely == 0 || (finely > 1 && hc_touched_about(made, &in, time, last, &asked, contact))) return 0;
            if (finely == 2) unknown = 1;
            if (finely < 3) continue;
        }
        by_height = (hc_size(form.by_height) + hc_size(form.xx) * (in.high - in.low)) * (in.high - in.low);
        by_time = (hc_size(form.by_time) + hc_size(form.yy) * (in.last - in.first)) * (in.last - in.first);
        half = by_height > by_time ? in.low + 0.5 * (in.high - in.low) : in.first + 0.5 * (in.last - in.first);
        if (++seen > HC_MOST_RECTANGLES || left + 2 > HC_RECTANGLES_KEPT) return 2;
        kept[left] = kept[left + 1] = in;
        if (by_height > by_time) kept[left].low = kept[left + 1].high = half;
        else kept[left].first = kept[left + 1].last = half;
        if (by_height > by_time ? !(half > in.low && half < in.high) : !(half > in.first && half < in.last)) return 2;
        left += 2;
    }
    return unknown ? 2 : 1;
}

/* Whether the spheroid, by numbers of two doubles, surely stays on one side of the plane at a height: as it lies beyond it
   at both times. The error is as in hc_finely_missed, of the first of its terms. */
static int hc_finely_beyond(hc_ended_sweep *made, double w, double first, double last) {
    double sides[2];
    int k;
    hc_make_finer(made);
    for (k = 0; k < 2; k++) {
        const hc_twin moved = hc_twin_product(hc_twin_of(k ? last : first), made->moved[2]);
        const hc_twin t = hc_twin_difference(hc_twin_of(w), hc_twin_sum(hc_twin_of(made->row[6]), moved));
        const double top = hc_size(w) + made->tall, size = 1 + top * top / made->between.T;
        if (!(size < HC_cap && hc_fine_share(&made->outer, t).high > HC_FINE_ERROR * size)) return 0;
        sides[k] = t.high;
    }
    return (sides[0] > 0) == (sides[1] > 0);
}

/* Whether the centre of the ellipse in the plane at a height surely lies outside the rim at a time, as the sections of the
   smaller spheroid are placed, and at all times within 4u of it. A coordinate is off by less than 8u of both its ends. */
static int hc_center_beyond_rim(const hc_ended_sweep *made, double w) {
    const hc_sections *const pair = &made->smaller;
    const double xi = pair->xi0 - pair->k * (w - pair->z), r = hc_radius(pair, w);
    const double along = made->wide + hc_size(pair->k) * (hc_size(w) + made->tall);
    return pair->eta * pair->eta + xi * xi - r * r > 2 * HC_ENDED_ERROR * (along * along + made->wide * made->wide + r * r);
}

/* The same of the disc at a height, whose rim the spheroid misses all the time. While it meets the plane, which is from one
   time to another, it stays within the rim or outside, and so does the centre of its ellipse in the plane: that tells at
   the time at which its centre is nearest to the plane, which is one of those, if there are any. If that is an end of the
   sweep, at which there is no contact, there is none at any time: the computed time is off by 4u, in which the centre moves
   by less than a quarter of the radius, as the slack is below 1/4. */
static int hc_disc_missed_between(hc_ended_sweep *made, double w, double first, double last, double *contact) {
    const double time = hc_kept_within(made->rise == 0 ? first : (w - made->sweep.from[2]) / made->rise, first, last);
    double center[3], under[2], share, near;
    int misses;
    if ((time == 0 && made->clear[0]) || (time == 1 && made->clear[1])) return 1;
    hc_center_at(made, first, center);
    under[0] = (w - center[2]) * (1 - HC_ENDED_ERROR);
    hc_center_at(made, last, center);
    under[1] = (w - center[2]) * (1 - HC_ENDED_ERROR);
    if ((under[0] > made->reach && under[1] > made->reach) || (under[0] < -made->reach && under[1] < -made->reach)) return 1;
    near = made->reach * (1 - HC_SMALL);
    if (hc_size(under[0]) > near && hc_size(under[1]) > near && hc_finely_beyond(made, w, first, last)) return 1;
    hc_center_at(made, time, center);
    hc_place_sections(&made->smaller, center);
    if (hc_center_beyond_rim(made, w)) return 1;
    share = (w - center[2]) * (w - center[2]) / made->smaller.T;
    misses = hc_disc_misses(&made->smaller, w);
    if (misses == 0) *contact = time;
    return 1 - share > HC_ENDED_ERROR * (share + 1) ? misses : 2;
}

/* Whether wall and discs are surely missed from a time to another: 1; 0 where there is contact at *contact; else 2. */
static int hc_missed_between(hc_ended_sweep *made, double first, double last, double *contact) {
    const double ends[2] = {made->low, made->high};
    int missed = made->wall ? hc_wall_missed_between(made, first, last, contact) : 1, k;
    for (k = 0; made->solid && k < 2 && missed == 1; k++)
        if (hc_size(ends[k]) <= HC_ENDED_GREATEST) missed = hc_disc_missed_between(made, ends[k], first, last, contact);
    return missed;
}

static int hc_ended_position_at(const hc_ended_sweep *made, const double *axis, double time, double scale) {
    double row[13] = {0};
    hc_sweep_at(&made->sweep, time, scale, row);
    if (axis) memcpy(row + 7, axis, 3 * sizeof *axis);
    else row[9] = 1;
    row[10] = made->low, row[11] = made->high, row[12] = made->solid;
    return hc_ended_position(row, hc_position_with(row, axis));
}

/* A time before which there is no contact, and at which a spheroid that is a little larger has contact, in the sense of
   hypcheck_passage; NaN where none is found. */
static double hc_first_time(hc_ended_sweep *made, const double *axis, double contact) {
    double clear = 0;
    int i, unknown = 0;
    for (i = 0; i < HC_TIMES && unknown < HC_MOST_UNKNOWN; i++) {
        const double middle = clear + 0.5 * (contact - clear);
        double met = middle;
        int missed;
        if (!(middle > clear && middle < contact)) break;
        missed = hc_missed_between(made, clear, middle, &met);
        if (missed == 1) clear = middle;
        else contact = met < middle ? met : middle; /* or no more is known before it */
        unknown = missed == 2 ? unknown + 1 : 0;
    }
    return hc_ended_position_at(made, axis, clear, 1 + HC_SEEN * made->sweep.slack) == 0 ? clear : hc_nothing_known();
}

/* As hc_passage_of, for a valid row with heights behind the axis. */
static int hc_ended_passage(const double row[16], const double *axis, double *time) {
    const double reach = row[2] > row[3] ? row[2] : row[3], low = row[13], high = row[14];
    const double bottom = row[6] < row[9] ? row[6] : row[9], top = row[6] < row[9] ? row[9] : row[6];
    const double ends = (hc_size(low) <= HC_ENDED_GREATEST ? hc_size(low) : 0) + (hc_size(high) <= HC_ENDED_GREATEST ? hc_size(high) : 0);
    const double more = reach + HC_u_8 * (hc_size(bottom) + hc_size(top) + reach + ends);
    const int solid = row[15] != 0;
    double places[2][13], contact = 1;
    int positions[2], whole[2], endless, known, k;
    hc_ended_sweep made;
    if (bottom - low > more && high - top > more) return hc_passage_of(row, axis, time);
    if (low - top > more || bottom - high > more) return 0;
    for (k = 0; k < 2; k++) {
        memcpy(places[k], row, 4 * sizeof *row);
        memcpy(places[k] + 4, row + 4 + 3 * k, 3 * sizeof *row);
        memcpy(places[k] + 7, row + 10, 6 * sizeof *row);
        whole[k] = hc_position_with(places[k], axis);
        positions[k] = hc_ended_position(places[k], whole[k]);
    }
    if (positions[0] == 0) {
        if (time) *time = 0;
        return 1;
    }
    known = positions[1] == 0 || (solid && positions[0] != 2 && positions[1] != 2 && positions[0] != positions[1]);
    if (known && !time) return 1;
    endless = hc_passage_of(row, axis, NULL);
    if (endless == 0 && (!solid || whole[0] == 1)) return 0;
    if (!hc_make_ended_sweep(&made, row, axis)) return known ? 1 : 2;
    made.wall = endless != 0;
    for (k = 0; k < 2; k++) made.clear[k] = positions[k] == 1 || positions[k] == -1;
    k = hc_missed_between(&made, 0, 1, &contact);
    if (k && !known) return k == 1 ? 0 : 2;
    if (time) *time = hc_first_time(&made, axis, contact);
    return 1;
}

/* The rows of a question about sweeps: 10, 13 or 16 numbers each. */
void hypcheck_passage_columns(size_t n, size_t width, const double *rows, int8_t *hits, double *times) {
    const double nan = hc_nothing_known();
    size_t i;
    for (i = 0; i < n; i++) {
        const double *const given = rows + width * i;
        double row[16] = {0}, end[7], *const axis = row + 10, *const heights = row + 13;
        int valid = width == 10 || width == 13 || width == 16, is_tilted;
        if (times) times[i] = nan;
        hits[i] = 127;
        if (!valid) continue;
        row[12] = 1;
        memcpy(row, given, width * sizeof *row);
        memcpy(end, row, 4 * sizeof *row);
        memcpy(end + 4, row + 7, 3 * sizeof *row);
        if (width == 16) valid = heights[0] < heights[1] && (heights[2] == 0 || heights[2] == 1);
        if (!(valid && hc_has_direction(axis) && hc_valid(row) && hc_valid(end))) continue;
        is_tilted = !((hc_word(axis[0]) | hc_word(axis[1])) << 1 == 0 || hc_word(row[2]) == hc_word(row[3]));
        hc_scale_axis(axis);
        hits[i] = (int8_t)(width == 16 && !(heights[0] < -DBL_MAX && heights[1] > DBL_MAX)
                               ? hc_ended_passage(row, is_tilted ? axis : NULL, times ? times + i : NULL)
                               : hc_passage_of(row, is_tilted ? axis : NULL, times ? times + i : NULL));
    }
}

void hypcheck_passage(size_t n, const double *rows10, int8_t *hits, double *times) { hypcheck_passage_columns(n, 10, rows10, hits, times); }

void hypcheck_passage_tilted(size_t n, const double *rows13, int8_t *hits, double *times) {
    hypcheck_passage_columns(n, 13, rows13, hits, times);
}

void hypcheck_classify_columns(size_t n, size_t width, const double *rows, int8_t *positions) {
    if (width == 7) hypcheck_classify(n, rows, positions);
    else if (width == 10) hypcheck_classify_tilted(n, rows, positions);
    else if (width == 13) hypcheck_classify_ended(n, rows, positions);
    else hc_refuse_all(n, positions);
}

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

#if HC_PRECISE
#pragma float_control(pop)
#endif
#endif
#elif defined(HC_LEVEL)
#define HC_EDITION_f18846c138270e11

/* ---- one instruction set: vectors of HC_WIDTH doubles; included once for each ---- */

#if HC_LEVEL == 3
#define HC_NAME(name) name##_avx512
#define HC_TARGET __attribute__((target("avx512f,avx512bw,avx512dq,avx512vl,fma,bmi2")))
#define HC_WIDTH 8
#define HC_NUMBER __m512d
#define HC_TRUTH __mmask8
#define HC_LOAD(from) _mm512_loadu_pd(from)
#define HC_SET(value) _mm512_set1_pd(value)
#define HC_ABS(a) _mm512_abs_pd(a)
#define HC_GT(a, b) _mm512_cmp_pd_mask(a, b, _CMP_GT_OQ)
#define HC_LT(a, b) _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ)
#define HC_GE(a, b) _mm512_cmp_pd_mask(a, b, _CMP_GE_OQ)
#define HC_LE(a, b) _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ)
#define HC_AND(a, b) ((HC_TRUTH)((a) & (b)))
#define HC_OR(a, b) ((HC_TRUTH)((a) | (b)))
#define HC_BITS(truth) ((uint64_t)(truth))
#define HC_SQRT(a) hc_about_root_avx512(a)
#define HC_INVERSE(a) hc_about_inverse_avx512(a)
#define HC_ROOT(a) _mm512_sqrt_pd(a)
#define HC_STORE(to, a) _mm512_storeu_pd(to, a)
#define HC_MIN(a, b) _mm512_min_pd(a, b)
#define HC_MAX(a, b) _mm512_max_pd(a, b)
#define HC_SELECT(truth, a, b) _mm512_mask_blend_pd(truth, b, a)
#elif HC_LEVEL == 2
#define HC_NAME(name) name##_avx2
#define HC_TARGET __attribute__((target("avx2,fma,bmi2")))
#define HC_WIDTH 4
#define HC_NUMBER __m256d
#define HC_TRUTH __m256d
#define HC_LOAD(from) _mm256_loadu_pd(from)
#define HC_SET(value) _mm256_set1_pd(value)
#define HC_ABS(a) _mm256_andnot_pd(_mm256_set1_pd(-0.0), a)
#define HC_GT(a, b) _mm256_cmp_pd(a, b, _CMP_GT_OQ)
#define HC_LT(a, b) _mm256_cmp_pd(a, b, _CMP_LT_OQ)
#define HC_GE(a, b) _mm256_cmp_pd(a, b, _CMP_GE_OQ)
#define HC_LE(a, b) _mm256_cmp_pd(a, b, _CMP_LE_OQ)
#define HC_AND(a, b) _mm256_and_pd(a, b)
#define HC_OR(a, b) _mm256_or_pd(a, b)
#define HC_BITS(truth) ((uint64_t)_mm256_movemask_pd(truth))
#define HC_SQRT(a) _mm256_sqrt_pd(a)
#define HC_INVERSE(a) (HC_SET(1.0) / (a))
#define HC_ROOT(a) _mm256_sqrt_pd(a)
#define HC_STORE(to, a) _mm256_storeu_pd(to, a)
#define HC_MIN(a, b) _mm256_min_pd(a, b)
#define HC_MAX(a, b) _mm256_max_pd(a, b)
#define HC_SELECT(truth, a, b) _mm256_blendv_pd(b, a, truth)
#elif HC_LEVEL == 1
#define HC_NAME(name) name##_sse2
#define HC_TARGET
#define HC_WIDTH 2
#define HC_NUMBER __m128d
#define HC_TRUTH __m128d
#define HC_LOAD(from) _mm_loadu_pd(from)
#define HC_SET(value) _mm_set1_pd(value)
#define HC_ABS(a) _mm_andnot_pd(_mm_set1_pd(-0.0), a)
#define HC_GT(a, b) _mm_cmpgt_pd(a, b)
#define HC_LT(a, b) _mm_cmplt_pd(a, b)
#define HC_GE(a, b) _mm_cmpge_pd(a, b)
#define HC_LE(a, b) _mm_cmple_pd(a, b)
#define HC_AND(a, b) _mm_and_pd(a, b)
#define HC_OR(a, b) _mm_or_pd(a, b)
#define HC_BITS(truth) ((uint64_t)_mm_movemask_pd(truth))
#define HC_SQRT(a) _mm_sqrt_pd(a)
#define HC_INVERSE(a) (HC_SET(1.0) / (a))
#define HC_ROOT(a) _mm_sqrt_pd(a)
#define HC_STORE(to, a) _mm_storeu_pd(to, a)
#define HC_MIN(a, b) _mm_min_pd(a, b)
#define HC_MAX(a, b) _mm_max_pd(a, b)
#define HC_SELECT(truth, a, b) _mm_or_pd(_mm_and_pd(truth, a), _mm_andnot_pd(truth, b))
#elif HC_LEVEL == 4
#define HC_NAME(name) name##_neon
#define HC_TARGET
#define HC_WIDTH 2
#define HC_NUMBER float64x2_t
#define HC_TRUTH uint64x2_t
#define HC_LOAD(from) vld1q_f64(from)
#define HC_SET(value) vdupq_n_f64(value)
#define HC_ABS(a) vabsq_f64(a)
#define HC_GT(a, b) vcgtq_f64(a, b)
#define HC_LT(a, b) vcltq_f64(a, b)
#define HC_GE(a, b) vcgeq_f64(a, b)
#define HC_LE(a, b) vcleq_f64(a, b)
#define HC_AND(a, b) vandq_u64(a, b)
#define HC_OR(a, b) vorrq_u64(a, b)
#define HC_BITS(truth) ((vgetq_lane_u64(truth, 0) & 1) | (vgetq_lane_u64(truth, 1) & 2))
#define HC_SQRT(a) vsqrtq_f64(a)
#define HC_INVERSE(a) (HC_SET(1.0) / (a))
#define HC_ROOT(a) vsqrtq_f64(a)
#define HC_STORE(to, a) vst1q_f64(to, a)
#define HC_MIN(a, b) vbslq_f64(vcltq_f64(a, b), a, b)
#define HC_MAX(a, b) vbslq_f64(vcgtq_f64(a, b), a, b)
#define HC_SELECT(truth, a, b) vbslq_f64(truth, a, b)
#else
#define HC_NAME(name) name##_plain
#define HC_TARGET
#define HC_WIDTH 1
#define HC_NUMBER double
#define HC_TRUTH int
#define HC_LOAD(from) (*(from))
#define HC_SET(value) (value)
#define HC_ABS(a) ((a) < 0 ? -(a) : (a))
#define HC_GT(a, b) ((a) > (b))
#define HC_LT(a, b) ((a) < (b))
#define HC_GE(a, b) ((a) >= (b))
#define HC_LE(a, b) ((a) <= (b))
#define HC_AND(a, b) ((a) & (b))
#define HC_OR(a, b) ((a) | (b))
#define HC_BITS(truth) ((uint64_t)(truth))
#define HC_SQRT(a) hc_rough_root(a)
#define HC_INVERSE(a) (HC_SET(1.0) / (a))
#define HC_ROOT(a) hc_fine_root(a)
#define HC_STORE(to, a) (*(to) = (a))
#define HC_MIN(a, b) ((a) < (b) ? (a) : (b))
#define HC_MAX(a, b) ((a) > (b) ? (a) : (b))
#define HC_SELECT(truth, a, b) ((truth) ? (a) : (b))
#endif

#if HC_LEVEL == 3
/* Within 2^-26, for guesses that prove nothing, in a quarter of the time: a step of Newton's method after 14 bits. */
HC_TARGET static inline __m512d hc_about_inverse_avx512(__m512d a) {
    const __m512d guess = _mm512_rcp14_pd(a);
    return guess * (_mm512_set1_pd(2.0) - a * guess);
}
HC_TARGET static inline __m512d hc_about_root_avx512(__m512d a) {
    const __m512d guess = _mm512_rsqrt14_pd(a), root = a * guess;
    return root * (_mm512_set1_pd(1.5) - _mm512_set1_pd(0.5) * root * guess);
}
#endif

HC_TARGET static int HC_NAME(hc_all_below)(HC_NUMBER numbers, double limit) {
    return HC_BITS(HC_LT(numbers, HC_SET(limit))) == ((uint64_t)1 << HC_WIDTH) - 1;
}

/* 64 bytes: 1 where `plus` has a bit, -1 where `minus` has one, else 0. */
HC_TARGET static void HC_NAME(hc_spread)(int8_t *bytes, uint64_t plus, uint64_t minus) {
#if HC_LEVEL == 3
    const __m512i ones = _mm512_maskz_set1_epi8((__mmask64)plus, 1);
    _mm512_storeu_si512((void *)bytes, _mm512_mask_set1_epi8(ones, (__mmask64)minus, -1));
#elif HC_LEVEL == 2
    const __m256i place = _mm256_setr_epi64x(0, 0x0101010101010101, 0x0202020202020202, 0x0303030303030303);
    const __m256i bit = _mm256_set1_epi64x((long long)0x8040201008040201u);
    int half;
    for (half = 0; half < 2; half++) {
        const __m256i p = _mm256_shuffle_epi8(_mm256_set1_epi32((int)(uint32_t)(plus >> 32 * half)), place);
        const __m256i m = _mm256_shuffle_epi8(_mm256_set1_epi32((int)(uint32_t)(minus >> 32 * half)), place);
        const __m256i is_plus = _mm256_cmpeq_epi8(_mm256_and_si256(p, bit), bit);
        const __m256i is_minus = _mm256_cmpeq_epi8(_mm256_and_si256(m, bit), bit);
        _mm256_storeu_si256((__m256i *)(void *)(bytes + 32 * half),
                            _mm256_or_si256(is_minus, _mm256_sub_epi8(_mm256_setzero_si256(), is_plus)));
    }
#elif HC_LEVEL == 1
    const __m128i bit = _mm_set1_epi64x((long long)0x8040201008040201u);
    int part;
    for (part = 0; part < 4; part++) {
        const int p = (int)(plus >> 16 * part & 0xffff), m = (int)(minus >> 16 * part & 0xffff);
        const __m128i eight_p = _mm_unpacklo_epi64(_mm_set1_epi8((char)p), _mm_set1_epi8((char)(p >> 8)));
        const __m128i eight_m = _mm_unpacklo_epi64(_mm_set1_epi8((char)m), _mm_set1_epi8((char)(m >> 8)));
        const __m128i is_plus = _mm_cmpeq_epi8(_mm_and_si128(eight_p, bit), bit);
        const __m128i is_minus = _mm_cmpeq_epi8(_mm_and_si128(eight_m, bit), bit);
        _mm_storeu_si128((__m128i *)(void *)(bytes + 16 * part),
                         _mm_or_si128(is_minus, _mm_sub_epi8(_mm_setzero_si128(), is_plus)));
    }
#elif HC_LEVEL == 4
    const uint8x8_t bit = vcreate_u8(0x8040201008040201u);
    int part;
    for (part = 0; part < 8; part++) {
        const int8x8_t p = vreinterpret_s8_u8(vtst_u8(vdup_n_u8((uint8_t)(plus >> 8 * part)), bit));
        const int8x8_t m = vreinterpret_s8_u8(vtst_u8(vdup_n_u8((uint8_t)(minus >> 8 * part)), bit));
        vst1_s8(bytes + 8 * part, vsub_s8(m, p)); /* each is 0 or -1 */
    }
#else
    int i;
    for (i = 0; i < HC_BLOCK; i++) bytes[i] = (int8_t)((int)(plus >> i & 1) - (int)(minus >> i & 1));
#endif
}

HC_TARGET static void HC_NAME(hc_spread_all)(int8_t *bytes, const hc_signs *signs, size_t blocks) {
    size_t block;
    for (block = 0; block < blocks; block++)
        HC_NAME(hc_spread)(bytes + HC_BLOCK * block, signs[block].plus, signs[block].minus);
}

/* The second stage on at most HC_BLOCK rows; column k begins at columns + k stride and is readable up to a multiple of
   HC_WIDTH rows. */
HC_TARGET static hc_bits HC_NAME(hc_certified)(const double *columns, size_t stride, int count) {
    hc_bits found = {0, 0, 0};
    int at;
    const HC_NUMBER u_4 = HC_SET(HC_u_4);
    const HC_NUMBER u_8 = HC_SET(HC_u_8);
    const HC_NUMBER u_12 = HC_SET(HC_u_12);
    const HC_NUMBER u_16 = HC_SET(HC_u_16);
    const HC_NUMBER slack = HC_SET(HC_slack);
    const HC_NUMBER least = HC_SET(HC_least);
    const HC_NUMBER greatest = HC_SET(HC_greatest);
    const HC_NUMBER farthest = HC_SET(HC_farthest);
    for (at = 0; at < count; at += HC_WIDTH) {
        const HC_NUMBER alpha = HC_LOAD(columns + 0 * stride + at);
        const HC_NUMBER gamma = HC_LOAD(columns + 1 * stride + at);
        const HC_NUMBER b = HC_LOAD(columns + 2 * stride + at);
        const HC_NUMBER d = HC_LOAD(columns + 3 * stride + at);
        const HC_NUMBER x = HC_LOAD(columns + 4 * stride + at);
        const HC_NUMBER y = HC_LOAD(columns + 5 * stride + at);
        const HC_NUMBER z = HC_LOAD(columns + 6 * stride + at);
        /* printed from the program "certified" */
        const HC_NUMBER alpha_over_b = alpha / b;
        const HC_NUMBER A = alpha_over_b * alpha_over_b;
        const HC_NUMBER gamma_over_d = gamma / d;
        const HC_NUMBER B = gamma_over_d * gamma_over_d;
        const HC_NUMBER AB = A * B;
        const HC_NUMBER c0 = -AB;
        const HC_NUMBER c0_plus_A = c0 + A;
        const HC_NUMBER C = c0_plus_A - B;
        const HC_NUMBER xx = x * x;
        const HC_NUMBER yy = y * y;
        const HC_NUMBER rr = xx + yy;
        const HC_NUMBER bb = b * b;
        const HC_NUMBER P = rr / bb;
        const HC_NUMBER z_over_d = z / d;
        const HC_NUMBER Q = z_over_d * z_over_d;
        const HC_NUMBER BP = B * P;
        const HC_NUMBER C_plus_BP = C + BP;
        const HC_NUMBER AQ = A * Q;
        const HC_NUMBER c1 = C_plus_BP - AQ;
        const HC_NUMBER A_minus_B = A - B;
        const HC_NUMBER K = A_minus_B + HC_SET(1.0);
        const HC_NUMBER K_minus_P = K - P;
        const HC_NUMBER c2 = K_minus_P - Q;
        const HC_NUMBER c2_squared = c2 * c2;
        const HC_NUMBER three_c1 = HC_SET(3.0) * c1;
        const HC_NUMBER h1 = c2_squared - three_c1;
        const HC_NUMBER c2c1 = c2 * c1;
        const HC_NUMBER nine_c0 = HC_SET(9.0) * c0;
        const HC_NUMBER h2 = c2c1 - nine_c0;
        const HC_NUMBER c1_squared = c1 * c1;
        const HC_NUMBER c2c0 = c2 * c0;
        const HC_NUMBER three_c2c0 = HC_SET(3.0) * c2c0;
        const HC_NUMBER h3 = c1_squared - three_c2c0;
        const HC_NUMBER h1h3 = h1 * h3;
        const HC_NUMBER h1h3_4 = HC_SET(4.0) * h1h3;
        const HC_NUMBER h2_squared = h2 * h2;
        const HC_NUMBER delta_3 = h1h3_4 - h2_squared;
        const HC_TRUTH alpha_usable = HC_GT(alpha, HC_SET(0.0));
        const HC_TRUTH gamma_usable = HC_GT(gamma, HC_SET(0.0));
        const HC_TRUTH b_not_small = HC_GT(b, least);
        const HC_TRUTH b_not_large = HC_LT(b, greatest);
        const HC_TRUTH d_not_small = HC_GT(d, least);
        const HC_TRUTH d_not_large = HC_LT(d, greatest);
        const HC_TRUTH A_not_small = HC_GT(A, least);
        const HC_TRUTH A_not_large = HC_LT(A, greatest);
        const HC_TRUTH B_not_small = HC_GT(B, least);
        const HC_TRUTH B_not_large = HC_LT(B, greatest);
        const HC_NUMBER P_plus_Q = P + Q;
        const HC_TRUTH not_too_far = HC_LT(P_plus_Q, farthest);
        const HC_TRUTH positive_radial = HC_AND(alpha_usable, gamma_usable);
        const HC_TRUTH b_usable = HC_AND(b_not_small, b_not_large);
        const HC_TRUTH d_usable = HC_AND(d_not_small, d_not_large);
        const HC_TRUTH A_usable = HC_AND(A_not_small, A_not_large);
        const HC_TRUTH B_usable = HC_AND(B_not_small, B_not_large);
        const HC_TRUTH radial_usable = HC_AND(b_usable, A_usable);
        const HC_TRUTH axial_usable = HC_AND(d_usable, B_usable);
        const HC_TRUTH ratios_usable = HC_AND(radial_usable, axial_usable);
        const HC_TRUTH sizes_usable = HC_AND(positive_radial, ratios_usable);
        const HC_TRUTH usable = HC_AND(sizes_usable, not_too_far);
        const HC_NUMBER A_plus_B = A + B;
        const HC_NUMBER sizes_1 = A_plus_B + AB;
        const HC_NUMBER BP_plus_AQ = BP + AQ;
        const HC_NUMBER terms_1 = sizes_1 + BP_plus_AQ;
        const HC_NUMBER sizes_2 = A_plus_B + HC_SET(1.0);
        const HC_NUMBER terms_2 = sizes_2 + P_plus_Q;
        const HC_NUMBER e1 = u_12 * terms_1;
        const HC_NUMBER e2 = u_8 * terms_2;
        const HC_NUMBER e0 = u_8 * AB;
        const HC_NUMBER m0 = AB + e0;
        const HC_NUMBER size_c1 = HC_ABS(c1);
        const HC_NUMBER m1 = size_c1 + e1;
        const HC_NUMBER size_c2 = HC_ABS(c2);
        const HC_NUMBER m2 = size_c2 + e2;
        const HC_NUMBER u_m0 = u_4 * m0;
        const HC_NUMBER f0 = e0 + u_m0;
        const HC_NUMBER u_m1 = u_4 * m1;
        const HC_NUMBER f1 = e1 + u_m1;
        const HC_NUMBER u_m2 = u_4 * m2;
        const HC_NUMBER twice_e2 = HC_SET(2.0) * e2;
        const HC_NUMBER f2 = twice_e2 + u_m2;
        const HC_NUMBER m2_f2 = m2 * f2;
        const HC_NUMBER thrice_f1 = HC_SET(3.0) * f1;
        const HC_NUMBER E1 = m2_f2 + thrice_f1;
        const HC_NUMBER m2_f1 = m2 * f1;
        const HC_NUMBER m1_e2 = m1 * e2;
        const HC_NUMBER cross_21 = m2_f1 + m1_e2;
        const HC_NUMBER ninefold_f0 = HC_SET(9.0) * f0;
        const HC_NUMBER E2 = cross_21 + ninefold_f0;
        const HC_NUMBER twice_e1 = HC_SET(2.0) * e1;
        const HC_NUMBER f3 = twice_e1 + u_m1;
        const HC_NUMBER m1_f3 = m1 * f3;
        const HC_NUMBER m2_f0 = m2 * f0;
        const HC_NUMBER m0_e2 = m0 * e2;
        const HC_NUMBER cross_20 = m2_f0 + m0_e2;
        const HC_NUMBER thrice_cross_20 = HC_SET(3.0) * cross_20;
        const HC_NUMBER E3 = m1_f3 + thrice_cross_20;
        const HC_NUMBER size_h1 = HC_ABS(h1);
        const HC_NUMBER a1 = size_h1 + E1;
        const HC_NUMBER size_h2 = HC_ABS(h2);
        const HC_NUMBER a2 = size_h2 + E2;
        const HC_NUMBER size_h3 = HC_ABS(h3);
        const HC_NUMBER a3 = size_h3 + E3;
        const HC_NUMBER u_a3 = u_4 * a3;
        const HC_NUMBER F3 = E3 + u_a3;
        const HC_NUMBER a1_F3 = a1 * F3;
        const HC_NUMBER a3_E1 = a3 * E1;
        const HC_NUMBER cross_13 = a1_F3 + a3_E1;
        const HC_NUMBER fourfold_cross_13 = HC_SET(4.0) * cross_13;
        const HC_NUMBER u_a2 = u_4 * a2;
        const HC_NUMBER twice_E2 = HC_SET(2.0) * E2;
        const HC_NUMBER F2 = twice_E2 + u_a2;
        const HC_NUMBER a2_F2 = a2 * F2;
        const HC_NUMBER E_sum = fourfold_cross_13 + a2_F2;
        const HC_NUMBER E = slack * E_sum;
        const HC_NUMBER minus_E = -E;
        const HC_NUMBER two_c2 = HC_SET(2.0) * c2;
        const HC_NUMBER twice_m2 = HC_SET(2.0) * m2;
        const HC_NUMBER thrice_B = HC_SET(3.0) * B;
        const HC_NUMBER chord_B = thrice_B + two_c2;
        const HC_NUMBER rise_B = chord_B * B;
        const HC_NUMBER slope_B = rise_B + c1;
        const HC_NUMBER offset_B = thrice_B + c2;
        const HC_NUMBER size_chord_B = thrice_B + twice_m2;
        const HC_NUMBER size_rise_B = size_chord_B * B;
        const HC_NUMBER size_slope_B = size_rise_B + m1;
        const HC_NUMBER u_slope_B = u_16 * size_slope_B;
        const HC_NUMBER carried_B = twice_e2 * B;
        const HC_NUMBER carried_1_B = carried_B + e1;
        const HC_NUMBER error_B = carried_1_B + u_slope_B;
        const HC_NUMBER bound_B = slack * error_B;
        const HC_NUMBER below_B = -bound_B;
        const HC_NUMBER size_offset_B = B + m2;
        const HC_NUMBER u_offset_B = u_16 * size_offset_B;
        const HC_NUMBER offset_error_B = e2 + u_offset_B;
        const HC_NUMBER offset_bound_B = slack * offset_error_B;
        const HC_NUMBER offset_below_B = -offset_bound_B;
        const HC_TRUTH rises_B = HC_GT(slope_B, bound_B);
        const HC_TRUTH falls_B = HC_LT(slope_B, below_B);
        const HC_TRUTH inflection_inside_B = HC_GT(offset_B, offset_bound_B);
        const HC_TRUTH inflection_beyond_B = HC_LT(offset_B, offset_below_B);
        const HC_NUMBER thrice_A = HC_SET(3.0) * A;
        const HC_NUMBER chord_A = thrice_A - two_c2;
        const HC_NUMBER rise_A = chord_A * A;
        const HC_NUMBER slope_A = rise_A + c1;
        const HC_NUMBER offset_A = thrice_A - c2;
        const HC_NUMBER size_chord_A = thrice_A + twice_m2;
        const HC_NUMBER size_rise_A = size_chord_A * A;
        const HC_NUMBER size_slope_A = size_rise_A + m1;
        const HC_NUMBER u_slope_A = u_16 * size_slope_A;
        const HC_NUMBER carried_A = twice_e2 * A;
        const HC_NUMBER carried_1_A = carried_A + e1;
        const HC_NUMBER error_A = carried_1_A + u_slope_A;
        const HC_NUMBER bound_A = slack * error_A;
        const HC_NUMBER below_A = -bound_A;
        const HC_NUMBER size_offset_A = A + m2;
        const HC_NUMBER u_offset_A = u_16 * size_offset_A;
        const HC_NUMBER offset_error_A = e2 + u_offset_A;
        const HC_NUMBER offset_bound_A = slack * offset_error_A;
        const HC_NUMBER offset_below_A = -offset_bound_A;
        const HC_TRUTH rises_A = HC_GT(slope_A, bound_A);
        const HC_TRUTH falls_A = HC_LT(slope_A, below_A);
        const HC_TRUTH inflection_inside_A = HC_GT(offset_A, offset_bound_A);
        const HC_TRUTH inflection_beyond_A = HC_LT(offset_A, offset_below_A);
        const HC_NUMBER minus_e1 = -e1;
        const HC_NUMBER minus_e2 = -e2;
        const HC_TRUTH distinct = HC_GT(delta_3, E);
        const HC_TRUTH one_root = HC_LT(delta_3, minus_E);
        const HC_TRUTH c1_positive = HC_GT(c1, e1);
        const HC_TRUTH c1_negative = HC_LT(c1, minus_e1);
        const HC_TRUTH c2_positive = HC_GT(c2, e2);
        const HC_TRUTH c2_negative = HC_LT(c2, minus_e2);
        const HC_TRUTH three_roots = HC_AND(distinct, usable);
        const HC_TRUTH falling_then_rising = HC_AND(c2_negative, c1_positive);
        const HC_TRUTH all_positive = HC_AND(three_roots, falling_then_rising);
        const HC_TRUTH some_sign_differs = HC_OR(c2_positive, c1_negative);
        const HC_TRUTH two_negative = HC_AND(three_roots, some_sign_differs);
        const HC_TRUTH some_below_B = HC_OR(inflection_inside_B, falls_B);
        const HC_TRUTH none_below_B = HC_AND(inflection_beyond_B, rises_B);
        const HC_TRUTH both_above_A = HC_AND(inflection_inside_A, rises_A);
        const HC_TRUTH none_above_A = HC_OR(inflection_beyond_A, falls_A);
        const HC_TRUTH exterior = HC_AND(all_positive, some_below_B);
        const HC_TRUTH interior = HC_AND(two_negative, both_above_A);
        const HC_TRUTH crossing = HC_AND(one_root, usable);
        const HC_TRUTH groove = HC_AND(all_positive, none_below_B);
        const HC_TRUTH throat = HC_AND(two_negative, none_above_A);
        const HC_TRUTH several_curves = HC_OR(groove, throat);
        const HC_TRUTH contact = HC_OR(crossing, several_curves);
        const HC_TRUTH clear = HC_OR(exterior, interior);
        const HC_TRUTH decided = HC_OR(clear, contact);
        /* end of the program "certified" */
        found.plus |= HC_BITS(exterior) << at;
        found.minus |= HC_BITS(interior) << at;
        found.decided |= HC_BITS(decided) << at;
    }
    return found;
}

/* The first stage on whole blocks of one scene: what it decides is in `signs`, and `left` has a bit for each other row. To
   collect these here would be a branch on data just loaded, and its misses cost more than the arithmetic. */
HC_TARGET static void HC_NAME(hc_one_line_position)(const hc_scene *scene, int blocks, const double *x_of, const double *y_of,
                                          const double *z_of, int fetch, hc_signs *signs, uint64_t *left) {
    int block;
    const HC_NUMBER K_beyond_0 = HC_SET(scene->beyond[0].K);
    const HC_NUMBER M_beyond_0 = HC_SET(scene->beyond[0].M);
    const HC_NUMBER K_within_0 = HC_SET(scene->within[0].K);
    const HC_NUMBER M_within_0 = HC_SET(scene->within[0].M);
    const HC_NUMBER K_under_0 = HC_SET(scene->under[0].K);
    const HC_NUMBER M_under_0 = HC_SET(scene->under[0].M);
    const HC_NUMBER K_above_0 = HC_SET(scene->above[0].K);
    const HC_NUMBER M_above_0 = HC_SET(scene->above[0].M);
    const HC_NUMBER reach = HC_SET(scene->reach);
    for (block = 0; block < blocks; block++) {
        const int base = HC_BLOCK * block;
        HC_NUMBER sum = HC_SET(0.0);
        hc_bits found = {0, 0, 0};
        int at;
        if (fetch)
            for (at = 0; at < HC_BLOCK; at += 8) {
                HC_FETCH(x_of, base + at + HC_AHEAD);
                HC_FETCH(y_of, base + at + HC_AHEAD);
                HC_FETCH(z_of, base + at + HC_AHEAD);
            }
        for (at = 0; at < HC_BLOCK; at += HC_WIDTH) {
            const HC_NUMBER x = HC_LOAD(x_of + base + at);
            const HC_NUMBER y = HC_LOAD(y_of + base + at);
            const HC_NUMBER z = HC_LOAD(z_of + base + at);
            /* printed from the program "one-line" */
            const HC_NUMBER xx = x * x;
            const HC_NUMBER yy = y * y;
            const HC_NUMBER R = xx + yy;
            const HC_NUMBER T = z * z;
            const HC_NUMBER R_plus_T = R + T;
            const HC_TRUTH in_reach = HC_LE(T, reach);
            const HC_NUMBER rise_beyond_0 = M_beyond_0 * T;
            const HC_NUMBER line_beyond_0 = K_beyond_0 + rise_beyond_0;
            const HC_TRUTH exterior = HC_GT(R, line_beyond_0);
            const HC_NUMBER rise_within_0 = M_within_0 * T;
            const HC_NUMBER line_within_0 = K_within_0 + rise_within_0;
            const HC_TRUTH interior = HC_LT(R, line_within_0);
            const HC_NUMBER rise_under_0 = M_under_0 * T;
            const HC_NUMBER line_under_0 = K_under_0 + rise_under_0;
            const HC_TRUTH is_under = HC_LT(R, line_under_0);
            const HC_NUMBER rise_above_0 = M_above_0 * T;
            const HC_NUMBER line_above_0 = K_above_0 + rise_above_0;
            const HC_TRUTH is_above = HC_GE(R, line_above_0);
            const HC_TRUTH contact_in_reach = HC_AND(is_under, is_above);
            const HC_TRUTH contact = HC_AND(contact_in_reach, in_reach);
            const HC_TRUTH clear = HC_OR(exterior, interior);
            const HC_TRUTH decided = HC_OR(clear, contact);
            /* end of the program "one-line" */
            sum = sum + R_plus_T;
            found.plus |= HC_BITS(exterior) << at;
            found.minus |= HC_BITS(interior) << at;
            found.decided |= HC_BITS(decided) << at;
        }
        signs[block].plus = found.plus;
        signs[block].minus = found.minus;
        left[block] = ~(HC_NAME(hc_all_below)(sum, HC_cap) ? found.decided : 0);
    }
}

HC_TARGET static void HC_NAME(hc_one_line_exterior)(const hc_scene *scene, int blocks, const double *x_of, const double *y_of,
                                          const double *z_of, int fetch, hc_signs *signs, uint64_t *left) {
    int block;
    const HC_NUMBER K_beyond_0 = HC_SET(scene->beyond[0].K);
    const HC_NUMBER M_beyond_0 = HC_SET(scene->beyond[0].M);
    const HC_NUMBER K_under_0 = HC_SET(scene->under[0].K);
    const HC_NUMBER M_under_0 = HC_SET(scene->under[0].M);
    const HC_NUMBER reach = HC_SET(scene->reach);
    for (block = 0; block < blocks; block++) {
        const int base = HC_BLOCK * block;
        HC_NUMBER sum = HC_SET(0.0);
        hc_bits found = {0, 0, 0};
        int at;
        if (fetch)
            for (at = 0; at < HC_BLOCK; at += 8) {
                HC_FETCH(x_of, base + at + HC_AHEAD);
                HC_FETCH(y_of, base + at + HC_AHEAD);
                HC_FETCH(z_of, base + at + HC_AHEAD);
            }
        for (at = 0; at < HC_BLOCK; at += HC_WIDTH) {
            const HC_NUMBER x = HC_LOAD(x_of + base + at);
            const HC_NUMBER y = HC_LOAD(y_of + base + at);
            const HC_NUMBER z = HC_LOAD(z_of + base + at);
            /* printed from the program "one-line" */
            const HC_NUMBER xx = x * x;
            const HC_NUMBER yy = y * y;
            const HC_NUMBER R = xx + yy;
            const HC_NUMBER T = z * z;
            const HC_NUMBER R_plus_T = R + T;
            const HC_TRUTH in_reach = HC_LE(T, reach);
            const HC_NUMBER rise_beyond_0 = M_beyond_0 * T;
            const HC_NUMBER line_beyond_0 = K_beyond_0 + rise_beyond_0;
            const HC_TRUTH exterior = HC_GT(R, line_beyond_0);
            const HC_NUMBER rise_under_0 = M_under_0 * T;
            const HC_NUMBER line_under_0 = K_under_0 + rise_under_0;
            const HC_TRUTH is_under = HC_LT(R, line_under_0);
            const HC_TRUTH not_exterior = HC_AND(is_under, in_reach);
            const HC_TRUTH exterior_decided = HC_OR(exterior, not_exterior);
            /* end of the program "one-line" */
            sum = sum + R_plus_T;
            found.plus |= HC_BITS(exterior) << at;
            found.decided |= HC_BITS(exterior_decided) << at;
        }
        signs[block].plus = found.plus;
        signs[block].minus = found.minus;
        left[block] = ~(HC_NAME(hc_all_below)(sum, HC_cap) ? found.decided : 0);
    }
}

HC_TARGET static void HC_NAME(hc_one_line_interior)(const hc_scene *scene, int blocks, const double *x_of, const double *y_of,
                                          const double *z_of, int fetch, hc_signs *signs, uint64_t *left) {
    int block;
    const HC_NUMBER K_within_0 = HC_SET(scene->within[0].K);
    const HC_NUMBER M_within_0 = HC_SET(scene->within[0].M);
    const HC_NUMBER K_above_0 = HC_SET(scene->above[0].K);
    const HC_NUMBER M_above_0 = HC_SET(scene->above[0].M);
    const HC_NUMBER reach = HC_SET(scene->reach);
    for (block = 0; block < blocks; block++) {
        const int base = HC_BLOCK * block;
        HC_NUMBER sum = HC_SET(0.0);
        hc_bits found = {0, 0, 0};
        int at;
        if (fetch)
            for (at = 0; at < HC_BLOCK; at += 8) {
                HC_FETCH(x_of, base + at + HC_AHEAD);
                HC_FETCH(y_of, base + at + HC_AHEAD);
                HC_FETCH(z_of, base + at + HC_AHEAD);
            }
        for (at = 0; at < HC_BLOCK; at += HC_WIDTH) {
            const HC_NUMBER x = HC_LOAD(x_of + base + at);
            const HC_NUMBER y = HC_LOAD(y_of + base + at);
            const HC_NUMBER z = HC_LOAD(z_of + base + at);
            /* printed from the program "one-line" */
            const HC_NUMBER xx = x * x;
            const HC_NUMBER yy = y * y;
            const HC_NUMBER R = xx + yy;
            const HC_NUMBER T = z * z;
            const HC_NUMBER R_plus_T = R + T;
            const HC_TRUTH in_reach = HC_LE(T, reach);
            const HC_NUMBER rise_within_0 = M_within_0 * T;
            const HC_NUMBER line_within_0 = K_within_0 + rise_within_0;
            const HC_TRUTH interior = HC_LT(R, line_within_0);
            const HC_NUMBER rise_above_0 = M_above_0 * T;
            const HC_NUMBER line_above_0 = K_above_0 + rise_above_0;
            const HC_TRUTH is_above = HC_GE(R, line_above_0);
            const HC_TRUTH not_interior = HC_AND(is_above, in_reach);
            const HC_TRUTH interior_decided = HC_OR(interior, not_interior);
            /* end of the program "one-line" */
            sum = sum + R_plus_T;
            found.plus |= HC_BITS(interior) << at;
            found.decided |= HC_BITS(interior_decided) << at;
        }
        signs[block].plus = found.plus;
        signs[block].minus = found.minus;
        left[block] = ~(HC_NAME(hc_all_below)(sum, HC_cap) ? found.decided : 0);
    }
}

HC_TARGET static void HC_NAME(hc_one_line_contact)(const hc_scene *scene, int blocks, const double *x_of, const double *y_of,
                                          const double *z_of, int fetch, hc_signs *signs, uint64_t *left) {
    int block;
    const HC_NUMBER K_beyond_0 = HC_SET(scene->beyond[0].K);
    const HC_NUMBER M_beyond_0 = HC_SET(scene->beyond[0].M);
    const HC_NUMBER K_within_0 = HC_SET(scene->within[0].K);
    const HC_NUMBER M_within_0 = HC_SET(scene->within[0].M);
    const HC_NUMBER K_under_0 = HC_SET(scene->under[0].K);
    const HC_NUMBER M_under_0 = HC_SET(scene->under[0].M);
    const HC_NUMBER K_above_0 = HC_SET(scene->above[0].K);
    const HC_NUMBER M_above_0 = HC_SET(scene->above[0].M);
    const HC_NUMBER reach = HC_SET(scene->reach);
    for (block = 0; block < blocks; block++) {
        const int base = HC_BLOCK * block;
        HC_NUMBER sum = HC_SET(0.0);
        hc_bits found = {0, 0, 0};
        int at;
        if (fetch)
            for (at = 0; at < HC_BLOCK; at += 8) {
                HC_FETCH(x_of, base + at + HC_AHEAD);
                HC_FETCH(y_of, base + at + HC_AHEAD);
                HC_FETCH(z_of, base + at + HC_AHEAD);
            }
        for (at = 0; at < HC_BLOCK; at += HC_WIDTH) {
            const HC_NUMBER x = HC_LOAD(x_of + base + at);
            const HC_NUMBER y = HC_LOAD(y_of + base + at);
            const HC_NUMBER z = HC_LOAD(z_of + base + at);
            /* printed from the program "one-line" */
            const HC_NUMBER xx = x * x;
            const HC_NUMBER yy = y * y;
            const HC_NUMBER R = xx + yy;
            const HC_NUMBER T = z * z;
            const HC_NUMBER R_plus_T = R + T;
            const HC_TRUTH in_reach = HC_LE(T, reach);
            const HC_NUMBER rise_beyond_0 = M_beyond_0 * T;
            const HC_NUMBER line_beyond_0 = K_beyond_0 + rise_beyond_0;
            const HC_TRUTH exterior = HC_GT(R, line_beyond_0);
            const HC_NUMBER rise_within_0 = M_within_0 * T;
            const HC_NUMBER line_within_0 = K_within_0 + rise_within_0;
            const HC_TRUTH interior = HC_LT(R, line_within_0);
            const HC_NUMBER rise_under_0 = M_under_0 * T;
            const HC_NUMBER line_under_0 = K_under_0 + rise_under_0;
            const HC_TRUTH is_under = HC_LT(R, line_under_0);
            const HC_NUMBER rise_above_0 = M_above_0 * T;
            const HC_NUMBER line_above_0 = K_above_0 + rise_above_0;
            const HC_TRUTH is_above = HC_GE(R, line_above_0);
            const HC_TRUTH contact_in_reach = HC_AND(is_under, is_above);
            const HC_TRUTH contact = HC_AND(contact_in_reach, in_reach);
            const HC_TRUTH clear = HC_OR(exterior, interior);
            const HC_TRUTH decided = HC_OR(clear, contact);
            /* end of the program "one-line" */
            sum = sum + R_plus_T;
            found.plus |= HC_BITS(contact) << at;
            found.decided |= HC_BITS(decided) << at;
        }
        signs[block].plus = found.plus;
        signs[block].minus = found.minus;
        left[block] = ~(HC_NAME(hc_all_below)(sum, HC_cap) ? found.decided : 0);
    }
}

HC_TARGET static void HC_NAME(hc_two_lines_position)(const hc_scene *scene, int blocks, const double *x_of, const double *y_of,
                                          const double *z_of, int fetch, hc_signs *signs, uint64_t *left) {
    int block;
    const HC_NUMBER K_beyond_1 = HC_SET(scene->beyond[1].K);
    const HC_NUMBER M_beyond_1 = HC_SET(scene->beyond[1].M);
    const HC_NUMBER K_beyond_2 = HC_SET(scene->beyond[2].K);
    const HC_NUMBER M_beyond_2 = HC_SET(scene->beyond[2].M);
    const HC_NUMBER K_within_1 = HC_SET(scene->within[1].K);
    const HC_NUMBER M_within_1 = HC_SET(scene->within[1].M);
    const HC_NUMBER K_within_2 = HC_SET(scene->within[2].K);
    const HC_NUMBER M_within_2 = HC_SET(scene->within[2].M);
    const HC_NUMBER K_under_1 = HC_SET(scene->under[1].K);
    const HC_NUMBER M_under_1 = HC_SET(scene->under[1].M);
    const HC_NUMBER K_under_2 = HC_SET(scene->under[2].K);
    const HC_NUMBER M_under_2 = HC_SET(scene->under[2].M);
    const HC_NUMBER K_above_1 = HC_SET(scene->above[1].K);
    const HC_NUMBER M_above_1 = HC_SET(scene->above[1].M);
    const HC_NUMBER K_above_2 = HC_SET(scene->above[2].K);
    const HC_NUMBER M_above_2 = HC_SET(scene->above[2].M);
    const HC_NUMBER reach = HC_SET(scene->reach);
    for (block = 0; block < blocks; block++) {
        const int base = HC_BLOCK * block;
        HC_NUMBER sum = HC_SET(0.0);
        hc_bits found = {0, 0, 0};
        int at;
        if (fetch)
            for (at = 0; at < HC_BLOCK; at += 8) {
                HC_FETCH(x_of, base + at + HC_AHEAD);
                HC_FETCH(y_of, base + at + HC_AHEAD);
                HC_FETCH(z_of, base + at + HC_AHEAD);
            }
        for (at = 0; at < HC_BLOCK; at += HC_WIDTH) {
            const HC_NUMBER x = HC_LOAD(x_of + base + at);
            const HC_NUMBER y = HC_LOAD(y_of + base + at);
            const HC_NUMBER z = HC_LOAD(z_of + base + at);
            /* printed from the program "two-lines" */
            const HC_NUMBER xx = x * x;
            const HC_NUMBER yy = y * y;
            const HC_NUMBER R = xx + yy;
            const HC_NUMBER T = z * z;
            const HC_NUMBER R_plus_T = R + T;
            const HC_TRUTH in_reach = HC_LE(T, reach);
            const HC_NUMBER rise_beyond_1 = M_beyond_1 * T;
            const HC_NUMBER line_beyond_1 = K_beyond_1 + rise_beyond_1;
            const HC_TRUTH exterior_1 = HC_GT(R, line_beyond_1);
            const HC_NUMBER rise_beyond_2 = M_beyond_2 * T;
            const HC_NUMBER line_beyond_2 = K_beyond_2 + rise_beyond_2;
            const HC_TRUTH exterior_2 = HC_GT(R, line_beyond_2);
            const HC_NUMBER rise_within_1 = M_within_1 * T;
            const HC_NUMBER line_within_1 = K_within_1 + rise_within_1;
            const HC_TRUTH interior_1 = HC_LT(R, line_within_1);
            const HC_NUMBER rise_within_2 = M_within_2 * T;
            const HC_NUMBER line_within_2 = K_within_2 + rise_within_2;
            const HC_TRUTH interior_2 = HC_LT(R, line_within_2);
            const HC_NUMBER rise_under_1 = M_under_1 * T;
            const HC_NUMBER line_under_1 = K_under_1 + rise_under_1;
            const HC_TRUTH is_under_1 = HC_LT(R, line_under_1);
            const HC_NUMBER rise_under_2 = M_under_2 * T;
            const HC_NUMBER line_under_2 = K_under_2 + rise_under_2;
            const HC_TRUTH is_under_2 = HC_LT(R, line_under_2);
            const HC_NUMBER rise_above_1 = M_above_1 * T;
            const HC_NUMBER line_above_1 = K_above_1 + rise_above_1;
            const HC_TRUTH is_above_1 = HC_GE(R, line_above_1);
            const HC_NUMBER rise_above_2 = M_above_2 * T;
            const HC_NUMBER line_above_2 = K_above_2 + rise_above_2;
            const HC_TRUTH is_above_2 = HC_GE(R, line_above_2);
            const HC_TRUTH exterior = HC_OR(exterior_1, exterior_2);
            const HC_TRUTH interior = HC_OR(interior_1, interior_2);
            const HC_TRUTH is_under = HC_AND(is_under_1, is_under_2);
            const HC_TRUTH is_above = HC_AND(is_above_1, is_above_2);
            const HC_TRUTH contact_in_reach = HC_AND(is_under, is_above);
            const HC_TRUTH contact = HC_AND(contact_in_reach, in_reach);
            const HC_TRUTH clear = HC_OR(exterior, interior);
            const HC_TRUTH decided = HC_OR(clear, contact);
            /* end of the program "two-lines" */
            sum = sum + R_plus_T;
            found.plus |= HC_BITS(exterior) << at;
            found.minus |= HC_BITS(interior) << at;
            found.decided |= HC_BITS(decided) << at;
        }
        signs[block].plus = found.plus;
        signs[block].minus = found.minus;
        left[block] = ~(HC_NAME(hc_all_below)(sum, HC_cap) ? found.decided : 0);
    }
}

HC_TARGET static void HC_NAME(hc_two_lines_exterior)(const hc_scene *scene, int blocks, const double *x_of, const double *y_of,
                                          const double *z_of, int fetch, hc_signs *signs, uint64_t *left) {
    int block;
    const HC_NUMBER K_beyond_1 = HC_SET(scene->beyond[1].K);
    const HC_NUMBER M_beyond_1 = HC_SET(scene->beyond[1].M);
    const HC_NUMBER K_beyond_2 = HC_SET(scene->beyond[2].K);
    const HC_NUMBER M_beyond_2 = HC_SET(scene->beyond[2].M);
    const HC_NUMBER K_under_1 = HC_SET(scene->under[1].K);
    const HC_NUMBER M_under_1 = HC_SET(scene->under[1].M);
    const HC_NUMBER K_under_2 = HC_SET(scene->under[2].K);
    const HC_NUMBER M_under_2 = HC_SET(scene->under[2].M);
    const HC_NUMBER reach = HC_SET(scene->reach);
    for (block = 0; block < blocks; block++) {
        const int base = HC_BLOCK * block;
        HC_NUMBER sum = HC_SET(0.0);
        hc_bits found = {0, 0, 0};
        int at;
        if (fetch)
            for (at = 0; at < HC_BLOCK; at += 8) {
                HC_FETCH(x_of, base + at + HC_AHEAD);
                HC_FETCH(y_of, base + at + HC_AHEAD);
                HC_FETCH(z_of, base + at + HC_AHEAD);
            }
        for (at = 0; at < HC_BLOCK; at += HC_WIDTH) {
            const HC_NUMBER x = HC_LOAD(x_of + base + at);
            const HC_NUMBER y = HC_LOAD(y_of + base + at);
            const HC_NUMBER z = HC_LOAD(z_of + base + at);
            /* printed from the program "two-lines" */
            const HC_NUMBER xx = x * x;
            const HC_NUMBER yy = y * y;
            const HC_NUMBER R = xx + yy;
            const HC_NUMBER T = z * z;
            const HC_NUMBER R_plus_T = R + T;
            const HC_TRUTH in_reach = HC_LE(T, reach);
            const HC_NUMBER rise_beyond_1 = M_beyond_1 * T;
            const HC_NUMBER line_beyond_1 = K_beyond_1 + rise_beyond_1;
            const HC_TRUTH exterior_1 = HC_GT(R, line_beyond_1);
            const HC_NUMBER rise_beyond_2 = M_beyond_2 * T;
            const HC_NUMBER line_beyond_2 = K_beyond_2 + rise_beyond_2;
            const HC_TRUTH exterior_2 = HC_GT(R, line_beyond_2);
            const HC_NUMBER rise_under_1 = M_under_1 * T;
            const HC_NUMBER line_under_1 = K_under_1 + rise_under_1;
            const HC_TRUTH is_under_1 = HC_LT(R, line_under_1);
            const HC_NUMBER rise_under_2 = M_under_2 * T;
            const HC_NUMBER line_under_2 = K_under_2 + rise_under_2;
            const HC_TRUTH is_under_2 = HC_LT(R, line_under_2);
            const HC_TRUTH exterior = HC_OR(exterior_1, exterior_2);
            const HC_TRUTH is_under = HC_AND(is_under_1, is_under_2);
            const HC_TRUTH not_exterior = HC_AND(is_under, in_reach);
            const HC_TRUTH exterior_decided = HC_OR(exterior, not_exterior);
            /* end of the program "two-lines" */
            sum = sum + R_plus_T;
            found.plus |= HC_BITS(exterior) << at;
            found.decided |= HC_BITS(exterior_decided) << at;
        }
        signs[block].plus = found.plus;
        signs[block].minus = found.minus;
        left[block] = ~(HC_NAME(hc_all_below)(sum, HC_cap) ? found.decided : 0);
    }
}

HC_TARGET static void HC_NAME(hc_two_lines_interior)(const hc_scene *scene, int blocks, const double *x_of, const double *y_of,
                                          const double *z_of, int fetch, hc_signs *signs, uint64_t *left) {
    int block;
    const HC_NUMBER K_within_1 = HC_SET(scene->within[1].K);
    const HC_NUMBER M_within_1 = HC_SET(scene->within[1].M);
    const HC_NUMBER K_within_2 = HC_SET(scene->within[2].K);
    const HC_NUMBER M_within_2 = HC_SET(scene->within[2].M);
    const HC_NUMBER K_above_1 = HC_SET(scene->above[1].K);
    const HC_NUMBER M_above_1 = HC_SET(scene->above[1].M);
    const HC_NUMBER K_above_2 = HC_SET(scene->above[2].K);
    const HC_NUMBER M_above_2 = HC_SET(scene->above[2].M);
    const HC_NUMBER reach = HC_SET(scene->reach);
    for (block = 0; block < blocks; block++) {
        const int base = HC_BLOCK * block;
        HC_NUMBER sum = HC_SET(0.0);
        hc_bits found = {0, 0, 0};
        int at;
        if (fetch)
            for (at = 0; at < HC_BLOCK; at += 8) {
                HC_FETCH(x_of, base + at + HC_AHEAD);
                HC_FETCH(y_of, base + at + HC_AHEAD);
                HC_FETCH(z_of, base + at + HC_AHEAD);
            }
        for (at = 0; at < HC_BLOCK; at += HC_WIDTH) {
            const HC_NUMBER x = HC_LOAD(x_of + base + at);
            const HC_NUMBER y = HC_LOAD(y_of + base + at);
            const HC_NUMBER z = HC_LOAD(z_of + base + at);
            /* printed from the program "two-lines" */
            const HC_NUMBER xx = x * x;
            const HC_NUMBER yy = y * y;
            const HC_NUMBER R = xx + yy;
            const HC_NUMBER T = z * z;
            const HC_NUMBER R_plus_T = R + T;
            const HC_TRUTH in_reach = HC_LE(T, reach);
            const HC_NUMBER rise_within_1 = M_within_1 * T;
            const HC_NUMBER line_within_1 = K_within_1 + rise_within_1;
            const HC_TRUTH interior_1 = HC_LT(R, line_within_1);
            const HC_NUMBER rise_within_2 = M_within_2 * T;
            const HC_NUMBER line_within_2 = K_within_2 + rise_within_2;
            const HC_TRUTH interior_2 = HC_LT(R, line_within_2);
            const HC_NUMBER rise_above_1 = M_above_1 * T;
            const HC_NUMBER line_above_1 = K_above_1 + rise_above_1;
            const HC_TRUTH is_above_1 = HC_GE(R, line_above_1);
            const HC_NUMBER rise_above_2 = M_above_2 * T;
            const HC_NUMBER line_above_2 = K_above_2 + rise_above_2;
            const HC_TRUTH is_above_2 = HC_GE(R, line_above_2);
            const HC_TRUTH interior = HC_OR(interior_1, interior_2);
            const HC_TRUTH is_above = HC_AND(is_above_1, is_above_2);
            const HC_TRUTH not_interior = HC_AND(is_above, in_reach);
            const HC_TRUTH interior_decided = HC_OR(interior, not_interior);
            /* end of the program "two-lines" */
            sum = sum + R_plus_T;
            found.plus |= HC_BITS(interior) << at;
            found.decided |= HC_BITS(interior_decided) << at;
        }
        signs[block].plus = found.plus;
        signs[block].minus = found.minus;
        left[block] = ~(HC_NAME(hc_all_below)(sum, HC_cap) ? found.decided : 0);
    }
}

HC_TARGET static void HC_NAME(hc_two_lines_contact)(const hc_scene *scene, int blocks, const double *x_of, const double *y_of,
                                          const double *z_of, int fetch, hc_signs *signs, uint64_t *left) {
    int block;
    const HC_NUMBER K_beyond_1 = HC_SET(scene->beyond[1].K);
    const HC_NUMBER M_beyond_1 = HC_SET(scene->beyond[1].M);
    const HC_NUMBER K_beyond_2 = HC_SET(scene->beyond[2].K);
    const HC_NUMBER M_beyond_2 = HC_SET(scene->beyond[2].M);
    const HC_NUMBER K_within_1 = HC_SET(scene->within[1].K);
    const HC_NUMBER M_within_1 = HC_SET(scene->within[1].M);
    const HC_NUMBER K_within_2 = HC_SET(scene->within[2].K);
    const HC_NUMBER M_within_2 = HC_SET(scene->within[2].M);
    const HC_NUMBER K_under_1 = HC_SET(scene->under[1].K);
    const HC_NUMBER M_under_1 = HC_SET(scene->under[1].M);
    const HC_NUMBER K_under_2 = HC_SET(scene->under[2].K);
    const HC_NUMBER M_under_2 = HC_SET(scene->under[2].M);
    const HC_NUMBER K_above_1 = HC_SET(scene->above[1].K);
    const HC_NUMBER M_above_1 = HC_SET(scene->above[1].M);
    const HC_NUMBER K_above_2 = HC_SET(scene->above[2].K);
    const HC_NUMBER M_above_2 = HC_SET(scene->above[2].M);
    const HC_NUMBER reach = HC_SET(scene->reach);
    for (block = 0; block < blocks; block++) {
        const int base = HC_BLOCK * block;
        HC_NUMBER sum = HC_SET(0.0);
        hc_bits found = {0, 0, 0};
        int at;
        if (fetch)
            for (at = 0; at < HC_BLOCK; at += 8) {
                HC_FETCH(x_of, base + at + HC_AHEAD);
                HC_FETCH(y_of, base + at + HC_AHEAD);
                HC_FETCH(z_of, base + at + HC_AHEAD);
            }
        for (at = 0; at < HC_BLOCK; at += HC_WIDTH) {
            const HC_NUMBER x = HC_LOAD(x_of + base + at);
            const HC_NUMBER y = HC_LOAD(y_of + base + at);
            const HC_NUMBER z = HC_LOAD(z_of + base + at);
            /* printed from the program "two-lines" */
            const HC_NUMBER xx = x * x;
            const HC_NUMBER yy = y * y;
            const HC_NUMBER R = xx + yy;
            const HC_NUMBER T = z * z;
            const HC_NUMBER R_plus_T = R + T;
            const HC_TRUTH in_reach = HC_LE(T, reach);
            const HC_NUMBER rise_beyond_1 = M_beyond_1 * T;
            const HC_NUMBER line_beyond_1 = K_beyond_1 + rise_beyond_1;
            const HC_TRUTH exterior_1 = HC_GT(R, line_beyond_1);
            const HC_NUMBER rise_beyond_2 = M_beyond_2 * T;
            const HC_NUMBER line_beyond_2 = K_beyond_2 + rise_beyond_2;
            const HC_TRUTH exterior_2 = HC_GT(R, line_beyond_2);
            const HC_NUMBER rise_within_1 = M_within_1 * T;
            const HC_NUMBER line_within_1 = K_within_1 + rise_within_1;
            const HC_TRUTH interior_1 = HC_LT(R, line_within_1);
            const HC_NUMBER rise_within_2 = M_within_2 * T;
            const HC_NUMBER line_within_2 = K_within_2 + rise_within_2;
            const HC_TRUTH interior_2 = HC_LT(R, line_within_2);
            const HC_NUMBER rise_under_1 = M_under_1 * T;
            const HC_NUMBER line_under_1 = K_under_1 + rise_under_1;
            const HC_TRUTH is_under_1 = HC_LT(R, line_under_1);
            const HC_NUMBER rise_under_2 = M_under_2 * T;
            const HC_NUMBER line_under_2 = K_under_2 + rise_under_2;
            const HC_TRUTH is_under_2 = HC_LT(R, line_under_2);
            const HC_NUMBER rise_above_1 = M_above_1 * T;
            const HC_NUMBER line_above_1 = K_above_1 + rise_above_1;
            const HC_TRUTH is_above_1 = HC_GE(R, line_above_1);
            const HC_NUMBER rise_above_2 = M_above_2 * T;
            const HC_NUMBER line_above_2 = K_above_2 + rise_above_2;
            const HC_TRUTH is_above_2 = HC_GE(R, line_above_2);
            const HC_TRUTH exterior = HC_OR(exterior_1, exterior_2);
            const HC_TRUTH interior = HC_OR(interior_1, interior_2);
            const HC_TRUTH is_under = HC_AND(is_under_1, is_under_2);
            const HC_TRUTH is_above = HC_AND(is_above_1, is_above_2);
            const HC_TRUTH contact_in_reach = HC_AND(is_under, is_above);
            const HC_TRUTH contact = HC_AND(contact_in_reach, in_reach);
            const HC_TRUTH clear = HC_OR(exterior, interior);
            const HC_TRUTH decided = HC_OR(clear, contact);
            /* end of the program "two-lines" */
            sum = sum + R_plus_T;
            found.plus |= HC_BITS(contact) << at;
            found.decided |= HC_BITS(decided) << at;
        }
        signs[block].plus = found.plus;
        signs[block].minus = found.minus;
        left[block] = ~(HC_NAME(hc_all_below)(sum, HC_cap) ? found.decided : 0);
    }
}
/* Near the multiplier at which the dual function of a tilted spheroid is greatest. It proves nothing: any result is safe,
   a good one leaves fewer rows to the integers. The poles are p = A1, A2 and B; C's components in the basis that both
   matrices are diagonal in, squared, are P1, P2 and Q. With S = A1 P1/(A1+l)² + A2 P2/(A2+l)² and T = 1 + B Q/(B-l)²,
   Newton's method solves 1/√S = 1/√T, whose sides are straight for a single term: from `l`, by `turns` steps at most. */
HC_TARGET static inline HC_NUMBER HC_NAME(hc_tilted_multiplier)(HC_NUMBER p, HC_NUMBER s, HC_NUMBER t, HC_NUMBER k0, HC_NUMBER k1,
                                                         HC_NUMBER m, HC_NUMBER radius, HC_NUMBER height, HC_NUMBER P1,
                                                         HC_NUMBER l, int turns) {
    const HC_NUMBER root = HC_SQRT(k1 * k1 + HC_SET(4.0) * k0 * t);
    const HC_NUMBER larger = HC_SET(0.5) * (HC_ABS(k1) + root);
    const HC_NUMBER one_pole = larger * HC_INVERSE(t), other_pole = k0 * HC_INVERSE(larger);
    const HC_TRUTH rising = HC_GE(k1, HC_SET(0.0));
    const HC_NUMBER B = HC_SELECT(rising, one_pole, other_pole), A2 = HC_SELECT(rising, other_pole, one_pole);
    const HC_NUMBER G = s * (radius - P1) - p * height, m_plane = m - t * P1, per_root = HC_INVERSE(root);
    const HC_NUMBER a1 = p * P1, a2 = A2 * HC_ABS(G + A2 * m_plane) * per_root, b = B * HC_ABS(B * m_plane - G) * per_root;
    const HC_NUMBER least = HC_SET(-0.999) * HC_MIN(p, A2), greatest = HC_SET(0.999) * B;
    int turn;
    for (turn = 0; turn < turns; turn++) {
        const HC_NUMBER from_A1 = p + l, from_A2 = A2 + l, from_B = B - l, from_both = from_A1 * from_A2;
        const HC_NUMBER inverse = HC_INVERSE(from_both * from_B), inverse_B = inverse * from_B;
        const HC_NUMBER i1 = inverse_B * from_A2, i2 = inverse_B * from_A1, i3 = inverse * from_both;
        const HC_NUMBER S1 = a1 * i1 * i1, S2 = a2 * i2 * i2, T3 = b * i3 * i3;
        const HC_NUMBER S = S1 + S2, T = HC_SET(1.0) + T3, root_S = HC_SQRT(S), root_T = HC_SQRT(T);
        const HC_NUMBER slope = (S1 * i1 + S2 * i2) * T * root_T + T3 * i3 * S * root_S;
        const HC_NUMBER moved = l + (root_S - root_T) * S * T * HC_INVERSE(slope);
        const HC_NUMBER next = HC_MIN(HC_MAX(moved, least), greatest); /* NaN becomes the first pole */
        const HC_NUMBER change = HC_ABS(next - l);
        l = next;
        if (!HC_BITS(HC_GT(change, HC_SET(HC_settled) * HC_ABS(l)))) break;
    }
    return l;
}

/* Tilted rows of ten, by columns as in hc_certified. */
HC_TARGET static hc_bits HC_NAME(hc_tilted)(const double *columns, size_t stride, int count) {
    hc_bits found = {0, 0, 0};
    int at;
    const HC_NUMBER u_p_l = HC_SET(HC_u_p_l);
    const HC_NUMBER u_k = HC_SET(HC_u_k);
    const HC_NUMBER u_d_l = HC_SET(HC_u_d_l);
    const HC_NUMBER u_F = HC_SET(HC_u_F);
    const HC_NUMBER u_psi = HC_SET(HC_u_psi);
    const HC_NUMBER less_sure = HC_SET(HC_less_sure);
    const HC_NUMBER least_b = HC_SET(HC_least_b);
    const HC_NUMBER greatest_b = HC_SET(HC_greatest_b);
    const HC_NUMBER least_square = HC_SET(HC_least_square);
    const HC_NUMBER greatest_square = HC_SET(HC_greatest_square);
    const HC_NUMBER farthest_square = HC_SET(HC_farthest_square);
    const HC_NUMBER least_axis = HC_SET(HC_least_axis);
    const HC_NUMBER greatest_axis = HC_SET(HC_greatest_axis);
    const HC_NUMBER greatest_l = HC_SET(HC_greatest_l);
    for (at = 0; at < count; at += HC_WIDTH) {
        const HC_NUMBER alpha = HC_LOAD(columns + 0 * stride + at);
        const HC_NUMBER gamma = HC_LOAD(columns + 1 * stride + at);
        const HC_NUMBER b = HC_LOAD(columns + 2 * stride + at);
        const HC_NUMBER d = HC_LOAD(columns + 3 * stride + at);
        const HC_NUMBER x = HC_LOAD(columns + 4 * stride + at);
        const HC_NUMBER y = HC_LOAD(columns + 5 * stride + at);
        const HC_NUMBER z = HC_LOAD(columns + 6 * stride + at);
        const HC_NUMBER axis_x = HC_LOAD(columns + 7 * stride + at);
        const HC_NUMBER axis_y = HC_LOAD(columns + 8 * stride + at);
        const HC_NUMBER axis_z = HC_LOAD(columns + 9 * stride + at);
        /* printed from the program "tilted", its first part */
        const HC_NUMBER r = HC_SET(1.0) / b;
        const HC_NUMBER alpha_r = alpha * r;
        const HC_NUMBER p = alpha_r * alpha_r;
        const HC_NUMBER gamma_r = gamma * r;
        const HC_NUMBER s = gamma_r * gamma_r;
        const HC_NUMBER d_r = d * r;
        const HC_NUMBER t = d_r * d_r;
        const HC_NUMBER x_r = x * r;
        const HC_NUMBER y_r = y * r;
        const HC_NUMBER z_r = z * r;
        const HC_NUMBER axis_xx = axis_x * axis_x;
        const HC_NUMBER axis_yy = axis_y * axis_y;
        const HC_NUMBER level = axis_xx + axis_yy;
        const HC_NUMBER upward = axis_z * axis_z;
        const HC_NUMBER w = level + upward;
        const HC_NUMBER h = level / w;
        const HC_NUMBER c = upward / w;
        const HC_NUMBER x_y = axis_x * y_r;
        const HC_NUMBER y_x = axis_y * x_r;
        const HC_NUMBER cross = x_y - y_x;
        const HC_NUMBER x_x = axis_x * x_r;
        const HC_NUMBER y_y = axis_y * y_r;
        const HC_NUMBER z_z = axis_z * z_r;
        const HC_NUMBER along_level = x_x + y_y;
        const HC_NUMBER along_axis = along_level + z_z;
        const HC_NUMBER cross_squared = cross * cross;
        const HC_NUMBER cross_part = cross_squared / w;
        const HC_NUMBER axis_squared = along_axis * along_axis;
        const HC_NUMBER axis_part = axis_squared / w;
        const HC_NUMBER xx = x_r * x_r;
        const HC_NUMBER yy = y_r * y_r;
        const HC_NUMBER radius = xx + yy;
        const HC_NUMBER height = z_r * z_r;
        const HC_NUMBER distance = radius + height;
        const HC_NUMBER t_1 = t - HC_SET(1.0);
        const HC_NUMBER s_p = s + p;
        const HC_NUMBER t_1_s_p = t_1 * s_p;
        const HC_NUMBER E = t_1_s_p * cross_part;
        const HC_NUMBER s_radius = s * radius;
        const HC_NUMBER p_height = p * height;
        const HC_NUMBER G = s_radius - p_height;
        const HC_NUMBER t_distance = t * distance;
        const HC_NUMBER t_1_axis = t_1 * axis_part;
        const HC_NUMBER m = t_distance - t_1_axis;
        const HC_NUMBER k0 = p * s;
        const HC_NUMBER t_h = t * h;
        const HC_NUMBER along = t_h + c;
        const HC_NUMBER t_c = t * c;
        const HC_NUMBER across = t_c + h;
        const HC_NUMBER s_along = s * along;
        const HC_NUMBER p_across = p * across;
        const HC_NUMBER k1 = s_along - p_across;
        /* end of the program "tilted", its first part */
        const HC_NUMBER P1 = HC_MAX(cross_squared / level, HC_SET(0.0)); /* 0 for 0/0, where level underflows */
        const uint64_t asked = count - at < HC_WIDTH ? (UINT64_C(1) << (count - at)) - 1 : (UINT64_C(1) << HC_WIDTH) - 1;
        HC_NUMBER l = HC_SET(0.0);
        int taken, turns;
        /* Divisions and roots, two of each a step, are most of what a row costs. Of rows that are uniform in a box about the paper's
           tower, one step decides 98 %, two all but 3 in 10⁵; rows near contact take the others at once. */
        for (taken = 0; taken < HC_TURNS; taken += turns) {
            turns = taken < 2 ? 1 : HC_TURNS - taken;
            l = HC_NAME(hc_tilted_multiplier)(p, s, t, k0, k1, m, radius, height, P1, l, turns);
            /* printed from the program "tilted", the rest */
            const HC_NUMBER p_l = p + l;
            const HC_NUMBER t_l = t * l;
            const HC_NUMBER k1_tl = k1 - t_l;
            const HC_NUMBER k1_tl_l = k1_tl * l;
            const HC_NUMBER k = k0 + k1_tl_l;
            const HC_NUMBER m_l = m * l;
            const HC_NUMBER g = G - m_l;
            const HC_NUMBER E_l = E * l;
            const HC_NUMBER p_l_g = p_l * g;
            const HC_NUMBER N = E_l + p_l_g;
            const HC_NUMBER l_N = l * N;
            const HC_NUMBER d_l = p_l * k;
            const HC_NUMBER one_l = HC_SET(1.0) + l;
            const HC_NUMBER one_l_d = one_l * d_l;
            const HC_NUMBER F = l_N - one_l_d;
            const HC_NUMBER p_l_m = p_l * m;
            const HC_NUMBER E_g = E + g;
            const HC_NUMBER N_slope = E_g - p_l_m;
            const HC_NUMBER k_slope = k1_tl - t_l;
            const HC_NUMBER p_l_k_slope = p_l * k_slope;
            const HC_NUMBER d_slope = k + p_l_k_slope;
            const HC_NUMBER l_N_slope = l * N_slope;
            const HC_NUMBER N_both = N + l_N_slope;
            const HC_NUMBER N_both_d = N_both - d_l;
            const HC_NUMBER gain = d_l * N_both_d;
            const HC_NUMBER loss = l_N * d_slope;
            const HC_NUMBER psi = gain - loss;
            const HC_NUMBER magnitude_x = HC_ABS(x);
            const HC_NUMBER magnitude_y = HC_ABS(y);
            const HC_NUMBER magnitude_z = HC_ABS(z);
            const HC_NUMBER magnitude_axis_x = HC_ABS(axis_x);
            const HC_NUMBER magnitude_axis_y = HC_ABS(axis_y);
            const HC_NUMBER magnitude_axis_z = HC_ABS(axis_z);
            const HC_NUMBER magnitude_l = HC_ABS(l);
            const HC_NUMBER magnitude_r = HC_SET(1.0) / b;
            const HC_NUMBER magnitude_alpha_r = alpha * magnitude_r;
            const HC_NUMBER magnitude_p = magnitude_alpha_r * magnitude_alpha_r;
            const HC_NUMBER magnitude_gamma_r = gamma * magnitude_r;
            const HC_NUMBER magnitude_s = magnitude_gamma_r * magnitude_gamma_r;
            const HC_NUMBER magnitude_d_r = d * magnitude_r;
            const HC_NUMBER magnitude_t = magnitude_d_r * magnitude_d_r;
            const HC_NUMBER magnitude_x_r = magnitude_x * magnitude_r;
            const HC_NUMBER magnitude_y_r = magnitude_y * magnitude_r;
            const HC_NUMBER magnitude_z_r = magnitude_z * magnitude_r;
            const HC_NUMBER magnitude_axis_xx = magnitude_axis_x * magnitude_axis_x;
            const HC_NUMBER magnitude_axis_yy = magnitude_axis_y * magnitude_axis_y;
            const HC_NUMBER magnitude_level = magnitude_axis_xx + magnitude_axis_yy;
            const HC_NUMBER magnitude_upward = magnitude_axis_z * magnitude_axis_z;
            const HC_NUMBER magnitude_w = magnitude_level + magnitude_upward;
            const HC_NUMBER magnitude_h = magnitude_level / magnitude_w;
            const HC_NUMBER magnitude_c = magnitude_upward / magnitude_w;
            const HC_NUMBER magnitude_x_y = magnitude_axis_x * magnitude_y_r;
            const HC_NUMBER magnitude_y_x = magnitude_axis_y * magnitude_x_r;
            const HC_NUMBER magnitude_cross = magnitude_x_y + magnitude_y_x;
            const HC_NUMBER magnitude_x_x = magnitude_axis_x * magnitude_x_r;
            const HC_NUMBER magnitude_y_y = magnitude_axis_y * magnitude_y_r;
            const HC_NUMBER magnitude_z_z = magnitude_axis_z * magnitude_z_r;
            const HC_NUMBER magnitude_along_level = magnitude_x_x + magnitude_y_y;
            const HC_NUMBER magnitude_along_axis = magnitude_along_level + magnitude_z_z;
            const HC_NUMBER magnitude_cross_squared = magnitude_cross * magnitude_cross;
            const HC_NUMBER magnitude_cross_part = magnitude_cross_squared / magnitude_w;
            const HC_NUMBER magnitude_axis_squared = magnitude_along_axis * magnitude_along_axis;
            const HC_NUMBER magnitude_axis_part = magnitude_axis_squared / magnitude_w;
            const HC_NUMBER magnitude_xx = magnitude_x_r * magnitude_x_r;
            const HC_NUMBER magnitude_yy = magnitude_y_r * magnitude_y_r;
            const HC_NUMBER magnitude_radius = magnitude_xx + magnitude_yy;
            const HC_NUMBER magnitude_height = magnitude_z_r * magnitude_z_r;
            const HC_NUMBER magnitude_distance = magnitude_radius + magnitude_height;
            const HC_NUMBER magnitude_t_1 = magnitude_t + HC_SET(1.0);
            const HC_NUMBER magnitude_s_p = magnitude_s + magnitude_p;
            const HC_NUMBER magnitude_t_1_s_p = magnitude_t_1 * magnitude_s_p;
            const HC_NUMBER magnitude_E = magnitude_t_1_s_p * magnitude_cross_part;
            const HC_NUMBER magnitude_s_radius = magnitude_s * magnitude_radius;
            const HC_NUMBER magnitude_p_height = magnitude_p * magnitude_height;
            const HC_NUMBER magnitude_G = magnitude_s_radius + magnitude_p_height;
            const HC_NUMBER magnitude_t_distance = magnitude_t * magnitude_distance;
            const HC_NUMBER magnitude_t_1_axis = magnitude_t_1 * magnitude_axis_part;
            const HC_NUMBER magnitude_m = magnitude_t_distance + magnitude_t_1_axis;
            const HC_NUMBER magnitude_k0 = magnitude_p * magnitude_s;
            const HC_NUMBER magnitude_t_h = magnitude_t * magnitude_h;
            const HC_NUMBER magnitude_along = magnitude_t_h + magnitude_c;
            const HC_NUMBER magnitude_t_c = magnitude_t * magnitude_c;
            const HC_NUMBER magnitude_across = magnitude_t_c + magnitude_h;
            const HC_NUMBER magnitude_s_along = magnitude_s * magnitude_along;
            const HC_NUMBER magnitude_p_across = magnitude_p * magnitude_across;
            const HC_NUMBER magnitude_k1 = magnitude_s_along + magnitude_p_across;
            const HC_NUMBER magnitude_p_l = magnitude_p + magnitude_l;
            const HC_NUMBER magnitude_t_l = magnitude_t * magnitude_l;
            const HC_NUMBER magnitude_k1_tl = magnitude_k1 + magnitude_t_l;
            const HC_NUMBER magnitude_k1_tl_l = magnitude_k1_tl * magnitude_l;
            const HC_NUMBER magnitude_k = magnitude_k0 + magnitude_k1_tl_l;
            const HC_NUMBER magnitude_m_l = magnitude_m * magnitude_l;
            const HC_NUMBER magnitude_g = magnitude_G + magnitude_m_l;
            const HC_NUMBER magnitude_E_l = magnitude_E * magnitude_l;
            const HC_NUMBER magnitude_p_l_g = magnitude_p_l * magnitude_g;
            const HC_NUMBER magnitude_N = magnitude_E_l + magnitude_p_l_g;
            const HC_NUMBER magnitude_l_N = magnitude_l * magnitude_N;
            const HC_NUMBER magnitude_d_l = magnitude_p_l * magnitude_k;
            const HC_NUMBER magnitude_one_l = HC_SET(1.0) + magnitude_l;
            const HC_NUMBER magnitude_one_l_d = magnitude_one_l * magnitude_d_l;
            const HC_NUMBER magnitude_F = magnitude_l_N + magnitude_one_l_d;
            const HC_NUMBER magnitude_p_l_m = magnitude_p_l * magnitude_m;
            const HC_NUMBER magnitude_E_g = magnitude_E + magnitude_g;
            const HC_NUMBER magnitude_N_slope = magnitude_E_g + magnitude_p_l_m;
            const HC_NUMBER magnitude_k_slope = magnitude_k1_tl + magnitude_t_l;
            const HC_NUMBER magnitude_p_l_k_slope = magnitude_p_l * magnitude_k_slope;
            const HC_NUMBER magnitude_d_slope = magnitude_k + magnitude_p_l_k_slope;
            const HC_NUMBER magnitude_l_N_slope = magnitude_l * magnitude_N_slope;
            const HC_NUMBER magnitude_N_both = magnitude_N + magnitude_l_N_slope;
            const HC_NUMBER magnitude_N_both_d = magnitude_N_both + magnitude_d_l;
            const HC_NUMBER magnitude_gain = magnitude_d_l * magnitude_N_both_d;
            const HC_NUMBER magnitude_loss = magnitude_l_N * magnitude_d_slope;
            const HC_NUMBER magnitude_psi = magnitude_gain + magnitude_loss;
            const HC_NUMBER e_pl = u_p_l * magnitude_p_l;
            const HC_NUMBER e_k = u_k * magnitude_k;
            const HC_NUMBER e_d = u_d_l * magnitude_d_l;
            const HC_NUMBER e_F = u_F * magnitude_F;
            const HC_NUMBER e_psi = u_psi * magnitude_psi;
            const HC_TRUTH alpha_positive = HC_GT(alpha, HC_SET(0.0));
            const HC_TRUTH gamma_positive = HC_GT(gamma, HC_SET(0.0));
            const HC_TRUTH d_positive = HC_GT(d, HC_SET(0.0));
            const HC_TRUTH b_not_small = HC_GT(b, least_b);
            const HC_TRUTH b_not_large = HC_LT(b, greatest_b);
            const HC_TRUTH p_not_small = HC_GT(p, least_square);
            const HC_TRUTH p_not_large = HC_LT(p, greatest_square);
            const HC_TRUTH s_not_small = HC_GT(s, least_square);
            const HC_TRUTH s_not_large = HC_LT(s, greatest_square);
            const HC_TRUTH t_not_small = HC_GT(t, least_square);
            const HC_TRUTH t_not_large = HC_LT(t, greatest_square);
            const HC_TRUTH w_not_small = HC_GT(w, least_axis);
            const HC_TRUTH w_not_large = HC_LT(w, greatest_axis);
            const HC_TRUTH not_too_far = HC_LT(distance, farthest_square);
            const HC_NUMBER size_l = HC_ABS(l);
            const HC_TRUTH l_usable = HC_LT(size_l, greatest_l);
            const HC_TRUTH b_usable = HC_AND(b_not_small, b_not_large);
            const HC_TRUTH p_usable = HC_AND(p_not_small, p_not_large);
            const HC_TRUTH s_usable = HC_AND(s_not_small, s_not_large);
            const HC_TRUTH t_usable = HC_AND(t_not_small, t_not_large);
            const HC_TRUTH w_usable = HC_AND(w_not_small, w_not_large);
            const HC_TRUTH ps_usable = HC_AND(p_usable, s_usable);
            const HC_TRUTH bt_usable = HC_AND(b_usable, t_usable);
            const HC_TRUTH radial_positive = HC_AND(alpha_positive, gamma_positive);
            const HC_TRUTH all_positive = HC_AND(radial_positive, d_positive);
            const HC_TRUTH squares_usable = HC_AND(ps_usable, bt_usable);
            const HC_TRUTH sizes_usable = HC_AND(squares_usable, all_positive);
            const HC_TRUTH place_usable = HC_AND(not_too_far, l_usable);
            const HC_TRUTH rest_usable = HC_AND(w_usable, place_usable);
            const HC_TRUTH usable = HC_AND(sizes_usable, rest_usable);
            const HC_TRUTH before_B_and_A2 = HC_GT(k, e_k);
            const HC_TRUTH before_A1 = HC_GT(p_l, e_pl);
            const HC_TRUTH between_poles = HC_AND(before_B_and_A2, before_A1);
            const HC_TRUTH inside = HC_AND(usable, between_poles);
            const HC_TRUTH phi_positive = HC_GT(F, e_F);
            const HC_TRUTH clear = HC_AND(phi_positive, inside);
            const HC_TRUTH on_side_of_B = HC_GT(l, HC_SET(0.0));
            const HC_TRUTH on_side_of_A = HC_LT(l, HC_SET(0.0));
            const HC_TRUTH exterior = HC_AND(clear, on_side_of_B);
            const HC_TRUTH interior = HC_AND(clear, on_side_of_A);
            const HC_NUMBER minus_F = -F;
            const HC_NUMBER minus_F_least = minus_F - e_F;
            const HC_TRUTH phi_negative = HC_GT(minus_F_least, HC_SET(0.0));
            const HC_NUMBER d_least = d_l - e_d;
            const HC_NUMBER room = minus_F_least * d_least;
            const HC_NUMBER room_least = less_sure * room;
            const HC_NUMBER size_psi = HC_ABS(psi);
            const HC_NUMBER psi_most = size_psi + e_psi;
            const HC_NUMBER B_most = s_along / t;
            const HC_NUMBER width = p + B_most;
            const HC_NUMBER slope_most = psi_most * width;
            const HC_TRUTH below_tangent = HC_LT(slope_most, room_least);
            const HC_TRUTH below = HC_AND(below_tangent, phi_negative);
            const HC_TRUTH contact = HC_AND(below, inside);
            const HC_TRUTH decided = HC_OR(clear, contact);
            /* end of the program "tilted", the rest */
            found.plus |= HC_BITS(exterior) << at; /* proved, as all that is decided: no later step takes it back */
            found.minus |= HC_BITS(interior) << at;
            found.decided |= HC_BITS(decided) << at;
            if (!(asked & ~HC_BITS(decided))) break;
        }
    }
    return found;
}

/* As the functions of lines, with half spaces of one orientation. */
HC_TARGET static void HC_NAME(hc_one_plane)(const hc_tilted_scene *scene, int blocks, const double *x_of, const double *y_of,
                                      const double *z_of, int fetch, hc_signs *signs, uint64_t *left) {
    int block;
    const HC_NUMBER a_beyond_0 = HC_SET(scene->beyond[0].a);
    const HC_NUMBER K_beyond_0 = HC_SET(scene->beyond[0].K);
    const HC_NUMBER M_beyond_0 = HC_SET(scene->beyond[0].M);
    const HC_NUMBER a_within_0 = HC_SET(scene->within[0].a);
    const HC_NUMBER K_within_0 = HC_SET(scene->within[0].K);
    const HC_NUMBER M_within_0 = HC_SET(scene->within[0].M);
    const HC_NUMBER a_under_0 = HC_SET(scene->under[0].a);
    const HC_NUMBER K_under_0 = HC_SET(scene->under[0].K);
    const HC_NUMBER M_under_0 = HC_SET(scene->under[0].M);
    const HC_NUMBER a_above_0 = HC_SET(scene->above[0].a);
    const HC_NUMBER K_above_0 = HC_SET(scene->above[0].K);
    const HC_NUMBER M_above_0 = HC_SET(scene->above[0].M);
    const HC_NUMBER r1_x = HC_SET(scene->r1_x);
    const HC_NUMBER r1_y = HC_SET(scene->r1_y);
    const HC_NUMBER r2_x = HC_SET(scene->r2_x);
    const HC_NUMBER r2_y = HC_SET(scene->r2_y);
    const HC_NUMBER r2_z = HC_SET(scene->r2_z);
    const HC_NUMBER r3_x = HC_SET(scene->r3_x);
    const HC_NUMBER r3_y = HC_SET(scene->r3_y);
    const HC_NUMBER r3_z = HC_SET(scene->r3_z);
    const HC_NUMBER reach = HC_SET(scene->reach);
    for (block = 0; block < blocks; block++) {
        const int base = HC_BLOCK * block;
        HC_NUMBER sum = HC_SET(0.0);
        hc_bits found = {0, 0, 0};
        int at;
        if (fetch)
            for (at = 0; at < HC_BLOCK; at += 8) {
                HC_FETCH(x_of, base + at + HC_AHEAD);
                HC_FETCH(y_of, base + at + HC_AHEAD);
                HC_FETCH(z_of, base + at + HC_AHEAD);
            }
        for (at = 0; at < HC_BLOCK; at += HC_WIDTH) {
            const HC_NUMBER x = HC_LOAD(x_of + base + at);
            const HC_NUMBER y = HC_LOAD(y_of + base + at);
            const HC_NUMBER z = HC_LOAD(z_of + base + at);
            /* printed from the program "one-plane" */
            const HC_NUMBER xx = x * x;
            const HC_NUMBER yy = y * y;
            const HC_NUMBER zz = z * z;
            const HC_NUMBER radius = xx + yy;
            const HC_NUMBER distance = radius + zz;
            const HC_NUMBER x1 = r1_x * x;
            const HC_NUMBER y1 = r1_y * y;
            const HC_NUMBER c1 = x1 + y1;
            const HC_NUMBER x2 = r2_x * x;
            const HC_NUMBER y2 = r2_y * y;
            const HC_NUMBER xy2 = x2 + y2;
            const HC_NUMBER z2 = r2_z * z;
            const HC_NUMBER c2 = xy2 + z2;
            const HC_NUMBER x3 = r3_x * x;
            const HC_NUMBER y3 = r3_y * y;
            const HC_NUMBER xy3 = x3 + y3;
            const HC_NUMBER z3 = r3_z * z;
            const HC_NUMBER c3 = xy3 + z3;
            const HC_NUMBER P1 = c1 * c1;
            const HC_NUMBER P2 = c2 * c2;
            const HC_NUMBER Q = c3 * c3;
            const HC_TRUTH in_reach = HC_LE(Q, reach);
            const HC_NUMBER part_beyond_0 = a_beyond_0 * P2;
            const HC_NUMBER place_beyond_0 = P1 + part_beyond_0;
            const HC_NUMBER rise_beyond_0 = M_beyond_0 * Q;
            const HC_NUMBER line_beyond_0 = K_beyond_0 + rise_beyond_0;
            const HC_TRUTH exterior = HC_GT(place_beyond_0, line_beyond_0);
            const HC_NUMBER part_within_0 = a_within_0 * P2;
            const HC_NUMBER place_within_0 = P1 + part_within_0;
            const HC_NUMBER rise_within_0 = M_within_0 * Q;
            const HC_NUMBER line_within_0 = K_within_0 + rise_within_0;
            const HC_TRUTH interior = HC_LT(place_within_0, line_within_0);
            const HC_NUMBER part_under_0 = a_under_0 * P2;
            const HC_NUMBER place_under_0 = P1 + part_under_0;
            const HC_NUMBER rise_under_0 = M_under_0 * Q;
            const HC_NUMBER line_under_0 = K_under_0 + rise_under_0;
            const HC_TRUTH is_under = HC_LT(place_under_0, line_under_0);
            const HC_NUMBER part_above_0 = a_above_0 * P2;
            const HC_NUMBER place_above_0 = P1 + part_above_0;
            const HC_NUMBER rise_above_0 = M_above_0 * Q;
            const HC_NUMBER line_above_0 = K_above_0 + rise_above_0;
            const HC_TRUTH is_above = HC_GE(place_above_0, line_above_0);
            const HC_TRUTH contact_in_reach = HC_AND(is_under, is_above);
            const HC_TRUTH contact = HC_AND(contact_in_reach, in_reach);
            const HC_TRUTH clear = HC_OR(exterior, interior);
            const HC_TRUTH decided = HC_OR(clear, contact);
            /* end of the program "one-plane" */
            sum = sum + distance;
            found.plus |= HC_BITS(exterior) << at;
            found.minus |= HC_BITS(interior) << at;
            found.decided |= HC_BITS(decided) << at;
        }
        signs[block].plus = found.plus;
        signs[block].minus = found.minus;
        left[block] = ~(HC_NAME(hc_all_below)(sum, HC_cap) ? found.decided : 0);
    }
}

HC_TARGET static void HC_NAME(hc_two_planes)(const hc_tilted_scene *scene, int blocks, const double *x_of, const double *y_of,
                                      const double *z_of, int fetch, hc_signs *signs, uint64_t *left) {
    int block;
    const HC_NUMBER a_beyond_1 = HC_SET(scene->beyond[1].a);
    const HC_NUMBER K_beyond_1 = HC_SET(scene->beyond[1].K);
    const HC_NUMBER M_beyond_1 = HC_SET(scene->beyond[1].M);
    const HC_NUMBER a_beyond_2 = HC_SET(scene->beyond[2].a);
    const HC_NUMBER K_beyond_2 = HC_SET(scene->beyond[2].K);
    const HC_NUMBER M_beyond_2 = HC_SET(scene->beyond[2].M);
    const HC_NUMBER a_within_1 = HC_SET(scene->within[1].a);
    const HC_NUMBER K_within_1 = HC_SET(scene->within[1].K);
    const HC_NUMBER M_within_1 = HC_SET(scene->within[1].M);
    const HC_NUMBER a_within_2 = HC_SET(scene->within[2].a);
    const HC_NUMBER K_within_2 = HC_SET(scene->within[2].K);
    const HC_NUMBER M_within_2 = HC_SET(scene->within[2].M);
    const HC_NUMBER a_under_1 = HC_SET(scene->under[1].a);
    const HC_NUMBER K_under_1 = HC_SET(scene->under[1].K);
    const HC_NUMBER M_under_1 = HC_SET(scene->under[1].M);
    const HC_NUMBER a_under_2 = HC_SET(scene->under[2].a);
    const HC_NUMBER K_under_2 = HC_SET(scene->under[2].K);
    const HC_NUMBER M_under_2 = HC_SET(scene->under[2].M);
    const HC_NUMBER a_above_1 = HC_SET(scene->above[1].a);
    const HC_NUMBER K_above_1 = HC_SET(scene->above[1].K);
    const HC_NUMBER M_above_1 = HC_SET(scene->above[1].M);
    const HC_NUMBER a_above_2 = HC_SET(scene->above[2].a);
    const HC_NUMBER K_above_2 = HC_SET(scene->above[2].K);
    const HC_NUMBER M_above_2 = HC_SET(scene->above[2].M);
    const HC_NUMBER r1_x = HC_SET(scene->r1_x);
    const HC_NUMBER r1_y = HC_SET(scene->r1_y);
    const HC_NUMBER r2_x = HC_SET(scene->r2_x);
    const HC_NUMBER r2_y = HC_SET(scene->r2_y);
    const HC_NUMBER r2_z = HC_SET(scene->r2_z);
    const HC_NUMBER r3_x = HC_SET(scene->r3_x);
    const HC_NUMBER r3_y = HC_SET(scene->r3_y);
    const HC_NUMBER r3_z = HC_SET(scene->r3_z);
    const HC_NUMBER reach = HC_SET(scene->reach);
    for (block = 0; block < blocks; block++) {
        const int base = HC_BLOCK * block;
        HC_NUMBER sum = HC_SET(0.0);
        hc_bits found = {0, 0, 0};
        int at;
        if (fetch)
            for (at = 0; at < HC_BLOCK; at += 8) {
                HC_FETCH(x_of, base + at + HC_AHEAD);
                HC_FETCH(y_of, base + at + HC_AHEAD);
                HC_FETCH(z_of, base + at + HC_AHEAD);
            }
        for (at = 0; at < HC_BLOCK; at += HC_WIDTH) {
            const HC_NUMBER x = HC_LOAD(x_of + base + at);
            const HC_NUMBER y = HC_LOAD(y_of + base + at);
            const HC_NUMBER z = HC_LOAD(z_of + base + at);
            /* printed from the program "two-planes" */
            const HC_NUMBER xx = x * x;
            const HC_NUMBER yy = y * y;
            const HC_NUMBER zz = z * z;
            const HC_NUMBER radius = xx + yy;
            const HC_NUMBER distance = radius + zz;
            const HC_NUMBER x1 = r1_x * x;
            const HC_NUMBER y1 = r1_y * y;
            const HC_NUMBER c1 = x1 + y1;
            const HC_NUMBER x2 = r2_x * x;
            const HC_NUMBER y2 = r2_y * y;
            const HC_NUMBER xy2 = x2 + y2;
            const HC_NUMBER z2 = r2_z * z;
            const HC_NUMBER c2 = xy2 + z2;
            const HC_NUMBER x3 = r3_x * x;
            const HC_NUMBER y3 = r3_y * y;
            const HC_NUMBER xy3 = x3 + y3;
            const HC_NUMBER z3 = r3_z * z;
            const HC_NUMBER c3 = xy3 + z3;
            const HC_NUMBER P1 = c1 * c1;
            const HC_NUMBER P2 = c2 * c2;
            const HC_NUMBER Q = c3 * c3;
            const HC_TRUTH in_reach = HC_LE(Q, reach);
            const HC_NUMBER part_beyond_1 = a_beyond_1 * P2;
            const HC_NUMBER place_beyond_1 = P1 + part_beyond_1;
            const HC_NUMBER rise_beyond_1 = M_beyond_1 * Q;
            const HC_NUMBER line_beyond_1 = K_beyond_1 + rise_beyond_1;
            const HC_TRUTH exterior_1 = HC_GT(place_beyond_1, line_beyond_1);
            const HC_NUMBER part_beyond_2 = a_beyond_2 * P2;
            const HC_NUMBER place_beyond_2 = P1 + part_beyond_2;
            const HC_NUMBER rise_beyond_2 = M_beyond_2 * Q;
            const HC_NUMBER line_beyond_2 = K_beyond_2 + rise_beyond_2;
            const HC_TRUTH exterior_2 = HC_GT(place_beyond_2, line_beyond_2);
            const HC_NUMBER part_within_1 = a_within_1 * P2;
            const HC_NUMBER place_within_1 = P1 + part_within_1;
            const HC_NUMBER rise_within_1 = M_within_1 * Q;
            const HC_NUMBER line_within_1 = K_within_1 + rise_within_1;
            const HC_TRUTH interior_1 = HC_LT(place_within_1, line_within_1);
            const HC_NUMBER part_within_2 = a_within_2 * P2;
            const HC_NUMBER place_within_2 = P1 + part_within_2;
            const HC_NUMBER rise_within_2 = M_within_2 * Q;
            const HC_NUMBER line_within_2 = K_within_2 + rise_within_2;
            const HC_TRUTH interior_2 = HC_LT(place_within_2, line_within_2);
            const HC_NUMBER part_under_1 = a_under_1 * P2;
            const HC_NUMBER place_under_1 = P1 + part_under_1;
            const HC_NUMBER rise_under_1 = M_under_1 * Q;
            const HC_NUMBER line_under_1 = K_under_1 + rise_under_1;
            const HC_TRUTH is_under_1 = HC_LT(place_under_1, line_under_1);
            const HC_NUMBER part_under_2 = a_under_2 * P2;
            const HC_NUMBER place_under_2 = P1 + part_under_2;
            const HC_NUMBER rise_under_2 = M_under_2 * Q;
            const HC_NUMBER line_under_2 = K_under_2 + rise_under_2;
            const HC_TRUTH is_under_2 = HC_LT(place_under_2, line_under_2);
            const HC_NUMBER part_above_1 = a_above_1 * P2;
            const HC_NUMBER place_above_1 = P1 + part_above_1;
            const HC_NUMBER rise_above_1 = M_above_1 * Q;
            const HC_NUMBER line_above_1 = K_above_1 + rise_above_1;
            const HC_TRUTH is_above_1 = HC_GE(place_above_1, line_above_1);
            const HC_NUMBER part_above_2 = a_above_2 * P2;
            const HC_NUMBER place_above_2 = P1 + part_above_2;
            const HC_NUMBER rise_above_2 = M_above_2 * Q;
            const HC_NUMBER line_above_2 = K_above_2 + rise_above_2;
            const HC_TRUTH is_above_2 = HC_GE(place_above_2, line_above_2);
            const HC_TRUTH exterior = HC_OR(exterior_1, exterior_2);
            const HC_TRUTH interior = HC_OR(interior_1, interior_2);
            const HC_TRUTH is_under = HC_AND(is_under_1, is_under_2);
            const HC_TRUTH is_above = HC_AND(is_above_1, is_above_2);
            const HC_TRUTH contact_in_reach = HC_AND(is_under, is_above);
            const HC_TRUTH contact = HC_AND(contact_in_reach, in_reach);
            const HC_TRUTH clear = HC_OR(exterior, interior);
            const HC_TRUTH decided = HC_OR(clear, contact);
            /* end of the program "two-planes" */
            sum = sum + distance;
            found.plus |= HC_BITS(exterior) << at;
            found.minus |= HC_BITS(interior) << at;
            found.decided |= HC_BITS(decided) << at;
        }
        signs[block].plus = found.plus;
        signs[block].minus = found.minus;
        left[block] = ~(HC_NAME(hc_all_below)(sum, HC_cap) ? found.decided : 0);
    }
}
/* Near the places where spheroids first touch, and the shortest gaps, by columns as in hc_certified. Both are guesses, but for
   the error of the touch, which is proved: hypcheck/kernel/clearance_points.py has the derivations. */
HC_TARGET static void HC_NAME(hc_touches)(const double *columns, size_t stride, int count, hc_touches *found) {
    const HC_NUMBER one = HC_SET(1.0), zero = HC_SET(0.0), tiny = HC_SET(HC_tiny), rounded = HC_SET(HC_rounded);
    int at, turn;
    for (at = 0; at < count; at += HC_WIDTH) {
        const HC_NUMBER alpha = HC_LOAD(columns + at), gamma = HC_LOAD(columns + stride + at);
        const HC_NUMBER b = HC_LOAD(columns + 2 * stride + at), d = HC_LOAD(columns + 3 * stride + at);
        const HC_NUMBER x = HC_LOAD(columns + 4 * stride + at), y = HC_LOAD(columns + 5 * stride + at);
        const HC_NUMBER z = HC_LOAD(columns + 6 * stride + at);
        const HC_NUMBER scale = HC_MAX(HC_ABS(x), HC_ABS(y));
        const HC_TRUTH off = HC_GE(scale, HC_SET(HC_least_offset));
        const HC_NUMBER unit = HC_SELECT(off, scale, one);
        const HC_NUMBER shrunk = one / unit, x_share = HC_SELECT(off, x * shrunk, one), y_share = HC_SELECT(off, y * shrunk, zero);
        const HC_NUMBER length = HC_ROOT(x_share * x_share + y_share * y_share);
        const HC_NUMBER sizes = one / (b * d), per_b = sizes * d, per_d = sizes * b; /* one quotient for two, here and below */
        const HC_NUMBER a = alpha * per_b, c = gamma * per_d, h = HC_ABS(z) * per_d;
        const HC_NUMBER r = HC_SELECT(off, scale * length, scale) * per_b;
        const HC_NUMBER A = a * a, B = c * c, W = A + B, p = HC_MAX(a * r, tiny), q = HC_MAX(c * h, tiny), slope = one / p;
        HC_NUMBER tau = A, sigma = B;
        for (turn = 0; turn < HC_TOUCH_TURNS; turn++) {
            const HC_NUMBER square = sigma * sigma + q * q, cone = HC_ROOT(square), steep = slope * cone;
            const HC_NUMBER step = (sigma - tau * steep) * square / (steep * square + q * q);
            tau = HC_MIN(tau + step, W);
            sigma = HC_MAX(sigma - step, zero);
            if (!HC_BITS(HC_GT(HC_ABS(step), HC_SET(HC_touch_settled) * HC_MIN(tau, sigma)))) break;
        }
        tau = HC_MAX(tau, HC_SET(HC_least_tau)), sigma = HC_MAX(sigma, HC_SET(HC_least_share) * W);
        {
            const HC_TRUTH low_pole = HC_LT(tau, sigma);
            const HC_NUMBER T = HC_SELECT(low_pole, tau, W - sigma), S = HC_SELECT(low_pole, W - tau, sigma);
            const HC_NUMBER poles = one / (T * S), per_T = poles * S, per_S = poles * T;
            const HC_NUMBER to_radius = A * per_T, to_height = B * per_S, radius = to_radius * r, height = to_height * h;
            const HC_NUMBER share = c * h * per_S, part = a * r * per_T, part_square = part * part;
            const HC_NUMBER low = a * HC_ROOT(one + share * share), high = c * HC_ROOT(HC_MAX(part_square - one, zero));
            const HC_NUMBER per_both = one / (low * high), per_high = HC_SELECT(HC_GT(high, zero), low * per_both, HC_SET(HC_NEVER));
            const HC_NUMBER lost = HC_SET(2.0) * rounded * B * part_square * per_high;
            const HC_NUMBER off_low = HC_ABS(low - radius) + rounded * (low + radius);
            const HC_NUMBER off_high = HC_ABS(high - height) + rounded * (high + height) + lost;
            const HC_NUMBER axes = one / (A * B), per_A = axes * B, per_B = axes * A;
            const HC_NUMBER by_low = off_low * off_low * T * per_A, by_high = off_high * off_high * S * per_B;
            const HC_NUMBER least = HC_SELECT(HC_LT(by_high, by_low), by_high, by_low);
            const HC_NUMBER across = HC_ROOT(least * to_radius), up = HC_ROOT(least * to_height);
            const HC_NUMBER error_low = d * up + b * (A * per_B * (height + up) / low) * up;
            const HC_NUMBER error_high = b * across + d * ((HC_SET(2.0) * radius + across) * across * per_high * (B * per_A) + lost);
            const HC_TRUTH other = HC_LT(error_high, error_low);
            const HC_NUMBER rho = HC_SELECT(other, radius, low), zeta = HC_SELECT(other, high, height);
            const HC_NUMBER gone = rho - r, risen = zeta - h, metres = rho * b + zeta * d;
            const HC_NUMBER factor = HC_ROOT(gone * gone + risen * risen), apart = HC_SET(HC_guess) * HC_MAX(factor, one);
            const HC_NUMBER least_factor = factor - apart, most_factor = factor + apart;
            const HC_NUMBER outward = HC_SET(HC_outward) * least_factor, inward = HC_SET(HC_inward) * most_factor;
            const HC_NUMBER error = HC_SELECT(other, error_high, error_low) + HC_SET(2.0) * rounded * metres;
            const HC_NUMBER inverse = one / length;
            HC_STORE(found->low + at, least_factor);
            HC_STORE(found->high + at, most_factor);
            HC_STORE(found->inner_b + at, outward * b);
            HC_STORE(found->inner_d + at, outward * d);
            HC_STORE(found->outer_b + at, inward * b);
            HC_STORE(found->outer_d + at, inward * d);
            HC_STORE(found->radius + at, rho * b);
            HC_STORE(found->height + at, zeta * d);
            HC_STORE(found->cosine + at, x_share * inverse);
            HC_STORE(found->sine + at, y_share * inverse);
            HC_STORE(found->sign + at, HC_SELECT(HC_LT(z, zero), HC_SET(-1.0), one));
            HC_STORE(found->error + at, HC_SET(HC_more_than) * error);
        }
    }
}

HC_TARGET static void HC_NAME(hc_gaps)(const double *columns, size_t stride, int count, const double *sides,
                                       const hc_touches *touches, hc_gaps *found) {
    const HC_NUMBER one = HC_SET(1.0), zero = HC_SET(0.0), half = HC_SET(0.5);
    int at, turn, settled;
    for (at = 0; at < count; at += HC_WIDTH) {
        const HC_NUMBER alpha = HC_LOAD(columns + at), gamma = HC_LOAD(columns + stride + at);
        const HC_NUMBER b = HC_LOAD(columns + 2 * stride + at), d = HC_LOAD(columns + 3 * stride + at);
        const HC_NUMBER x = HC_LOAD(columns + 4 * stride + at), y = HC_LOAD(columns + 5 * stride + at);
        const HC_NUMBER level = HC_ABS(HC_LOAD(columns + 6 * stride + at)), side = HC_LOAD(sides + at);
        const HC_NUMBER r = HC_LOAD(touches->cosine + at) * x + HC_LOAD(touches->sine + at) * y;
        const HC_NUMBER steep = alpha / gamma, bb = b * b, dd = d * d, inverse_gamma = one / gamma;
        HC_NUMBER height = HC_LOAD(touches->height + at), lowest = zero;
        HC_NUMBER highest = HC_SELECT(HC_GT(side, zero), HC_SET(HC_NEVER), level);
        HC_NUMBER cone, slope, v, n, gap, both;
        settled = 0;
        for (turn = 0;; turn++) {
            HC_NUMBER bend, off_place, moved, change;
            HC_TRUTH above, inside;
            const HC_NUMBER share = height * inverse_gamma;
            HC_NUMBER inverse, b_v, bend_v, bend_n;
            cone = HC_ROOT(one + share * share);
            inverse = one / cone;
            slope = steep * share * inverse;
            v = HC_ROOT(bb + dd * slope * slope);
            n = HC_ROOT(one + slope * slope);
            both = one / (v * n); /* one quotient for two */
            gap = (side * (r - slope * level - alpha * inverse) - v) * v * both;
            if (settled || turn == HC_GAP_TURNS) break;
            b_v = n * both;
            bend_v = bb * dd * b_v * b_v * b_v;
            b_v = v * both;
            bend_n = gap * b_v * b_v * b_v;
            off_place = height - level - side * slope * (dd * n * both + gap * b_v);
            bend = one - side * steep * inverse_gamma * inverse * inverse * inverse * (bend_v + bend_n);
            above = HC_GT(off_place, zero);
            lowest = HC_SELECT(above, lowest, height);
            highest = HC_SELECT(above, height, highest);
            moved = height - off_place / bend;
            change = HC_ABS(moved - height);
            settled = !HC_BITS(HC_GT(change, HC_SET(HC_gap_settled) * height));
            inside = HC_AND(HC_AND(HC_GE(moved, lowest), HC_LE(moved, highest)), HC_GT(bend, zero));
            height = HC_SELECT(inside, moved, HC_MIN(half * (lowest + highest), height + height + level));
        }
        {
            const HC_NUMBER rho = alpha * cone, zeta = height, b_v = bb * n * both, d_v = dd * slope * n * both;
            const HC_NUMBER across = rho - (r - side * b_v), up = zeta - (level + side * d_v), largest = HC_MAX(b, d);
            const HC_NUMBER length = HC_ROOT(across * across + up * up), width = v * v * both;
            const HC_NUMBER terms = length + rho + zeta + HC_ABS(x) + HC_ABS(y) + level + largest;
            const HC_NUMBER most = length + HC_SET(HC_points) * terms;
            const HC_NUMBER tried = HC_MIN(gap, most) - HC_SET(HC_guess) * (HC_ABS(gap) + width), thick = width + tried;
            const HC_NUMBER per_width = one / width;
            HC_STORE(found->radius + at, rho);
            HC_STORE(found->height + at, zeta);
            HC_STORE(found->most + at, most);
            HC_STORE(found->width + at, width);
            HC_STORE(found->tried + at, tried);
            HC_STORE(found->inner_b + at, HC_SET(HC_outward) * HC_ROOT(thick * (bb * per_width + tried)));
            HC_STORE(found->inner_d + at, HC_SET(HC_outward) * HC_ROOT(thick * (dd * per_width + tried)));
        }
    }
}
#undef HC_NAME
#undef HC_TARGET
#undef HC_WIDTH
#undef HC_NUMBER
#undef HC_TRUTH
#undef HC_LOAD
#undef HC_SET
#undef HC_ABS
#undef HC_GT
#undef HC_LT
#undef HC_GE
#undef HC_LE
#undef HC_AND
#undef HC_OR
#undef HC_BITS
#undef HC_SQRT
#undef HC_INVERSE
#undef HC_ROOT
#undef HC_STORE
#undef HC_MIN
#undef HC_MAX
#undef HC_SELECT

#endif
