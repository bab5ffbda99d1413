// Reads a file line by line, in memory of one line. A last line without its line end is no line:
// its writer died (torn()). A read error is never taken for the end.
//
// Errors: LineError, for a file that cannot be read ("FILE: cannot be read: ...") and a line that
// is too long ("FILE:LINE: ...").
//
//   LineReader lines("DIR/frames.csv");
//   while (const auto line = lines.next()) use(*line, lines.place());
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "scenarios/input_file.h"

namespace simbench {

class LineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class LineReader {
 public:
  explicit LineReader(std::string path, Pipes pipes = Pipes::kRead);

  // Valid until the next call; nothing at the end.
  std::optional<std::string_view> next();
  // After the last line: whether bytes without a line end follow.
  bool torn() const { return at_end_ && begin_ < end_; }
  // The size of the file, 0 if that is unknown, and the bytes of it that were read.
  std::uint64_t size() const { return file_.size(); }
  std::uint64_t bytes_read() const { return bytes_read_; }
  // "FILE:LINE" of the line that was read last, or of the torn one; of the first if there is none.
  std::string place() const;

 private:
  // False at the end of the file.
  bool read_more();

  std::string path_;
  InputFile file_;
  std::string buffer_;
  std::size_t begin_ = 0;  // of the unread bytes
  std::size_t end_ = 0;
  std::size_t line_ = 0;
  std::uint64_t bytes_read_ = 0;
  bool at_end_ = false;
};

}  // namespace simbench
