#include "recording/recording_folder.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>

#include "algorithms/ports/assert.h"
#include "recording/append_file.h"
#include "recording/event.h"
#include "recording/event_text.h"
#include "recording/line_reader.h"
#include "recording/recording_manifest.h"

namespace simbench {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kFlushInterval{100};
constexpr int kFlushEvents = 1000;

// Throws if an event names a camera or a host that the rig does not have: its members are called
// camera, host, slave and peer.
class NumbersCheck {
 public:
  explicit NumbersCheck(const RigLayout& layout) : layout_(layout) {}

  void operator()(const FrameEvent& event) const { camera(event.record.camera); }
  void operator()(const RecordingEvent& event) const { std::visit(*this, event); }
  template <class Event>
  void operator()(const Event& event) const {
    if constexpr (requires { event.camera; }) camera(event.camera);
    if constexpr (requires { event.host; }) host("host", event.host);
    if constexpr (requires { event.slave; }) host("slave", event.slave);
    if constexpr (requires { event.exchange.peer; }) host("peer", event.exchange.peer);
    if constexpr (requires { event.host_errors; }) errors(event.host_errors.size());
  }

 private:
  void camera(std::uint32_t number) const { check("camera", number, layout_.cameras.size()); }
  void host(const char* name, std::uint32_t number) const { check(name, number, layout_.hosts); }
  void errors(std::size_t count) const {
    if (count == layout_.hosts) return;
    throw TextFieldError(fmt::format("found {} clock errors, allowed: one for each of {} hosts",
                                     count, layout_.hosts));
  }
  static void check(const char* name, std::size_t number, std::size_t count) {
    if (number < count) return;
    throw TextFieldError(fmt::format("{}: found {}, allowed: 0 to {}", name, number, count - 1));
  }

  const RigLayout& layout_;
};

// One of a capture's two files. `capture` must outlive it.
class CaptureFile {
 public:
  enum class Kind : std::uint8_t { kFrames, kEvents };

  CaptureFile(const std::string& path, Kind kind, const RecordedCapture& capture);

  bool has_event() const { return state_ == State::kEvent; }
  std::uint64_t order() const { return order_; }
  const KeptEvent& event() const { return event_; }
  std::string place() const { return lines_.place(); }
  // Why the next event cannot be read; empty at a good end.
  const std::string& damage() const { return damage_; }
  // Reads the next event.
  void advance();

 private:
  enum class State : std::uint8_t { kEvent, kEnd, kDamaged };

  void read_header();
  void read_line();
  void read_event(std::string_view line);
  void at_end();
  void set_damaged(std::string damage);

  LineReader lines_;
  std::string path_;
  Kind kind_;
  const RecordedCapture& capture_;
  std::uint64_t expected_ = 0;  // lines, of a complete capture
  std::uint64_t read_ = 0;
  std::uint64_t order_ = 0;
  KeptEvent event_;
  std::string damage_;
  State state_ = State::kEvent;
};

// A capture event by event, in the order in which it was recorded: merges its two files by `order`.
// A complete capture must have every event. In one without an end, `order` may have gaps where the
// writer died between its two files. Errors: RecordingFolderError, after all events before the
// damage.
class CaptureReader {
 public:
  // `capture` must outlive this.
  CaptureReader(const std::string& folder, const RecordedCapture& capture);

  // False at the end.
  bool next();
  const KeptEvent& event() const { return current_->event(); }

 private:
  const RecordedCapture& capture_;
  CaptureFile frames_;
  CaptureFile events_;
  CaptureFile* current_ = nullptr;
  std::uint64_t expected_order_ = 0;
};

LineReader lines_of(const std::string& path) {
  try {
    return LineReader(path, Pipes::kRefused);
  } catch (const LineError& error) {
    throw RecordingFolderError(error.what());
  }
}

CaptureFile::CaptureFile(const std::string& path, Kind kind, const RecordedCapture& capture)
    : lines_(lines_of(path)), path_(path), kind_(kind), capture_(capture) {
  if (capture.complete) expected_ = kind == Kind::kFrames ? capture.frames : capture.other_events;
  if (kind_ == Kind::kFrames) read_header();
  if (state_ == State::kEvent) advance();
}

void CaptureFile::read_header() {
  std::optional<std::string_view> header;
  try {
    header = lines_.next();
  } catch (const LineError& error) {
    set_damaged(error.what());
    return;
  }
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
  } catch (const LineError& error) {
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
  std::visit(NumbersCheck(capture_.layout), event_);
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
  // Without an end, order may have gaps; it never goes back.
  if (!in_order && (capture_.complete || current_->order() < expected_order_)) {
    throw RecordingFolderError(fmt::format("{}: order: found {}, allowed: {}", current_->place(),
                                           current_->order(), expected_order_));
  }
  expected_order_ = current_->order() + 1;
  return true;
}

class RecordedSource final : public RecordingSource {
 public:
  explicit RecordedSource(const RecordingFolder& folder) : folder_(folder) {}

