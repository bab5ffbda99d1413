// A file in memory, with a path like any other: for tests that write thousands.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <stdexcept>
#include <string>
#include <string_view>

namespace simbench::bags {

class MemoryFile {
 public:
  explicit MemoryFile(std::string_view bytes) : file_(memfd_create("test", MFD_CLOEXEC)) {
    while (!bytes.empty()) {
      const ssize_t size = write(file_, bytes.data(), bytes.size());
      if (size < 0) throw std::runtime_error("a file in memory cannot be written");
      bytes.remove_prefix(static_cast<std::size_t>(size));
    }
    path_ = "/proc/self/fd/" + std::to_string(file_);
  }
  ~MemoryFile() { close(file_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  int file_;
  std::string path_;
};

}  // namespace simbench::bags
