/* Starts a program so that it cannot touch the program that judges it, the machine or the answers. Linux only.

   launcher OPTIONS -- PROGRAM ARGUMENTS    --probe alone prints what this system allows, a line for each means

   --namespaces       user, PID, network, IPC, host name and mount namespaces: it sees no other process and no network
   --landlock         Landlock: it opens only what --read, --list and --write name
   --seccomp          a filter of system calls (filter.h)
   --scratch=FOLDER   with --namespaces: an empty folder in memory, the only writable one, of --bytes; also /dev/shm
   --private=FOLDER   with --namespaces: an empty folder stands in its place
   --show=PATH        with --namespaces: is seen although it lies in a folder that is replaced
   --hide=PATH        with --namespaces: a folder or file that is seen empty
   --reveal=FILE      with --namespaces: a file of a hidden folder that is seen all the same
   --read=PATH, --list=FOLDER, --write=PATH     of Landlock: read with all below, only list, or also change
   --judge=PID        without --namespaces: no signal reaches this process, and what filter.h says besides
   --threads=N, --descriptors=N, --bytes=N     limits: of its processes and threads, of one process, of one file
   --life=FD          everything ends when the other end of this pipe is closed
   --report=FD        the reason why the program was not started: a decimal errno, a blank, and a text

   The launcher stays as the supervisor. It ends as the program ended, and before that ends all processes which that left
   behind. With --namespaces the program's parent is the first process of its namespace, which no signal from inside
   reaches; the system ends the others with it. Without, the supervisor is their subreaper (PR_SET_CHILD_SUBREAPER).
   Nothing is allocated after the program's environment is known, and no library but the system's is used. */

#define _GNU_SOURCE
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/utsname.h>
#include <sys/wait.h>
#include <unistd.h>

#include "filter.h"
#include "landlock.h"

enum { MOST = 8192 };

struct paths {
    const char *path[MOST];
    int count;
};

static struct {
    int namespaces, landlock, seccomp, life, report;
    const char *scratch;
    struct paths private, show, hide, reveal, read, list, write;
    long judge, threads, descriptors, bytes;
} plan;

/* End, and say why: the caller reads it from the pipe --report. */
static void fail(const char *format, ...) {
    const int number = errno;
    char text[1024];
    va_list values;
    int used = snprintf(text, sizeof text, "%d ", number);
    va_start(values, format);
    used += vsnprintf(text + used, sizeof text - (size_t)used, format, values);
    va_end(values);
    if (used > (int)sizeof text - 1) used = (int)sizeof text - 1;
    if (write(plan.report < 0 ? 2 : plan.report, text, (size_t)used) < 0) _exit(125);
    _exit(126);
}

static void require(int result, const char *what, const char *where) {
    if (result < 0) fail("%s %s: %s", what, where, strerror(errno));
}

/* ---- the options ---- */

static int path_option(const char *word, const char *name, struct paths *paths) {
    const size_t length = strlen(name);
    if (strncmp(word, name, length) != 0 || word[length] != '=') return 0;
    if (paths->count == MOST) fail("more than %d paths for %s", MOST, name);
    paths->path[paths->count++] = word + length + 1;
    return 1;
}

static int number_option(const char *word, const char *name, long *number) {
    const size_t length = strlen(name);
    if (strncmp(word, name, length) != 0 || word[length] != '=') return 0;
    *number = strtol(word + length + 1, NULL, 10);
    return 1;
}

static int switch_option(const char *word, const char *name, int *on) {
    if (strcmp(word, name) != 0) return 0;
    return *on = 1;
}

