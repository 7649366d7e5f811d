/* The filter of system calls: what no answer to a question about geometry needs (seccomp(2), linux/seccomp.h).

   What only an attack on the system calls ends the process with SIGSYS, so that the run says so. What ordinary programs
   try and can do without fails, as if this system did not have it (ENOSYS) or did not allow it (EPERM): sockets, tracing
   (the leak sanitizer tries it as it ends), memory that is in no process (memfd, System V), and whatever later systems
   have. Without namespaces fails too what reaches other processes, or changes a file that is not open for writing. All
   else is allowed, so that runtimes run as they always do. */

#ifndef HYPCHECK_FILTER_H
#define HYPCHECK_FILTER_H

#include <errno.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <stddef.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#ifndef SECCOMP_RET_KILL_PROCESS
#define SECCOMP_RET_KILL_PROCESS 0x80000000U
#endif
#ifndef SECCOMP_FILTER_FLAG_SPEC_ALLOW
#define SECCOMP_FILTER_FLAG_SPEC_ALLOW (1UL << 2) /* no slower than without a filter: Linux 4.17 */
#endif

#if defined(__x86_64__)
#define NATIVE AUDIT_ARCH_X86_64
#elif defined(__aarch64__)
#define NATIVE AUDIT_ARCH_AARCH64
#elif defined(__riscv) && __riscv_xlen == 64
#define NATIVE AUDIT_ARCH_RISCV64
#elif defined(__powerpc64__) && defined(__LITTLE_ENDIAN__)
#define NATIVE AUDIT_ARCH_PPC64LE
#endif

/* Calls that only an attack makes. Numbers from 424 on are the same on every architecture. */
static const unsigned short KILLED[] = {
    SYS_process_vm_writev, SYS_kexec_load, SYS_init_module, SYS_finit_module, SYS_delete_module, SYS_reboot,
    SYS_mount, SYS_umount2, SYS_pivot_root, SYS_chroot, SYS_swapon, SYS_swapoff, SYS_acct, SYS_quotactl,
    SYS_open_by_handle_at, SYS_setns, SYS_keyctl, SYS_add_key, SYS_request_key, SYS_bpf, SYS_settimeofday,
    SYS_clock_settime, SYS_adjtimex, SYS_clock_adjtime, SYS_sethostname, SYS_setdomainname, SYS_vhangup,
    428 /* open_tree */, 429 /* move_mount */, 430 /* fsopen */, 431 /* fsconfig */, 432 /* fsmount */,
    433 /* fspick */, 438 /* pidfd_getfd */, 442 /* mount_setattr */,
#ifdef SYS_kexec_file_load
    SYS_kexec_file_load,
#endif
#ifdef SYS_ioperm
    SYS_ioperm, SYS_iopl,
#endif
};

/* Calls that ordinary programs may try: EPERM. */
static const unsigned short REFUSED[] = {
    SYS_socket, SYS_ptrace, SYS_process_vm_readv, SYS_perf_event_open, SYS_kcmp, SYS_unshare, SYS_syslog,
    SYS_mq_open, SYS_semget, SYS_msgget,
};

/* Calls that programs can do without where a system does not have them: ENOSYS. clone3 passes its flags in memory. */
static const unsigned short UNKNOWN[] = {
    SYS_memfd_create, SYS_userfaultfd, SYS_shmget, 424 /* pidfd_send_signal */, 425 /* io_uring_setup */,
    426 /* io_uring_enter */, 427 /* io_uring_register */, 435 /* clone3 */, 440 /* process_madvise */, 447 /* memfd_secret */,
    448 /* process_mrelease */,
};

/* Calls whose first argument is the process that gets a signal or is opened. */
static const unsigned short SIGNALS[] = {
    SYS_kill, SYS_tkill, SYS_tgkill, SYS_rt_sigqueueinfo, SYS_rt_tgsigqueueinfo, 434 /* pidfd_open */,
};

/* Calls with a process or a thread as first argument; 0 is the one that calls. */
static const unsigned short OF_PROCESS[] = {
    SYS_prlimit64, SYS_sched_setaffinity, SYS_sched_setscheduler, SYS_sched_setparam, SYS_sched_setattr,
};

