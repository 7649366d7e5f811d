/* What a program asks of a C library where there is none: four functions on memory, and on ARM the calls into the system that
   qemu answers. What is volatile keeps compilers from calling memcpy in memcpy. */

void *memcpy(void *restrict to, const void *restrict from, size_t n) {
    volatile unsigned char *const target = to;
    const volatile unsigned char *const source = from;
    size_t i;
    for (i = 0; i < n; i++) target[i] = source[i];
    return to;
}

void *memmove(void *to, const void *from, size_t n) {
    volatile unsigned char *const target = to;
    const volatile unsigned char *const source = from;
    size_t i;
    if ((uintptr_t)to <= (uintptr_t)from) return memcpy(to, from, n);
    for (i = n; i > 0; i--) target[i - 1] = source[i - 1];
    return to;
}

void *memset(void *to, int value, size_t n) {
    volatile unsigned char *const target = to;
    size_t i;
    for (i = 0; i < n; i++) target[i] = (unsigned char)value;
    return to;
}

int strcmp(const char *left, const char *right) {
    for (; *left && *left == *right; left++) right++;
    return (unsigned char)*left - (unsigned char)*right;
}

#if defined(__arm__)

enum { EXIT = 1, READ = 3, WRITE = 4 };

static long call(long number, long first, long second, long third) {
    register long r7 __asm__("r7") = number, r0 __asm__("r0") = first, r1 __asm__("r1") = second, r2 __asm__("r2") = third;
    __asm__ volatile("svc #0" : "+r"(r0) : "r"(r7), "r"(r1), "r"(r2) : "memory");
    return r0;
}

static size_t moved(long number, long file, long at, size_t size) {
    size_t done = 0;
    long step = 1;
    for (; done < size && step > 0; done += step > 0 ? (size_t)step : 0) step = call(number, file, at + (long)done, (long)(size - done));
    return done;
}

static void set_mode(uint32_t mode) { (void)mode; }
static size_t get(void *to, size_t size) { return moved(READ, 0, (long)to, size); }
static size_t put(const void *from, size_t size) { return moved(WRITE, 1, (long)from, size); }

int main(void);
void _start(void) {
    call(EXIT, main(), 0, 0);
    for (;;) {}
}

#endif
