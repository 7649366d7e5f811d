/* The sign of x + axis_x by the entries for tilted spheroids; -DLACKS exports those for upright ones alone. */
#include <stddef.h>
#include <stdint.h>

const char *hypcheck_describe(void) { return "{\"name\": \"tilted sign\", \"tilt\": true}"; }

static int8_t sign(double x) { return (x > 0) - (x < 0); }

void hypcheck_classify_scene(const double sizes[4], size_t n, const double *x, const double *y, const double *z,
                             int8_t *positions) {
    (void)sizes, (void)y, (void)z;
    for (size_t i = 0; i < n; i++) positions[i] = sign(x[i]);
}

#ifdef LACKS
void hypcheck_classify(size_t n, const double *rows, int8_t *positions) {
    for (size_t i = 0; i < n; i++) positions[i] = sign(rows[7 * i + 4]);
}
#else
void hypcheck_classify_tilted(size_t n, const double *rows, int8_t *positions) {
    for (size_t i = 0; i < n; i++) positions[i] = sign(rows[10 * i + 4] + rows[10 * i + 7]);
}

void hypcheck_classify_tilted_scene(const double sizes[4], const double axis[3], size_t n, const double *x,
                                    const double *y, const double *z, int8_t *positions) {
    (void)sizes, (void)y, (void)z;
    for (size_t i = 0; i < n; i++) positions[i] = sign(x[i] + axis[0]);
}
#endif
