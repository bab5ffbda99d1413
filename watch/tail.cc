#include "watch/tail.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

namespace simbench::watch {

Tail::Tail(std::string path, std::uint64_t most_first)
    : path_(std::move(path)), most_first_(most_first) {}

Tail::~Tail() { close(); }

void Tail::close() {
  if (file_ >= 0) ::close(file_);
  file_ = -1;
}

bool Tail::open() {
  file_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat found = {};
  if (file_ < 0) return false;
  if (fstat(file_, &found) != 0 || !S_ISREG(found.st_mode)) {
    close();
    return false;
  }
  device_ = found.st_dev;
  number_ = found.st_ino;
  unfinished_.clear();
  at_ = 0;
  const auto size = static_cast<std::uint64_t>(found.st_size);
  // A file that came while we watched is read whole.
  skips_line_ = !was_opened_ && size > most_first_;
  if (skips_line_) at_ = size - most_first_;
  was_opened_ = true;
  return true;
}

bool Tail::is_replaced(bool& is_there) const {
  struct stat found = {};
  is_there = ::stat(path_.c_str(), &found) == 0;
  return !is_there || found.st_dev != device_ || found.st_ino != number_;
}

// All that there is from where it was left, up to a piece.
std::string Tail::read_on() {
  std::string text;
  while (text.size() < kMostPiece) {
    const std::size_t before = text.size();
    text.resize(std::min(before + 256 * 1024, kMostPiece));
    const ssize_t got =
        pread(file_, text.data() + before, text.size() - before, static_cast<off_t>(at_));
    text.resize(before + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got <= 0) break;
    at_ += static_cast<std::uint64_t>(got);
  }
  return text;
}

GrownText Tail::poll() {
  GrownText grown;
  if (file_ < 0) {
    const bool is_first = !was_opened_;
    grown.is_there = open();
    if (!grown.is_there) return grown;
    grown.begins_anew = !is_first;
    grown.is_cut = skips_line_;
  }
  struct stat now = {};
  if (fstat(file_, &now) == 0 && static_cast<std::uint64_t>(now.st_size) < at_) {
    at_ = 0;
    unfinished_.clear();
    grown.begins_anew = true;
  }
  std::string text = std::move(unfinished_) + read_on();
  unfinished_.clear();
  const std::size_t end = text.rfind('\n');
  if (end == std::string::npos) {
    if (text.size() < kLongestLine) unfinished_ = std::move(text);
    text.clear();
  } else {
    unfinished_ = text.substr(end + 1);
    text.resize(end + 1);
  }
  if (skips_line_ && !text.empty()) {
    text.erase(0, text.find('\n') + 1);
    skips_line_ = false;
  }
  grown.text = std::move(text);
  // What replaced it is read once nothing more comes from the old one.
  if (is_replaced(grown.is_there) && grown.text.empty()) close();
  return grown;
}

std::string Tail::head(std::size_t most) const {
  std::string text(file_ >= 0 ? most : 0, '\0');
  const ssize_t got = file_ >= 0 ? pread(file_, text.data(), most, 0) : 0;
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  return text;
}

}  // namespace simbench::watch
