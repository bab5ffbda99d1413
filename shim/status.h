// What the program is told of files, where the machine's own numbers and times would differ from
// run to run.
//
//   timespec written{};
//   if (!find_modified(7, written)) print("as the file says");
#pragma once

#include <sys/types.h>
#include <time.h>

namespace simbench::shim {

// What st_dev is of the files of the host's folder.
inline constexpr dev_t kOwnDevice = 1;

// When the open file was last written to, by the host's clock. False: the file says it itself.
bool find_modified(int fd, timespec& modified);
// By the host's system clock.
timespec host_time();
// The file was just made, by this process: it is none that the world knows. `path` is the
// machine's; with AT_EMPTY_PATH and "", `folder` is the file.
void note_made(int folder, const char* path, int flags = 0);

}  // namespace simbench::shim
