// Reads a text file (recording/text_file.h: also compressed, UTF-16, "-") line by line, in memory
// of one line. A last line without its line end is no line: its writer died (torn()). A read error
// is never taken for the end.
//
// A compressed file may have four million lines and one for each of its bytes, so that a small one
// cannot become more than memory holds.
//
// Errors: LineError, for a file that cannot be read ("FILE: cannot be read: ...") and a line that
// is too long ("FILE:LINE: ...").
//
//   LineReader lines("DIR/frames.csv");
//   while (const auto line = lines.next()) use(*line, lines.place());
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "recording/text_file.h"

namespace simbench {

class LineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class LineReader {
 public:
  explicit LineReader(std::string path, Pipes pipes = Pipes::kRead);
  // Text as if it were the content of `path`.
  LineReader(std::string path, std::string_view text);

  // Valid until the next call; nothing at the end.
  std::optional<std::string_view> next();
  // After the last line: whether bytes without a line end follow.
  bool torn() const { return exhausted_ && begin_ < end_; }
  // What is read from here on is kept, until rewind() goes back to it.
  void mark();
  void rewind();
  // The size of the file, 0 if that is unknown, and the bytes of it that were read.
  std::uint64_t size() const { return file_ ? file_->size() : 0; }
  std::uint64_t bytes_read() const { return file_ ? file_->bytes_read() : 0; }
  const std::string& path() const { return path_; }
  // The number of the line that was read last, or of the torn one; of the first if there is none.
  std::size_t line() const { return std::max<std::size_t>(torn() ? line_ + 1 : line_, 1); }
  // "FILE:LINE" of it.
  std::string place() const;

 private:
  // False at the end of the file.
  bool read_more();

  std::string path_;
  std::optional<TextFile> file_{};  // none: the text is in the buffer
  std::string buffer_;
  std::size_t begin_ = 0;  // of the unread bytes
  std::size_t end_ = 0;
  std::size_t line_ = 0;
  bool at_end_ = false;                // of the file
  bool exhausted_ = false;             // no line is left
  std::optional<std::size_t> kept_{};  // where the kept bytes begin
  std::size_t kept_line_ = 0;
};

}  // namespace simbench
