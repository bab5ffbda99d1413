// Memory and semaphores with names, which processes of a host share: files of the host's /dev/shm,
// as libc makes them in the machine's. Waiting for a semaphore is a lock of the world's.
//
// Source: shm_overview(7), sem_overview(7).
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <semaphore.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "shim/chance.h"
#include "shim/link.h"

namespace simbench::shim {
namespace {

constexpr int kMostOpenSemaphores = 64;

// One that is opened twice is at one place.
struct OpenSemaphore {
  sem_t* place = nullptr;
  ino_t file = 0;
  int users = 0;
};
OpenSemaphore semaphores[kMostOpenSemaphores];

// Where an object of that name is; false with EINVAL.
bool write_path(char* room, std::size_t size, const char* kind, const char* name) {
  while (*name == '/') ++name;
  const int written = snprintf(room, size, "/dev/shm/%s%s", kind, name);
  if (*name != '\0' && strchr(name, '/') == nullptr && written > 0 &&
      static_cast<std::size_t>(written) < size) {
    return true;
  }
  errno = EINVAL;
  return false;
}

sem_t* map(int file) {
  struct stat status {};
  if (fstat(file, &status) < 0) return SEM_FAILED;
  for (OpenSemaphore& each : semaphores) {
    if (each.users == 0 || each.file != status.st_ino) continue;
    ++each.users;
    return each.place;
  }
  for (OpenSemaphore& each : semaphores) {
    if (each.users != 0) continue;
    void* place = mmap(nullptr, sizeof(sem_t), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (place == MAP_FAILED) return SEM_FAILED;
    each = {.place = static_cast<sem_t*>(place), .file = status.st_ino, .users = 1};
    return each.place;
  }
  errno = ENOMEM;
  return SEM_FAILED;
}

// It has its value before it has its name. -1 with errno.
int make(const char* path, mode_t mode, unsigned int value) {
  sem_t fresh{};
  if (value > SEM_VALUE_MAX) return refuse(EINVAL);
  sem_init(&fresh, 1, value);
  std::uint64_t number = 0;
  take_chance(&number, sizeof number);
  char temporary[PATH_MAX];
  snprintf(temporary, sizeof temporary, "/dev/shm/sem.%016lx", number);
  const int file = open(temporary, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  if (file < 0) return -1;
  const bool is_whole = machine_call(SYS_write, file, &fresh, sizeof fresh) == sizeof fresh;
  const bool is_named = is_whole && link(temporary, path) == 0;
  const int error = errno;
  unlink(temporary);
  if (is_named) return file;
  close(file);
  return refuse(error);
}

int open_or_make(const char* path, int flags, mode_t mode, unsigned int value) {
  for (;;) {
    if ((flags & (O_CREAT | O_EXCL)) != (O_CREAT | O_EXCL)) {
      const int file = open(path, O_RDWR | O_CLOEXEC | O_NOFOLLOW);
      if (file >= 0 || errno != ENOENT || (flags & O_CREAT) == 0) return file;
    }
    const int file = make(path, mode, value);
    if (file >= 0 || errno != EEXIST || (flags & O_EXCL) != 0) return file;
  }
}

}  // namespace

SIMBENCH_CALL int shm_open(const char* name, int flags, mode_t mode) {
  if (!is_simulated()) return SIMBENCH_REAL(shm_open)(name, flags, mode);
  char path[PATH_MAX];
  if (!write_path(path, sizeof path, "", name)) return -1;
  return open(path, flags | O_CLOEXEC | O_NOFOLLOW, mode);
}

SIMBENCH_CALL int shm_unlink(const char* name) {
  if (!is_simulated()) return SIMBENCH_REAL(shm_unlink)(name);
  char path[PATH_MAX];
  return write_path(path, sizeof path, "", name) ? unlink(path) : -1;
}

SIMBENCH_CALL sem_t* sem_open(const char* name, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const bool makes = (flags & O_CREAT) != 0;
  const mode_t mode = makes ? va_arg(arguments, mode_t) : 0;
  const unsigned int value = makes ? va_arg(arguments, unsigned int) : 0;
  va_end(arguments);
  if (!is_simulated()) return SIMBENCH_REAL(sem_open)(name, flags, mode, value);
  char path[PATH_MAX];
  if (!write_path(path, sizeof path, "sem.", name)) return SEM_FAILED;
  const int file = open_or_make(path, flags, mode, value);
  if (file < 0) return SEM_FAILED;
  sem_t* place = map(file);
  const int error = errno;
  close(file);
  errno = error;
  return place;
}

SIMBENCH_CALL int sem_close(sem_t* semaphore) {
  if (!is_simulated()) return SIMBENCH_REAL(sem_close)(semaphore);
  for (OpenSemaphore& each : semaphores) {
    if (each.users == 0 || each.place != semaphore) continue;
    if (--each.users == 0) munmap(semaphore, sizeof *semaphore);
    return 0;
  }
  return refuse(EINVAL);
}

SIMBENCH_CALL int sem_unlink(const char* name) {
  if (!is_simulated()) return SIMBENCH_REAL(sem_unlink)(name);
  char path[PATH_MAX];
  return write_path(path, sizeof path, "sem.", name) ? unlink(path) : -1;
}

}  // namespace simbench::shim
