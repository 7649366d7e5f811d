/* Answers jobs with hypcheck.h on any processor: a job is four 32-bit words, what, mode, level, n, and then doubles, all in the
   order of bytes of this processor. Made for qemu, for microcontrollers without a system, and for WebAssembly. */

#define HYPCHECK_IMPLEMENTATION
#include "hypcheck.h"

enum { ROWS, LEANING_ROWS, SCENE, LEANING_SCENE, ONE, WAYS, LEANING_WAYS, CLEARANCES, STACKS, LEANING_STACKS, ENDED_ROWS };
enum { MOST = 1 << 16, PAINTED = 1 << 18 };
typedef struct {
    uint32_t what, mode, level, n;
} job;

static double numbers[10 * MOST + 16];
static int8_t answers[4 * MOST];
static double times[HYPCHECK_NEAR_NUMBERS * MOST];
static uint32_t depth;

#define APART __attribute__((noinline, noclone))
#ifdef __clang__
#undef APART
#define APART __attribute__((noinline))
#endif

/* The stack below the caller is painted, used, and looked at: what is no longer painted was used. */
static APART void paint(void) {
    volatile unsigned char area[PAINTED];
    uint32_t i;
    for (i = 0; i < PAINTED; i++) area[i] = 0xa5;
}

static APART uint32_t unpainted(void) {
    volatile unsigned char area[PAINTED];
    uint32_t i;
    for (i = 0; i < PAINTED && area[i] == 0xa5; i++) {}
    return PAINTED - i;
}

static APART void ask_rows(size_t n) { hypcheck_ask(HYPCHECK_POSITION, n, numbers, answers); }
static APART void ask_leaning_rows(size_t n) { hypcheck_ask_tilted(HYPCHECK_POSITION, n, numbers, answers); }

/* The deepest that one row, and any row of a job, reaches. */
static void measure(void (*ask)(size_t), size_t n) {
    uint32_t used;
    paint();
    ask(n);
    used = unpainted();
    if (used > depth) depth = used;
}

/* A scene that was prepared answers as others do: where it does not, its answer becomes 99. */
static void compare_prepared(int leans, size_t n, const double *centres) {
    const double *const x = centres, *const y = x + n, *const z = y + n;
    static int8_t again[MOST];
    hypcheck_scene scene;
    size_t i;
    int question;
    hypcheck_prepare(&scene, numbers, leans ? numbers + 4 : NULL, n, x, y, z);
    for (question = 0; question < 4; question++) {
        hypcheck_ask_prepared(question, &scene, n, x, y, z, again);
        for (i = 0; i < n; i++)
            if (again[i] != answers[(size_t)question * n + i]) answers[(size_t)question * n + i] = 99;
    }
}

/* Answers a job. Returns how many bytes of answers and of times there are, or 0 for what is no job. */
static int answer(const job *asked, size_t *bytes, size_t *doubles) {
    const size_t n = asked->n;
    const double *const centres = numbers + (asked->what == LEANING_SCENE ? 7 : 4);
    size_t i;
    int question;
    static const char *const levels[] = {"plain", "sse2", "avx2", "avx512", "neon"};
    if (n > MOST || asked->level >= sizeof levels / sizeof *levels || !hypcheck_use_level(levels[asked->level])) return 0;
    *bytes = n, *doubles = 0;
    switch (asked->what) {
    case ROWS: ask_rows(n); break;
    case LEANING_ROWS: ask_leaning_rows(n); break;
    case SCENE:
    case LEANING_SCENE: /* the answers to each question */
        for (question = 0; question < 4; question++) {
            int8_t *const to = answers + (size_t)question * n;
            const double *const x = centres, *const y = x + n, *const z = y + n;
            if (asked->what == SCENE) hypcheck_ask_scene(question, numbers, n, x, y, z, to);
            else hypcheck_ask_tilted_scene(question, numbers, numbers + 4, n, x, y, z, to);
        }
        *bytes = 4 * n;
        compare_prepared(asked->what == LEANING_SCENE, n, centres);
        break;
    case ONE:
        for (i = 0; i < n; i++) {
            const double *const r = numbers + 7 * i;
            answers[i] = (int8_t)hypcheck_position(r[0], r[1], r[2], r[3], r[4], r[5], r[6]);
        }
        break;
    case WAYS: hypcheck_passage(n, numbers, answers, times), *doubles = n; break;
    case LEANING_WAYS: hypcheck_passage_tilted(n, numbers, answers, times), *doubles = n; break;
    case CLEARANCES:
        hypcheck_clearance(n, numbers, answers, (hypcheck_near *)(void *)times);
        *doubles = HYPCHECK_NEAR_NUMBERS * n;
        break;
    case STACKS: measure(ask_rows, n), times[0] = depth, *doubles = 1; break;
    case LEANING_STACKS: measure(ask_leaning_rows, n), times[0] = depth, *doubles = 1; break;
    case ENDED_ROWS: hypcheck_classify_ended(n, numbers, answers); break;
    default: return 0;
    }
    return 1;
}

static size_t width(const job *asked) {
    static const size_t of_row[] = {7, 10, 3, 3, 7, 10, 13, 7, 7, 10, 13};
    const size_t sizes = asked->what == SCENE ? 4 : asked->what == LEANING_SCENE ? 7 : 0;
    return asked->what < sizeof of_row / sizeof *of_row ? of_row[asked->what] * asked->n + sizes : 0;
}

#ifdef BARE
#include "bare.h"
#endif

#if defined(__wasm__)

/* The host writes a job and its numbers, calls `work`, and reads the answers. */
static job asked;
__attribute__((export_name("job_at"))) job *job_at(void) { return &asked; }
__attribute__((export_name("numbers_at"))) double *numbers_at(void) { return numbers; }
__attribute__((export_name("answers_at"))) int8_t *answers_at(void) { return answers; }
__attribute__((export_name("times_at"))) double *times_at(void) { return times; }
__attribute__((export_name("width"))) uint32_t doubles_asked(void) { return (uint32_t)width(&asked); }

/* Bytes of answers and doubles of times, as one number; -1 for what is no job. */
__attribute__((export_name("work"))) double work(void) {
    size_t bytes, doubles;
    return answer(&asked, &bytes, &doubles) ? (double)bytes * 16777216.0 + (double)doubles : -1;
}

#else

#ifndef BARE
#include <fenv.h>
#include <stdio.h>
static const int modes[] = {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
/* The last two modes are the precision of x87, which its control word has: 24 bits, and 53. */
static void set_mode(uint32_t mode) {
    fesetround(modes[mode < 4 ? mode : 0]);
#if defined(__i386__)
    {
        const unsigned short precision = mode == 4 ? 0x007f : mode == 5 ? 0x027f : 0x037f;
        if (mode == 0 || mode > 3) __asm__ volatile("fldcw %0" : : "m"(precision));
    }
#endif
}
static size_t get(void *to, size_t size) { return fread(to, 1, size, stdin); }
static size_t put(const void *from, size_t size) { return fwrite(from, 1, size, stdout); }
#endif

int main(void) {
    job asked;
    size_t bytes, doubles;
    while (get(&asked, sizeof asked) == sizeof asked) {
        const size_t size = sizeof *numbers * width(&asked);
        int known;
        if (size > sizeof numbers || get(numbers, size) != size) return 2;
        set_mode(asked.mode);
        known = answer(&asked, &bytes, &doubles);
        set_mode(0);
        if (!known) return 3;
        if (put(answers, bytes) != bytes || put(times, doubles * sizeof *times) != doubles * sizeof *times) return 4;
    }
    return 0;
}

#endif
