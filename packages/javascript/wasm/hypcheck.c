/* The library as WebAssembly: hypcheck.h and the four functions that it asks of a C library. The builtins are instructions. */
#define HYPCHECK_IMPLEMENTATION
#include "hypcheck.h"

void *memcpy(void *to, const void *from, size_t n) { return __builtin_memmove(to, from, n); }
void *memmove(void *to, const void *from, size_t n) {
    unsigned char *target = to;
    const unsigned char *source = from;
    size_t i;
    if (target <= source) {
        for (i = 0; i < n; i++) ((volatile unsigned char *)target)[i] = source[i];
    } else {
        for (i = n; i > 0; i--) ((volatile unsigned char *)target)[i - 1] = source[i - 1];
    }
    return to;
}
void *memset(void *to, int value, size_t n) {
    size_t i;
    for (i = 0; i < n; i++) ((volatile unsigned char *)to)[i] = (unsigned char)value;
    return to;
}
int strcmp(const char *left, const char *right) {
    for (; *left && *left == *right; left++) right++;
    return (unsigned char)*left - (unsigned char)*right;
}