/* The place of the program among the words. */
static int read_options(int count, char **words) {
    struct paths scratch = {0};
    long life = -1, report = -1;
    int place = 1;
    for (; place < count && strcmp(words[place], "--") != 0; place++) {
        const char *word = words[place];
        if (switch_option(word, "--namespaces", &plan.namespaces) || switch_option(word, "--landlock", &plan.landlock) ||
            switch_option(word, "--seccomp", &plan.seccomp) || path_option(word, "--scratch", &scratch) ||
            path_option(word, "--private", &plan.private) || path_option(word, "--show", &plan.show) ||
            path_option(word, "--hide", &plan.hide) || path_option(word, "--reveal", &plan.reveal) ||
            path_option(word, "--read", &plan.read) ||
            path_option(word, "--list", &plan.list) ||
            path_option(word, "--write", &plan.write) || number_option(word, "--judge", &plan.judge) ||
            number_option(word, "--threads", &plan.threads) || number_option(word, "--bytes", &plan.bytes) ||
            number_option(word, "--descriptors", &plan.descriptors) || number_option(word, "--life", &life) ||
            number_option(word, "--report", &report))
            continue;
        fail("unknown option %s", word);
    }
    plan.scratch = scratch.count ? scratch.path[0] : NULL;
    plan.life = (int)life;
    plan.report = (int)report;
    if (place + 1 >= count) fail("no program is given");
    return place + 1;
}

#include "mounts.h"

/* ---- the program itself ---- */

static void limit(int resource, long most) {
    struct rlimit now;
    if (most < 0 || getrlimit(resource, &now) != 0) return;
    if (now.rlim_max == RLIM_INFINITY || now.rlim_max > (rlim_t)most) now.rlim_max = (rlim_t)most;
    if (now.rlim_cur == RLIM_INFINITY || now.rlim_cur > now.rlim_max) now.rlim_cur = now.rlim_max;
    require(setrlimit(resource, &now), "cannot limit", "resources");
}

/* Processes of a user count in each user namespace by itself since Linux 5.14, and not at all for the superuser. */
static int counts_by_itself(void) {
    struct utsname system;
    int major = 0, minor = 0;
    if (!plan.namespaces || uname(&system) != 0 || sscanf(system.release, "%d.%d", &major, &minor) != 2) return 0;
    return major > 5 || (major == 5 && minor >= 14);
}

static void drop_capabilities(void) {
    /* Version 3 of linux/capability.h: two words of each set. */
    struct { uint32_t version; int process; } head = {0x20080522, 0};
    struct { uint32_t effective, permitted, inheritable; } none[2] = {{0}, {0}};
    for (int capability = 0; prctl(PR_CAPBSET_READ, capability, 0, 0, 0) >= 0; capability++)
        (void)prctl(PR_CAPBSET_DROP, capability, 0, 0, 0); /* refused where it has none to drop */
    require((int)syscall(SYS_capset, &head, none), "cannot drop", "capabilities");
}

/* Run the program, looked for on PATH where its name has no slash. execvp would give a file that is no program to a shell,
   and what starts would depend on whether it is isolated. Returns with errno where it cannot be run. */
static void execute(char **words) {
    const char *folder = getenv("PATH");
    char path[4096];
    int denied = 0;
    if (strchr(words[0], '/') != NULL) {
        execv(words[0], words);
        return;
    }
    if (folder == NULL) folder = "/bin:/usr/bin";
    for (;;) {
        errno = ENOENT;
        const size_t length = strcspn(folder, ":");
        const int used = snprintf(path, sizeof path, "%.*s%s%s", (int)length, folder, length ? "/" : "", words[0]);
        if (used > 0 && used < (int)sizeof path) execv(path, words);
        if (errno == EACCES) denied = 1;
        else if (errno != ENOENT && errno != ENOTDIR) return;
        if (folder[length] == '\0') break;
        folder += length + 1;
    }
    errno = denied ? EACCES : ENOENT;
}

