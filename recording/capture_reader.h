// A capture of a recording folder, event by event, in the order in which it was recorded.
//
// Merges the capture's two files by their `order`. Of a complete capture every event must be there;
// of one without an end, what is there is given: order may then have gaps where the writer died
// between its two files, and a torn last line is no line.
//
// Memory does not grow with the files. Errors: RecordingFolderError, after all events that come
// before the damage: "FILE: ..." where a file cannot be read, "FILE:LINE: ..." where a line is
// damaged or longer than kLongestLine.
//
//   CaptureReader reader("monday", capture);
//   while (reader.next()) notify(reader.event(), sink);
#ifndef SIMBENCH_RECORDING_CAPTURE_READER_H_
#define SIMBENCH_RECORDING_CAPTURE_READER_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "recording/event.h"
#include "recording/recording_folder.h"

namespace simbench {

// Clock errors of a million hosts fit.
inline constexpr std::size_t kLongestLine = 32U << 20U;

// A file line by line. A last line without its line end is no line: it is what a writer had not
// finished (torn()).
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
  std::size_t begin_ = 0;  // of what is not taken yet
  std::size_t end_ = 0;
  std::size_t line_ = 0;
  int file_ = -1;
  bool at_end_ = false;
};

// One of the two files. `capture` must outlive it.
class CaptureFile {
 public:
  enum class Kind : std::uint8_t { kFrames, kEvents };

  CaptureFile(const std::string& path, Kind kind, const RecordedCapture& capture);

  bool has_event() const { return state_ == State::kEvent; }
  std::uint64_t order() const { return order_; }
  const RecordingEvent& event() const { return event_; }
  std::string place() const { return lines_.place(); }
  // Why there is no event though there should be one; empty at a good end.
  const std::string& damage() const { return damage_; }
  // Goes on to the next event.
  void advance();

 private:
  enum class State : std::uint8_t { kEvent, kEnd, kDamaged };

  void read_header();
  void read_line();
  void read_event(std::string_view line);
  void check_numbers() const;
  void at_end();
  void set_damaged(std::string damage);

  LineReader lines_;
  std::string path_;
  Kind kind_;
  const RecordedCapture& capture_;
  std::uint64_t expected_ = 0;  // lines, of a complete capture
  std::uint64_t read_ = 0;
  std::uint64_t order_ = 0;
  RecordingEvent event_;
  std::string damage_;
  State state_ = State::kEvent;
};

class CaptureReader {
 public:
  // `capture` must outlive this.
  CaptureReader(const std::string& folder, const RecordedCapture& capture);

  // False at the end.
  bool next();
  const RecordingEvent& event() const { return current_->event(); }

 private:
  const RecordedCapture& capture_;
  CaptureFile frames_;
  CaptureFile events_;
  CaptureFile* current_ = nullptr;
  std::uint64_t expected_order_ = 0;
};

}  // namespace simbench

#endif  // SIMBENCH_RECORDING_CAPTURE_READER_H_
