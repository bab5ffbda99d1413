#include "app/recordings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <utility>
#include <variant>

#include "app/interrupt.h"
#include "app/recorded_streams.h"
#include "recording/counted.h"
#include "recording/dataset_folder.h"
#include "recording/forwarding_sink.h"
#include "scenarios/loader.h"
#include "sim/programs/kernel_clock.h"

namespace simbench::app {
namespace {

// Records one capture; leaves one that fails without an end.
void record(const evaluation::PipelineChoice& choice, std::uint64_t seed, RecordingSource& source,
            RecordingWriter& writer, CapturesMade& made) {
  const std::string& pipeline = choice.pipeline.name;
  const auto warn = [&](const std::string& text) {
    made.warnings.push_back(fmt::format("pipeline {}, seed {}: {}", pipeline, seed, text));
  };
  RecordingSink& sink = writer.begin(pipeline, seed);
  try {
    const RecordingCost cost = evaluation::record_run(source, choice, seed, sink);
    writer.end(cost);
    ++made.recorded;
    if (!cost.program_failures.empty()) ++made.programs_failed;
    for (const std::string& note : cost.notes) warn(note);
  } catch (const RecordingFailed& failure) {
    writer.abandon({failure.what()});
    warn(failure.what());
  } catch (const RecordingCancelled&) {
    writer.abandon({"interrupted"});
    throw;
  }
}

constexpr std::uint64_t kMostSeeds = 1'000'000;

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Whether a capture has what some estimators need besides frames.
class InputCheck final : public ForwardingSink {
 public:
  using ForwardingSink::ForwardingSink;
  void on_event(const RecordingEvent& event) override {
    has_polls_ = has_polls_ || std::holds_alternative<DevicePoll>(event);
    has_sightings_ = has_sightings_ || std::holds_alternative<LedSighting>(event);
    sink().on_event(event);
  }

  // What the capture lacks of a need; null if nothing.
  const char* lacking(Need need) const {
    if (need == Need::kPolls && !has_polls_) return "polls of the cameras' clocks";
    if (need == Need::kLedClock && !has_sightings_) return "sightings of a clock of LEDs";
    return nullptr;
  }

 private:
  bool has_polls_ = false;
  bool has_sightings_ = false;
};

// The recorded captures. Refuses one without polls, or without sightings of an LED clock, to a
// pipeline that needs them: its stamps would be bare arrivals, or none of a common clock.
class CheckedSource final : public RecordingSource {
 public:
  // `choices` outlive it. `of_files`: it has neither stamps of hosts nor a model of the cameras.
  CheckedSource(std::unique_ptr<RecordingSource> source,
                const std::vector<evaluation::PipelineChoice>& choices, bool of_files)
      : source_(std::move(source)), choices_(choices), of_files_(of_files) {}

  RecordingCost record(const RecordingRequest& request, RecordingSink& sink) override {
    InputCheck check(sink);
    RecordingCost cost = source_->record(request, check);
    for (const evaluation::PipelineChoice& choice : choices_) {
      if (choice.pipeline.name == request.pipeline) check_needs(choice, check);
    }
    return cost;
  }
  bool runs_host_sync() const override { return source_->runs_host_sync(); }

 private:
  void check_needs(const evaluation::PipelineChoice& choice, const InputCheck& check) const {
    for (const Need need : choice.device_time.info().needs) {
      const bool lacks_hosts = of_files_ && need == Need::kHostStamps;
      const char* const missing =
          lacks_hosts ? "stamps of the host's clock by the camera" : check.lacking(need);
      if (missing == nullptr) continue;
      throw RecordingFailed(fmt::format("{} needs {}, and none was recorded",
                                        choice.device_time.info().name, missing));
    }
    if (!of_files_ || !choice.device_time_variants.calibrated) return;
    throw RecordingFailed(
        fmt::format("{} needs delays that were measured for the cameras' model, which files do not "
                    "state",
                    choice.pipeline.device_time));
  }

