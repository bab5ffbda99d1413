// What /proc and /sys say of the simulated host.
//
//   if (is_told("/proc/uptime")) return open_told("/proc/uptime", O_RDONLY);
//
// Source: proc(5).
#pragma once

namespace simbench::shim {

// Whether the world tells what is in it.
bool is_told(const char* path);
// A descriptor of a file with the text as it is now; -1 with errno.
int open_told(const char* path, int flags);

// Whether it may be the machine's: below /proc what the process is itself, and nothing below /sys.
// Paths elsewhere may.
bool is_of_process(const char* path);

}  // namespace simbench::shim
