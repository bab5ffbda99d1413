// Where a camera changes its frame rate.
//
// Two ways: at once, by more than kCoarseShare, as automatic exposure does in the dark (the middle
// interval of kRateFrames frames is another for twice as many frames, and nearly all of them have
// it); and by kFineShare at least, from one level to another that each hold for two eighths of the
// recording, far beyond what the eighths scatter. A phase that moves at once is no change of rate
// (PhaseStep).
//
//   const std::vector<RateChange> changes = rate_changes(recorded.streams[0].frames, grid);
//
// Complexity: O(n log n).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "evaluation/frames/stamp_grid.h"
#include "recording/recorded_streams.h"

namespace simbench::evaluation {

inline constexpr double kCoarseShare = 0.02;
inline constexpr double kFineShare = 300e-6;
inline constexpr std::size_t kRateFrames = 15;

// From here on frames came at another rate.
struct RateChange {
  double at_s = 0;  // after the first arrival
  double from_hz = 0;
  double to_hz = 0;
};

// Frames with unwrapped stamps, and their grid.
std::vector<RateChange> rate_changes(std::span<const StampedFrame> frames, const StampGrid& grid);

}  // namespace simbench::evaluation
