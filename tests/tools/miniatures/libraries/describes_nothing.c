/* Its description is a null pointer. */
#include <stddef.h>
#include <stdint.h>

const char *hypcheck_describe(void) { return NULL; }

void hypcheck_classify(size_t n, const double *rows, int8_t *positions) {
    (void)rows;
    for (size_t i = 0; i < n; i++) positions[i] = 0;
}
