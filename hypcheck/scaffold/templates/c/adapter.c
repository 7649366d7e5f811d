/* The door between hypcheck and predicate.c: questions on standard input, answers on standard output.
 *
 *     @BUILD@
 *
 * docs/protocol.md of hypcheck says what is spoken. Only the build line changes when the predicate does.
 */
#define _POSIX_C_SOURCE 199309L /* clock_gettime */
#include "predicate.h"

#include <locale.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#ifdef _WIN32
#include <fcntl.h>
#include <io.h>
#endif

/* A predicate has the function that its description asks for; the other may be missing. */
#ifdef __ELF__
@position@
#pragma weak hypcheck_classify
#pragma weak hypcheck_classify_tilted
@passage@
#pragma weak hypcheck_passage
#pragma weak hypcheck_passage_tilted
@end@
#endif

@position@
enum { MOST_COLUMNS = 10, MOST = 65536, MOST_REPEATS = 999999999, LINE = 1024 };
@passage@
enum { MOST_COLUMNS = 13, MOST = 65536, MOST_REPEATS = 999999999, LINE = 1024 };
@end@

static double rows[MOST * MOST_COLUMNS];
static unsigned char bytes[MOST * MOST_COLUMNS * 8];
@position@
static int8_t positions[MOST];

/* Whether the predicate claims "tilt":true, and the numbers of a row then. */
static bool tilt;
static size_t columns = 7;

static void classify(size_t n) { (tilt ? hypcheck_classify_tilted : hypcheck_classify)(n, rows, positions); }
@passage@
static int8_t hits[MOST];
static double first[MOST];

/* Whether the predicate claims "tilt":true and "times":true, and the numbers of a row. */
static bool tilt, times;
static size_t columns = 10;

static void classify(size_t n) { (tilt ? hypcheck_passage_tilted : hypcheck_passage)(n, rows, hits, times ? first : NULL); }
@end@

/* The next line, false at the end of the input. One that is too long to mean anything becomes empty. */
static bool read_line(char line[LINE]) {
    size_t length = 0;
    int character;
    while ((character = getchar()) != EOF && character != '\n')
        if (length < LINE) line[length++] = (char)character;
    bool any = length > 0 || character != EOF;
    line[length < LINE ? length : 0] = '\0';
    return any;
}

/* As many decimals as a row has and nothing else. strtod rounds correctly, and reads a point in the locale that main sets. */
static bool parse_row(const char *line, double *row) {
    for (size_t column = 0; column < columns; column++) {
        char *end;
        row[column] = strtod(line, &end);
        if (end == line) return false;
        line = end;
    }
    return line[strspn(line, " \t\r")] == '\0';
}

/* Float64 from eight bytes, the least significant first, whatever the order of this machine. Written out like this,
 * compilers make one load of it; of a loop at -O2 they do not, and it would take longer than most predicates. */
static double little_endian(const unsigned char *byte) {
    uint64_t bits = (uint64_t)byte[0] | (uint64_t)byte[1] << 8 | (uint64_t)byte[2] << 16 | (uint64_t)byte[3] << 24 |
                    (uint64_t)byte[4] << 32 | (uint64_t)byte[5] << 40 | (uint64_t)byte[6] << 48 | (uint64_t)byte[7] << 56;
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

@passage@
static void write_little_endian(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 8; i++) putchar((int)(bits >> (8 * i) & 255));
}

@end@
/* Both read the n rows of a question, and return false where these are none. */
static bool read_text(size_t n) {
    bool understood = true;
    for (size_t i = 0; i < n; i++) { /* to the last line, so that the next question is found */
        char line[LINE];
        understood &= read_line(line) && parse_row(line, rows + columns * i);
    }
    return understood;
}

static bool read_binary(size_t n) {
    if (fread(bytes, 8 * columns, n, stdin) != n) return false;
    for (size_t i = 0; i < columns * n; i++) rows[i] = little_endian(bytes + 8 * i);
    return true;
}

