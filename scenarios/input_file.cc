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

// Why a file of this mode is not read; null if it is.
const char* refusal(mode_t mode, Pipes pipes) {
  if (S_ISDIR(mode)) return "it is a folder";
  if (S_ISCHR(mode) || S_ISBLK(mode)) return "it is a device";
  if (S_ISSOCK(mode)) return "it is a socket; allowed: a file";
  if (S_ISFIFO(mode) && pipes == Pipes::kRefused) return "it is a pipe; allowed: a file";
  return nullptr;
}

}  // namespace

InputFile::InputFile(const std::string& path, Pipes pipes) {
  struct stat found {};
  // A socket cannot be opened.
  if (stat(path.c_str(), &found) == 0 && S_ISSOCK(found.st_mode)) {
    throw FileError(refusal(found.st_mode, pipes));
  }
  // Without blocking: opening a pipe would wait for its other end.
  file_ = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file_ < 0) fail_with(errno);
  const bool known = fstat(file_, &found) == 0;
  const int reason = errno;
  const char* const refused = known ? refusal(found.st_mode, pipes) : nullptr;
  if (!known || refused != nullptr) {
    close(file_);
    if (refused != nullptr) throw FileError(refused);
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

std::string file_content(const std::string& path, std::size_t most, Pipes pipes) {
  InputFile file(path, pipes);
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
