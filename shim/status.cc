// What stat() says of files, and how their times are set.
//
// The machine's files are as they are, but none is from after the world's beginning. Those of the
// host have numbers that the world gives, in the order in which they were first looked at, times of
// the host's clock, and sizes on a disk of blocks of 4096 bytes; they are root's. Times of reading
// are not kept (as of a file system that is mounted with noatime), nor those of making.
#include "shim/status.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/sysmacros.h>
#include <sys/time.h>
#include <unistd.h>
#include <utime.h>

#include <initializer_list>

#include "shim/begin.h"
#include "shim/devices.h"
#include "shim/hidden.h"
#include "shim/link.h"
#include "shim/paths.h"
#include "shim/proc.h"
#include "shim/refused_calls.h"

namespace simbench::shim {
namespace {

constexpr std::uint32_t kBlock = 4096;
constexpr std::uint32_t kSector = 512;  // what st_blocks counts
// No file of the host has changed before: a program may say that one is older.
constexpr std::int64_t kEarliest = kWorldBegin - 3600 * kSecond;
// What this system's header may not have yet.
constexpr std::uint32_t kMountMask = 0x1000;

std::int64_t born = INT64_MAX;  // the host's folder
MachineIds folders;             // of that

std::int64_t ns_of(const statx_timestamp& time) { return time.tv_sec * kSecond + time.tv_nsec; }

statx_timestamp as_stamp(std::int64_t ns) {
  statx_timestamp stamp{};
  stamp.tv_sec = ns / kSecond;
  stamp.tv_nsec = static_cast<std::uint32_t>(ns % kSecond);
  return stamp;
}

// The world knows the file from now on. Returns when it was written to.
std::int64_t look_at(struct statx& status, bool is_new = false) {
  const std::int64_t modified = ns_of(status.stx_mtime);
  const bool is_by_machine = is_of_machine(born, modified, ns_of(status.stx_ctime));
  const FileSight sight{.device = makedev(status.stx_dev_major, status.stx_dev_minor),
                        .file = status.stx_ino,
                        .born = ns_of(status.stx_btime),
                        .modified = is_by_machine ? modified : 0,
                        .is_new = is_new ? 1 : 0};
  std::int64_t by_host = modified;
  const std::int64_t number = ask_for({.call = Call::kLookAtFile}, by_host, {&sight, sizeof sight});
  if (number >= 0) status.stx_ino = static_cast<std::uint64_t>(number);
  return is_by_machine ? by_host : modified;
}

void show_own(struct statx& status) {
  const std::int64_t modified = look_at(status);
  status.stx_mtime = as_stamp(modified);
  status.stx_atime = status.stx_mtime;
  status.stx_ctime = as_stamp(modified < kEarliest ? kEarliest : modified);
  status.stx_dev_major = major(kOwnDevice);
  status.stx_dev_minor = minor(kOwnDevice);
  if (status.stx_uid == machine_ids().user || status.stx_uid == folders.user) status.stx_uid = 0;
  if (status.stx_gid == machine_ids().group || status.stx_gid == folders.group) status.stx_gid = 0;
  if (S_ISDIR(status.stx_mode)) status.stx_size = kBlock;
  status.stx_blksize = kBlock;
  status.stx_blocks = (status.stx_size + kBlock - 1) / kBlock * (kBlock / kSector);
}

void show(struct statx& status) {
  if (is_of_host(born, ns_of(status.stx_ctime))) {
    show_own(status);
  } else {
    status.stx_atime = status.stx_mtime;
    for (statx_timestamp* each : {&status.stx_atime, &status.stx_mtime, &status.stx_ctime}) {
      if (ns_of(*each) > kWorldBegin) *each = as_stamp(kWorldBegin);
    }
  }
  status.stx_btime = {};
  status.stx_mnt_id = 0;
  status.stx_mask &= ~(STATX_BTIME | kMountMask);
}

int statx_at(int folder, const char* path, int flags, unsigned int mask, struct statx* status) {
  const OwnPath own(path);
  const unsigned int all = is_simulated() ? STATX_BASIC_STATS | STATX_BTIME | mask : mask;
  const long result = machine_call(SYS_statx, folder, own.text(), flags, all, status);
  if (result == 0 && is_simulated()) show(*status);
  return static_cast<int>(result);
}

timespec to_plain(const statx_timestamp& time) {
  return {.tv_sec = time.tv_sec, .tv_nsec = time.tv_nsec};
}

int stat_told(const char* path, struct statx* status) {
  const int file = open_told(path, O_RDONLY | O_CLOEXEC);
  if (file < 0) return -1;
  const int result = statx_at(file, "", AT_EMPTY_PATH, 0, status);
  machine_call(SYS_close, file);
  status->stx_mode = S_IFREG | 0444;
  return result;
}

int stat_at(int folder, const char* path, struct stat* status, int flags) {
  if (!is_simulated()) {
    return static_cast<int>(machine_call(SYS_newfstatat, folder, path, status, flags));
  }
  if (is_device(path)) return describe_device(path, *status);
  struct statx found {};
  const int result = is_told(path) ? stat_told(path, &found)
                                   : statx_at(folder, path, flags, STATX_BASIC_STATS, &found);
  if (result < 0) return -1;
  *status = {};
  status->st_dev = makedev(found.stx_dev_major, found.stx_dev_minor);
  status->st_ino = found.stx_ino;
  status->st_mode = found.stx_mode;
  status->st_nlink = found.stx_nlink;
  status->st_uid = found.stx_uid;
  status->st_gid = found.stx_gid;
  status->st_rdev = makedev(found.stx_rdev_major, found.stx_rdev_minor);
  status->st_size = static_cast<off_t>(found.stx_size);
  status->st_blksize = static_cast<blksize_t>(found.stx_blksize);
  status->st_blocks = static_cast<blkcnt_t>(found.stx_blocks);
  status->st_atim = to_plain(found.stx_atime);
  status->st_mtim = to_plain(found.stx_mtime);
  status->st_ctim = to_plain(found.stx_ctime);
  return 0;
}

}  // namespace

timespec host_time() {
  return to_timespec(ask({.call = Call::kReadClock, .a = CLOCK_REALTIME, .b = 1}));
}

void note_made(int folder, const char* path, int flags) {
  if (!is_simulated()) return;
  const int before = errno;
  struct statx status {};
  const bool is_there = machine_call(SYS_statx, folder, path, flags | AT_SYMLINK_NOFOLLOW,
                                     STATX_BASIC_STATS | STATX_BTIME, &status) == 0;
  if (is_there && is_of_host(born, ns_of(status.stx_ctime))) look_at(status, true);
  errno = before;
}

void begin_files() {
  struct statx status {};
  if (machine_call(SYS_statx, AT_FDCWD, own_folder(), 0, STATX_BASIC_STATS | STATX_BTIME, &status) <
      0) {
    return;
  }
  // Without a time of making, that of the last change comes later than some files.
  const bool has_birth = (status.stx_mask & STATX_BTIME) != 0;
  born = ns_of(has_birth ? status.stx_btime : status.stx_ctime);
  folders = {.user = status.stx_uid, .group = status.stx_gid};
}

bool find_modified(int fd, timespec& modified) {
  struct statx status {};
  if (machine_call(SYS_statx, fd, "", AT_EMPTY_PATH, STATX_BASIC_STATS | STATX_BTIME, &status) < 0)
    return false;
  const std::int64_t before = ns_of(status.stx_mtime);
  if (!S_ISREG(status.stx_mode) || !is_of_machine(born, before, ns_of(status.stx_ctime))) {
    return false;
  }
  modified = to_timespec(look_at(status));
  return true;
}

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
  if (!is_simulated()) return static_cast<int>(machine_call(SYS_fstat, fd, status));
  return stat_at(fd, "", status, AT_EMPTY_PATH);
}

