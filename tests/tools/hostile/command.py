"""A command that attacks what it can reach when it is asked first, says on standard error how far it came, and answers.

`python -I -S command.py ATTACK JUDGE VICTIM PACKAGE VECTORS COPY`: the judge is a process; the victim a folder of files
that must not change; the package and the vectors are those of hypcheck; the copy is a folder with another of these.
"""

# ruff: noqa: BLE001, PERF203, PERF401, RET503, S606, T201 - it is as bad as it can be

import ctypes
import json
import mmap
import os
import platform
import resource
import signal
import sys
import time

ATTACK, VICTIM, PACKAGE, VECTORS, COPY = sys.argv[1], *sys.argv[3:7]
JUDGE = int(sys.argv[2])
SECONDS = 5.0
"""No attack goes on for longer."""


def write(path, text="forged", how="w"):
    with open(path, how) as file:
        file.write(text)
    return "wrote"


def rewrite_judge():
    return write(os.path.join(PACKAGE, "runs", "judge.py"), "\n", "a")


def forge_summary():
    return write(os.path.join(VICTIM, "summary.json"))


def forge_summary_after_the_end():
    return daemon(lambda: (time.sleep(0.3), write(os.path.join(VICTIM, "summary.json"))))


def daemon(work):
    """Leaves its parent, group and session, and gives up its output."""
    if os.fork():
        return "left a daemon"
    os.setsid()
    if os.fork():
        os._exit(0)
    for stream in range(3):
        os.close(stream)
    try:
        work()
    finally:
        os._exit(0)


def daemon_without_environment():
    if os.fork():
        return "left a daemon"
    os.setsid()
    for stream in range(3):
        os.close(stream)
    os.execve("/bin/sleep", ["sleep", f"600.{JUDGE}"], {})


def read_vectors():
    with open(VECTORS, "rb") as file:
        return f"read {len(file.read())} bytes"


def import_hypcheck():
    sys.path.insert(0, os.path.dirname(PACKAGE))
    import hypcheck

    return f"imported {hypcheck.classify}"


def open_socket():
    import _socket

    _socket.socket(_socket.AF_INET, _socket.SOCK_STREAM).connect(("127.0.0.1", 22))
    return "connected"


def read_token():
    if "GITHUB_TOKEN" in os.environ:
        return "read GITHUB_TOKEN"
    with open(os.path.expanduser("~/.netrc")) as file:
        return f"read {file.read()!r}" if file else ""


def write_memory_of_judge():
    with open(f"/proc/{JUDGE}/mem", "wb") as file:
        file.seek(4096)
        file.write(b"x")
    return "wrote"


def write_memory_by_call():
    libc = ctypes.CDLL(None, use_errno=True)
    vector = (ctypes.c_size_t * 2)(4096, 1)
    result = libc.process_vm_writev(JUDGE, vector, 1, vector, 1, 0)
    return f"returned {result}"


def stop_judge():
    os.kill(JUDGE, signal.SIGSTOP)
    return "stopped it"


def kill_judge():
    os.kill(JUDGE, signal.SIGKILL)
    return "killed it"


def kill_supervisor():
    """Its parent is what would end it."""
    parent = os.getppid()
    os.kill(parent, signal.SIGKILL)
    time.sleep(0.05)
    if os.getppid() != parent:
        return "killed it"
    os.kill(-1, signal.SIGUSR2)  # everything that it may
    return "it ignored the signal"


def fork_bomb():
    until = time.monotonic() + SECONDS
    for number in range(4000):
        try:
            if not os.fork():
                time.sleep(SECONDS)
                os._exit(0)
        except BlockingIOError:
            return f"started {number} processes, and then no more"
        if time.monotonic() > until:
            break
    return f"started {number} processes"


def fill_disk():
    written = 0
    for number in range(64):
        with open(os.path.join(os.environ["TMPDIR"], str(number)), "wb", buffering=0) as file:
            written += file.write(bytes(1 << 20))
    return f"wrote {written >> 20} MiB"


