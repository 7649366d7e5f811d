/* Whether x0 and x1 have unlike signs, and x0/(x0 - x1) as the time; with an axis, x0 + axis_x counts as x0. -DTIMES
 * describes times, -DTILT axes; -DLACKS lacks both entries; -DBEYOND writes one time too many. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#ifdef TIMES
#define TIMES_KEY ", \"times\": true"
#else
#define TIMES_KEY ""
#endif
#ifdef TILT
#define TILT_KEY ", \"tilt\": true"
#else
#define TILT_KEY ""
#endif

const char *hypcheck_describe(void) {
    return "{\"name\": \"crossing\", \"question\": \"passage\"" TIMES_KEY TILT_KEY "}";
}

static void one(double from, double to, int8_t *hit, double *time) {
    *hit = from * to <= 0;
    if (time) *time = *hit ? from / (from - to) : NAN;
}

void hypcheck_classify(size_t n, const double *rows, int8_t *positions) { (void)n, (void)rows, (void)positions; }

#ifndef LACKS
void hypcheck_passage(size_t n, const double *rows, int8_t *hits, double *times) {
    for (size_t i = 0; i < n; i++) one(rows[10 * i + 4], rows[10 * i + 7], hits + i, times ? times + i : NULL);
#ifdef BEYOND
    times[n] = 0;
#endif
}

void hypcheck_passage_tilted(size_t n, const double *rows, int8_t *hits, double *times) {
    for (size_t i = 0; i < n; i++)
        one(rows[13 * i + 4] + rows[13 * i + 10], rows[13 * i + 7], hits + i, times ? times + i : NULL);
}
#endif
