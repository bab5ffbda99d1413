// The real-network experiment as a backend: one record() is one repetition with fresh processes.
//
// Each request: the cameras' capture of the request's seed is simulated and written as a recording,
// a rig of processes is made that plays it (hardware/experiment), with clocks that start wrong by
// amounts drawn for the seed, the conductor runs a session of the request's pipeline on it, and
// the capture is told to the sink with its truth (app/experiment_truth.h). So every pipeline
// meets the same exposures and the same clocks for the same seed, and the machine's real sockets,
// schedulers and timers between them.
//
// Errors: RecordingFailed for a repetition that went wrong; others may succeed.
//
//   ExperimentSource source(scenario, {.namespaces = !NetworkSandbox::enter()});
//   source.record({.seed = 1, .pipeline = "yoon2021_both", .host_sync = sync.get()}, scorer);
#ifndef SIMBENCH_APP_EXPERIMENT_SOURCE_H_
#define SIMBENCH_APP_EXPERIMENT_SOURCE_H_

#include <functional>
#include <string>
#include <vector>

#include "hardware/experiment/temporary_folder.h"
#include "recording/event.h"
#include "recording/recording.h"
#include "scenarios/scenario.h"

namespace simbench::app {

struct ExperimentOptions {
  bool namespaces = false;                             // the caller is in a NetworkSandbox
  std::function<void(const std::string&)> progress{};  // a line for each step; may be empty
  std::function<bool()> cancelled{};                   // may be empty
  // Told the relay's after each repetition, a line of JSON (hardware/relay/relay.h); may be empty.
  std::function<void(const std::string&)> relay_statistics{};
  std::string program = "/proc/self/exe";  // simbench
};

class ExperimentSource final : public RecordingSource {
 public:
  // `scenario` outlives this. Throws scenarios::InputError for what a relay cannot imitate.
  ExperimentSource(const scenarios::Scenario& scenario, ExperimentOptions options);

  RecordingCost record(const RecordingRequest& request, RecordingSink& sink) override;

 private:
  // Of the seed, in played_ and in a folder; returns its name as a rig file has it.
  std::string record_cameras(std::uint64_t seed);

  const scenarios::Scenario& scenario_;
  ExperimentOptions options_;
  hardware::TemporaryFolder folder_;
  KeptRecording played_;
};

}  // namespace simbench::app

#endif  // SIMBENCH_APP_EXPERIMENT_SOURCE_H_
