#include "shim/devices.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/sysmacros.h>

#include "shim/link.h"

namespace simbench::shim {
namespace {

struct Known {
  const char* path;
  Kind kind;
  HostDevice device;
  unsigned major;  // Linux gives these out as drivers come
};
constexpr Known kKnown[] = {{"/dev/ptp0", Kind::kCard, HostDevice::kCard, 249},
                            {"/dev/pps0", Kind::kPulses, HostDevice::kPulses, 250}};

bool host_has(const Known& device) {
  const std::uint32_t there =
      device.device == HostDevice::kCard ? identity().has_card_clock : identity().has_pulse_line;
  return there != 0;
}

// Null with ENOENT.
const Known* find(const char* path) {
  for (const Known& each : kKnown) {
    if (strcmp(path, each.path) == 0 && host_has(each)) return &each;
  }
  errno = ENOENT;
  return nullptr;
}

void describe(const Known& device, struct stat& status) {
  status = {};
  status.st_mode = S_IFCHR | 0600;
  status.st_nlink = 1;
  status.st_rdev = makedev(device.major, 0);
  status.st_blksize = 4096;
  status.st_atim = status.st_mtim = status.st_ctim = to_timespec(kWorldBegin);
}

}  // namespace

bool is_device(const char* path) {
  if (!has_world()) return false;
  return strncmp(path, "/dev/ptp", strlen("/dev/ptp")) == 0 ||
         strncmp(path, "/dev/pps", strlen("/dev/pps")) == 0;
}

int open_device(const char* path, int flags) {
  const Known* const device = find(path);
  if (device == nullptr) return -1;
  const int fd = open_descriptor(device->kind, (flags & O_NONBLOCK) != 0, (flags & O_CLOEXEC) != 0);
  if (fd < 0) return -1;
  if (ask({.call = Call::kOpenDevice, .fd = fd, .a = static_cast<std::int64_t>(device->device)}) <
      0) {
    discard_descriptor(fd);
    return -1;
  }
  return fd;
}

int describe_device(const char* path, struct stat& status) {
  const Known* const device = find(path);
  if (device == nullptr) return -1;
  describe(*device, status);
  return 0;
}

int describe_device(const char* path, struct statx& status) {
  struct stat plain {};
  if (describe_device(path, plain) < 0) return -1;
  status = {};
  status.stx_mask = STATX_BASIC_STATS;
  status.stx_mode = static_cast<std::uint16_t>(plain.st_mode);
  status.stx_nlink = 1;
  status.stx_rdev_major = major(plain.st_rdev);
  status.stx_rdev_minor = minor(plain.st_rdev);
  status.stx_blksize = static_cast<std::uint32_t>(plain.st_blksize);
  status.stx_atime.tv_sec = status.stx_mtime.tv_sec = status.stx_ctime.tv_sec =
      plain.st_mtim.tv_sec;
  return 0;
}

bool describe_device(int fd, struct stat& status) {
  for (const Known& each : kKnown) {
    if (kind_of(fd) != each.kind) continue;
    describe(each, status);
    return true;
  }
  return false;
}

}  // namespace simbench::shim
