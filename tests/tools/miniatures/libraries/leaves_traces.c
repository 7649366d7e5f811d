/* The sign of x; what else it does depends on gamma: 100 and more are calls that leave something changed behind. */
#include <fcntl.h>
#include <fenv.h>
#include <locale.h>
#include <signal.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>
#include <xmmintrin.h>

int feenableexcept(int);

void hypcheck_classify(size_t n, const double *rows, int8_t *positions) {
    volatile double far = 0;
    switch ((int)rows[1]) {
    case 100: _mm_setcsr(_mm_getcsr() | 0x8000); break;
    case 101: _mm_setcsr(_mm_getcsr() | 0x0040); break;
    case 102: feenableexcept(FE_DIVBYZERO); break;
    case 103: signal(SIGUSR1, SIG_IGN); break;
    case 104: setlocale(LC_ALL, "C.UTF-8") || setlocale(LC_ALL, "C"); break;
    case 105: chdir("/"); break;
    case 106: open("/dev/null", O_RDONLY); break;
    case 107: dup2(open("/dev/null", O_RDONLY), 1); break;
    case 108: ((double *)rows)[0] = 1; break;
    case 109: for (size_t k = 0; k < 4096; k++) far += rows[7 * n + k]; break;
    case 110: memset(positions - 4096, 1, 4096); break;
    }
    for (size_t i = 0; i < n; i++) positions[i] = (rows[7 * i + 4] > 0) - (rows[7 * i + 4] < 0);
}
