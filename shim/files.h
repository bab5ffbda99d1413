// The times of files that a program writes.
//
//   const int fd = open("drift", O_WRONLY);
//   note_written(fd, true);
//   stamp_file(fd);  // before it is closed
#pragma once

namespace simbench::shim {

// Whether it was opened to be written.
void note_written(int fd, bool is);
// Gives the file the time of the host's system clock, if it was.
void stamp_file(int fd);

}  // namespace simbench::shim
