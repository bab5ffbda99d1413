// Files: opened, named and removed where the program's paths lead (shim/paths.h), with times of the
// world's clock and names in order.
//
// The kernel stamps what a program writes with the machine's time. The time of the host's system
// clock is put there when the file is closed; until then, and for the machine's files from after
// the world's beginning, it is what stat() says.
#include "shim/files.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>
#include <utime.h>

#include <initializer_list>

#include "shim/begin.h"
#include "shim/chance.h"
#include "shim/devices.h"
#include "shim/link.h"
#include "shim/local.h"
#include "shim/paths.h"
#include "shim/refused_calls.h"

namespace simbench::shim {
namespace {

bool is_written[kMostDescriptors];  // opened to be

// The machine's time at which the program began, as the kernel stamped its folder.
timespec machine_begin{};

bool is_before(const timespec& one, const timespec& other) {
  return one.tv_sec != other.tv_sec ? one.tv_sec < other.tv_sec : one.tv_nsec < other.tv_nsec;
}

timespec world_now() {
  return to_timespec(ask({.call = Call::kReadClock, .a = CLOCK_REALTIME, .b = 1}));
}

void show(timespec& time, const timespec& now) {
  if (!is_before(machine_begin, time)) {
    // The machine's: one from after the world's beginning is from then.
    const timespec begin{.tv_sec = kWorldBegin / kSecond, .tv_nsec = 0};
    if (is_before(begin, time)) time = is_before(now, begin) ? now : begin;
    return;
  }
  time = now;
}

void show_times(struct stat& status) {
  const timespec now = world_now();
  for (timespec* each : {&status.st_atim, &status.st_mtim, &status.st_ctim}) {
    if (is_before(now, *each)) show(*each, now);
  }
}

int stat_at(int folder, const char* path, struct stat* status, int flags) {
  if (is_device(path)) return describe_device(path, *status);
  const OwnPath own(path);
  const long result = machine_call(SYS_newfstatat, folder, own.text(), status, flags);
  if (result == 0 && is_simulated()) show_times(*status);
  return static_cast<int>(result);
}

int open_path(int folder, const char* path, int flags, mode_t mode) {
  if (is_chance(path)) return open_descriptor(Kind::kChance, false, (flags & O_CLOEXEC) != 0);
  if (is_device(path)) return open_device(path, flags);
  const OwnPath own(path, (flags & O_CREAT) != 0 ? Use::kCreates : Use::kReads);
  const int fd = static_cast<int>(machine_call(SYS_openat, folder, own.text(), flags, mode));
  if (fd >= 0 && is_simulated()) {
    note_pipe(fd);
    note_written(fd, (flags & O_ACCMODE) != O_RDONLY);
  }
  return fd;
}

mode_t mode_of(int flags, va_list arguments) {
  const bool has_mode = (flags & (O_CREAT | O_TMPFILE)) != 0;
  return has_mode ? va_arg(arguments, mode_t) : 0;
}

}  // namespace

void begin_files() {
  struct stat status {};
  if (machine_call(SYS_newfstatat, AT_FDCWD, own_folder(), &status, 0) == 0) {
    machine_begin = status.st_mtim;
  }
}

void note_written(int fd, bool is) {
  if (fd >= 0 && fd < kMostDescriptors) is_written[fd] = is;
}

void stamp_file(int fd) {
  if (fd < 0 || fd >= kMostDescriptors || !is_written[fd] || !is_simulated()) return;
  is_written[fd] = false;
  const int before = errno;
  const timespec now = world_now();
  const timespec both[2] = {now, now};
  machine_call(SYS_utimensat, fd, nullptr, both, 0, kOfTheShim);
  errno = before;
}

SIMBENCH_CALL int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return open_path(AT_FDCWD, path, flags, mode);
}

SIMBENCH_CALL int open64(const char* path, int flags, ...) __attribute__((alias("open")));

SIMBENCH_CALL int openat(int folder, const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return open_path(folder, path, flags, mode);
}

SIMBENCH_CALL int openat64(int folder, const char* path, int flags, ...)
    __attribute__((alias("openat")));

SIMBENCH_CALL int open_checked(const char* path, int flags) __asm__("__open_2");
int open_checked(const char* path, int flags) { return open_path(AT_FDCWD, path, flags, 0); }

