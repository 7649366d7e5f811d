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
   Memory      nothing is allocated. The stack holds up to @STACK_KILOBYTES@ kilobytes, @TILTED_KILOBYTES@ for axes that are tilted.
   Threads     every function may be called from any number of threads at once. There is one global variable, the
               instruction set in use (below): it is written once with one value, or by hypcheck_use_level.
   Arithmetic  answers do not depend on the rounding mode, on flushing subnormals to zero, or on contraction into FMA;
               floating-point flags may be raised. -ffast-math breaks the proofs and is refused.

   Every statement of floating-point arithmetic below between "printed" and "end of" is printed from the straight-line
   programs that hypcheck proves to be the formulas they are named after, as are the steps of the exact integers. What
   their bounds are and why they hold: docs/kernel.md of hypcheck. Made by: @COMMAND@ */

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
#define HYPCHECK_VERSION "@VERSION@"
const char *hypcheck_version(void);

#ifdef __cplusplus
}
#endif

#endif
