// The error budgets of pipelines: how much of the error of each comes from each stage.
//
// Each stage between a trigger pulse and a frame set can be replaced by its oracle:
//
//   trigger             every pulse on time at every camera
//   exposure            all exposures equally long and steady
//   stamp quantisation  stamps without noise, arrivals without quantum (the camera's register keeps
//                       its microsecond)
//   device clock        camera oscillators without any error
//   USB delivery        every frame stamped as if it arrived in the middle of its exposure
//   host clock          every host reads the master's clock
//   gathering           sets by the true pulse
//   polls               of the cameras' clocks, answered at once: only of pipelines whose
//                       device_time needs polls
//   granularity         frames have lengths of any nanosecond: only of steered pipelines
//
// What of the scenario each stage is, and what it is where the stage is ideal, says
// scenarios/schema.json (scenarios/ideal.h).
//
// Problem: the error of a pipeline is to be divided among the stages, so that the user sees which
// of them is worth a better cable, clock or algorithm.
//
// Naive attempt: replace one stage by its oracle; what the error falls by is that stage's part.
//
// Why it fails: these parts do not add up to the error. Where two stages spoil the same stamp,
// replacing one of them may gain nothing; where two errors cancel, it makes the error larger; and
// what a stage gains depends on which others were replaced before it.
//
// Key idea: a stage's part is its Shapley value, the reduction of the error when the stage is
// replaced by its oracle, averaged over all orders in which the stages can be replaced, and
// therefore over all 2^n worlds with some of the n ideal, each simulated with the same seeds. The
// parts and the remainder (the error that is left when all stages are ideal) add up to the error,
// exactly for each seed. A part may be negative: two errors can cancel. What a stage gains alone is
// stated beside it (ErrorParts::alone).
//
// Contract: three errors are divided.
//  - amd_ms: over the sets that gathering emits, so that gathering counts; if it emits none in one
//    of the worlds, over the true pulses, where gathering has no part (amd_of_sets tells which);
//  - absolute_error_ms: likewise;
//  - physical_ms: how far apart the exposures of a pulse really were (exposure_spread). No
//    algorithm can remove it, since it is the same in all clocks; AMD contains it.
//
// Streams of random numbers belong to components, so a real stage draws the same numbers whichever
// others are ideal. Lost frames stay lost. A host synchronisation that looks at frames gets their
// real arrivals: its use of them is part of the host clock.
//
// A pipeline with a capture_alignment has a "phase" in place of the trigger, which is ideal where
// all cameras expose at once as far as their granularity lets them (the oracle of
// capture_alignment). What the host clock does to the exposures is in its part of physical_ms.
//
// Cost: 128 scores of the pipeline per seed (twice as many for each of polls and granularity), over
// 32 captures in 16 worlds: gathering and delivery only change what is scored, the host clock only
// the pipeline. Twice as many captures and worlds for each of the two, and where the scenario draws
// errors of its delays' calibration, which an ideal delivery takes away. The cameras' half of a
// world is made once for all pipelines (docs/design.md section 2), and so is the capture of an
// ideal host clock. Memory: on each thread a scorer for every pipeline in four or two sets of
// stages at a time. Source: Shapley, "A value for n-person games", 1953; docs/design.md section 6.
// Each oracle is a definition.
//
//   const std::vector<Budget> budgets =
//       error_budgets(scenario, scenario.pipelines, make_world, {.seeds = 32}, nullptr);
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/budget/shapley.h"
#include "evaluation/run/evaluate.h"
#include "evaluation/scoring/results.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

enum class BudgetStage : std::uint8_t {
  kTrigger,
  kExposure,
  kStampQuantisation,
  kDeviceClock,
  kUsbDelivery,
  kHostClock,
  kGathering,
  kPolls,        // of pipelines whose device_time needs them alone
  kGranularity,  // of pipelines with a capture_alignment alone
};

inline constexpr std::size_t kStageCount = 9;
inline constexpr std::size_t kCommonStages = 7;  // of all pipelines
// As the schema of scenarios names them.
inline constexpr std::array<std::string_view, kStageCount> kStageNames = {
    "trigger",   "exposure", "stamp quantisation", "device clock", "USB delivery", "host clock",
    "gathering", "polls",    "granularity"};

// A set of stages, as the bits of a number below 2^9.
class StageSet {
 public:
  static constexpr std::size_t kSets = std::size_t{1} << kStageCount;

  constexpr StageSet() = default;
  constexpr explicit StageSet(std::size_t bits) : bits_(bits) {}
  constexpr bool has(BudgetStage stage) const { return (bits_ & bit(stage)) != 0; }
  constexpr std::size_t bits() const { return bits_; }
  constexpr StageSet with(BudgetStage stage) const { return StageSet(bits_ | bit(stage)); }
  // Returns the stages that are in both sets.
  constexpr StageSet among(StageSet others) const { return StageSet(bits_ & others.bits_); }

 private:
  static constexpr std::size_t bit(BudgetStage stage) {
    return std::size_t{1} << static_cast<std::size_t>(stage);
  }
  std::size_t bits_ = 0;
};

// Returns the scenario with `pipeline` as its only one and the stages `ideal` replaced, except the
// delivery, which a scenario cannot express.
scenarios::Scenario ideal_scenario(const scenarios::Scenario& scenario,
                                   const scenarios::Pipeline& pipeline, StageSet ideal);

// One error, divided.
struct ErrorParts {
  BudgetPart total;
  std::array<BudgetPart, kStageCount> stages;
  BudgetPart remainder;
  // By how much the error falls if that stage alone is ideal.
  std::array<BudgetPart, kStageCount> alone;
};

struct Budget {
  std::string pipeline;
  bool is_steered = false;  // by a capture_alignment
  bool has_polls = false;
  bool amd_of_sets = true;
  // Why there is none: a real program ended too early in one of the runs. Empty: there is one.
  std::string failed{};
  ErrorParts amd_ms;
  ErrorParts absolute_error_ms;
  ErrorParts physical_ms;
};

// The stages that a budget has, in order, and their names: the trigger of a steered pipeline is the
// "phase" of its alignment.
std::vector<BudgetStage> budget_stages(const Budget& budget);
std::string_view stage_name(const Budget& budget, BudgetStage stage);

// How often a budget of these pipelines scores each at a seed.
std::size_t stage_sets(const scenarios::Scenario& scenario,
                       const std::vector<scenarios::Pipeline>& pipelines);

// Returns a budget for each pipeline, in this order. Ignores EvaluationOptions::pipelines and
// keep_pulses. Throws what evaluate() throws.
std::vector<Budget> error_budgets(const scenarios::Scenario& scenario,
                                  const std::vector<scenarios::Pipeline>& pipelines,
                                  const WorldFactory& make_world, const EvaluationOptions& options,
                                  const Progress& progress);

}  // namespace simbench::evaluation
