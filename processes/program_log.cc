#include "processes/program_log.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <sstream>
#include <utility>

namespace simbench::processes {

ProgramLog::ProgramLog(int folder, const std::string& name) {
  unlinkat(folder, name.c_str(), 0);  // of an earlier run; what cannot be removed is in the way
  constexpr int kNew = O_CREAT | O_EXCL | O_NOFOLLOW;
  descriptor_ = openat(folder, name.c_str(), O_RDWR | O_APPEND | O_CLOEXEC | kNew, 0600);
  error_ = descriptor_ < 0 ? errno : 0;
}

ProgramLog::~ProgramLog() {
  if (descriptor_ >= 0) close(descriptor_);
}

ProgramLog::ProgramLog(ProgramLog&& other) noexcept { *this = std::move(other); }

ProgramLog& ProgramLog::operator=(ProgramLog&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(error_, other.error_);
  return *this;
}

std::string ProgramLog::last_line() const {
  constexpr off_t kMost = 4096;
  struct stat status {};
  if (descriptor_ < 0 || fstat(descriptor_, &status) != 0) return "";
  std::string end(static_cast<std::size_t>(std::min(kMost, status.st_size)), '\0');
  const auto begin = status.st_size - static_cast<off_t>(end.size());
  const ssize_t size = pread(descriptor_, end.data(), end.size(), begin);
  end.resize(static_cast<std::size_t>(std::max<ssize_t>(0, size)));
  std::istringstream lines(end);
  std::string last;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t letter = line.find_last_not_of(" \t\r");
    if (letter != std::string::npos) last = line.substr(0, letter + 1);
  }
  return last;
}

}  // namespace simbench::processes
