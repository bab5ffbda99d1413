// Files: opened, named and removed where the program's paths lead (shim/paths.h).
//
// The kernel stamps what a program writes with the machine's time. The time of the host's system
// clock is put there when the file is closed.
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
#include <time.h>
#include <unistd.h>

#include "shim/chance.h"
#include "shim/devices.h"
#include "shim/link.h"
#include "shim/local.h"
#include "shim/paths.h"
#include "shim/proc.h"
#include "shim/refused_calls.h"
#include "shim/status.h"

namespace simbench::shim {
namespace {

bool is_written[kMostDescriptors];  // opened to be

// Whether open() would make one.
bool makes_file(int folder, const char* path, int flags) {
  if ((flags & O_TMPFILE) == O_TMPFILE) return true;
  return (flags & O_CREAT) != 0 && is_simulated() &&
         kernel_call(SYS_faccessat, folder, to_word(path), F_OK) == -ENOENT;
}

int open_path(int folder, const char* path, int flags, mode_t mode) {
  if (is_chance(path)) return open_descriptor(Kind::kChance, false, (flags & O_CLOEXEC) != 0);
  if (is_device(path)) return open_device(path, flags);
  if (is_told(path)) return open_told(path, flags);
  const OwnPath own(path, (flags & O_CREAT) != 0 ? Use::kCreates : Use::kReads);
  const bool is_new = makes_file(folder, own.text(), flags);
  const int fd = static_cast<int>(machine_call(SYS_openat, folder, own.text(), flags, mode));
  if (fd >= 0 && is_simulated()) {
    if (is_new) note_made(fd, "", AT_EMPTY_PATH);
    note_pipe(fd);
    note_written(fd, (flags & O_ACCMODE) != O_RDONLY);
  }
  return fd;
}

// The result of a call that makes a file.
int made(long result, int folder, const char* path) {
  if (result == 0) note_made(folder, path);
  return static_cast<int>(result);
}

mode_t mode_of(int flags, va_list arguments) {
  const bool has_mode = (flags & (O_CREAT | O_TMPFILE)) != 0;
  return has_mode ? va_arg(arguments, mode_t) : 0;
}

}  // namespace

void note_written(int fd, bool is) {
  if (fd >= 0 && fd < kMostDescriptors) is_written[fd] = is;
}

void stamp_file(int fd) {
  if (fd < 0 || fd >= kMostDescriptors || !is_written[fd] || !is_simulated()) return;
  is_written[fd] = false;
  const int before = errno;
  timespec modified{};
  if (find_modified(fd, modified)) {
    const timespec both[2] = {modified, modified};
    machine_call(SYS_utimensat, fd, nullptr, both, 0, kOfTheShim);
  }
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
  if (is_told(path)) {
    const int told = open_told(path, writes(mode) ? O_RDWR : O_RDONLY);
    return told < 0 ? nullptr : fdopen(told, mode);
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

// Calls with one path, which do on the program's own what they say.

SIMBENCH_CALL int access(const char* path, int mode) {
  struct stat status {};
  if (is_device(path)) return describe_device(path, status);
  if (is_told(path)) return (mode & (W_OK | X_OK)) != 0 ? refuse(EACCES) : 0;
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
  return made(machine_call(SYS_mkdirat, AT_FDCWD, own.text(), mode), AT_FDCWD, own.text());
}
SIMBENCH_CALL int mkdirat(int folder, const char* path, mode_t mode) {
  const OwnPath own(path, Use::kCreates);
  return made(machine_call(SYS_mkdirat, folder, own.text(), mode), folder, own.text());
}
SIMBENCH_CALL int mkfifo(const char* path, mode_t mode) {
  const OwnPath own(path, Use::kCreates);
  const long result = machine_call(SYS_mknodat, AT_FDCWD, own.text(), mode | S_IFIFO, 0);
  return made(result, AT_FDCWD, own.text());
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

SIMBENCH_CALL ssize_t readlinkat(int folder, const char* path, char* room, std::size_t size) {
  char found[PATH_MAX];
  const long length =
      machine_call(SYS_readlinkat, folder, OwnPath(path).text(), found, sizeof found - 1);
  if (length < 0) return -1;
  found[length] = '\0';
  char other[PATH_MAX];
  const char* seen = is_simulated() ? seen_path(found, other, sizeof other) : found;
  // Descriptors without a path: "pipe:[7]".
  struct stat status {};
  const char* number = strchr(found, '[');
  if (is_simulated() && found[0] != '/' && number != nullptr && number[1] >= '0' &&
      number[1] <= '9' && fstatat(folder, path, &status, 0) == 0) {
    snprintf(other, sizeof other, "%.*s[%lu]", static_cast<int>(number - found), found,
             static_cast<unsigned long>(status.st_ino));
    seen = other;
  }
  const std::size_t whole = strlen(seen);
  const std::size_t taken = whole < size ? whole : size;
  memcpy(room, seen, taken);
  return static_cast<ssize_t>(taken);
}
SIMBENCH_CALL ssize_t readlink(const char* path, char* room, std::size_t size) {
  return readlinkat(AT_FDCWD, path, room, size);
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

SIMBENCH_CALL char* get_current_dir_name() {
  return is_simulated() ? getcwd(nullptr, 0) : SIMBENCH_REAL(get_current_dir_name)();
}
SIMBENCH_CALL char* plain_getwd(char* room) __asm__("getwd");
char* plain_getwd(char* room) { return getcwd(room, PATH_MAX); }

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
  const long result = machine_call(SYS_symlinkat, own.text(), AT_FDCWD, there.text());
  return made(result, AT_FDCWD, there.text());
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
  char name[] = P_tmpdir "/XXXXXX";
  const int fd = mkstemp(name);
  if (fd < 0) return nullptr;
  unlink(name);
  return fdopen(fd, "w+");
}

}  // namespace simbench::shim
