#include "recording/recording_folder.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <utility>

#include "algorithms/ports/assert.h"
#include "recording/append_file.h"
#include "recording/capture_reader.h"
#include "recording/event_text.h"
#include "recording/recording_manifest.h"

namespace simbench {
namespace {

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

 private:
  const RecordingFolder& folder_;
};

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kFlushInterval{100};
constexpr int kFlushEvents = 1000;

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
    line += ',';
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

  void on_frame(const FrameRecord& frame, const FrameTruth* truth) override {
    if (files_) files_->add_frame(frame, truth);
  }
  void on_pulse(const PulseTruth& truth) override {
    add(PulseEvent{truth.pulse, truth.at, {truth.host_errors.begin(), truth.host_errors.end()}});
  }
  void on_adjustment(const ClockAdjustment& adjustment) override { add(adjustment); }
  void on_poll(const DevicePoll& poll) override { add(poll); }
  void on_exchange(std::uint32_t host, const Exchange& exchange) override {
    add(ExchangeEvent{host, exchange});
  }
  void on_outcome(const SyncOutcome& outcome) override { add(outcome); }

 private:
  void add(const RecordingEvent& event) {
    if (files_) files_->add_event(event);
  }

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
