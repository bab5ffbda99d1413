// What the bench predicts of real rigs whose truth was measured, beside what was measured.
//
// Problem: a model that agrees with itself and with other models may still be wrong about the
// world.
//
// Naive attempt: choose parameters until the scenario shows the measured figure.
//
// Why it fails: then the figure is in the model, and says nothing of the next rig.
//
// Key idea: a scenario of the same rig takes its parameters from documents alone, and the figure is
// looked at afterwards. The ratio is that of the median of the predictions over the seeds to the
// median of what was measured, whose stretches or devices differ by themselves. What the
// publication does not give spans further predictions. A figure that was known when a mechanism was
// chosen is marked and does not count.
//
// Cost: one clock run for each scenario, pipeline and seed, and one for each other value of what is
// unknown. Errors: those of evaluate_clocks().
//
//   const std::vector<RealityRow> rows = compare_with_reality(
//       scenarios::real_recordings().front(), make_clocks, {.seeds = 5}, nullptr);
//   for (const RealityRow& row : rows) print(row.setting->name, row.ratio());
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/clock_run/clock_evaluation.h"
#include "evaluation/statistics/statistics.h"
#include "scenarios/reality.h"

namespace simbench::evaluation {

struct RealityOptions {
  std::uint64_t seeds = 0;  // 0: as the recording says
  unsigned jobs = 0;
  bool spans_unknown = false;  // also predict with the other values of what is unknown
  const std::atomic<bool>* cancel = nullptr;
};

// The prediction with one unknown parameter at another value.
struct RealitySpan {
  const scenarios::UnknownParameter* parameter = nullptr;
  std::string value;
  double predicted_us = kNan;
};

struct RealityRow {
  const scenarios::RealitySetting* setting = nullptr;
  std::vector<double> predicted_us{};  // by seed
  std::vector<RealitySpan> spans{};

  double measured_us() const;  // the median
  double least_measured_us() const;
  double largest_measured_us() const;
  double median_us() const;  // of the predictions
  double ratio() const { return median_us() / measured_us(); }
  // Whether the ratio is within the factor.
  bool is_within() const;
  bool counts() const { return setting->used_for.empty(); }
};

// The recording must outlive the rows.
std::vector<RealityRow> compare_with_reality(const scenarios::RealRecording& recording,
                                             const ClockWorldFactory& make_world,
                                             const RealityOptions& options,
                                             const Progress& progress);

}  // namespace simbench::evaluation
