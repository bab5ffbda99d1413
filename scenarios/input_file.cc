#include "scenarios/input_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace simbench {
namespace {

constexpr std::size_t kFirstBytes = std::size_t{64} << 10;

ReadFunction read_function = ::read;

[[noreturn]] void fail_with(int reason) { throw FileError(std::strerror(reason)); }

}  // namespace

InputFile::InputFile(const std::string& path) {
  // Without blocking: opening a pipe would wait for its other end.
  file_ = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file_ < 0) fail_with(errno);
  struct stat found {};
  const bool known = fstat(file_, &found) == 0;
  const int reason = errno;
  const bool folder = known && S_ISDIR(found.st_mode);
  const bool device = known && (S_ISCHR(found.st_mode) || S_ISBLK(found.st_mode));
  if (!known || folder || device) {
    close(file_);
    if (folder) throw FileError("it is a folder");
    if (device) throw FileError("it is a device");
    fail_with(reason);
  }
  waits_ = !S_ISREG(found.st_mode);
  if (!waits_) size_ = static_cast<std::uint64_t>(found.st_size);
}

InputFile::~InputFile() { close(file_); }

std::size_t InputFile::read(char* to, std::size_t most) {
  while (true) {
    if (waits_) {
      // Not a read that blocks: it would be resumed after an interrupt.
      pollfd wait{file_, POLLIN, 0};
      if (poll(&wait, 1, -1) < 0) fail_with(errno);
    }
    const ssize_t size = read_function(file_, to, most);
    if (size >= 0) return static_cast<std::size_t>(size);
    if (errno != EINTR && !(waits_ && errno == EAGAIN)) fail_with(errno);
  }
}

void InputFile::seek(std::uint64_t position) {
  if (lseek(file_, static_cast<off_t>(position), SEEK_SET) < 0) fail_with(errno);
}

std::string file_content(const std::string& path, std::size_t most) {
  InputFile file(path);
  const std::string too_large = fmt::format("found more than {} bytes", most);
  if (file.size() > most) throw FileTooLarge(too_large);
  // One byte more than there should be: the last read finds the end.
  std::string text(std::max<std::size_t>(static_cast<std::size_t>(file.size()) + 1, kFirstBytes),
                   '\0');
  std::size_t length = 0;
  while (const std::size_t size = file.read(text.data() + length, text.size() - length)) {
    length += size;
    if (length > most) throw FileTooLarge(too_large);
    if (length == text.size()) text.resize(std::min(2 * length, most + 1));
  }
  text.resize(length);
  return text;
}

ReadFunction exchange_read_function(ReadFunction other) {
  return std::exchange(read_function, other);
}

}  // namespace simbench
