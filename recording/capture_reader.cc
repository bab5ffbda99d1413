#include "recording/capture_reader.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>
#include <variant>

#include "recording/event_text.h"
#include "recording/recording_folder.h"
#include "recording/recording_manifest.h"

namespace simbench {
namespace {

// Whether an event names a camera or a host that the rig does not have.
struct NumbersCheck {
  const RigLayout& layout;

  void camera(std::uint32_t number) const { check("camera", number, layout.cameras.size()); }
  void host(const char* name, std::uint32_t number) const { check(name, number, layout.hosts); }

  void operator()(const FrameEvent& event) const { camera(event.record.camera); }
  void operator()(const PulseEvent& event) const {
    if (event.host_errors.size() == layout.hosts) return;
    throw TextFieldError(fmt::format("found {} clock errors, allowed: one for each of {} hosts",
                                     event.host_errors.size(), layout.hosts));
  }
  void operator()(const ClockAdjustment& event) const { host("host", event.host); }
  void operator()(const DevicePoll& event) const { camera(event.camera); }
  void operator()(const ExchangeEvent& event) const {
    host("host", event.host);
    host("peer", event.exchange.peer);
  }
  void operator()(const SyncOutcome& event) const { host("slave", event.slave); }

  static void check(const char* name, std::size_t number, std::size_t count) {
    if (number < count) return;
    throw TextFieldError(fmt::format("{}: found {}, allowed: 0 to {}", name, number, count - 1));
  }
};

constexpr std::size_t kBlock = 64U << 10U;

[[noreturn]] void fail(const std::string& path, int reason) {
  throw RecordingFolderError(fmt::format("{}: cannot be read: {}", path, std::strerror(reason)));
}

}  // namespace

CaptureFile::CaptureFile(const std::string& path, Kind kind, const RecordedCapture& capture)
    : lines_(path), path_(path), kind_(kind), capture_(capture) {
  if (capture.complete) expected_ = kind == Kind::kFrames ? capture.frames : capture.other_events;
  if (kind_ == Kind::kFrames) read_header();
  if (state_ == State::kEvent) advance();
}

void CaptureFile::read_header() {
  const auto header = lines_.next();
  if (!header) {
    at_end();
  } else if (*header != fmt::format("order,{},{}", kFrameColumns, kFrameTruthColumns)) {
    set_damaged(fmt::format("{}: found {}, allowed: order,{},{}", lines_.place(),
                            quoted_bytes(*header), kFrameColumns, kFrameTruthColumns));
  }
}

void CaptureFile::advance() {
  try {
    read_line();
  } catch (const RecordingFolderError& error) {
    set_damaged(error.what());
  } catch (const TextFieldError& error) {
    set_damaged(fmt::format("{}: {}", lines_.place(), error.what()));
  }
}

void CaptureFile::read_line() {
  const auto line = lines_.next();
  if (!line) {
    at_end();
    return;
  }
  if (capture_.complete && read_ == expected_) {
    throw TextFieldError(fmt::format("found another line, allowed: {}", expected_));
  }
  const std::uint64_t before = order_;
  read_event(*line);
  if (read_ > 0 && order_ <= before) {
    throw TextFieldError(fmt::format("order: found {}, allowed: above {}", order_, before));
  }
  check_numbers();
  ++read_;
}

void CaptureFile::read_event(std::string_view line) {
  FieldReader fields(line);
  order_ = fields.whole<std::uint64_t>("order");
  if (kind_ == Kind::kEvents) {
    event_ = simbench::read_event(fields);
    if (std::holds_alternative<FrameEvent>(event_)) {
      throw TextFieldError("found a frame, allowed: other events");
    }
    return;
  }
  FrameEvent frame{read_frame(fields), std::nullopt};
  if (!fields.take_empty(kFrameTruthColumnCount)) frame.truth = read_truth(fields);
  fields.end();
  event_ = frame;
}

void CaptureFile::check_numbers() const { std::visit(NumbersCheck{capture_.layout}, event_); }

void CaptureFile::at_end() {
  state_ = State::kEnd;
  if (!capture_.complete || (read_ == expected_ && !lines_.torn())) return;
  set_damaged(fmt::format("{}: ends after {} of {} lines", path_, read_, expected_));
}

void CaptureFile::set_damaged(std::string damage) {
  state_ = State::kDamaged;
  damage_ = std::move(damage);
}

CaptureReader::CaptureReader(const std::string& folder, const RecordedCapture& capture)
    : capture_(capture),
      frames_(capture_folder(folder, capture.pipeline, capture.seed) + kFramesFile,
              CaptureFile::Kind::kFrames, capture),
      events_(capture_folder(folder, capture.pipeline, capture.seed) + kEventsFile,
              CaptureFile::Kind::kEvents, capture) {}

bool CaptureReader::next() {
  if (current_ != nullptr) current_->advance();
  const bool frame_first =
      frames_.has_event() && (!events_.has_event() || frames_.order() < events_.order());
  current_ = frame_first ? &frames_ : &events_;
  const std::string& damage = frames_.damage().empty() ? events_.damage() : frames_.damage();
  const bool in_order = current_->has_event() && current_->order() == expected_order_;
  if (!in_order && !damage.empty()) throw RecordingFolderError(damage);
  if (!current_->has_event()) return false;
  // Of a capture without an end, order may leave some out; it never goes back.
  if (!in_order && (capture_.complete || current_->order() < expected_order_)) {
    throw RecordingFolderError(fmt::format("{}: order: found {}, allowed: {}", current_->place(),
                                           current_->order(), expected_order_));
  }
  expected_order_ = current_->order() + 1;
  return true;
}

LineReader::LineReader(std::string path) : path_(std::move(path)), buffer_(kBlock, '\0') {
  // Not O_RDONLY alone: a pipe in the place of the file would wait for somebody to open its end.
  file_ = open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file_ < 0) fail(path_, errno);
}

LineReader::~LineReader() {
  if (file_ >= 0) close(file_);
}

std::optional<std::string_view> LineReader::next() {
  std::size_t searched = begin_;
  while (true) {
    const std::size_t stop = std::string_view(buffer_.data(), end_).find('\n', searched);
    if (stop != std::string_view::npos) {
      const std::string_view line(buffer_.data() + begin_, stop - begin_);
      begin_ = stop + 1;
      ++line_;
      return line;
    }
    const std::size_t length = end_ - begin_;
    if (length > kLongestLine) {
      ++line_;
      throw RecordingFolderError(
          fmt::format("{}: longer than {} bytes, no line of a recording", place(), kLongestLine));
    }
    if (at_end_ || !read_more()) return std::nullopt;
    searched = begin_ + length;
  }
}

bool LineReader::read_more() {
  if (begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  if (end_ == buffer_.size()) buffer_.resize(buffer_.size() * 2);
  ssize_t size = -1;
  do {
    size = read(file_, buffer_.data() + end_, buffer_.size() - end_);
  } while (size < 0 && errno == EINTR);
  if (size < 0) fail(path_, errno);
  end_ += static_cast<std::size_t>(size);
  at_end_ = size == 0;
  if (torn()) ++line_;
  return !at_end_;
}

std::string LineReader::place() const { return fmt::format("{}:{}", path_, line_); }

}  // namespace simbench
