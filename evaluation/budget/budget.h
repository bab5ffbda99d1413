// The error budget of a pipeline: which stage its error comes from.
//
// A stage's part is its Shapley value: what replacing the stage by its oracle takes off the error,
// averaged over all orders in which the seven stages can be replaced, and so over all 2^7 worlds
// with some of them ideal, each simulated with the same seeds. The parts and the remainder (the
// error that is left when all stages are ideal) add up to the error, for each seed exactly. A part
// may be negative: two errors can cancel.
//
// Three errors are divided:
//  - amd_ms: over the sets that gathering emits, so that gathering counts; if in some of the worlds
//    it emits none, over the true pulses, where it has no part (amd_of_sets tells which);
//  - absolute_error_ms: likewise;
//  - physical_ms: how far apart the exposures of a pulse really were (exposure_spread). The same in
//    all clocks, so no algorithm can remove it; AMD contains it.
//
// Cost: 128 runs of the pipeline per seed. Source: Shapley, "A value for n-person games", 1953.
//
//   const Budget budget = error_budget(scenario, pipeline, make_world, {.seeds = 32}, nullptr);
@@
// The stages between a trigger pulse and a frame set, and worlds in which some of them are ideal.
//
// Each stage can be replaced by its oracle, alone or together with others:
//
//   trigger             every pulse on time at every camera
//   exposure            all exposures equally long and steady
//   stamp quantisation  stamps without noise, arrivals without quantum (the camera's register keeps
//                       its microsecond)
//   device clock        camera oscillators without any error
//   USB delivery        every frame stamped as if it arrived in the middle of its exposure; polls
//   of
//                       a camera's clock answered at once
//   host clock          every host reads the master's clock
//   gathering           sets by the true pulse
//
// Streams of random numbers belong to components, so a stage that is still real draws the same
// numbers whichever others are ideal. Frames that are lost stay lost. A host synchronisation that
// looks at frames sees them as they really arrive: its use of them is part of the host clock.
// Source: docs/design.md section 6; each oracle as above is a definition.
//
//   const StageSet ideal = StageSet().with(Stage::kHostClock);
//   const Scenario world = ideal_scenario(scenario, pipeline, ideal);
//   auto source = ideal_delivery(make_simulation(world), world, ideal);
#ifndef SIMBENCH_EVALUATION_BUDGET_BUDGET_H_
#define SIMBENCH_EVALUATION_BUDGET_BUDGET_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/run/evaluate.h"
#include "evaluation/scoring/results.h"
#include "recording/recording.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

enum class Stage : std::uint8_t {
  kTrigger,
  kExposure,
  kStampQuantisation,
  kDeviceClock,
  kUsbDelivery,
  kHostClock,
  kGathering,
};

inline constexpr std::size_t kStageCount = 7;
inline constexpr std::array<std::string_view, kStageCount> kStageNames = {
    "trigger",      "exposure",   "stamp quantisation", "device clock",
    "USB delivery", "host clock", "gathering"};

// A set of stages, as the bits of a number below 2^7.
class StageSet {
 public:
  static constexpr std::size_t kSets = std::size_t{1} << kStageCount;

  constexpr StageSet() = default;
  constexpr explicit StageSet(std::size_t bits) : bits_(bits) {}
  constexpr bool has(Stage stage) const { return (bits_ & bit(stage)) != 0; }
  constexpr StageSet with(Stage stage) const { return StageSet(bits_ | bit(stage)); }

 private:
  static constexpr std::size_t bit(Stage stage) {
    return std::size_t{1} << static_cast<std::size_t>(stage);
  }
  std::size_t bits_ = 0;
};

// The scenario with `pipeline` as its only one and the stages `ideal` replaced, but for the
// delivery, which a scenario cannot express.
scenarios::Scenario ideal_scenario(const scenarios::Scenario& scenario,
                                   const scenarios::Pipeline& pipeline, StageSet ideal);

// `source` itself, or with the stamps of an ideal delivery if `ideal` has that. `world` is the
// scenario that the source simulates. record() throws std::runtime_error on a frame without truth.
std::unique_ptr<RecordingSource> ideal_delivery(std::unique_ptr<RecordingSource> source,
                                                const scenarios::Scenario& world, StageSet ideal);

// Means over the seeds, with the band from 5 to 95 %. Means, because they add up.
struct BudgetPart {
  std::vector<double> values;  // by seed
  double mean = 0;
  double p05 = 0;
  double p95 = 0;
};

// One error, divided.
struct ErrorParts {
  BudgetPart total;
  std::array<BudgetPart, kStageCount> stages;
  BudgetPart remainder;
};

struct Budget {
  std::string pipeline;
  bool amd_of_sets = true;
  ErrorParts amd_ms;
  ErrorParts absolute_error_ms;
  ErrorParts physical_ms;
};

// The backend for a world; called from worker threads, the scenario outlives what it returns.
using WorldFactory = std::function<std::unique_ptr<RecordingSource>(const scenarios::Scenario&)>;

// Of options, pipelines and keep_pulses are not used. Throws what evaluate() throws.
Budget error_budget(const scenarios::Scenario& scenario, const scenarios::Pipeline& pipeline,
                    const WorldFactory& make_world, const EvaluationOptions& options,
                    const Progress& progress);

// Shapley values of n players: `worth[s]` belongs to the coalition whose members are the bits of s,
// 2^n values in all; the result says by how much each player lowers it. O(n 2^n).
std::vector<double> shapley_values(std::span<const double> worth);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_BUDGET_BUDGET_H_