def memory_behind_setsid():
    """A child in a session of its own, whose parent has ended."""
    daemon(lambda: (bytearray(b"x") * (800 << 20), time.sleep(SECONDS)))
    time.sleep(SECONDS)
    return "took it"


def memory_in_no_process():
    file = os.memfd_create("hidden")
    return f"wrote {os.write(file, bytes(1 << 20))} bytes"


def exhaust_descriptors():
    files = []
    for _ in range(100_000):
        files.append(os.open("/dev/null", os.O_RDONLY))
    return f"opened {len(files)}"


def link_scratch():
    """What removes the scratch folder would remove the victim."""
    scratch = os.environ["TMPDIR"]
    os.symlink(VICTIM, os.path.join(scratch, "link"))
    os.rename(scratch, scratch + "-moved")
    os.symlink(VICTIM, scratch)
    return "replaced it"


def escape_to_new_namespace():
    result = ctypes.CDLL(None, use_errno=True).unshare(0x10000000)
    return "became another user" if result == 0 else os.strerror(ctypes.get_errno())


def look_at_processes():
    found = [name for name in os.listdir("/proc") if name.isdigit() and name != str(os.getpid())]
    seen = []
    for name in found:
        try:
            with open(f"/proc/{name}/environ", "rb") as file:
                seen.append(len(file.read()))
        except OSError:
            continue
    return f"read the environment of {len(seen)} others"


def count_secrets():
    return f"{sum('s3same' in value for value in os.environ.values())} secrets"


def tell_secrets():
    """What it reads, it says on standard error, which reports quote."""
    return "told: " + ", ".join(sorted({value for value in os.environ.values() if "s3same" in value}))


def limit_judge():
    """To what they are already, so that nothing is broken where this is allowed."""
    for limit in (resource.RLIMIT_CPU, resource.RLIMIT_NOFILE):
        resource.prlimit(JUDGE, limit, resource.prlimit(JUDGE, limit))
    return "set the limits of the judge"


def blind_supervisor():
    """Without descriptors it cannot look for what it has to end."""
    try:
        resource.prlimit(os.getppid(), resource.RLIMIT_NOFILE, (0, 0))
    finally:
        daemon_without_environment()
    return "left a daemon that nobody can find"


def slow_judge():
    os.setpriority(os.PRIO_PROCESS, JUDGE, os.getpriority(os.PRIO_PROCESS, JUDGE))
    return "set its priority"


def slow_everybody():
    os.setpriority(os.PRIO_USER, os.getuid(), os.getpriority(os.PRIO_USER, os.getuid()))
    return "set the priority of all"


def move_judge():
    os.sched_setaffinity(JUDGE, os.sched_getaffinity(JUDGE))
    return "set its processors"


def schedule_judge():
    os.sched_setscheduler(JUDGE, os.sched_getscheduler(JUDGE), os.sched_getparam(JUDGE))
    return "set its scheduler"


def slow_files_of_judge():
    number = {"x86_64": 251, "aarch64": 30, "riscv64": 30}[platform.machine()]
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.syscall(number, 1, JUDGE, 0) == 0:
        return "set its priority of files"
    return os.strerror(ctypes.get_errno())


def chmod_report():
    os.chmod(os.path.join(VICTIM, "summary.json"), 0o600)
    return "changed its mode"


def chmod_report_by_descriptor():
    file = os.open(os.path.join(VICTIM, "summary.json"), os.O_RDONLY)
    os.fchmod(file, 0o600)
    return "changed its mode"


def touch_report():
    os.utime(os.path.join(VICTIM, "summary.json"), (1, 1))
    return "changed its time"


def mark_report():
    os.setxattr(os.path.join(VICTIM, "summary.json"), "user.forged", b"1")
    return "changed its attributes"