SIMBENCH_CALL int open64_checked(const char* path, int flags) __asm__("__open64_2");
int open64_checked(const char* path, int flags) { return open_path(AT_FDCWD, path, flags, 0); }

SIMBENCH_CALL int openat_checked(int folder, const char* path, int flags) __asm__("__openat_2");
int openat_checked(int folder, const char* path, int flags) {
  return open_path(folder, path, flags, 0);
}

SIMBENCH_CALL int creat(const char* path, mode_t mode) {
  return open_path(AT_FDCWD, path, O_WRONLY | O_CREAT | O_TRUNC, mode);
}

namespace {

ssize_t read_chance(void* /*cookie*/, char* data, std::size_t size) {
  return take_chance(data, size);
}

bool writes(const char* mode) { return strpbrk(mode, "wa+") != nullptr; }

}  // namespace

SIMBENCH_CALL FILE* fopen(const char* path, const char* mode) {
  if (is_chance(path)) {
    return fopencookie(nullptr, mode, {.read = read_chance, .write = {}, .seek = {}, .close = {}});
  }
  const OwnPath own(path, writes(mode) ? Use::kCreates : Use::kReads);
  FILE* file = SIMBENCH_REAL(fopen)(own.text(), mode);
  if (file != nullptr && is_simulated()) note_written(fileno(file), writes(mode));
  return file;
}

SIMBENCH_CALL FILE* fopen64(const char* path, const char* mode) { return fopen(path, mode); }

SIMBENCH_CALL FILE* freopen(const char* path, const char* mode, FILE* file) {
  const OwnPath own(path, writes(mode) ? Use::kCreates : Use::kReads);
  return SIMBENCH_REAL(freopen)(own.text(), mode, file);
}

SIMBENCH_CALL FILE* freopen64(const char* path, const char* mode, FILE* file) {
  return freopen(path, mode, file);
}

// What stat() says.

SIMBENCH_CALL int stat(const char* path, struct stat* status) {
  return stat_at(AT_FDCWD, path, status, 0);
}
SIMBENCH_CALL int lstat(const char* path, struct stat* status) {
  return stat_at(AT_FDCWD, path, status, AT_SYMLINK_NOFOLLOW);
}
SIMBENCH_CALL int fstatat(int folder, const char* path, struct stat* status, int flags) {
  return stat_at(folder, path, status, flags);
}
SIMBENCH_CALL int fstat(int fd, struct stat* status) {
  if (is_simulated() && describe_device(fd, *status)) return 0;
  const long result = machine_call(SYS_fstat, fd, status);
  if (result == 0 && is_simulated()) show_times(*status);
  return static_cast<int>(result);
}

SIMBENCH_CALL int stat64(const char*, struct stat64*) __attribute__((alias("stat")));
SIMBENCH_CALL int lstat64(const char*, struct stat64*) __attribute__((alias("lstat")));
SIMBENCH_CALL int fstatat64(int, const char*, struct stat64*, int)
    __attribute__((alias("fstatat")));
SIMBENCH_CALL int fstat64(int, struct stat64*) __attribute__((alias("fstat")));

// What programs that were compiled before glibc 2.33 call.
SIMBENCH_CALL int __xstat(int /*version*/, const char* path, struct stat* status) {
  return stat(path, status);
}
SIMBENCH_CALL int __lxstat(int /*version*/, const char* path, struct stat* status) {
  return lstat(path, status);
}
SIMBENCH_CALL int __fxstat(int /*version*/, int fd, struct stat* status) {
  return fstat(fd, status);
}
SIMBENCH_CALL int __xstat64(int, const char*, struct stat*) __attribute__((alias("__xstat")));
SIMBENCH_CALL int __lxstat64(int, const char*, struct stat*) __attribute__((alias("__lxstat")));
SIMBENCH_CALL int __fxstat64(int, int, struct stat*) __attribute__((alias("__fxstat")));

SIMBENCH_CALL int statx(int folder, const char* path, int flags, unsigned int mask,
                        struct statx* status) {
  if (is_device(path)) return describe_device(path, *status);
  const OwnPath own(path);
  const long result = machine_call(SYS_statx, folder, own.text(), flags, mask, status);
  if (result < 0 || !is_simulated()) return static_cast<int>(result);
  const timespec now = world_now();
  for (statx_timestamp* each :
       {&status->stx_atime, &status->stx_mtime, &status->stx_ctime, &status->stx_btime}) {
    timespec time{.tv_sec = each->tv_sec, .tv_nsec = each->tv_nsec};
    if (!is_before(now, time)) continue;
    show(time, now);
    each->tv_sec = time.tv_sec;
    each->tv_nsec = static_cast<std::uint32_t>(time.tv_nsec);
  }
  return 0;
}

