/* What hypcheck.h asks of <string.h>, where there is no C library. */
#include <stddef.h>

void *memcpy(void *to, const void *from, size_t n);
void *memmove(void *to, const void *from, size_t n);
void *memset(void *to, int value, size_t n);
int strcmp(const char *left, const char *right);
