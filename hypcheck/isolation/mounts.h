/* Namespaces, and what a program in them sees of the machine's files. Part of launcher.c, which includes it once. */

static void write_file(const char *path, const char *text) {
    const int file = open(path, O_WRONLY | O_CLOEXEC);
    require(file, "cannot open", path);
    if (write(file, text, strlen(text)) < 0) fail("cannot write %s: %s", path, strerror(errno));
    close(file);
}

static void enter_namespaces(void) {
    const unsigned user = geteuid(), group = getegid();
    char map[64];
    require(unshare(CLONE_NEWUSER | CLONE_NEWNS | CLONE_NEWPID | CLONE_NEWNET | CLONE_NEWIPC | CLONE_NEWUTS), "cannot make",
            "namespaces");
    write_file("/proc/self/setgroups", "deny");
    snprintf(map, sizeof map, "%u %u 1", user, user);
    write_file("/proc/self/uid_map", map);
    snprintf(map, sizeof map, "%u %u 1", group, group);
    write_file("/proc/self/gid_map", map);
}

/* Of linux/mount.h, since Linux 5.12. */
struct mount_attributes {
    uint64_t set, clear, propagation, user_namespace;
};
#ifndef SYS_mount_setattr
#define SYS_mount_setattr 442
#endif
enum { READ_ONLY = 1, NO_SETUID = 2 };

static void read_only(const char *path, int all_below) {
    struct mount_attributes attributes = {.set = READ_ONLY | NO_SETUID};
    require((int)syscall(SYS_mount_setattr, AT_FDCWD, path, all_below ? 0x8000 /* AT_RECURSIVE */ : 0, &attributes,
                         sizeof attributes),
            "cannot make read-only", path);
}

static void make_folders(const char *path) {
    char part[4096];
    if (strlen(path) >= sizeof part) fail("a path is too long: %s", path);
    for (size_t end = 1; path[end - 1]; end++) {
        if (path[end] != '/' && path[end] != '\0') continue;
        memcpy(part, path, end);
        part[end] = '\0';
        if (mkdir(part, 0755) != 0 && errno != EEXIST && errno != EROFS) fail("cannot make %s: %s", part, strerror(errno));
    }
}

/* Mount what `source` is open on at `target`, a folder or a file. */
static void bind(int source, const char *target) {
    char link[64];
    snprintf(link, sizeof link, "/proc/self/fd/%d", source);
    require(mount(link, target, NULL, MS_BIND | MS_REC, NULL), "cannot show", target);
}

static void empty_file(const char *path) {
    const int file = open(path, O_WRONLY | O_CREAT | O_CLOEXEC, 0444);
    require(file, "cannot make", path);
    close(file);
}

static int is_folder(int file) {
    struct stat found;
    return fstat(file, &found) == 0 && S_ISDIR(found.st_mode);
}

/* Mount what `source` is open on at a path that may not be there yet. */
static void show(int source, const char *path) {
    char folder[4096];
    if (is_folder(source)) make_folders(path);
    else {
        if (snprintf(folder, sizeof folder, "%s", path) >= (int)sizeof folder) fail("a path is too long: %s", path);
        *strrchr(folder, '/') = '\0';
        make_folders(folder);
        empty_file(path);
    }
    bind(source, path);
    close(source);
}

static void memory_folder(const char *path, const char *options) {
    require(mount("hypcheck", path, "tmpfs", MS_NOSUID | MS_NODEV, options), "cannot make a folder in memory at", path);
}

static const char *const DEVICES[] = {"/dev/null", "/dev/zero", "/dev/full", "/dev/random", "/dev/urandom"};
enum { DEVICE_COUNT = sizeof DEVICES / sizeof *DEVICES };

