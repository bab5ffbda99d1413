#include "app/fit_task.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/recorded_streams.h"
#include "evaluation/fit/fit_check.h"
#include "recording/recording_folder.h"
#include "scenarios/loader.h"

namespace simbench::app {
namespace {

// The recording's own scenario: by name if it is an unchanged built-in one.
evaluation::FitBase own_base(const std::string& folder, const std::string& scenario_json) {
  evaluation::FitBase base{.scenario = scenarios::load_scenario_text(
                               scenario_json, folder + "/manifest.json: scenario")};
  const std::string& name = base.scenario.name;
  for (const scenarios::BuiltinScenario& builtin : scenarios::builtin_scenarios()) {
    if (builtin.name != name) continue;
    if (scenarios::load_scenario(name).resolved_json() != base.scenario.resolved_json()) continue;
    base.stated = name;
  }
  return base;
}

evaluation::FitBase stated_base(const std::string& name) {
  return {.scenario = scenarios::load_scenario(name), .stated = name};
}

std::string captures_text(const std::vector<RecordedCapture>& captures) {
  constexpr std::size_t kShown = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(captures.size(), kShown); ++i) {
    text += fmt::format("{}{} seed {}", i > 0 ? ", " : "", captures[i].pipeline, captures[i].seed);
  }
  return captures.size() > kShown ? text + ", ..." : text;
}

std::size_t chosen_capture(const RecordingFolder& folder, const std::string& path,
                           const FitChoice& choice) {
  const std::vector<RecordedCapture>& captures = folder.captures();
  const auto found =
      std::find_if(captures.begin(), captures.end(), [&](const RecordedCapture& capture) {
        return (choice.pipeline.empty() || capture.pipeline == choice.pipeline) &&
               (!choice.seed || capture.seed == *choice.seed);
      });
  if (found != captures.end()) return static_cast<std::size_t>(found - captures.begin());
  throw evaluation::FitError(captures.empty() ? fmt::format("{}: found no capture", path)
                                              : fmt::format("{}: found no such capture, allowed {}",
                                                            path, captures_text(captures)));
}

FitTask task_of_folder(const std::string& path, const FitChoice& choice) {
  if (choice.one_host) {
    throw evaluation::FitError("--one-host: found with a recording folder, which knows its hosts");
  }
  const RecordingFolder folder(path);
  const std::size_t capture = chosen_capture(folder, path, choice);
  FitTask task;
  task.base = choice.base.empty() ? own_base(path, folder.description().scenario_json)
                                  : stated_base(choice.base);
  evaluation::FitInputSink sink({.hosts = folder.description().hosts,
                                 .cameras = folder.description().cameras,
                                 .warm_up_ms = task.base.scenario.timeline.warm_up_ms});
  folder.play(capture, sink);
  task.input = sink.take();
  const RecordedCapture& chosen = folder.captures()[capture];
  task.capture = fmt::format("{} seed {}{}", chosen.pipeline, chosen.seed,
                             chosen.complete ? "" : ", which has no end");
  return task;
}

FitTask task_of_files(const std::vector<std::string>& inputs, const FitChoice& choice,
                      const bags::FileOptions& options, const ReadProgress& progress) {
  if (!choice.pipeline.empty() || choice.seed) {
    throw evaluation::FitError("--pipeline and --seed choose a capture of a recording folder");
  }
  FitTask task;
  RecordedStreams recorded = recorded_streams(inputs, options, progress);
  task.input = evaluation::fit_input(recorded.streams, choice.one_host);
  task.base = choice.base.empty() ? evaluation::default_base(task.input) : stated_base(choice.base);
  task.notes = std::move(recorded.notes);
  return task;
}

}  // namespace

FitTask fit_task(const std::vector<std::string>& inputs, const FitChoice& choice,
                 const bags::FileOptions& options, const ReadProgress& progress) {
  const std::optional<std::string> folder = recording_folder_of(inputs);
  FitTask task =
      folder ? task_of_folder(*folder, choice) : task_of_files(inputs, choice, options, progress);
  task.base.recording = inputs;
  return task;
}

}  // namespace simbench::app
