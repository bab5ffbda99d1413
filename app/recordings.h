// Recording folders: a scenario recorded into one, and one evaluated again.
//
// A capture that fails is left without an end, and the others are made all the same. What went
// wrong during a capture (RecordingCost::notes) is a warning and is kept with it. A folder
// evaluated again gives the table that its run printed.
//
//   RecordingWriter writer("monday", {.backend = "sim", .scenario_json =
//   scenario.resolved_json()}); CapturesMade made; record_captures(choices,
//   *simulated_world(scenario), {.seeds = 3}, writer, made, progress);
//
// Files of other people (bags, CSV, IBL) are a recording of one capture (app/stream_run.h), scored
// by the same code. What a recording lacks of a pipeline's need is the reason why its row has no
// score.
//
//   const RecordedRun run("monday");
//   const evaluation::Results results = run.evaluate(run.chosen({}), {}, progress);
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/stream_run.h"
#include "bags/recorded_files.h"
#include "evaluation/run/evaluate.h"
#include "evaluation/run/pipeline_choice.h"
#include "recording/recording.h"
#include "recording/recording_folder.h"
#include "scenarios/scenario.h"

namespace simbench::app {

struct CapturePlan {
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 1;
};

struct CapturesMade {
  std::uint64_t recorded = 0;
  std::uint64_t programs_failed = 0;  // of these: a real program ended too early in them
  std::vector<std::string> warnings{};
};

// Records every pipeline's capture of every seed. `made` is up to date also when this ends by an
// exception. Throws RecordingCancelled, what the source throws except RecordingFailed,
// and RecordingFolderError (a full disk). Progress counts captures.
void record_captures(const std::vector<evaluation::PipelineChoice>& choices,
                     RecordingSource& source, const CapturePlan& plan, RecordingWriter& writer,
                     CapturesMade& made, const evaluation::Progress& progress);

class RecordedRun {
 public:
  // Throws RecordingFolderError or scenarios::InputError where there is nothing to evaluate: no
  // capture, no scenario.
  explicit RecordedRun(const std::string& folder);
  // Evaluates files, whose streams these are. Throws scenarios::InputError.
  RecordedRun(std::vector<std::string> files, RecordedStreams recorded,
              const StreamScoring& scoring);
  RecordedRun(RecordedRun&&) = default;
  RecordedRun& operator=(RecordedRun&&) = default;

  const std::string& path() const { return path_; }
  const scenarios::Scenario& scenario() const {
    return streams_ ? streams_->scenario() : scenario_;
  }
  // The streams of files; null of a recording folder.
  const StreamRun* streams() const { return streams_ ? &*streams_ : nullptr; }
  // The planned captures that are not there, as of a killed `simbench record`: a line a pipeline.
  std::vector<std::string> missing() const;
  // These pipelines, or all in the order in which they were recorded if none is named. Throws
  // scenarios::InputError for one that was not recorded.
  std::vector<std::string> chosen(const std::vector<std::string>& pipelines) const;
  std::uint64_t first_seed() const { return first_seed_; }
  // What a program's calendar says, since 1970, where a host's clock reads 0: a simulated world has
  // one of its own.
  Nanoseconds calendar_zero() const;
  std::uint64_t seeds() const { return seeds_; }
  // Plays the captures of these pipelines; `choices` and this outlive it. Refuses a pipeline whose
  // needs the recording lacks (RecordingFailed). Ends at Ctrl-C (app/interrupt.h).
  std::unique_ptr<RecordingSource> source(
      const std::vector<evaluation::PipelineChoice>& choices) const;
  struct Wanted {
    bool keep_pulses = false;
    bool certify = false;  // SeedScore::certified_ms
  };
  // Scores all recorded seeds; notes captures that are missing or damaged. Ends at Ctrl-C.
  evaluation::Results evaluate(const std::vector<std::string>& pipelines, const Wanted& wanted,
                               const evaluation::Progress& progress) const;

 private:
  std::string path_;
  std::optional<RecordingFolder> folder_;  // this, or streams_
  std::optional<StreamRun> streams_;
  scenarios::Scenario scenario_;  // of a folder
  std::uint64_t first_seed_ = 1;
  std::uint64_t seeds_ = 1;
};

// Throws scenarios::InputError unless it is one recording folder: files have neither the hosts'
// messages nor polls of the cameras' clocks, so that nothing is certain about their frames.
void check_evidence(const std::vector<std::string>& inputs);

// Whether the folder has a manifest and no results: a recording, and no archive of a run.
bool is_recording_folder(const std::string& path);
// Whether it is that, or a file of other people: anything but a folder and a .json file.
bool is_recording(const std::string& path);

// A recording folder, or files with this scoring, of which a folder has the pipelines alone:
// RecordedRun::chosen() takes them. Throws what RecordedRun and app::recorded_streams() do, and
// scenarios::InputError for a folder with another scoring.
RecordedRun recorded_run(const std::vector<std::string>& inputs, const bags::FileOptions& options,
                         const StreamScoring& scoring, const ReadProgress& progress = {});

// What went wrong in captures that were scored all the same.
std::vector<std::string> capture_notes(const evaluation::Results& results);

}  // namespace simbench::app
