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

@CONSTANTS@
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