// Calls with one path, which do on the program's own what they say.

SIMBENCH_CALL int access(const char* path, int mode) {
  struct stat status {};
  if (is_device(path)) return describe_device(path, status);
  return static_cast<int>(machine_call(SYS_faccessat, AT_FDCWD, OwnPath(path).text(), mode));
}
SIMBENCH_CALL int euidaccess(const char* path, int mode) { return access(path, mode); }
SIMBENCH_CALL int eaccess(const char* path, int mode) { return access(path, mode); }
SIMBENCH_CALL int faccessat(int folder, const char* path, int mode, int flags) {
  if (!is_simulated()) return SIMBENCH_REAL(faccessat)(folder, path, mode, flags);
  if (is_device(path)) return access(path, mode);
  return static_cast<int>(machine_call(SYS_faccessat, folder, OwnPath(path).text(), mode));
}
SIMBENCH_CALL int unlink(const char* path) {
  return static_cast<int>(machine_call(SYS_unlinkat, AT_FDCWD, OwnPath(path).text(), 0));
}
SIMBENCH_CALL int unlinkat(int folder, const char* path, int flags) {
  return static_cast<int>(machine_call(SYS_unlinkat, folder, OwnPath(path).text(), flags));
}
SIMBENCH_CALL int rmdir(const char* path) {
  return static_cast<int>(machine_call(SYS_unlinkat, AT_FDCWD, OwnPath(path).text(), AT_REMOVEDIR));
}
SIMBENCH_CALL int mkdir(const char* path, mode_t mode) {
  const OwnPath own(path, Use::kCreates);
  return static_cast<int>(machine_call(SYS_mkdirat, AT_FDCWD, own.text(), mode));
}
SIMBENCH_CALL int mkdirat(int folder, const char* path, mode_t mode) {
  const OwnPath own(path, Use::kCreates);
  return static_cast<int>(machine_call(SYS_mkdirat, folder, own.text(), mode));
}
SIMBENCH_CALL int mkfifo(const char* path, mode_t mode) {
  const OwnPath own(path, Use::kCreates);
  return static_cast<int>(machine_call(SYS_mknodat, AT_FDCWD, own.text(), mode | S_IFIFO, 0));
}
SIMBENCH_CALL int chmod(const char* path, mode_t mode) {
  return static_cast<int>(machine_call(SYS_fchmodat, AT_FDCWD, OwnPath(path).text(), mode));
}
SIMBENCH_CALL int chdir(const char* path) {
  return static_cast<int>(machine_call(SYS_chdir, OwnPath(path).text()));
}
SIMBENCH_CALL int truncate(const char* path, off_t size) {
  return static_cast<int>(machine_call(SYS_truncate, OwnPath(path).text(), size));
}
SIMBENCH_CALL int truncate64(const char* path, off64_t size) { return truncate(path, size); }

SIMBENCH_CALL ssize_t readlink(const char* path, char* room, std::size_t size) {
  return machine_call(SYS_readlinkat, AT_FDCWD, OwnPath(path).text(), room, size);
}
SIMBENCH_CALL ssize_t readlinkat(int folder, const char* path, char* room, std::size_t size) {
  return machine_call(SYS_readlinkat, folder, OwnPath(path).text(), room, size);
}

SIMBENCH_CALL char* realpath(const char* path, char* result) {
  if (!is_simulated()) return SIMBENCH_REAL(realpath)(path, result);
  char found[PATH_MAX];
  if (SIMBENCH_REAL(realpath)(OwnPath(path).text(), found) == nullptr) return nullptr;
  char room[PATH_MAX];
  const char* seen = seen_path(found, room, sizeof room);
  if (result == nullptr) return strdup(seen);
  return strcpy(result, seen);
}

