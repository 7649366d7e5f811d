/* A disk that fails, for one folder: preloaded, it counts the calls that change files in the folder, and lets some fail.

   Until fail_from() is called, nothing fails. What happens from the n-th call on is one of

   once    that call alone fails, with ENOSPC or EIO
   full    from that call on, what needs room fails with ENOSPC; of the first data, half is still written
   dead    that call and all later ones fail with EIO
   killed  the process dies in that call; of data, half is written
   short   of the data of that call half is written, which is no error: the caller must write the rest */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

enum { ONCE_FULL, ONCE_BROKEN, FULL, DEAD, KILLED, SHORT };
enum { DESCRIPTORS = 4096, CALLS = 4096 };

static char folder[4096];
static long calls, first;
static int how;
static char ours[DESCRIPTORS];
static char told[CALLS];

/* The kind of each call so far: o(pen), w(rite), s(ync), r(ename), u(nlink), m(kdir), p(ermissions), c(lose). */
const char *calls_so_far(void) { return told; }

void fail_from(const char *path, long n, int kind)
{
    calls = 0;
    first = n;
    how = kind;
    memset(told, 0, sizeof told);
    snprintf(folder, sizeof folder, "%s", path);
}

static int within(const char *path) { return folder[0] && path && strncmp(path, folder, strlen(folder)) == 0; }

static int is_ours(int file) { return file >= 0 && file < DESCRIPTORS && ours[file]; }

/* Counts a call; returns whether it fails, with errno set. */
static int fails(char kind, int needs_room)
{
    long n = calls++;
    if (n < CALLS - 1)
        told[n] = kind;
    if (first < 0 || n < first || how == SHORT)
        return 0;
    if (how == FULL ? !needs_room : how != DEAD && n > first)
        return 0;
    errno = how == FULL || how == ONCE_FULL ? ENOSPC : EIO;
    return 1;
}

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

static void die(void)
{
    kill(getpid(), SIGKILL);
    for (;;)
        pause();
}

#define FAIL(kind, needs_room)         \
    do {                               \
        if (fails(kind, needs_room)) { \
            if (how == KILLED)         \
                die();                 \
            return -1;                 \
        }                              \
    } while (0)

ssize_t write(int file, const void *data, size_t size)
{
    if (!is_ours(file))
        return REAL(write)(file, data, size);
    long n = calls;
    if (!fails('w', 1) && !(how == SHORT && n == first))
        return REAL(write)(file, data, size);
    if (n == first && size > 1 && (how == SHORT || how == FULL))
        return REAL(write)(file, data, size / 2);
    if (how == KILLED) {
        ssize_t half = REAL(write)(file, data, size / 2);
        (void)half;
        die();
    }
    return how == SHORT ? REAL(write)(file, data, size) : -1;
}

static int opened(int file)
{
    if (file >= 0 && file < DESCRIPTORS)
        ours[file] = 1;
    return file;
}

int open64(const char *path, int flags, ...)
{
    va_list more;
    va_start(more, flags);
    mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(more, mode_t) : 0;
    va_end(more);
    if (!within(path) || !(flags & (O_WRONLY | O_RDWR | O_CREAT)))
        return REAL(open64)(path, flags, mode);
    FAIL('o', 1);
    return opened(REAL(open64)(path, flags, mode));
}

int open(const char *path, int flags, ...)
{
    va_list more;
    va_start(more, flags);
    mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(more, mode_t) : 0;
    va_end(more);
    return open64(path, flags, mode);
}

int close(int file)
{
    int was = is_ours(file);
    if (was)
        ours[file] = 0;
    int done = REAL(close)(file);
    if (was && done == 0)
        FAIL('c', 0);
    return done;
}

int fsync(int file)
{
    if (is_ours(file))
        FAIL('s', 1);
    return REAL(fsync)(file);
}

int rename(const char *from, const char *to)
{
    if (within(from))
        FAIL('r', 0);
    return REAL(rename)(from, to);
}

int unlink(const char *path)
{
    if (within(path))
        FAIL('u', 0);
    return REAL(unlink)(path);
}

int mkdir(const char *path, mode_t mode)
{
    if (within(path))
        FAIL('m', 1);
    return REAL(mkdir)(path, mode);
}

int chmod(const char *path, mode_t mode)
{
    if (within(path))
        FAIL('p', 0);
    return REAL(chmod)(path, mode);
}