/* A /dev with the devices that hold nothing; as the superuser's, a program could open a disk. */
static void make_devices(void) {
    int device[DEVICE_COUNT];
    for (int i = 0; i < DEVICE_COUNT; i++) device[i] = open(DEVICES[i], O_PATH | O_CLOEXEC);
    memory_folder("/dev", "mode=755,size=64k");
    for (int i = 0; i < DEVICE_COUNT; i++) {
        if (device[i] < 0) continue;
        empty_file(DEVICES[i]);
        bind(device[i], DEVICES[i]);
        close(device[i]);
    }
    if (symlink("/proc/self/fd", "/dev/fd") || symlink("fd/0", "/dev/stdin") || symlink("fd/1", "/dev/stdout") ||
        symlink("fd/2", "/dev/stderr"))
        fail("cannot make /dev: %s", strerror(errno));
}

/* The limit belongs to the PID namespace since Linux 6.14; before that it is the whole system's, and is left alone. */
static void limit_processes(void) {
    struct utsname system;
    int major = 0, minor = 0;
    char number[32];
    if (!plan.threads || uname(&system) != 0 || sscanf(system.release, "%d.%d", &major, &minor) != 2) return;
    if (major < 6 || (major == 6 && minor < 14)) return;
    snprintf(number, sizeof number, "%ld", plan.threads);
    write_file("/proc/sys/kernel/pid_max", number);
}

/* What the program sees: everything read-only, but for an empty scratch folder; private folders and hidden paths empty. */
static void mount_view(void) {
    int shown[MOST], revealed[MOST];
    char here[4096], size[64];
    if (getcwd(here, sizeof here) == NULL) fail("cannot find the working directory: %s", strerror(errno));
    require(mount(NULL, "/", NULL, MS_REC | MS_PRIVATE, NULL), "cannot own", "the mounts");
    read_only("/", 1);
    for (int i = 0; i < plan.show.count; i++) shown[i] = open(plan.show.path[i], O_PATH | O_CLOEXEC);
    for (int i = 0; i < plan.reveal.count; i++) revealed[i] = open(plan.reveal.path[i], O_PATH | O_CLOEXEC);
    make_devices();
    snprintf(size, sizeof size, "mode=1777,size=%ld,nr_inodes=65536", plan.bytes);
    for (int i = 0; i < plan.private.count; i++) memory_folder(plan.private.path[i], "mode=755,size=1m");
    make_folders("/dev/shm");
    make_folders(plan.scratch);
    memory_folder(plan.scratch, size);
    if (strcmp(plan.scratch, "/dev/shm") != 0)
        require(mount(plan.scratch, "/dev/shm", NULL, MS_BIND, NULL), "cannot show", "/dev/shm");
    for (int i = 0; i < plan.show.count; i++) {
        if (shown[i] < 0) continue;
        show(shown[i], plan.show.path[i]);
    }
    const int nothing = open("/dev/null", O_PATH | O_CLOEXEC);
    for (int i = 0; i < plan.hide.count; i++) {
        const int hidden = open(plan.hide.path[i], O_PATH | O_CLOEXEC);
        if (hidden < 0) continue;
        if (is_folder(hidden)) memory_folder(plan.hide.path[i], "mode=755,size=1m");
        else bind(nothing, plan.hide.path[i]);
        close(hidden);
    }
    close(nothing);
    for (int i = 0; i < plan.reveal.count; i++) {
        if (revealed[i] >= 0) show(revealed[i], plan.reveal.path[i]);
    }
    for (int i = 0; i < plan.hide.count; i++) {
        struct stat found;
        if (stat(plan.hide.path[i], &found) == 0 && S_ISDIR(found.st_mode)) read_only(plan.hide.path[i], 0);
    }
    for (int i = 0; i < plan.private.count; i++) read_only(plan.private.path[i], 0);
    read_only("/dev", 0);
    require(mount("proc", "/proc", "proc", MS_NOSUID | MS_NODEV | MS_NOEXEC, NULL), "cannot mount", "/proc");
    limit_processes();
    read_only("/proc", 0);
    require(chdir(here), "cannot enter", here); /* the same folder, as it is seen now */
}
