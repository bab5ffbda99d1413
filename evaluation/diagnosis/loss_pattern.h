// Where the missing frames of a stream are: at its start, at even distances, or anywhere. It tells
// what to look for: a camera that settles, a task that runs every so often, or a link.
//
//   const LossPlaces places = loss_places(recorded.streams[0].frames, gaps);
//
// Complexity: O(n log n).
#pragma once

#include <cstdint>
#include <span>

#include "evaluation/frames/frame_account.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {

enum class LossPattern : std::uint8_t { kNone, kAtStart, kPeriodic, kRandom };

struct LossPlaces {
  LossPattern pattern = LossPattern::kNone;
  double every_s = kNan;    // of a periodic one
  std::int64_t places = 0;  // gaps with missing frames
};

// `gaps`: of these frames (frame_gaps()).
LossPlaces loss_places(std::span<const StampedFrame> frames, std::span<const FrameGap> gaps);

}  // namespace simbench::evaluation