SIMBENCH_CALL char* getcwd(char* room, std::size_t size) {
  if (!is_simulated()) return SIMBENCH_REAL(getcwd)(room, size);
  char found[PATH_MAX];
  if (machine_call(SYS_getcwd, found, sizeof found) < 0) return nullptr;
  char other[PATH_MAX];
  const char* seen = seen_path(found, other, sizeof other);
  if (room == nullptr) return strdup(seen);
  if (strlen(seen) >= size) {
    errno = ERANGE;
    return nullptr;
  }
  return strcpy(room, seen);
}

// Calls with two.

SIMBENCH_CALL int renameat2(int folder, const char* from, int other, const char* to,
                            unsigned int flags) {
  const OwnPath own(from);
  const OwnPath there(to, Use::kCreates);
  return static_cast<int>(
      machine_call(SYS_renameat2, folder, own.text(), other, there.text(), flags));
}
SIMBENCH_CALL int renameat(int folder, const char* from, int other, const char* to) {
  return renameat2(folder, from, other, to, 0);
}
SIMBENCH_CALL int rename(const char* from, const char* to) {
  return renameat2(AT_FDCWD, from, AT_FDCWD, to, 0);
}
SIMBENCH_CALL int link(const char* from, const char* to) {
  const OwnPath own(from);
  const OwnPath there(to, Use::kCreates);
  return static_cast<int>(
      machine_call(SYS_linkat, AT_FDCWD, own.text(), AT_FDCWD, there.text(), 0));
}
SIMBENCH_CALL int symlink(const char* to, const char* from) {
  const OwnPath own(to);
  const OwnPath there(from, Use::kCreates);
  return static_cast<int>(machine_call(SYS_symlinkat, own.text(), AT_FDCWD, there.text()));
}

// Names of temporary files are of the world's chance.

namespace {

// Fills in the six X before a suffix; false with EINVAL.
bool fill_name(char* name, int suffix) {
  constexpr char kLetters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";
  constexpr std::size_t kPlaces = 6;
  const std::size_t size = strlen(name);
  const auto after = static_cast<std::size_t>(suffix);
  if (suffix < 0 || size < kPlaces + after) {
    errno = EINVAL;
    return false;
  }
  char* places = name + size - after - kPlaces;
  unsigned char bytes[kPlaces];
  take_chance(bytes, sizeof bytes);
  for (std::size_t i = 0; i < kPlaces; ++i) {
    places[i] = kLetters[bytes[i] % (sizeof kLetters - 1)];
  }
  return true;
}

bool has_places(const char* name, int suffix) {
  const std::size_t size = strlen(name);
  const std::size_t end = size - static_cast<std::size_t>(suffix);
  return suffix >= 0 && static_cast<std::size_t>(suffix) + 6 <= size &&
         strncmp(name + end - 6, "XXXXXX", 6) == 0;
}

}  // namespace

SIMBENCH_CALL int mkostemps(char* name, int suffix, int flags) {
  if (!is_simulated()) return SIMBENCH_REAL(mkostemps)(name, suffix, flags);
  if (!has_places(name, suffix)) return refuse(EINVAL);
  for (;;) {
    if (!fill_name(name, suffix)) return -1;
    const int fd = open(name, (flags & ~O_ACCMODE) | O_RDWR | O_CREAT | O_EXCL, 0600);
    if (fd >= 0 || errno != EEXIST) return fd;
  }
}
SIMBENCH_CALL int mkstemp(char* name) { return mkostemps(name, 0, 0); }
SIMBENCH_CALL int mkstemp64(char* name) { return mkostemps(name, 0, 0); }
SIMBENCH_CALL int mkostemp(char* name, int flags) { return mkostemps(name, 0, flags); }
SIMBENCH_CALL int mkstemps(char* name, int suffix) { return mkostemps(name, suffix, 0); }

SIMBENCH_CALL char* mkdtemp(char* name) {
  if (!is_simulated()) return SIMBENCH_REAL(mkdtemp)(name);
  if (!has_places(name, 0)) {
    errno = EINVAL;
    return nullptr;
  }
  for (;;) {
    fill_name(name, 0);
    if (mkdir(name, 0700) == 0) return name;
    if (errno != EEXIST) return nullptr;
  }
}

SIMBENCH_CALL FILE* tmpfile() {
  if (!is_simulated()) return SIMBENCH_REAL(tmpfile)();
  char name[] = "/tmp/XXXXXX";
  const int fd = mkstemp(name);
  if (fd < 0) return nullptr;
  unlink(name);
  return fdopen(fd, "w+");
}

}  // namespace simbench::shim
