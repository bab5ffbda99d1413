// A file line by line, in memory that does not grow with the file.
//
// A last line without its line end is no line: it is what a writer had not finished (torn()).
//
// Errors: RecordingFolderError, "FILE: ..." where it cannot be read, "FILE:LINE: ..." where a line
// is longer than kLongestLine.
//
//   LineReader lines("DIR/events.csv");
//   while (const auto line = lines.next()) ...   // valid until the next call
#ifndef SIMBENCH_RECORDING_LINE_READER_H_
#define SIMBENCH_RECORDING_LINE_READER_H_

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace simbench {

// Clock errors of a million hosts fit.
inline constexpr std::size_t kLongestLine = 32U << 20U;

class LineReader {
 public:
  explicit LineReader(std::string path);
  ~LineReader();
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

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
  std::size_t begin_ = 0;  // of what is not taken yet
  std::size_t end_ = 0;
  std::size_t line_ = 0;
  int file_ = -1;
  bool at_end_ = false;
};

}  // namespace simbench

#endif  // SIMBENCH_RECORDING_LINE_READER_H_
