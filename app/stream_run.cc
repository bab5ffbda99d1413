#include "app/stream_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "algorithms/registry.h"
#include "evaluation/frames/camera_statistics.h"
#include "evaluation/run/pipeline_choice.h"
#include "recording/counted.h"
#include "recording/text_fields.h"
#include "reports/archive/archive.h"
#include "scenarios/document.h"
#include "scenarios/loader.h"

namespace simbench::app {
namespace {

using scenarios::InputError;
using scenarios::Pipeline;
using scenarios::Scenario;

constexpr const char* kUsualGathering = "yoon2021";
// A host_sync that does nothing stands for the one that ran while the files were recorded.
constexpr const char* kNoHostSync = "free_running";

class OfTheCommandLine final : public scenarios::Origin {
 public:
  std::string describe(const std::string& /*pointer*/) const override { return "--pipelines"; }
};

std::vector<std::string> kinds_of(const std::vector<RecordedStream>& streams) {
  std::vector<std::string> kinds;
  for (const RecordedStream& stream : streams) {
    if (std::ranges::find(kinds, stream.stream) == kinds.end()) kinds.push_back(stream.stream);
  }
  return kinds;
}

// The kind that the most cameras have; of equal ones the first.
std::string chosen_kind(const std::vector<RecordedStream>& streams, const std::string& wanted) {
  const std::vector<std::string> kinds = kinds_of(streams);
  const auto cameras = [&streams](const std::string& kind) {
    return std::ranges::count(streams, kind, &RecordedStream::stream);
  };
  if (kinds.empty()) throw InputError("found no stream of a camera, allowed one or more");
  if (wanted.empty()) return *std::ranges::max_element(kinds, {}, cameras);
  if (std::ranges::find(kinds, wanted) != kinds.end()) return wanted;
  throw InputError(fmt::format("--stream: found '{}', allowed {}", scenarios::shown_text(wanted),
                               fmt::join(kinds, ", ")));
}

Pipeline pipeline_named(const std::string& name) {
  const std::size_t plus = name.find('+');
  Pipeline pipeline{.name = name,
                    .host_sync = kNoHostSync,
                    .device_time = name.substr(0, plus),
                    .gathering = kUsualGathering};
  if (plus == std::string::npos) return pipeline;
  pipeline.gathering = name.substr(plus + 1);
  if (pipeline.gathering.find('+') == std::string::npos) return pipeline;
  throw InputError(fmt::format(
      "--pipelines {}: found more than two parts, allowed of files: device_time[+gathering], since "
      "host_sync had its effect when they were recorded",
      scenarios::shown_text(name)));
}

std::vector<Pipeline> pipelines_of(const std::vector<std::string>& names) {
  std::vector<Pipeline> pipelines;
  pipelines.reserve(names.size());
  for (const std::string& name : names) pipelines.push_back(pipeline_named(name));
  if (!names.empty()) return pipelines;
  for (const std::string& name : device_times_of_stamps()) {
    pipelines.push_back(pipeline_named(name));
  }
  return pipelines;
}

std::string recording_name(const std::vector<std::string>& inputs) {
  std::string name = printable_name(inputs.front());
  if (inputs.size() > 1) name += fmt::format(" and {} more", inputs.size() - 1);
  return name;
}

nlohmann::ordered_json recording_json(const evaluation::StreamSource& source,
                                      const std::vector<std::string>& inputs,
                                      const std::string& kind, bool genlock) {
  nlohmann::ordered_json cameras = nlohmann::ordered_json::array();
  for (std::size_t camera = 0; camera < source.streams().size(); ++camera) {
    cameras.push_back({{"camera", printable_name(source.streams()[camera]->camera)},
                       {"host", printable_name(source.hosts()[source.host_of(camera)])},
                       {"frames", source.streams()[camera]->frames.size()}});
  }
  nlohmann::ordered_json paths = nlohmann::ordered_json::array();
  for (const std::string& path : inputs) paths.push_back(printable_name(path));
  return {{"files", paths},
          {"stream", printable_name(kind)},
          {"genlock", genlock},
          {"cameras", cameras}};
}

std::string json_of(const Scenario& scenario, const nlohmann::ordered_json& recording) {
  nlohmann::ordered_json root = {{"name", scenario.name},
                                 {"summary", scenario.summary},
                                 {reports::kRecordingMember, recording},
                                 {"pipelines", nlohmann::ordered_json::array()}};
  for (const Pipeline& pipeline : scenario.pipelines) {
    root["pipelines"].push_back({{"name", pipeline.name},
                                 {"device_time", pipeline.device_time},
                                 {"gathering", pipeline.gathering}});
  }
  return root.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

// Polls, stamps of hosts and a clock of LEDs are the recording's to lack, which the row of a
// pipeline says that needs them (app/recordings.h): the scenario allows all.
void allow_all_needs(Scenario& scenario) {
  scenario.cameras.clock_poll.interval_ms = 1;
  scenario.cameras.stamp_clock = scenarios::ClockOwner::kHost;
  scenario.cameras.led_clock.emplace();
}

Scenario stream_scenario(const evaluation::StreamSource& source,
                         const std::vector<std::string>& inputs, const std::string& kind,
                         const StreamScoring& scoring) {
  Scenario scenario;
  const auto cameras = static_cast<std::int64_t>(source.streams().size());
  scenario.name = recording_name(inputs);
  scenario.hosts.count = static_cast<std::int64_t>(source.hosts().size());
  scenario.cameras.count = cameras;
  for (std::size_t camera = 0; camera < source.streams().size(); ++camera) {
    scenario.cameras.host_of_camera.push_back(source.host_of(camera));
  }
  scenario.cameras.sync_mode =
      scoring.genlock ? scenarios::SyncMode::kGenlock : scenarios::SyncMode::kDefault;
  scenario.trigger.rate_hz =
      source.period() ? 1e9 / static_cast<double>(source.period()->count()) : 1;
  scenario.evaluation.gathering_interval_periods = 0.5;  // the paper's
  scenario.pipelines = pipelines_of(scoring.pipelines);
  scenario.summary = fmt::format(
      "{} of {} on {}, at {:.3f} Hz by their own clocks, from files. {}. host_sync cannot be run "
      "again.",
      printable_name(kind), counted(source.streams().size(), "camera"),
      counted(source.hosts().size(), "host"), scenario.trigger.rate_hz,
      scoring.genlock ? "GenLock order tells which frames belong together"
                      : "Which frames belong together is not known");
  scenario.resolved_json = scenarios::Lazy<std::string>(
      json_of(scenario, recording_json(source, inputs, kind, scoring.genlock)));
  scenario.origin = std::make_shared<OfTheCommandLine>();
  allow_all_needs(scenario);
  return scenario;
}

}  // namespace

StreamRun::StreamRun(RecordedStreams recorded, const std::vector<std::string>& inputs,
                     const StreamScoring& scoring)
    : recorded_(std::move(recorded)),
      kind_(chosen_kind(recorded_.streams, scoring.stream)),
      genlock_(scoring.genlock),
      scenario_(stream_scenario(*source(), inputs, kind_, scoring)) {}

std::unique_ptr<evaluation::StreamSource> StreamRun::source() const {
  return std::make_unique<evaluation::StreamSource>(recorded_.streams, kind_, genlock_);
}

std::vector<std::string> StreamRun::notes() const {
  std::vector<std::string> others = kinds_of(recorded_.streams);
  std::erase(others, kind_);
  if (others.empty()) return {};
  return {fmt::format("{} is scored; --stream chooses {}", kind_, fmt::join(others, " or "))};
}

std::vector<std::string> StreamRun::warnings() const {
  std::vector<std::string> warnings;
  for (const RecordedStream& stream : recorded_.streams) {
    if (stream.stream != kind_) continue;
    std::ranges::move(evaluation::doubts_of(stream), std::back_inserter(warnings));
  }
  const auto by_order = [](const Pipeline& pipeline) { return pipeline.gathering == "genlock"; };
  if (!genlock_ && std::ranges::none_of(scenario_.pipelines, by_order)) return warnings;
  const std::unique_ptr<evaluation::StreamSource> played = source();
  if (played->period() && played->first_arrival_range() >= *played->period() / 2) {
    warnings.push_back(kind_ +
                       ": the cameras' first frames lie half a period or more apart: without a "
                       "common start, AMD and RMDV by GenLock order are meaningless");
  }
  return warnings;
}

std::vector<evaluation::StampedStream> stamped_streams(const std::vector<RecordedStream>& streams,
                                                       const std::vector<std::string>& device_times,
                                                       const std::string& option) {
  const std::vector<std::string> known = device_times_of_stamps();
  for (const std::string& name : device_times) {
    if (std::ranges::find(known, name) != known.end()) continue;
    throw InputError(fmt::format("{}: found '{}', allowed: {}", option, scenarios::shown_text(name),
                                 fmt::join(known, ", ")));
  }
  std::vector<evaluation::StampedStream> all;
  for (const std::string& kind : kinds_of(streams)) {
    evaluation::StreamSource source(streams, kind, /*genlock=*/false);
    if (!source.period()) continue;
    const Scenario scenario = stream_scenario(source, {kind}, kind, {.pipelines = device_times});
    for (const evaluation::PipelineChoice& choice : evaluation::choose_pipelines(scenario, {})) {
      evaluation::GatheredSets found = evaluation::gathered_sets(scenario, choice, source);
      for (std::size_t camera = 0; camera < found.stamps.size(); ++camera) {
        all.push_back({.stream = source.streams()[camera],
                       .device_time = choice.pipeline.device_time,
                       .relative = choice.device_time.make()->relative(),
                       .stamps = std::move(found.stamps[camera])});
      }
    }
  }
  std::ranges::stable_sort(all, {}, &evaluation::StampedStream::stream);
  return all;
}

std::vector<std::string> device_times_of_stamps() {
  std::vector<std::string> names;
  for (const DeviceTimeEntry& entry : algorithms<DeviceTimeEntry>()) {
    const bool needs_more = std::ranges::any_of(entry.info.needs, [](Need need) {
      return need == Need::kPolls || need == Need::kHostStamps || need == Need::kLedClock ||
             need == Need::kTriggerCode || need == Need::kTruth;
    });
    if (entry.make && !needs_more) names.push_back(entry.info.name);
  }
  return names;
}

}  // namespace simbench::app
