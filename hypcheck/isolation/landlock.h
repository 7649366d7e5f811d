/* Landlock (linux/landlock.h, Linux 5.13): a process gives up all files but those that rules name, for itself and its
   children. The constants stand here since the headers of the system that compiles may be older than the one that runs. */

#ifndef HYPCHECK_LANDLOCK_H
#define HYPCHECK_LANDLOCK_H

#include <fcntl.h>
#include <stdint.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

/* The numbers are the same on every architecture (include/uapi/asm-generic/unistd.h). */
enum { SYSTEM_CREATE_RULESET = 444, SYSTEM_ADD_RULE = 445, SYSTEM_RESTRICT_SELF = 446 };

/* struct landlock_ruleset_attr and struct landlock_path_beneath_attr. */
struct landlock_handled {
    uint64_t files, network, scopes;
};
struct landlock_beneath {
    uint64_t allowed;
    int32_t parent;
} __attribute__((packed));

/* LANDLOCK_ACCESS_FS_*: EXECUTE, WRITE_FILE, READ_FILE, READ_DIR, and to MAKE_SYM (1 << 12) in the first version. */
#define LANDLOCK_READ ((uint64_t)(1 << 0 | 1 << 2 | 1 << 3))
#define LANDLOCK_LIST ((uint64_t)(1 << 3))
#define LANDLOCK_FIRST ((uint64_t)(1 << 13) - 1)
#define LANDLOCK_REFER ((uint64_t)1 << 13)    /* version 2 */
#define LANDLOCK_TRUNCATE ((uint64_t)1 << 14) /* version 3 */
#define LANDLOCK_IOCTL ((uint64_t)1 << 15)    /* version 5 */
#define LANDLOCK_ALL (~(uint64_t)0)
#define LANDLOCK_DEVICE ((uint64_t)(1 << 1 | 1 << 2) | LANDLOCK_TRUNCATE | LANDLOCK_IOCTL)
/* What a rule about a file that is no folder may allow. */
#define LANDLOCK_OF_FILE ((uint64_t)(1 << 0 | 1 << 1 | 1 << 2) | LANDLOCK_TRUNCATE | LANDLOCK_IOCTL)
/* LANDLOCK_ACCESS_NET_BIND_TCP and CONNECT_TCP: version 4. LANDLOCK_SCOPE_ABSTRACT_UNIX_SOCKET and SIGNAL: version 6. */
enum { LANDLOCK_TCP = 3, LANDLOCK_SCOPES = 3, LANDLOCK_RULE_BENEATH = 1, LANDLOCK_ASK_VERSION = 1 };

static int landlock_version(void) {
    const long version = syscall(SYSTEM_CREATE_RULESET, NULL, 0, LANDLOCK_ASK_VERSION);
    return version < 0 ? 0 : (int)version;
}

static uint64_t landlock_files(int version) {
    return LANDLOCK_FIRST | (version >= 2 ? LANDLOCK_REFER : 0) | (version >= 3 ? LANDLOCK_TRUNCATE : 0) |
           (version >= 5 ? LANDLOCK_IOCTL : 0);
}

/* A set of rules to add to; -1 where there is no Landlock. */
static int landlock_begin(void) {
    const int version = landlock_version();
    const struct landlock_handled handled = {landlock_files(version), LANDLOCK_TCP, LANDLOCK_SCOPES};
    const size_t size = version >= 6 ? sizeof handled : version >= 4 ? 2 * sizeof(uint64_t) : sizeof(uint64_t);
    if (version == 0) return -1;
    return (int)syscall(SYSTEM_CREATE_RULESET, &handled, size, 0);
}

/* Allow that access to a path and what is below; a path that is not there needs no rule. */
static void landlock_allow(int rules, const char *path, uint64_t access) {
    struct landlock_beneath rule = {access & landlock_files(landlock_version()), open(path, O_PATH | O_CLOEXEC)};
    struct stat found;
    if (rule.parent < 0) return;
    if (fstat(rule.parent, &found) != 0 || !S_ISDIR(found.st_mode)) rule.allowed &= LANDLOCK_OF_FILE;
    (void)syscall(SYSTEM_ADD_RULE, rules, LANDLOCK_RULE_BENEATH, &rule, 0);
    close(rule.parent);
}

/* Needs PR_SET_NO_NEW_PRIVS before. */
static int landlock_end(int rules) {
    const int result = (int)syscall(SYSTEM_RESTRICT_SELF, rules, 0);
    close(rules);
    return result;
}

#endif