  RecordingCost record(const RecordingRequest& request, RecordingSink& sink) override {
    const auto found = folder_.find(request.pipeline, request.seed);
    if (!found) {
      throw RecordingFailed(fmt::format("pipeline {}, seed {} is not among the recorded captures",
                                        request.pipeline, request.seed));
    }
    const RecordedCapture& capture = folder_.captures()[*found];
    RecordingCost cost = capture.cost;
    cost.notes = capture.notes;
    try {
      folder_.play(*found, sink);
    } catch (const RecordingFolderError& error) {
      cost.notes.push_back(fmt::format("damaged, played up to there: {}", error.what()));
    }
    return cost;
  }
  bool runs_host_sync() const override { return false; }

 private:
  const RecordingFolder& folder_;
};

void make_folder(const std::string& folder) {
  std::error_code error;
  const fs::path parent = fs::path(folder).parent_path();
  if (fs::is_directory(folder, error)) {
    const bool empty = fs::is_empty(folder, error);
    if (!error && empty) return;
    throw RecordingFolderError(
        error ? fmt::format("{}: {}", folder, error.message())
              : fmt::format("{}: is not empty; a recording needs a new folder", folder));
  }
  if (!parent.empty() && !fs::is_directory(parent, error)) {
    throw RecordingFolderError(
        fmt::format("{}: there is no folder {}; make it first", folder, parent.string()));
  }
  if (!fs::create_directory(folder, error)) {
    throw RecordingFolderError(fmt::format("{}: cannot be written: {}", folder,
                                           error ? error.message() : "a file has this name"));
  }
}

// The two files of a capture as they are written.
class CaptureFiles {
 public:
  explicit CaptureFiles(const std::string& folder)
      : frames_(folder + kFramesFile), events_(folder + kEventsFile) {
    frames_.buffer() = fmt::format("order,{},{}\n", kFrameColumns, kFrameTruthColumns);
    flush();
  }

  void add_frame(const FrameRecord& frame, const FrameTruth* truth) {
    std::string& line = frames_.buffer();
    append_number(line, order_);
    append_frame(line, frame);
    if (truth != nullptr) {
      append_truth(line, *truth);
    } else {
      line.append(kFrameTruthColumnCount, ',');
    }
    ++frame_count_;
    end_line(line);
  }

  void add_event(const RecordingEvent& event) {
    std::string& line = events_.buffer();
    append_number(line, order_);
    line += ',';
    append_event(line, event);
    end_line(line);
  }

  void close() {
    frames_.close();
    events_.close();
  }
  std::uint64_t frames() const { return frame_count_; }
  std::uint64_t other_events() const { return order_ - frame_count_; }

 private:
  void end_line(std::string& line) {
    line += '\n';
    ++order_;
    if (++waiting_ >= kFlushEvents || Clock::now() - flushed_ >= kFlushInterval) flush();
  }

  void flush() {
    frames_.flush();
    events_.flush();
    waiting_ = 0;
    flushed_ = Clock::now();
  }

  AppendFile frames_;
  AppendFile events_;
  std::uint64_t order_ = 0;
  std::uint64_t frame_count_ = 0;
  int waiting_ = 0;
  Clock::time_point flushed_;
};

}  // namespace

RecordingFolder::RecordingFolder(std::string folder) : folder_(std::move(folder)) {
  while (folder_.size() > 1 && folder_.ends_with('/')) folder_.pop_back();
  RecordingManifest manifest = read_manifest(folder_);
  description_ = std::move(manifest.description);
  captures_ = std::move(manifest.captures);
  for (RecordedCapture& capture : captures_) {
    if (!capture.complete) {
      capture.notes.emplace_back("the recording has no end: what was written until then is there");
    }
  }
}

std::optional<std::size_t> RecordingFolder::find(const std::string& pipeline,
                                                 std::uint64_t seed) const {
  for (std::size_t i = 0; i < captures_.size(); ++i) {
    if (captures_[i].pipeline == pipeline && captures_[i].seed == seed) return i;
  }
  return std::nullopt;
}

