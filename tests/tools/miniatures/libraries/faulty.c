/* The sign of x, until the unlucky row: -DFAULT says what becomes of that, and of *p, its position. */
#include <fenv.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#define SEGFAULT *(volatile int *)8 = 1
#define NOT_WRITTEN continue
#define WRITES_BESIDE memset(positions - 8, 1, n + 16)
#define CHANGES_ROUNDING fesetround(FE_UPWARD)
#define CHANGES_SSE_ROUNDING _MM_SET_ROUNDING_MODE(_MM_ROUND_DOWN)
#define PRINTS printf("7 1\n1\n"), fflush(stdout)

void hypcheck_classify(size_t n, const double *rows, int8_t *positions) {
    for (size_t i = 0; i < n; i++) {
        if (rows[7 * i + 1] == 13.0) { FAULT; }
        positions[i] = (rows[7 * i + 4] > 0) - (rows[7 * i + 4] < 0);
    }
}