/* Calls that change mode, owner, times or attributes. Of which file, neither a filter nor Landlock can tell. */
static const unsigned short OF_FILE[] = {
    SYS_fchmod, SYS_fchmodat, SYS_fchown, SYS_fchownat, SYS_utimensat, SYS_setxattr, SYS_lsetxattr, SYS_fsetxattr,
    SYS_removexattr, SYS_lremovexattr, SYS_fremovexattr, 452 /* fchmodat2 */, 463 /* setxattrat */, 466 /* removexattrat */,
#ifdef SYS_chmod
    SYS_chmod, SYS_chown, SYS_lchown, SYS_utime, SYS_utimes, SYS_futimesat,
#endif
};

/* From this number on, the same on every architecture, no call was known when this was written (Linux 6.14). */
enum { LATER = 467 };

/* IOPRIO_WHO_PROCESS of linux/ioprio.h, and PRIO_PROCESS of sys/resource.h. */
enum { FILES_OF_PROCESS = 1, TIME_OF_PROCESS = 0 };

#if defined(__x86_64__)
/* The same for programs of 32 bits (arch/x86/entry/syscalls/syscall_32.tbl). */
static const unsigned short KILLED_32[] = {
    348, 283, 128, 350, 129, 88, 21, 22, 52, 217, 61, 87, 115, 51, 131, 342, 346, 288, 286, 287, 357, 79, 264, 124, 343,
    74, 121, 111, 428, 429, 430, 431, 432, 433, 438, 442, 101, 110, 25, 404, 405,
};
static const unsigned short REFUSED_32[] = {359, 26, 347, 336, 349, 310, 103, 277, 393, 399, 117 /* ipc */, 102 /* socketcall */};
static const unsigned short UNKNOWN_32[] = {356, 374, 395, 424, 425, 426, 427, 435, 447};
static const unsigned short SIGNALS_32[] = {37, 238, 270, 178, 335, 434};
static const unsigned short OF_PROCESS_32[] = {340, 241, 156, 154, 351};
static const unsigned short OF_FILE_32[] = {
    15, 94, 306, 16, 95, 182, 198, 207, 212, 298, 30, 271, 299, 320, 412, 226, 227, 228, 235, 236, 237, 452, 463, 466,
};
enum { CLONE_32 = 120, SETPRIORITY_32 = 97, IOPRIO_SET_32 = 289 };
#endif

enum { LONGEST = 600 };
static struct sock_filter code[LONGEST];
static unsigned short length;

static void emit(struct sock_filter instruction) {
    if (length < LONGEST) code[length] = instruction;
    length++;
}

static void load(size_t offset) {
    emit((struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, (unsigned)offset));
}

static void when_equal(unsigned value, unsigned result) {
    emit((struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0, 1));
    emit((struct sock_filter)BPF_STMT(BPF_RET | BPF_K, result));
}

static void end_with(unsigned result) {
    emit((struct sock_filter)BPF_STMT(BPF_RET | BPF_K, result));
}

#define EACH(table, result) \
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) when_equal(table[i], result)

/* The low half of an argument; the first is 0. */
static size_t argument(unsigned number) {
    const unsigned one = 1;
    return offsetof(struct seccomp_data, args) + 8 * number + (*(const char *)&one ? 0 : 4);
}

/* Begin a block for this value; end_when sets the jump over it. */
static unsigned short begin_when(unsigned value) {
    emit((struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0, 0));
    return (unsigned short)(length - 1);
}

static void end_when(unsigned short start) {
    const int distance = length - start - 1;
    if (distance > 255) length = LONGEST + 1; /* a jump has eight bits */
    else if (start < LONGEST) code[start].jf = (unsigned char)distance;
}

static void no_new_namespace(unsigned clone_number) {
    const unsigned short start = begin_when(clone_number);
    load(argument(0));
    emit((struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K,
                                      CLONE_NEWUSER | CLONE_NEWNS | CLONE_NEWPID | CLONE_NEWNET | CLONE_NEWIPC, 0, 1));
    end_with(SECCOMP_RET_ERRNO | EPERM);
    end_with(SECCOMP_RET_ALLOW);
    end_when(start);
}

/* Begin a block of that many instructions for each of these calls. */
static void when_any(const unsigned short *calls, unsigned char count, unsigned instructions) {
    for (unsigned char i = 0; i < count; i++)
        emit((struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, calls[i], count - i, 0));
    emit((struct sock_filter)BPF_STMT(BPF_JMP | BPF_JA, instructions));
}

