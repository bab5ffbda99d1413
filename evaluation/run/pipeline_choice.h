// The pipelines of a scenario with the registered algorithms that they name.
//
// An algorithm's parameters come from the scenario's /algorithms/<its name> or else
// /algorithms/<its family>; several algorithms may share a family, and each takes what it declares.
// Refused are a parameter that no algorithm of that name declares, parameters that contradict each
// other, and an algorithm that needs what the scenario's world lacks (AlgorithmInfo::needs). The
// name of a device_time may have the suffixes of its variants (algorithms/device_time/variants.h).
//
// Programs in place of a host_sync are the application's (set_program_maker): evaluation knows no
// simulator. Those that cannot run here refuse nothing: their pipeline has no captures, and says
// why.
//
//   for (const PipelineChoice& choice : choose_pipelines(scenario, {"yoon2021_both"})) {
//     PipelineScorer scorer(scorer_setup(scenario, choice));
//     const SeedScore score = score_run(source, choice, /*seed=*/1, scorer, scorer);
//   }
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "algorithms/device_time/variants.h"
#include "algorithms/registry.h"
#include "evaluation/scoring/pipeline_scorer.h"
#include "recording/recording.h"
#include "scenarios/lazy.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

// An algorithm with its checked parameters.
template <class Entry>
struct ChosenAlgorithm {
  Entry entry;
  Parameters parameters;

  const AlgorithmInfo& info() const { return entry.info; }
  // Not of the oracle of device_time, which is none.
  bool can_be_made() const { return static_cast<bool>(entry.make); }
  auto make() const { return entry.make(parameters); }
  auto make(const GatheringSetup& setup) const { return entry.make(parameters, setup); }
  // Whether it runs as another choice does.
  bool is_same(const ChosenAlgorithm& other) const {
    return info().name == other.info().name && parameters.all() == other.parameters.all();
  }
};

struct PipelineChoice {
  scenarios::Pipeline pipeline;
  ChosenAlgorithm<HostSyncEntry> host_sync;
  ChosenAlgorithm<CaptureAlignmentEntry> capture_alignment;  // without a name: none
  ChosenAlgorithm<DeviceTimeEntry> device_time;              // of the base name
  DeviceTimeName device_time_variants;                       // the suffixes in the pipeline's name
  ChosenAlgorithm<GatheringEntry> gathering;
  bool scores_offline = false;  // SeedScore::offline_amd_ms, for claim C7
  std::string problem{};        // why its programs cannot run, one line
  // What the stages after host_sync see in place of the capture: passes a changed one on to `sink`.
  // Empty: all as it is.
  std::function<std::unique_ptr<RecordingSink>(RecordingSink& sink)> view{};
  // The scenario that states how it is scored, where that is not the capture's: one that differs in
  // scoring alone (is_scoring_alone() in capture_groups.h). Null: the capture's.
  std::shared_ptr<const scenarios::Scenario> scored_in{};
  // What a user of the scenario knows, for a device_time that subtracts it, of each group of
  // cameras (scenarios/camera_groups.h). Shared by all pipelines.
  scenarios::Lazy<std::vector<CalibratedDelays>> delays{};

  // Whether no trigger reaches the cameras.
  bool is_steered() const { return !pipeline.capture_alignment.empty(); }
};

// The host synchronisation that a pipeline's programs are, and why they cannot run here, one line;
// empty if they can.
struct ProgramEntry {
  HostSyncEntry entry;
  std::string problem{};
};
using ProgramMaker =
    std::function<ProgramEntry(const scenarios::Scenario&, const scenarios::Pipeline&)>;

// From now on; not thread-safe: before running anything. Without it pipelines with programs are
// refused.
void set_program_maker(ProgramMaker maker);

// Returns the named pipelines in the given order; all of the scenario if `names` is empty. Throws
// scenarios::InputError for an unknown pipeline or algorithm (naming the known ones), a pipeline
// named twice, a parameter that is not declared or not allowed, or a published figure of a metric
// that there is not, that is no series or cannot have that value.
std::vector<PipelineChoice> choose_pipelines(const scenarios::Scenario& scenario,
                                             const std::vector<std::string>& names);

// What is known of the scenario's trigger for those that find a frame's pulse by its code; null
// without /trigger/code.
std::shared_ptr<const CodedPulses> coded_pulses(const scenarios::Scenario& scenario);

// Returns the scenario that states how the pipeline is scored in captures of `scenario`.
const scenarios::Scenario& scoring_scenario(const scenarios::Scenario& scenario,
                                            const PipelineChoice& choice);

// Returns the scorer's setup for the pipeline. It has the second, offline estimator, which keeps
// all frames, where claim C7 needs it, in captures of at most 200,000 evaluated frames.
ScorerSetup scorer_setup(const scenarios::Scenario& scenario, const PipelineChoice& choice);

// Records one capture of the pipeline, with a host_sync of its own. `observer` may be null. Throws
// RecordingFailed for a choice with a problem.
RecordingCost record_run(RecordingSource& source, const PipelineChoice& choice, std::uint64_t seed,
                         RecordingSink& sink, WorldObserver* observer = nullptr,
                         const ShareDone& share_done = {});

// The score of a capture that has gone to the scorer, which has no values if a program ended too
// early in it (scoring/program_failures.h); call once.
SeedScore captured_score(PipelineScorer& scorer, RecordingCost cost, std::uint64_t seed);

// Records one and returns its score. `sink` passes the capture on to the scorer, or is the scorer.
SeedScore score_run(RecordingSource& source, const PipelineChoice& choice, std::uint64_t seed,
                    PipelineScorer& scorer, RecordingSink& sink, WorldObserver* observer = nullptr);

}  // namespace simbench::evaluation