SIMBENCH_CALL int stat64(const char*, struct stat64*) __attribute__((alias("stat")));
SIMBENCH_CALL int lstat64(const char*, struct stat64*) __attribute__((alias("lstat")));
SIMBENCH_CALL int fstatat64(int, const char*, struct stat64*, int)
    __attribute__((alias("fstatat")));
SIMBENCH_CALL int fstat64(int, struct stat64*) __attribute__((alias("fstat")));

// What programs that were compiled before glibc 2.33 call.
SIMBENCH_CALL int old_stat(int, const char*, struct stat*) __asm__("__xstat");
SIMBENCH_CALL int old_lstat(int, const char*, struct stat*) __asm__("__lxstat");
SIMBENCH_CALL int old_fstat(int, int, struct stat*) __asm__("__fxstat");
SIMBENCH_CALL int old_fstatat(int, int, const char*, struct stat*, int) __asm__("__fxstatat");
int old_stat(int /*version*/, const char* path, struct stat* status) { return stat(path, status); }
int old_lstat(int /*version*/, const char* path, struct stat* status) {
  return lstat(path, status);
}
int old_fstat(int /*version*/, int fd, struct stat* status) { return fstat(fd, status); }
int old_fstatat(int /*version*/, int folder, const char* path, struct stat* status, int flags) {
  return fstatat(folder, path, status, flags);
}
SIMBENCH_CALL int old_stat64(int, const char*, struct stat*) __asm__("__xstat64")
    __attribute__((alias("__xstat")));
SIMBENCH_CALL int old_lstat64(int, const char*, struct stat*) __asm__("__lxstat64")
    __attribute__((alias("__lxstat")));
SIMBENCH_CALL int old_fstat64(int, int, struct stat*) __asm__("__fxstat64")
    __attribute__((alias("__fxstat")));
