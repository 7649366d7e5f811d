/* The sign of x, and a count of the calls about one row. */
#include <stddef.h>
#include <stdint.h>

long calls_about_one_row = 0;

void hypcheck_classify(size_t n, const double *rows, int8_t *positions) {
    calls_about_one_row += n == 1;
    for (size_t i = 0; i < n; i++) positions[i] = (rows[7 * i + 4] > 0) - (rows[7 * i + 4] < 0);
}
