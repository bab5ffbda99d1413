#include "watch/grown_stamps.h"

#include <algorithm>
#include <functional>
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

struct GrownReader {
  std::function<void()> forget;  // the file begins anew
  std::function<void()> learn;   // what the first lines hold, which is dropped from then on
  std::function<void(const std::string& text)> read;
};

// Reads what has grown behind the first lines. What cannot be read (an Error) is a problem once
// these are there: a heading without rows is none yet.
template <class Error>
void read_grown(GrowingText& tail, FirstLines& first, GrownState& found,
                const GrownReader& reader) {
  const GrownText grown = tail.poll();
  found.is_there = grown.is_there;
  found.begins_anew = grown.begins_anew;
  if (grown.begins_anew) {
    first.forget();
    reader.forget();
  }
  const auto attempt = [&](const auto& action) {
    try {
      action();
    } catch (const Error& error) {
      if (first.are_all()) found.problem = error.what();
    }
  };
  attempt([&] {
    if (grown.is_cut) {
      first.take(tail.head(kHeadBytes));
      reader.learn();
    }
    if (!grown.text.empty()) reader.read(first.text() + grown.text);
  });
  if (first.are_all() || grown.text.empty()) return;
  first.take(grown.text);
  attempt(reader.learn);
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
  Found found;
  read_grown<RecordedFileError>(*tail_, first_, found,
                                {.forget = [&] { known_.clear(); },
                                 .learn = [&] { learn(); },
                                 .read =
                                     [&](const std::string& text) {
                                       found.streams = read(text);
                                       for (RecordedStream& stream : found.streams) {
                                         drop_first(known_[key_of(stream)], stream);
                                       }
                                     }});
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
  Found found;
  read_grown<scenarios::InputError>(
      *tail_, first_, found,
      {.forget = [&] { known_ = 0; },
       .learn = [&] { learn(); },
       .read =
           [&](const std::string& text) {
             found.points = read(text);
             const auto known = static_cast<std::ptrdiff_t>(std::min(known_, found.points.size()));
             found.points.erase(found.points.begin(), found.points.begin() + known);
             found.format = format_;
           }});
  return found;
}

}  // namespace simbench::watch