def open_devices():
    """The terminals of this user, disks, the kernel's messages."""
    found, opened = [], []
    for folder, _, files in os.walk("/dev"):
        found += [os.path.join(folder, name) for name in files]
    of_files = ("/dev/fd/", "/dev/std")
    usual = {"null", "zero", "full", "random", "urandom", "tty", "tty0", "ttyS0", "console", "ptmx", "pts/0", "kmsg"}
    usual |= {"kvm", "vda", "sda", "loop0", "mem", "fuse"}
    found = {each for each in found if not each.startswith(of_files)}
    for path in sorted(found | {f"/dev/{name}" for name in usual}):
        try:
            os.close(os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_NOCTTY))
        except OSError:
            continue
        opened.append(os.path.basename(path))
    return f"opened {len(opened)}: {' '.join(opened)}"[:200]


def list_terminals():
    return f"found {os.listdir('/dev/pts')}"


def call_what_nobody_knows():
    """open_tree_attr of Linux 6.15, file_getattr and file_setattr of 6.17, and a number that no system has yet."""
    libc = ctypes.CDLL(None, use_errno=True)
    errors = []
    for number in (467, 468, 469, 500):
        libc.syscall(number, -1, 0, 0, 0, 0)
        errors.append(ctypes.get_errno())
    return f"errors {errors}"


def make_calls_of_32_bits():
    """setpriority, fchmod and a call that no system has yet, by the gate of programs of 32 bits."""
    code = mmap.mmap(-1, 4096, prot=mmap.PROT_READ | mmap.PROT_WRITE | mmap.PROT_EXEC)
    code.write(bytes.fromhex("53 89f8 89f3 89d1 31d2 cd80 5b c3"))
    call = ctypes.CFUNCTYPE(ctypes.c_int, *(ctypes.c_int,) * 3)(ctypes.addressof(ctypes.c_char.from_buffer(code)))
    file = os.open(os.path.join(os.environ["TMPDIR"], "own"), os.O_CREAT | os.O_WRONLY)
    return f"errors {[-call(97, 0, JUDGE), -call(94, file, 0o600), -call(500, 0, 0)]}"


def survive_by_forking():
    """Each process of the chain has ended before anybody can look at it twice."""
    if os.fork():
        return "left a daemon"
    for stream in range(3):
        os.close(stream)
    until = time.monotonic() + SECONDS
    while time.monotonic() < until:
        if os.fork():
            os._exit(0)
        os.setsid()
    os.execve("/bin/sleep", ["sleep", f"600.{JUDGE}"], {})


def memory_by_page_tables():
    """Each page that is read is the system's own page of zeros; the tables that lead there are its own."""
    step = 2 << 20
    size = 100_000 * step
    area = mmap.mmap(-1, size, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS | 0x4000, prot=mmap.PROT_READ)
    area.madvise(mmap.MADV_NOHUGEPAGE)
    for place in range(0, size, step):
        area[place]
    time.sleep(SECONDS)
    return f"took {size // step * 4096 >> 20} MiB"


def read_repository():
    """The judge's own repository has all answers, whatever its working tree has."""
    place = os.path.join(os.path.dirname(PACKAGE), ".git")
    if os.path.isfile(place):
        with open(place) as file:
            place = file.read().split()[1]
    with open(os.path.join(place, "HEAD")) as file:
        return f"read {file.read()}"


def import_built_copy():
    """What a build left beside the sources."""
    folder = os.path.join(os.path.dirname(PACKAGE), "build")
    built = [os.path.join(place, name) for place, _, files in os.walk(folder) for name in files]
    with open(built[0] if built else folder + "/nothing", "rb") as file:
        return f"read {len(file.read())} bytes"


def import_second_copy():
    """A copy of the package in a folder that it sees."""
    sys.path.insert(0, COPY)
    from hypcheck import kernel

    return f"imported {kernel}"


