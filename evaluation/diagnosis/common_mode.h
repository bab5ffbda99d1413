// The periods of cameras whose arrivals were stamped by one clock, compared with each other.
//
// Problem: a host's clock that is slewed moves the arrivals of all its cameras. Each period by
// itself is then as uncertain as the clock; their differences are not. Within windows of time that
// all cameras share, the phases of two cameras are compared, median by median, and a line through
// the differences gives the difference of their periods, with the scatter of the differences as its
// uncertainty.
//
//   const StreamFacts* const cameras[] = {&facts_a, &facts_b};
//   const auto periods = relative_periods(cameras, std::vector<int>{1, 1});
//
// Errors: nothing for fewer than two cameras, phases that step, or less than half of the longest
// recording in common. Complexity: O(n log n) in the frames.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "evaluation/diagnosis/stream_facts.h"

namespace simbench::evaluation {

// `multiples`: of the common period, of each camera. Returns periods divided by these; the first
// camera's is its own period by its host's clock, and has no uncertainty.
std::optional<std::vector<PeriodEstimate>> relative_periods(
    std::span<const StreamFacts* const> cameras, std::span<const int> multiples);

}  // namespace simbench::evaluation
