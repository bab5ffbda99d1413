// System V shared memory, by which reference clocks speak to time daemons (NTP's segments): files
// in the host's folder, which the programs of a host share. A segment's number is its key.
//
// Source: shmget(2), shmop(2), shmctl(2).
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/ipc.h>
#include <sys/mman.h>
#include <sys/shm.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "shim/link.h"
#include "shim/paths.h"
#include "shim/status.h"

namespace simbench::shim {
namespace {

constexpr int kMostSegments = 64;
constexpr std::size_t kMostSize = std::size_t{64} << 20U;

struct Attached {
  void* address = nullptr;
  std::size_t size = 0;
};
Attached attached[kMostSegments];
int private_segments = 0;

class SegmentName {
 public:
  explicit SegmentName(int segment) {  // NOLINT: which fills the text
    snprintf(text_, sizeof text_, "/dev/shm/sysv-%08x", static_cast<unsigned>(segment));
  }
  const char* text() const { return text_; }

 private:
  char text_[40];
};

int open_segment(int segment, int flags) {
  const SegmentName name(segment);
  const OwnPath path(name.text(), (flags & O_CREAT) != 0 ? Use::kCreates : Use::kReads);
  return static_cast<int>(
      machine_call(SYS_openat, AT_FDCWD, path.text(), flags | O_CLOEXEC | O_NOFOLLOW, 0600));
}

std::size_t size_of(int file) {
  struct stat status {};
  return machine_call(SYS_fstat, file, &status) == 0 ? static_cast<std::size_t>(status.st_size) : 0;
}

int number_of_key(key_t key) {
  if (key != IPC_PRIVATE) return key & 0x7FFFFFFF;
  return (identity().process << 16U | ++private_segments) & 0x7FFFFFFF;
}

}  // namespace

SIMBENCH_CALL int shmget(key_t key, std::size_t size, int flags) {
  if (!is_simulated()) return static_cast<int>(machine_call(SYS_shmget, key, size, flags));
  if (size > kMostSize) return refuse(EINVAL);
  const int segment = number_of_key(key);
  const bool creates = key == IPC_PRIVATE || (flags & IPC_CREAT) != 0;
  const bool is_exclusive = creates && (flags & IPC_EXCL) != 0;
  const int file =
      open_segment(segment, O_RDWR | (creates ? O_CREAT : 0) | (is_exclusive ? O_EXCL : 0));
  if (file < 0) return -1;
  int error = 0;
  const std::size_t there = size_of(file);
  if (there == 0) note_made(file, "", AT_EMPTY_PATH);
  if (there == 0 && machine_call(SYS_ftruncate, file, size) < 0) error = errno;
  if (there != 0 && there < size) error = EINVAL;
  machine_call(SYS_close, file);
  return error == 0 ? segment : refuse(error);
}

SIMBENCH_CALL void* shmat(int segment, const void* address, int flags) {
  void* const failed = at<void>(-1);
  if (!is_simulated()) {
    return at<void>(machine_call(SYS_shmat, segment, address, flags));
  }
  const int file = open_segment(segment, O_RDWR);
  if (file < 0) {
    errno = EINVAL;
    return failed;
  }
  const std::size_t size = size_of(file);
  const int protection = (flags & SHM_RDONLY) != 0 ? PROT_READ : PROT_READ | PROT_WRITE;
  void* memory = mmap(const_cast<void*>(address), size, protection, MAP_SHARED, file, 0);
  machine_call(SYS_close, file);
  if (memory == MAP_FAILED) return failed;
  for (Attached& each : attached) {
    if (each.address != nullptr) continue;
    each = {memory, size};
    return memory;
  }
  munmap(memory, size);
  errno = EMFILE;
  return failed;
}

SIMBENCH_CALL int shmdt(const void* address) {
  if (!is_simulated()) return static_cast<int>(machine_call(SYS_shmdt, address));
  for (Attached& each : attached) {
    if (each.address != address || address == nullptr) continue;
    munmap(each.address, each.size);
    each = {};
    return 0;
  }
  return refuse(EINVAL);
}

SIMBENCH_CALL int shmctl(int segment, int command, shmid_ds* facts) {
  if (!is_simulated()) return static_cast<int>(machine_call(SYS_shmctl, segment, command, facts));
  const int file = open_segment(segment, O_RDONLY);
  if (file < 0) return refuse(EINVAL);
  const std::size_t size = size_of(file);
  machine_call(SYS_close, file);
  switch (command) {
    case IPC_RMID: {
      const SegmentName name(segment);
      return static_cast<int>(machine_call(SYS_unlinkat, AT_FDCWD, OwnPath(name.text()).text(), 0));
    }
    case IPC_STAT:
      *facts = {};
      facts->shm_segsz = size;
      facts->shm_perm.mode = 0600;
      return 0;
    case IPC_SET:
      return 0;
    default:
      return refuse(EINVAL);
  }
}

}  // namespace simbench::shim
