#include "recording/line_reader.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "recording/recording_folder.h"

namespace simbench {
namespace {

constexpr std::size_t kBlock = 64U << 10U;
constexpr std::size_t kLongestLine = 32U << 20U;  // clock errors of a million hosts fit

[[noreturn]] void fail_to_read(const std::string& path, int reason) {
  throw RecordingFolderError(fmt::format("{}: cannot be read: {}", path, std::strerror(reason)));
}

}  // namespace

LineReader::LineReader(std::string path) : path_(std::move(path)), buffer_(kBlock, '\0') {
  // Not O_RDONLY alone: opening a pipe in the place of the file would wait for its other end.
  file_ = open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file_ < 0) fail_to_read(path_, errno);
}

LineReader::~LineReader() {
  if (file_ >= 0) close(file_);
}

std::optional<std::string_view> LineReader::next() {
  std::size_t searched = begin_;
  while (true) {
    const std::size_t stop = std::string_view(buffer_.data(), end_).find('\n', searched);
    if (stop != std::string_view::npos) {
      const std::string_view line(buffer_.data() + begin_, stop - begin_);
      begin_ = stop + 1;
      ++line_;
      return line;
    }
    const std::size_t length = end_ - begin_;
    if (length > kLongestLine) {
      ++line_;
      throw RecordingFolderError(
          fmt::format("{}: longer than {} bytes, no line of a recording", place(), kLongestLine));
    }
    if (at_end_ || !read_more()) return std::nullopt;
    searched = begin_ + length;
  }
}

bool LineReader::read_more() {
  if (begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  if (end_ == buffer_.size()) buffer_.resize(buffer_.size() * 2);
  ssize_t size = -1;
  do {
    size = read(file_, buffer_.data() + end_, buffer_.size() - end_);
  } while (size < 0 && errno == EINTR);
  if (size < 0) fail_to_read(path_, errno);
  end_ += static_cast<std::size_t>(size);
  at_end_ = size == 0;
  if (torn()) ++line_;
  return !at_end_;
}

std::string LineReader::place() const { return fmt::format("{}:{}", path_, line_); }

}  // namespace simbench