static void become(char **words, long supervisor) {
    (void)setsid(); /* a signal to its group reaches no other */
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_NOFILE, plan.descriptors ? plan.descriptors : -1);
    limit(RLIMIT_FSIZE, plan.bytes ? plan.bytes : -1);
    if (counts_by_itself()) limit(RLIMIT_NPROC, plan.threads ? plan.threads : -1);
    drop_capabilities();
    require(prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0), "cannot refuse", "new privileges");
    if (plan.landlock) {
        const int rules = landlock_begin();
        require(rules, "cannot use", "Landlock");
        for (int i = 0; i < plan.read.count; i++) landlock_allow(rules, plan.read.path[i], LANDLOCK_READ);
        for (int i = 0; i < plan.list.count; i++) landlock_allow(rules, plan.list.path[i], LANDLOCK_LIST);
        for (int i = 0; i < plan.write.count; i++) landlock_allow(rules, plan.write.path[i], LANDLOCK_ALL);
        for (int i = 0; i < DEVICE_COUNT; i++) landlock_allow(rules, DEVICES[i], LANDLOCK_DEVICE);
        require(landlock_end(rules), "cannot use", "Landlock");
    }
    if (plan.seccomp) require(install_filter(plan.namespaces ? 0 : plan.judge, plan.namespaces ? 0 : supervisor), "cannot use", "seccomp");
    execute(words);
    fail("exec %s: %s", words[0], strerror(errno));
}

/* ---- supervision ---- */

/* End as a process with this wait status ended. */
static void end_as(int status) {
    if (WIFSIGNALED(status)) {
        limit(RLIMIT_CORE, 0);
        signal(WTERMSIG(status), SIG_DFL);
        raise(WTERMSIG(status));
    }
    _exit(WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status));
}

static void close_standard(void) {
    for (int stream = 0; stream < 3; stream++) close(stream);
}

/* The first process of the namespace: wait for the program, tell the supervisor how it ended, and end the others. */
static void be_first(char **words, int told) {
    (void)prctl(PR_SET_PDEATHSIG, SIGKILL, 0, 0, 0);
    mount_view();
    const pid_t program = fork();
    require(program, "cannot start", "a process");
    if (program == 0) become(words, 0);
    (void)prctl(PR_SET_DUMPABLE, 0, 0, 0, 0);
    close_standard();
    close(plan.report);
    for (;;) {
        int status;
        const pid_t ended = wait(&status);
        if (ended == program) {
            if (write(told, &status, sizeof status) < 0) _exit(1);
            _exit(0);
        }
        if (ended < 0 && errno == ECHILD) _exit(1);
    }
}

/* The parent of a process, of which `all` is the folder /proc; 0 where it has ended. */
static long parent_of(DIR *all, long process) {
    char path[64], text[512];
    long parent = 0;
    snprintf(path, sizeof path, "%ld/stat", process);
    const int file = openat(dirfd(all), path, O_RDONLY | O_CLOEXEC);
    if (file < 0) return 0;
    const ssize_t got = read(file, text, sizeof text - 1);
    close(file);
    if (got <= 0) return 0;
    text[got] = '\0';
    const char *after = strrchr(text, ')'); /* the name before it may hold anything */
    return after != NULL && sscanf(after + 1, " %*c %ld", &parent) == 1 ? parent : 0;
}

/* Kill the children of this process, again and again: those of a child that ended are its own then. `all` is /proc. */
static void end_children(DIR *all) {
    for (int round = 0; round < 2000; round++) {
        const struct dirent *each;
        if (all != NULL) rewinddir(all);
        while (all != NULL && (each = readdir(all)) != NULL) {
            const long process = strtol(each->d_name, NULL, 10);
            if (process > 1 && parent_of(all, process) == getpid()) kill((pid_t)process, SIGKILL);
        }
        while (waitpid(-1, NULL, WNOHANG) > 0) continue;
        if (waitpid(-1, NULL, WNOHANG) < 0 && errno == ECHILD) return;
        poll(NULL, 0, 1);
    }
}

static void note(int number) { (void)number; }

