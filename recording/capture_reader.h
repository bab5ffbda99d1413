// A capture of a recording folder, event by event, in the order in which it was recorded.
//
// Merges the capture's two files by their `order`. Of a complete capture every event must be there;
// of one without an end, what is there is given: order may then have gaps where the writer died
// between its two files, and a torn last line is no line.
//
// Errors: RecordingFolderError, after all events that come before the damage.
//
//   CaptureReader reader(folder, capture);
//   while (reader.next()) tell(reader.event(), sink);
#ifndef SIMBENCH_RECORDING_CAPTURE_READER_H_
#define SIMBENCH_RECORDING_CAPTURE_READER_H_

#include <cstdint>
#include <string>

#include "recording/event.h"
#include "recording/line_reader.h"
#include "recording/recording_folder.h"

namespace simbench {

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
