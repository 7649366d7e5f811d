/* The sign of x, by both entries, with a description. */
#include <stddef.h>
#include <stdint.h>

const char *hypcheck_describe(void) { return "{\"name\": \"sign\", \"language\": \"c\", \"precision\": \"exact\"}"; }

void hypcheck_classify(size_t n, const double *rows, int8_t *positions) {
    for (size_t i = 0; i < n; i++) positions[i] = (rows[7 * i + 4] > 0) - (rows[7 * i + 4] < 0);
}

void hypcheck_classify_scene(const double sizes[4], size_t n, const double *x, const double *y, const double *z,
                             int8_t *positions) {
    (void)sizes, (void)y, (void)z;
    for (size_t i = 0; i < n; i++) positions[i] = (x[i] > 0) - (x[i] < 0);
}
