#include "recording/line_reader.h"

#include <fmt/format.h>

#include <cstring>
#include <utility>

#include "scenarios/input_file.h"

namespace simbench {
namespace {

constexpr std::size_t kBlock = 64U << 10U;
constexpr std::size_t kLeastLines = 4'000'000;  // of a compressed file; others have a byte for each
constexpr std::size_t kLongestLine = 32U << 20U;  // clock errors of a million hosts fit

[[noreturn]] void fail_to_read_lines(const std::string& path, const FileError& error) {
  throw LineError(fmt::format("{}: cannot be read: {}", path, error.what()));
}

TextFile opened(const std::string& path, Pipes pipes) {
  try {
    return TextFile(path, pipes);
  } catch (const FileError& error) {
    fail_to_read_lines(path, error);
  }
}

}  // namespace

LineReader::LineReader(std::string path, Pipes pipes)
    : path_(std::move(path)), file_(opened(path_, pipes)), buffer_(kBlock, '\0') {}

LineReader::LineReader(std::string path, std::string_view text)
    : path_(std::move(path)), buffer_(text), end_(buffer_.size()) {
  if (text.starts_with("\xef\xbb\xbf")) begin_ = 3;  // the mark of UTF-8
}

std::optional<std::string_view> LineReader::next() {
  std::size_t searched = begin_;
  while (true) {
    const std::size_t stop = std::string_view(buffer_.data(), end_).find('\n', searched);
    if (stop != std::string_view::npos) {
      const std::string_view line(buffer_.data() + begin_, stop - begin_);
      begin_ = stop + 1;
      ++line_;
      if (file_ && line_ > kLeastLines && line_ - kLeastLines > file_->bytes_read()) {
        throw LineError(
            fmt::format("{}: more lines than a file of its size may have ({} and one a "
                        "byte); unpack it",
                        place(), kLeastLines));
      }
      return line;
    }
    const std::size_t length = end_ - begin_;
    if (length > kLongestLine) {
      ++line_;
      throw LineError(
          fmt::format("{}: longer than {} bytes, no line of a recording", place(), kLongestLine));
    }
    if (at_end_ || !read_more()) {
      exhausted_ = true;
      return std::nullopt;
    }
    searched = begin_ + length;
  }
}

bool LineReader::read_more() {
  if (!file_) {
    at_end_ = true;
    return false;
  }
  const std::size_t unused = kept_.value_or(begin_);
  if (unused > 0) {
    std::memmove(buffer_.data(), buffer_.data() + unused, end_ - unused);
    begin_ -= unused;
    end_ -= unused;
    if (kept_) kept_ = 0;
  }
  if (end_ == buffer_.size()) buffer_.resize(buffer_.size() * 2);
  std::size_t size = 0;
  try {
    size = file_->read(buffer_.data() + end_, buffer_.size() - end_);
  } catch (const FileError& error) {
    fail_to_read_lines(path_, error);
  }
  end_ += size;
  at_end_ = size == 0;
  return !at_end_;
}

void LineReader::mark() {
  kept_ = begin_;
  kept_line_ = line_;
}

void LineReader::rewind() {
  begin_ = *kept_;
  line_ = kept_line_;
  kept_.reset();
  exhausted_ = false;
}

std::string LineReader::place() const { return fmt::format("{}:{}", path_, line()); }

}  // namespace simbench
