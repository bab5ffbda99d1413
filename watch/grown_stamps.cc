#include "watch/grown_stamps.h"

#include <algorithm>
#include <utility>

#include "recording/rs_csv.h"
#include "scenarios/loader.h"

namespace simbench::watch {
namespace {

constexpr std::size_t kFrameLines = 64;
constexpr std::size_t kClockLines = 8;
constexpr std::size_t kHeadBytes = 64 * 1024;

std::string key_of(const RecordedStream& stream) { return stream.camera + '\n' + stream.stream; }

// Drops the first so many frames of a stream.
void drop_first(std::size_t count, RecordedStream& stream) {
  count = std::min(count, stream.frames.size());
  const auto drop = [count](auto& values) {
    const auto most = static_cast<std::ptrdiff_t>(std::min(count, values.size()));
    values.erase(values.begin(), values.begin() + most);
  };
  drop(stream.frames);
  drop(stream.origin.messages);
  stream.columns.for_each(drop);
}

}  // namespace

void FirstLines::take(std::string_view text) {
  while (!text.empty() && !are_all()) {
    const std::size_t end = text.find('\n') + 1;
    if (end == 0) return;
    text_.append(text.substr(0, end));
    text.remove_prefix(end);
    ++lines_;
  }
}

GrownFrames::GrownFrames(std::unique_ptr<GrowingText> text, std::optional<RecordingColumns> columns)
    : tail_(std::move(text)), columns_(std::move(columns)), first_(kFrameLines) {}

std::vector<RecordedStream> GrownFrames::read(const std::string& text) const {
  CsvRecordingReader reader = columns_ ? CsvRecordingReader(*columns_) : CsvRecordingReader();
  reader.read_text(text, tail_->path());
  return reader.take();
}

// What the first lines hold is dropped from every later piece.
void GrownFrames::learn() {
  known_.clear();
  for (const RecordedStream& stream : read(first_.text())) {
    known_[key_of(stream)] = stream.frames.size();
  }
}

GrownFrames::Found GrownFrames::poll() {
  const GrownText grown = tail_->poll();
  Found found{{.is_there = grown.is_there, .begins_anew = grown.begins_anew}};
  if (grown.begins_anew) {
    first_.forget();
    known_.clear();
  }
  try {
    if (grown.is_cut) {
      first_.take(tail_->head(kHeadBytes));
      learn();
    }
    if (grown.text.empty()) return found;
    found.streams = read(first_.text() + grown.text);
    for (RecordedStream& stream : found.streams) drop_first(known_[key_of(stream)], stream);
  } catch (const RecordedFileError& error) {
    // A heading without rows is no recording yet.
    if (first_.are_all()) found.problem = error.what();
  }
  if (first_.are_all()) return found;
  first_.take(grown.text);
  try {
    learn();
  } catch (const RecordedFileError& error) {
    if (first_.are_all()) found.problem = error.what();
  }
  return found;
}

GrownClock::GrownClock(std::unique_ptr<GrowingText> text, evaluation::ClockLogOptions options)
    : tail_(std::move(text)), options_(std::move(options)), first_(kClockLines) {}

std::vector<evaluation::ClockLogPoint> GrownClock::read(const std::string& text) {
  evaluation::ClockLog log = evaluation::parse_clock_log(text, tail_->path(), options_);
  format_ = log.format;
  return std::move(log.points);
}

void GrownClock::learn() { known_ = read(first_.text()).size(); }

GrownClock::Found GrownClock::poll() {
  const GrownText grown = tail_->poll();
  Found found{{.is_there = grown.is_there, .begins_anew = grown.begins_anew}};
  if (grown.begins_anew) {
    first_.forget();
    known_ = 0;
  }
  try {
    if (grown.is_cut) {
      first_.take(tail_->head(kHeadBytes));
      learn();
    }
    if (grown.text.empty()) return found;
    found.points = read(first_.text() + grown.text);
    const auto known = static_cast<std::ptrdiff_t>(std::min(known_, found.points.size()));
    found.points.erase(found.points.begin(), found.points.begin() + known);
    found.format = format_;
  } catch (const scenarios::InputError& error) {
    if (first_.are_all()) found.problem = error.what();
  }
  if (first_.are_all()) return found;
  first_.take(grown.text);
  try {
    learn();
  } catch (const scenarios::InputError& error) {
    if (first_.are_all()) found.problem = error.what();
  }
  return found;
}

}  // namespace simbench::watch