  std::unique_ptr<RecordingSource> source_;
  const std::vector<evaluation::PipelineChoice>& choices_;
  bool of_files_;
};

scenarios::Scenario recorded_scenario(const RecordingFolder& recorded, const std::string& folder) {
  const std::string& text = recorded.description().scenario_json;
  if (text.empty()) {
    throw RecordingFolderError(
        fmt::format("{}/manifest.json: /scenario: found null, allowed: a scenario", folder));
  }
  return scenarios::load_scenario_text(text, fmt::format("{}/manifest.json#/scenario", folder));
}

}  // namespace

void record_captures(const std::vector<evaluation::PipelineChoice>& choices,
                     RecordingSource& source, const CapturePlan& plan, RecordingWriter& writer,
                     CapturesMade& made, const evaluation::Progress& progress) {
  const std::uint64_t total = choices.size() * plan.seeds;
  std::uint64_t done = 0;
  for (std::uint64_t i = 0; i < plan.seeds; ++i) {
    for (const evaluation::PipelineChoice& choice : choices) {
      record(choice, plan.first_seed + i, source, writer, made);
      progress(++done, total);
    }
  }
}

RecordedRun::RecordedRun(const std::string& folder)
    : path_(folder), folder_(std::in_place, folder) {
  const std::vector<RecordedCapture>& captures = folder_->captures();
  if (captures.empty()) throw RecordingFolderError(fmt::format("{}: holds no capture", folder));
  scenario_ = recorded_scenario(*folder_, folder);
  const auto [first, last] = std::minmax_element(
      captures.begin(), captures.end(),
      [](const RecordedCapture& a, const RecordedCapture& b) { return a.seed < b.seed; });
  if (last->seed - first->seed >= kMostSeeds) {
    throw RecordingFolderError(
        fmt::format("{}/manifest.json: found seeds {} and {}, allowed: {} in a row", folder,
                    first->seed, last->seed, kMostSeeds));
  }
  first_seed_ = first->seed;
  seeds_ = last->seed - first->seed + 1;
}

Nanoseconds RecordedRun::calendar_zero() const {
  const bool is_simulated = folder_ && folder_->description().backend == "sim";
  return Nanoseconds(is_simulated ? sim::kEpochNs : 0);
}

RecordedRun::RecordedRun(std::vector<std::string> files, RecordedStreams recorded,
                         const StreamScoring& scoring)
    : path_(fmt::format("{}", fmt::join(files, " "))),
      streams_(std::in_place, std::move(recorded), files, scoring) {}

std::vector<std::string> RecordedRun::missing() const {
  if (!folder_) return {};
  const PlannedCaptures& planned = folder_->description().planned;
  std::vector<std::string> notes;
  for (const std::string& pipeline : planned.pipelines) {
    const auto begun = static_cast<std::uint64_t>(std::count_if(
        folder_->captures().begin(), folder_->captures().end(),
        [&](const RecordedCapture& capture) { return capture.pipeline == pipeline; }));
    if (begun >= planned.seeds) continue;
    notes.push_back(fmt::format("pipeline {}: {} of {} not recorded", pipeline,
                                planned.seeds - begun, counted(planned.seeds, "capture")));
  }
  return notes;
}

std::vector<std::string> RecordedRun::chosen(const std::vector<std::string>& pipelines) const {
  std::vector<std::string> known;
  if (streams_) {
    for (const scenarios::Pipeline& each : scenario().pipelines) known.push_back(each.name);
  } else {
    for (const RecordedCapture& capture : folder_->captures()) {
      if (!contains(known, capture.pipeline)) known.push_back(capture.pipeline);
    }
  }
  for (const std::string& name : pipelines) {
    if (contains(known, name)) continue;
    throw scenarios::InputError(fmt::format("--pipelines: found '{}', recorded in {}: {}", name,
                                            path_, fmt::join(known, ", ")));
  }
  return pipelines.empty() ? known : pipelines;
}

std::unique_ptr<RecordingSource> RecordedRun::source(
    const std::vector<evaluation::PipelineChoice>& choices) const {
  std::unique_ptr<RecordingSource> played =
      streams_ ? streams_->source() : make_recorded_source(*folder_);
  return interruptible(
      std::make_unique<CheckedSource>(std::move(played), choices, streams_.has_value()));
}

evaluation::Results RecordedRun::evaluate(const std::vector<std::string>& pipelines,
                                          const Wanted& wanted,
                                          const evaluation::Progress& progress) const {
  const std::vector<evaluation::PipelineChoice> choices =
      evaluation::choose_pipelines(scenario(), pipelines);
  std::optional<evaluation::Assumptions> certify;
  if (wanted.certify) certify = evaluation::assumptions_of(scenario());
  evaluation::Results results = evaluation::evaluate(
      scenario(), [this, &choices] { return source(choices); },
      {.first_seed = first_seed_,
       .seeds = seeds_,
       .pipelines = pipelines,
       .keep_pulses = wanted.keep_pulses,
       .certify = certify},
      progress);
  if (!streams_) return results;
  for (evaluation::Row& row : results.rows) row.host_sync = "as_recorded";
  results.claims.clear();
  std::ranges::move(streams_->warnings(), std::back_inserter(results.warnings));
  return results;
}

void check_evidence(const std::vector<std::string>& inputs) {
  if (recording_folder_of(inputs)) return;
  throw scenarios::InputError(fmt::format(
      "{}: nothing is certain about how far frames of files are apart; found no messages between "
      "hosts and no polls of the cameras' clocks, allowed: a folder that `simbench record` wrote, "
      "which has both. `simbench diagnose {}` says what is likely",
      fmt::join(inputs, " "), fmt::join(inputs, " ")));
}

bool is_recording_folder(const std::string& path) {
  const std::filesystem::path folder(path);
  return std::filesystem::exists(folder / "manifest.json") &&
         !std::filesystem::exists(folder / "results.json");
}

bool is_recording(const std::string& path) {
  if (is_recording_folder(path)) return true;
  if (std::filesystem::is_directory(path)) {
    return bags::is_bag(path) || !dataset_files(path).empty();
  }
  return std::filesystem::exists(path) && !path.ends_with(".json");
}

RecordedRun recorded_run(const std::vector<std::string>& inputs, const bags::FileOptions& options,
                         const StreamScoring& scoring, const ReadProgress& progress) {
  if (const auto folder = recording_folder_of(inputs)) {
    if (!scoring.stream.empty() || scoring.genlock) {
      throw scenarios::InputError(
          "--stream, --genlock: allowed with files; a recording folder has a scenario, which "
          "states them");
    }
    return RecordedRun(*folder);
  }
  return RecordedRun(inputs, recorded_streams(inputs, options, progress), scoring);
}

std::vector<std::string> capture_notes(const evaluation::Results& results) {
  std::vector<std::string> notes;
  for (const evaluation::Row& row : results.rows) {
    for (const evaluation::SeedScore& seed : row.seeds) {
      for (const std::string& note : seed.cost.notes) {
        notes.push_back(fmt::format("pipeline {}, seed {}: {}", row.pipeline, seed.seed, note));
      }
    }
  }
  return notes;
}

}  // namespace simbench::app
