"""A command that attacks what it can reach when it is asked first, says on standard error how far it came, and answers.

`python -I -S command.py ATTACK JUDGE VICTIM PACKAGE VECTORS`: the judge is a process; the victim a folder of files that
must not change; the package and the vectors are those of hypcheck.
"""

# ruff: noqa: BLE001, PERF203, PERF401, RET503, S606, T201 - it is as bad as it can be

import ctypes
import json
import os
import signal
import sys
import time

ATTACK, VICTIM, PACKAGE, VECTORS = sys.argv[1], *sys.argv[3:6]
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