/* Each reads the rest of a question and replies, or returns what is wrong. */
static const char *classify_text(const char *sequence, size_t n) {
@position@
    if (!read_text(n)) return tilt ? "a row is not ten decimals" : "a row is not seven decimals";
@passage@
    if (!read_text(n)) return tilt ? "a row is not thirteen decimals" : "a row is not ten decimals";
@end@
    classify(n);
    printf("%s %zu\n", sequence, n);
@position@
    for (size_t i = 0; i < n; i++) printf("%d\n", positions[i]);
@passage@
    for (size_t i = 0; i < n; i++) {
        if (times && hits[i] == 1) printf("1 %.17g\n", first[i]);
        else printf("%d\n", hits[i]);
    }
@end@
    return NULL;
}

static const char *classify_binary(const char *sequence, size_t n) {
    if (!read_binary(n)) return "the input ended within the rows";
    classify(n);
    printf("%s %zu\n", sequence, n);
@position@
    fwrite(positions, 1, n, stdout);
@passage@
    fwrite(hits, 1, n, stdout);
    for (size_t i = 0; times && i < n; i++) write_little_endian(first[i]);
@end@
    return NULL;
}

static const char *time_binary(const char *sequence, size_t n, unsigned long repeat) {
    if (!read_binary(n)) return "the input ended within the rows";
    struct timespec start, stop;
    clock_gettime(CLOCK_MONOTONIC, &start);
    for (unsigned long i = 0; i < repeat; i++) classify(n);
    clock_gettime(CLOCK_MONOTONIC, &stop);
    long long nanoseconds = (stop.tv_sec - start.tv_sec) * 1000000000LL + (stop.tv_nsec - start.tv_nsec);
    long checksum = 0;
@position@
    for (size_t i = 0; i < n; i++) checksum += positions[i];
@passage@
    for (size_t i = 0; i < n; i++) checksum += hits[i];
@end@
    printf("%s %lld %ld\n", sequence, nanoseconds, checksum);
    return NULL;
}

@position@
/* Whether the rows come in this form: text or binary, or tilted-text or tilted-binary. */
static bool comes_as(const char *how, const char *form) {
    if (!tilt) return strcmp(how, form) == 0;
    return strncmp(how, "tilted-", 7) == 0 && strcmp(how + 7, form) == 0;
@passage@
/* Whether the rows come in this form: passage-text or passage-binary. */
static bool comes_as(const char *how, const char *form) {
    return strncmp(how, "passage-", 8) == 0 && strcmp(how + 8, form) == 0;
@end@
}

/* The widths keep numbers from overflowing (-1 is read as the greatest), and `more` is what may not follow. */
static const char *answer(const char *line) {
    char sequence[20], how[16], more;
    unsigned long n, repeat;
    if (sscanf(line, "classify %19[0-9] %5lu %15s %c", sequence, &n, how, &more) == 3 && n <= MOST) {
        if (comes_as(how, "text")) return classify_text(sequence, n);
        if (comes_as(how, "binary")) return classify_binary(sequence, n);
    }
    if (sscanf(line, "time %19[0-9] %5lu %9lu %15s %c", sequence, &n, &repeat, how, &more) == 4 && n <= MOST)
        if (repeat > 0 && repeat <= MOST_REPEATS && comes_as(how, "binary")) return time_binary(sequence, n, repeat);
    return "the question is not understood";
}

int main(void) {
    char line[LINE];
    setlocale(LC_NUMERIC, "C");
#ifdef _WIN32
    _setmode(_fileno(stdin), _O_BINARY);
    _setmode(_fileno(stdout), _O_BINARY);
#endif
    tilt = strstr(hypcheck_describe(), "\"tilt\":true") != NULL;
@passage@
    times = strstr(hypcheck_describe(), "\"times\":true") != NULL;
@end@
    if (tilt) columns = MOST_COLUMNS;
@position@
    if (!(tilt ? hypcheck_classify_tilted : hypcheck_classify)) {
@passage@
    if (!(tilt ? hypcheck_passage_tilted : hypcheck_passage)) {
@end@
        fputs("the predicate lacks the function that its description asks for, see predicate.h\n", stderr);
        return 1;
    }
    puts(hypcheck_describe());
    fflush(stdout);
    while (read_line(line)) {
        const char *trouble = answer(line);
        if (trouble) printf("error %s\n", trouble);
        fflush(stdout);
    }
    return 0;
}
