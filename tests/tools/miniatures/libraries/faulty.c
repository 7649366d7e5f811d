/* The sign of x; the gamma of an unlucky row says what becomes of it. */
#include <fenv.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

void hypcheck_classify(size_t n, const double *rows, int8_t *positions) {
    for (size_t i = 0; i < n; i++) {
        switch ((int)rows[7 * i + 1]) {
        case 13: printf("7 1\n1\n"), fflush(stdout); break;
        case 14: continue;
        case 15: *(volatile int *)8 = 1; break;
        case 16: memset(positions - 8, 1, n + 16); break;
        case 17: fesetround(FE_UPWARD); break;
#if defined(__SSE__)
        case 18: _MM_SET_ROUNDING_MODE(_MM_ROUND_DOWN); break;
#endif
        }
        positions[i] = (rows[7 * i + 4] > 0) - (rows[7 * i + 4] < 0);
    }
}
