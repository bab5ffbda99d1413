// Read errors at any byte: while it lives, reading fails with EIO after so many bytes, over all
// files.
//
//   for (std::size_t byte = 0; byte < size; ++byte) {
//     const ReadFault fault(byte);
//     EXPECT_THROW(read_file(path), FileError);
//   }
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>

#include "scenarios/input_file.h"

namespace simbench {

class ReadFault {
 public:
  explicit ReadFault(std::size_t after_bytes) : before_(exchange_read_function(&read_until)) {
    left = after_bytes;
  }
  ~ReadFault() { exchange_read_function(before_); }
  ReadFault(const ReadFault&) = delete;
  ReadFault& operator=(const ReadFault&) = delete;

 private:
  static ssize_t read_until(int file, void* to, std::size_t most) {
    if (left == 0) {
      errno = EIO;
      return -1;
    }
    const ssize_t size = ::read(file, to, std::min(most, left));
    if (size > 0) left -= static_cast<std::size_t>(size);
    return size;
  }

  static inline std::size_t left = 0;
  ReadFunction before_;
};

}  // namespace simbench