void RecordingFolder::play(std::size_t capture, RecordingSink& sink) const {
  SIMBENCH_ASSERT(capture < captures_.size(), "a capture of this folder");
  const RecordedCapture& played = captures_[capture];
  sink.on_start(played.layout);
  CaptureReader reader(folder_, played);
  while (reader.next()) notify(reader.event(), sink);
}

std::unique_ptr<RecordingSource> make_recorded_source(const RecordingFolder& folder) {
  return std::make_unique<RecordedSource>(folder);
}

class RecordingWriter::State final : public RecordingSink {
 public:
  State(std::string folder, RecordingDescription description)
      : folder_(std::move(folder)), manifest_{std::move(description), {}} {
    const std::string& scenario = manifest_.description.scenario_json;
    SIMBENCH_ASSERT(scenario.empty() || nlohmann::json::accept(scenario),
                    "a recording's scenario is JSON");
    make_folder(folder_);
  }

  void begin(const std::string& pipeline, std::uint64_t seed) {
    SIMBENCH_ASSERT(!next_, "one capture is recorded at a time");
    for (const RecordedCapture& capture : manifest_.captures) {
      if (capture.pipeline == pipeline && capture.seed == seed) {
        throw RecordingFolderError(
            fmt::format("{}: pipeline {}, seed {} is recorded already", folder_, pipeline, seed));
      }
    }
    write_manifest(manifest_, folder_);
    next_ = RecordedCapture{};
    next_->pipeline = pipeline;
    next_->seed = seed;
  }

  void end(const RecordingCost& cost, std::vector<std::string> notes) {
    if (!finish_files(std::move(notes))) return;
    RecordedCapture& capture = manifest_.captures.back();
    capture.complete = true;
    capture.cost = cost;
    capture.cost.notes.clear();
    capture.notes.insert(capture.notes.begin(), cost.notes.begin(), cost.notes.end());
    write_manifest(manifest_, folder_);
  }

  void abandon(std::vector<std::string> notes) {
    if (!finish_files(std::move(notes))) return;
    RecordedCapture& capture = manifest_.captures.back();
    capture.frames = 0;
    capture.other_events = 0;
    write_manifest(manifest_, folder_);
  }

  void on_start(const RigLayout& layout) override {
    SIMBENCH_ASSERT(next_ && !files_, "a capture starts once, between begin() and end()");
    const std::string folder = capture_folder(folder_, next_->pipeline, next_->seed);
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) {
      throw RecordingFolderError(fmt::format("{}: cannot be written: {}", folder, error.message()));
    }
    files_ = std::make_unique<CaptureFiles>(folder);
    next_->layout = layout;
    manifest_.captures.push_back(*next_);
    write_manifest(manifest_, folder_);
  }

  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) override {
    if (!files_) return;
    for_each_frame(frames, truths, [this](const FrameRecord& frame, const FrameTruth* truth) {
      files_->add_frame(frame, truth);
    });
  }
  void on_event(const RecordingEvent& event) override {
    if (files_) files_->add_event(event);
  }

 private:
  // False if there was nothing to write. Afterwards there is no capture, also if it throws.
  bool finish_files(std::vector<std::string> notes) {
    SIMBENCH_ASSERT(next_, "end() without begin()");
    next_.reset();
    if (!files_) return false;
    RecordedCapture& capture = manifest_.captures.back();
    capture.frames = files_->frames();
    capture.other_events = files_->other_events();
    capture.notes = std::move(notes);
    const std::unique_ptr<CaptureFiles> files = std::move(files_);
    files->close();
    return true;
  }

  std::string folder_;
  RecordingManifest manifest_;
  std::optional<RecordedCapture> next_;  // between begin() and end()
  std::unique_ptr<CaptureFiles> files_;  // from on_start() on
};

RecordingWriter::RecordingWriter(std::string folder, RecordingDescription description)
    : state_(std::make_unique<State>(std::move(folder), std::move(description))) {}

RecordingWriter::~RecordingWriter() = default;

RecordingSink& RecordingWriter::begin(const std::string& pipeline, std::uint64_t seed) {
  state_->begin(pipeline, seed);
  return *state_;
}

void RecordingWriter::end(const RecordingCost& cost, std::vector<std::string> notes) {
  state_->end(cost, std::move(notes));
}

void RecordingWriter::abandon(std::vector<std::string> notes) { state_->abandon(std::move(notes)); }

}  // namespace simbench
