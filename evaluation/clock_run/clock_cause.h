// What a cause of the clocks' errors is; clock_causes.h finds them.
//
//   const ClockCause step{.what = "the step of a clock", .spread_from_ms = 1, .spread_to_ms = 0.1};
//   step.effect();  // 0.9
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/statistics/statistics.h"
#include "scenarios/loader.h"

namespace simbench::evaluation {

struct ClockCause {
  std::string what;                         // "the steps of a clock"
  std::vector<scenarios::Override> sets{};  // what takes it away
  // Means over the seeds, with and without it.
  double spread_from_ms = kNan;
  double spread_to_ms = kNan;
  double largest_from_ms = kNan;
  double largest_to_ms = kNan;

  // How much smaller each is without the cause, as a share, and the larger of the two.
  double spread_effect() const { return saved_share(spread_from_ms, spread_to_ms); }
  double largest_effect() const { return saved_share(largest_from_ms, largest_to_ms); }
  double effect() const { return std::max(spread_effect(), largest_effect()); }

  static double saved_share(double from_ms, double to_ms) {
    return from_ms > 0 ? 1 - to_ms / from_ms : 0;
  }
};

struct ClockCauses {
  std::uint64_t seeds = 0;           // of which values are the means
  std::vector<std::string> tried{};  // empty: nothing was asked
  std::vector<ClockCause> found{};   // the one with the largest effect first
  // Causes that this world does not let one take away: "the time between ...: found 0.1, allowed
  // ...".
  std::vector<std::string> refused{};
};

}  // namespace simbench::evaluation
