// A file descriptor that closes itself.
//
//   const Descriptor file(open("rig.key", O_RDONLY | O_CLOEXEC));
//   if (file.good()) use(file.read_at(0, 66));
#pragma once

#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace simbench::hardware {

class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { reset(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }  // negative: none
  bool good() const { return number_ >= 0; }
  int release() { return std::exchange(number_, -1); }
  void reset(int number = -1) {
    if (good()) close(number_);
    number_ = number;
  }

  // Reads `length` bytes from `offset` on, fewer at the end of the file. Nothing on an error, which
  // is in errno.
  std::optional<std::string> read_at(std::uint64_t offset, std::size_t length) const {
    std::string text(length, '\0');
    std::size_t have = 0;
    while (have < length) {
      const ssize_t got =
          pread(number_, text.data() + have, length - have, static_cast<off_t>(offset + have));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) return std::nullopt;
      if (got == 0) break;
      have += static_cast<std::size_t>(got);
    }
    text.resize(have);
    return text;
  }
  // How much of the text was written: all of it, unless there was an error, which is in errno.
  std::size_t write_all(std::string_view text) const {
    std::size_t done = 0;
    while (done < text.size()) {
      const ssize_t put = ::write(number_, text.data() + done, text.size() - done);
      if (put < 0 && errno == EINTR) continue;
      if (put == 0) errno = ENOSPC;
      if (put <= 0) break;
      done += static_cast<std::size_t>(put);
    }
    return done;
  }

 private:
  int number_;
};

}  // namespace simbench::hardware
