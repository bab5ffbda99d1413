// The frames and clock errors in a file that grows: what the readers of whole files
// (recording/rs_csv.h, evaluation/stability/clock_log.h) say of each piece.
//
// These readers learn from the first lines what the columns are. The first lines of the file are
// therefore read with each piece, and what they hold is dropped. A piece that cannot
// be read is a problem, not an end: it is skipped, and the next one is read.
//
//   GrownFrames frames(std::make_unique<Tail>("rig.csv"), {});
//   for (const RecordedStream& stream : frames.poll().streams) use(stream);
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/stability/clock_log.h"
#include "recording/recorded_streams.h"
#include "recording/recording_columns.h"
#include "watch/tail.h"

namespace simbench::watch {

// What a poll has found of a file besides what it holds.
struct GrownState {
  bool is_there = true;
  bool begins_anew = false;  // another file, or the same from its beginning
  std::string problem{};     // of this piece; mostly empty
};

// The first lines of a file, at most so many.
class FirstLines {
 public:
  explicit FirstLines(std::size_t most) : most_(most) {}
  void take(std::string_view text);
  bool are_all() const { return lines_ >= most_; }
  const std::string& text() const { return text_; }
  void forget() { *this = FirstLines(most_); }

 private:
  std::size_t most_;
  std::string text_;
  std::size_t lines_ = 0;
};

class GrownFrames {
 public:
  GrownFrames(std::unique_ptr<GrowingText> text, std::optional<RecordingColumns> columns);

  const std::string& path() const { return tail_->path(); }
  struct Found : GrownState {
    std::vector<RecordedStream> streams{};  // the new frames alone
  };
  Found poll();

 private:
  using Counts = std::map<std::string, std::size_t>;  // frames by camera and stream

  std::vector<RecordedStream> read(const std::string& text) const;
  void learn();

  std::unique_ptr<GrowingText> tail_;
  std::optional<RecordingColumns> columns_;
  FirstLines first_;
  Counts known_;  // of what was handed out or stands in the first lines
};

class GrownClock {
 public:
  GrownClock(std::unique_ptr<GrowingText> text, evaluation::ClockLogOptions options);

  const std::string& path() const { return tail_->path(); }
  struct Found : GrownState {
    std::vector<evaluation::ClockLogPoint> points{};
    std::string format{};
  };
  Found poll();

 private:
  std::vector<evaluation::ClockLogPoint> read(const std::string& text);
  void learn();

  std::unique_ptr<GrowingText> tail_;
  std::string format_;
  evaluation::ClockLogOptions options_;
  FirstLines first_;
  std::size_t known_ = 0;  // points, likewise
};

}  // namespace simbench::watch