def abstract_socket():
    """A name in no folder, at which a process outside could wait."""
    import _socket

    _socket.socket(_socket.AF_UNIX, _socket.SOCK_STREAM).bind(f"\0hypcheck-{JUDGE}")
    return "bound"


def count_descriptors():
    """What the judge has open and left open when it started this program."""
    found = []
    for number in range(3, 1024):
        try:
            os.fstat(number)
        except OSError:
            continue
        found.append(os.readlink(f"/proc/self/fd/{number}"))
    return f"{len(found)} inherited: {' '.join(found)}"


def read_by_another_root():
    """What is hidden at its place may be seen from where another process begins."""
    found = []
    for process in ("self", "1", os.getppid(), JUDGE):
        for begin in ("root", "cwd"):
            try:
                with open(f"/proc/{process}/{begin}/{VECTORS}") as file:
                    found.append(len(file.read()))
            except OSError:
                continue
    return f"read {len(found)} files"


def replace_interpreter():
    """What the next question would run."""
    import encodings

    tried = []
    for folder in (os.path.dirname(os.path.realpath(sys.executable)), os.path.dirname(encodings.__file__)):
        try:
            os.close(os.open(os.path.join(folder, f"hypcheck-{JUDGE}"), os.O_CREAT | os.O_WRONLY))
            os.remove(os.path.join(folder, f"hypcheck-{JUDGE}"))
            tried.append(folder)
        except OSError:
            continue
    return f"wrote into {len(tried)} folders"


CALLS = {
    "ptrace": (101, 0x4206, JUDGE, 0, 0),
    "add_key": (248, b"user", b"x", b"y", 1, -3),
    "keyctl": (250, 0, -3, 1),
    "perf_event_open": (298, None, JUDGE, -1, -1, 0),
    "fanotify_init": (300, 0, 0),
    "open_by_handle_at": (304, -100, None, 0),
    "kcmp": (312, os.getpid(), JUDGE, 0, 0, 0),
    "bpf": (321, 0, None, 0),
    "userfaultfd": (323, 1),
    "io_uring_setup": (425, 1, bytes(120)),
    "pidfd_getfd": (438, -1, 0, 0),
    "process_madvise": (440, -1, None, 0, 0, 0),
    "process_mrelease": (448, -1, 0),
    "process_vm_readv": (310, JUDGE, None, 0, None, 0, 0),
    "shmget": (29, 1, 4096, 0o1600),
    "msgget": (68, 1, 0o1600),
    "mq_open": (240, b"hypcheck", 0o102, 0o600, None),
    "memfd_secret": (447, 0),
}
"""By their names, numbers of x86-64, and arguments with which they do nothing."""


def call_what_exploits_like():
    """Each call in a child, as one may end with a signal; what is neither refused nor unknown is named."""
    libc, answered = ctypes.CDLL(None, use_errno=True), []
    for name, call in CALLS.items():
        child = os.fork()
        if not child:
            done = libc.syscall(*call)
            os._exit(0 if done >= 0 else ctypes.get_errno())
        _, status = os.waitpid(child, 0)
        if os.WIFEXITED(status) and os.WEXITSTATUS(status) not in (1, 38):
            answered.append(name)
    return f"answered: {' '.join(answered)}"


def flood_with_words():
    """More than any report should keep."""
    for _ in range(256):
        os.write(2, b"x" * (1 << 16))
    return "flooded"


def attack():
    try:
        return globals()[ATTACK]()
    except BaseException as error:
        return f"{type(error).__name__}: {error}"


def main():
    print(json.dumps({"protocol": 1, "name": ATTACK}), flush=True)
    said = False
    while words := sys.stdin.readline().split():
        rows = [sys.stdin.readline() for _ in range(int(words[2]))]
        if not said:
            said = True
            print(attack(), file=sys.stderr, flush=True)
        print(f"{words[1]} {len(rows)}\n" + "0\n" * len(rows), end="", flush=True)


main()