SIMBENCH_CALL int old_fstatat64(int, int, const char*, struct stat*, int) __asm__("__fxstatat64")
    __attribute__((alias("__fxstatat")));

SIMBENCH_CALL int statx(int folder, const char* path, int flags, unsigned int mask,
                        struct statx* status) {
  if (is_device(path)) return describe_device(path, *status);
  return is_told(path) ? stat_told(path, status) : statx_at(folder, path, flags, mask, status);
}

// Times that a program sets. Those of the machine's files stay as they are.

namespace {

bool is_in_own_folder(int file) {
  char link[32];
  char path[PATH_MAX];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const long size = machine_call(SYS_readlinkat, AT_FDCWD, link, path, sizeof path - 1);
  if (size <= 0) return false;
  path[size] = '\0';
  char room[PATH_MAX];
  return seen_path(path, room, sizeof room) != path;
}

void set_now(timespec& time) {
  if (time.tv_nsec == UTIME_NOW) time = host_time();
}

// `file` is open, perhaps for nothing else.
int set_times(int file, const timespec* given) {
  if (!is_in_own_folder(file)) return refuse(EROFS);
  const timespec now{.tv_sec = 0, .tv_nsec = UTIME_NOW};
  timespec both[2] = {now, now};
  if (given != nullptr) memcpy(both, given, sizeof both);
  for (timespec& each : both) {
    const bool is_word = each.tv_nsec == UTIME_NOW || each.tv_nsec == UTIME_OMIT;
    if (!is_word && (each.tv_nsec < 0 || each.tv_nsec >= kSecond)) return refuse(EINVAL);
    set_now(each);
  }
  char link[32];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  return static_cast<int>(machine_call(SYS_utimensat, AT_FDCWD, link, both, 0, kOfTheShim));
}

int set_times_at(int folder, const char* path, const timespec* times, int flags) {
  const OwnPath own(path);
  const int how = O_PATH | O_CLOEXEC | ((flags & AT_SYMLINK_NOFOLLOW) != 0 ? O_NOFOLLOW : 0);
  const int file = static_cast<int>(machine_call(SYS_openat, folder, own.text(), how));
  if (file < 0) return -1;
  const int result = set_times(file, times);
  const int error = errno;
  machine_call(SYS_close, file);
  errno = error;
  return result;
}

struct Times {
  timespec both[2];
};

Times times_of(const timeval* given) {
  Times times{};
  for (int i = 0; i < 2; ++i) {
    times.both[i] = {.tv_sec = given[i].tv_sec, .tv_nsec = given[i].tv_usec * 1000};
  }
  return times;
}

}  // namespace

SIMBENCH_CALL int utimensat(int folder, const char* path, const timespec* times, int flags) {
  if (!is_simulated()) return SIMBENCH_REAL(utimensat)(folder, path, times, flags);
  return set_times_at(folder, path, times, flags);
}
SIMBENCH_CALL int futimens(int fd, const timespec* times) {
  return is_simulated() ? set_times(fd, times) : SIMBENCH_REAL(futimens)(fd, times);
}
SIMBENCH_CALL int futimesat(int folder, const char* path, const timeval* times) {
  if (!is_simulated()) return SIMBENCH_REAL(futimesat)(folder, path, times);
  if (times == nullptr) return set_times_at(folder, path, nullptr, 0);
  return set_times_at(folder, path, times_of(times).both, 0);
}
SIMBENCH_CALL int utimes(const char* path, const timeval* times) {
  return is_simulated() ? futimesat(AT_FDCWD, path, times) : SIMBENCH_REAL(utimes)(path, times);
}
SIMBENCH_CALL int lutimes(const char* path, const timeval* times) {
  if (!is_simulated()) return SIMBENCH_REAL(lutimes)(path, times);
  if (times == nullptr) return set_times_at(AT_FDCWD, path, nullptr, AT_SYMLINK_NOFOLLOW);
  return set_times_at(AT_FDCWD, path, times_of(times).both, AT_SYMLINK_NOFOLLOW);
}
SIMBENCH_CALL int futimes(int fd, const timeval* times) {
  if (!is_simulated()) return SIMBENCH_REAL(futimes)(fd, times);
  return set_times(fd, times != nullptr ? times_of(times).both : nullptr);
}
SIMBENCH_CALL int utime(const char* path, const utimbuf* times) {
  if (!is_simulated()) return SIMBENCH_REAL(utime)(path, times);
  if (times == nullptr) return set_times_at(AT_FDCWD, path, nullptr, 0);
  const timespec both[2] = {{.tv_sec = times->actime, .tv_nsec = 0},
                            {.tv_sec = times->modtime, .tv_nsec = 0}};
  return set_times_at(AT_FDCWD, path, both, 0);
}

}  // namespace simbench::shim