static void no_signal(const unsigned short *calls, unsigned char count, long judge, long supervisor) {
    const long spared[] = {judge, supervisor, -judge, -supervisor, -1 /* every process of this user */};
    const unsigned char spared_count = sizeof spared / sizeof *spared;
    when_any(calls, count, 2U * spared_count + 2);
    load(argument(0));
    for (unsigned char i = 0; i < spared_count; i++) when_equal((unsigned)spared[i], SECCOMP_RET_ERRNO | EPERM);
    end_with(SECCOMP_RET_ALLOW);
}

static void only_of_itself(const unsigned short *calls, unsigned char count) {
    when_any(calls, count, 4);
    load(argument(0));
    when_equal(0, SECCOMP_RET_ALLOW);
    end_with(SECCOMP_RET_ERRNO | EPERM);
}

/* A call whose first argument says what its second is: `of_process`, and 0 for the one that calls. */
static void only_own_priority(unsigned short call, unsigned of_process) {
    when_any(&call, 1, 6);
    load(argument(0));
    emit((struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, of_process, 0, 3));
    load(argument(1));
    when_equal(0, SECCOMP_RET_ALLOW);
    end_with(SECCOMP_RET_ERRNO | EPERM);
}

static void refuse_later(void) {
    emit((struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, LATER, 0, 1)); /* those of x32 too */
    end_with(SECCOMP_RET_ERRNO | ENOSYS);
}

#define COUNTED(table) table, sizeof table / sizeof *table

/* Install it for this process and its children; `judge` and `supervisor` are 0 with namespaces, which keep all others
   away. No signal from here reaches these two, no other process gets other limits or priorities, and no file another mode.
   Needs PR_SET_NO_NEW_PRIVS before. -1 and errno where the system or the architecture has no filters. */
static int install_filter(long judge, long supervisor) {
#ifndef NATIVE
    (void)judge, (void)supervisor;
    errno = ENOSYS;
    return -1;
#else
    struct sock_fprog program;
    length = 0;
    load(offsetof(struct seccomp_data, arch));
#if defined(__x86_64__)
    const unsigned short narrow = begin_when(AUDIT_ARCH_I386);
    load(offsetof(struct seccomp_data, nr));
    EACH(KILLED_32, SECCOMP_RET_KILL_PROCESS);
    EACH(REFUSED_32, SECCOMP_RET_ERRNO | EPERM);
    EACH(UNKNOWN_32, SECCOMP_RET_ERRNO | ENOSYS);
    refuse_later();
    no_new_namespace(CLONE_32);
    if (judge) {
        EACH(OF_FILE_32, SECCOMP_RET_ERRNO | EPERM);
        no_signal(COUNTED(SIGNALS_32), judge, supervisor);
        only_of_itself(COUNTED(OF_PROCESS_32));
        only_own_priority(SETPRIORITY_32, TIME_OF_PROCESS);
        only_own_priority(IOPRIO_SET_32, FILES_OF_PROCESS);
    }
    end_with(SECCOMP_RET_ALLOW);
    end_when(narrow);
#endif
    emit((struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, NATIVE, 1, 0));
    end_with(SECCOMP_RET_ERRNO | ENOSYS);
    load(offsetof(struct seccomp_data, nr));
    EACH(KILLED, SECCOMP_RET_KILL_PROCESS);
    EACH(REFUSED, SECCOMP_RET_ERRNO | EPERM);
    EACH(UNKNOWN, SECCOMP_RET_ERRNO | ENOSYS);
    refuse_later();
    no_new_namespace(SYS_clone);
    if (judge) {
        EACH(OF_FILE, SECCOMP_RET_ERRNO | EPERM);
        no_signal(COUNTED(SIGNALS), judge, supervisor);
        only_of_itself(COUNTED(OF_PROCESS));
        only_own_priority(SYS_setpriority, TIME_OF_PROCESS);
        only_own_priority(SYS_ioprio_set, FILES_OF_PROCESS);
    }
    end_with(SECCOMP_RET_ALLOW);
    if (length > LONGEST) {
        errno = E2BIG;
        return -1;
    }
    program.len = length;
    program.filter = code;
    return (int)syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_SPEC_ALLOW, &program);
#endif
}

#endif
