// Reads a file line by line, in memory of one line. A last line without its line end is no line:
// its writer died (torn()).
//
// Errors: RecordingFolderError, for a file that cannot be read and a line that is too long.
//
//   LineReader lines("DIR/frames.csv");
//   while (const auto line = lines.next()) parse(*line, lines.place());
#ifndef SIMBENCH_RECORDING_LINE_READER_H_
#define SIMBENCH_RECORDING_LINE_READER_H_

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace simbench {

class LineReader {
 public:
  explicit LineReader(std::string path);
  ~LineReader();
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  // Valid until the next call; nothing at the end.
  std::optional<std::string_view> next();
  // After the last line: whether bytes without a line end follow.
  bool torn() const { return at_end_ && begin_ < end_; }
  // "FILE:LINE" of the line that was read last, or of the torn one.
  std::string place() const;

 private:
  // False at the end of the file.
  bool read_more();

  std::string path_;
  std::string buffer_;
  std::size_t begin_ = 0;  // of the unread bytes
  std::size_t end_ = 0;
  std::size_t line_ = 0;
  int file_ = -1;
  bool at_end_ = false;
};

}  // namespace simbench

#endif  // SIMBENCH_RECORDING_LINE_READER_H_