/* Wait until `child` ends or the caller is gone; the status of the program. */
static int supervise(pid_t child, int told) {
    struct pollfd life = {.fd = plan.life, .events = 0};
    sigset_t before;
    int status = 0, inside;
    DIR *all = opendir("/proc"); /* now: it may not have a descriptor later */
    sigprocmask(SIG_SETMASK, NULL, &before);
    sigdelset(&before, SIGCHLD);
    for (;;) {
        const pid_t ended = waitpid(-1, &status, WNOHANG);
        if (ended == child) break;
        if (ended > 0) continue;
        if (ppoll(&life, plan.life < 0 ? 0 : 1, NULL, &before) > 0) {
            kill(child, SIGKILL);
            status = SIGKILL;
            break;
        }
    }
    end_children(all);
    if (told >= 0 && read(told, &inside, sizeof inside) == (ssize_t)sizeof inside) status = inside;
    return status;
}

static int run(char **words) {
    int told[2] = {-1, -1};
    const long supervisor = getpid();
    sigset_t ended;
    struct sigaction noted = {.sa_handler = note};
    fcntl(plan.report, F_SETFD, FD_CLOEXEC);
    if (plan.life >= 0) fcntl(plan.life, F_SETFD, FD_CLOEXEC);
    if (plan.namespaces) {
        enter_namespaces();
        require(pipe2(told, O_CLOEXEC), "cannot make", "a pipe");
    } else
        require(prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0), "cannot be", "a subreaper");
    const pid_t child = fork();
    require(child, "cannot start", "a process");
    if (child == 0) {
        close(plan.life);
        if (plan.namespaces) be_first(words, told[1]);
        (void)prctl(PR_SET_PDEATHSIG, SIGKILL, 0, 0, 0);
        become(words, supervisor);
    }
    sigemptyset(&ended);
    sigaddset(&ended, SIGCHLD);
    sigprocmask(SIG_BLOCK, &ended, NULL);
    sigaction(SIGCHLD, &noted, NULL);
    (void)prctl(PR_SET_DUMPABLE, 0, 0, 0, 0);
    close_standard();
    close(plan.report);
    if (told[1] >= 0) close(told[1]);
    end_as(supervise(child, told[0]));
    return 1;
}

/* ---- what this system allows ---- */

/* Try a step in a process of its own and print "NAME" and why it failed, or nothing. */
static void try_step(const char *name, void (*step)(void)) {
    int answer[2];
    char text[1024];
    require(pipe2(answer, O_CLOEXEC), "cannot make", "a pipe");
    const pid_t child = fork();
    require(child, "cannot start", "a process");
    if (child == 0) {
        plan.report = answer[1];
        step();
        _exit(0);
    }
    close(answer[1]);
    const ssize_t got = read(answer[0], text, sizeof text - 1);
    close(answer[0]);
    waitpid(child, NULL, 0);
    text[got > 0 ? got : 0] = '\0';
    const char *reason = strchr(text, ' ');
    printf("%s %s\n", name, reason != NULL ? reason + 1 : "");
}

static void try_view(void) {
    mount_view();
    _exit(0);
}

static void try_namespaces(void) {
    int status = 0;
    enter_namespaces();
    require(chdir("/"), "cannot enter", "/"); /* the folder of the caller may be below /tmp */
    plan.scratch = "/tmp";
    plan.bytes = 1 << 20;
    const pid_t first = fork();
    require(first, "cannot start", "a process");
    if (first == 0) try_view();
    waitpid(first, &status, 0);
}

static void try_landlock(void) {
    require(landlock_begin(), "Landlock:", "the system call");
}

static void try_seccomp(void) {
    require(prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0), "cannot refuse", "new privileges");
    require(install_filter(0, 0), "seccomp:", "the system call");
}

int main(int count, char **words) {
    if (count == 2 && strcmp(words[1], "--probe") == 0) {
        try_step("namespaces", try_namespaces);
        try_step("landlock", try_landlock);
        try_step("seccomp", try_seccomp);
        printf("abi %d\n", landlock_version());
        return 0;
    }
    return run(words + read_options(count, words));
}
