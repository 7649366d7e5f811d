/* The sign of x by the protocol of commands; -DBINARY=true offers the binary form, which must be fast. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define QUOTE(word) #word
#define TEXT(word) QUOTE(word)

static double rows[65536 * 7];
static int8_t positions[65536];

static int8_t sign(double x) { return (x > 0) - (x < 0); }

int main(void) {
    char line[1024], how[16];
    unsigned long sequence, n;
    puts("{\"protocol\": 1, \"name\": \"sign\", \"language\": \"c\", \"binary\": " TEXT(BINARY) "}");
    fflush(stdout);
    while (fgets(line, sizeof line, stdin)) {
        if (sscanf(line, "classify %lu %lu %15s", &sequence, &n, how) != 3) return 1;
        if (strcmp(how, "binary") == 0) {
            if (fread(rows, 56, n, stdin) != n) return 1;
            for (size_t i = 0; i < n; i++) positions[i] = sign(rows[7 * i + 4]);
            printf("%lu %lu\n", sequence, n);
            fwrite(positions, 1, n, stdout);
        } else {
            for (size_t i = 0; i < n; i++) {
                char *rest = fgets(line, sizeof line, stdin);
                double x = 0;
                for (int column = 0; column < 5; column++) x = strtod(rest, &rest);
                positions[i] = sign(x);
            }
            printf("%lu %lu\n", sequence, n);
            for (size_t i = 0; i < n; i++) printf("%d\n", positions[i]);
        }
        fflush(stdout);
    }
    return 0;
}
