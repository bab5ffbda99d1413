// The devices that a host of the world has: its network card's clock, /dev/ptp0 (shim/card.h), and
// its line with a pulse per second, /dev/pps0 (shim/pulses.h). No device of these kinds is the
// machine's.
//
//   const int fd = is_device("/dev/pps0") ? open_device("/dev/pps0", O_RDWR) : -1;
#pragma once

#include <sys/stat.h>

namespace simbench::shim {

// Whether the path is that of such a device, there or not.
bool is_device(const char* path);
// As open().
int open_device(const char* path, int flags);
// As stat(), statx() and fstat(). The last one is false for descriptors of anything else.
int describe_device(const char* path, struct stat& status);
int describe_device(const char* path, struct statx& status);
bool describe_device(int fd, struct stat& status);

}  // namespace simbench::shim
