#include "app/experiment_source.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "app/experiment_truth.h"
#include "hardware/conductor/rig_source.h"
#include "hardware/experiment/experiment_rig.h"
#include "hardware/experiment/network_sandbox.h"
#include "hardware/relay/network_law.h"
#include "recording/recording_folder.h"
#include "sim/rig/simulation.h"

namespace simbench::app {
namespace {

constexpr const char* kPlayed = "played";

std::vector<hardware::NodeOscillator> oscillators_of(const hardware::RigSource& source) {
  std::vector<hardware::NodeOscillator> oscillators;
  for (const hardware::HostReport& host : source.hosts()) {
    if (host.lost) throw RecordingFailed(host.name + " was lost");
    oscillators.push_back(host.oscillator);
  }
  return oscillators;
}

}  // namespace

ExperimentSource::ExperimentSource(const scenarios::Scenario& scenario, ExperimentOptions options)
    : scenario_(scenario), options_(std::move(options)) {
  hardware::check_relay_can(scenario);
}

std::string ExperimentSource::record_cameras(std::uint64_t seed) {
  const std::string folder = folder_.file(fmt::format("seed{}", seed));
  const RecordingRequest request = {.seed = seed, .pipeline = kPlayed};
  sim::make_simulation(scenario_)->record(request, played_);
  if (!std::filesystem::exists(folder)) {
    RecordingWriter writer(folder, {.backend = "sim", .scenario_json = scenario_.resolved_json});
    played_.play(writer.begin(kPlayed, seed));
    writer.end({});
  }
  return fmt::format("{}#{}/{}", folder, kPlayed, seed);
}

RecordingCost ExperimentSource::record(const RecordingRequest& request, RecordingSink& sink) {
  try {
    const std::string recording = record_cameras(request.seed);
    hardware::ExperimentRig rig({.scenario = &scenario_,
                                 .recording = recording,
                                 .clocks = hardware::draw_clock_starts(scenario_, request.seed),
                                 .seed = request.seed,
                                 .namespaces = options_.namespaces,
                                 .program = options_.program});
    hardware::RigSource source(rig.conductor(), rig.key(), scenario_,
                               {.progress = options_.progress,
                                .prompt = {},
                                .cancelled = options_.cancelled,
                                .collect_session = {}});
    KeptRecording captured;
    RecordingCost cost = source.record(request, captured);
    const std::optional<MonotonicTime> zero = rig.trigger_zero();
    if (!zero) throw RecordingFailed("the trigger was never switched on");
    const ExperimentTruth truth = {
        .played = played_, .zero = *zero, .oscillators = oscillators_of(source)};
    add_truth(truth, captured, sink);
    if (options_.relay_statistics) options_.relay_statistics(rig.end_relay());
    return cost;
  } catch (const hardware::ChildError& error) {
    throw RecordingFailed(error.what());
  } catch (const hardware::SandboxError& error) {
    throw RecordingFailed(error.what());
  }
}

}  // namespace simbench::app
