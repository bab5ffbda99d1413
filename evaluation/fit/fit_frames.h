// Which frames of a stream a fit uses, and what it leaves out.
//
// Frames come in order of delivery, late ones after their successors. Within a stretch they are put
// in order of their device stamps; then arrivals may go back. A stretch ends where (arrival -
// device stamp) changes for good: a clock was set, stamps slipped by a period, the camera was
// restarted and its clock began again. The step must exceed half a period and kJumpSpreads times
// the usual spread of the delays, by the medians of kStretchS on either side, so that no stall
// shorter than half of that counts. The longest stretch is used: a line through several would rest
// on steps that are known no better than the delays.
//
// Its start is left out: `warm_up` if stated, else 5 s of recordings of 20 s and more, as the
// diagnosis does, or a quarter of shorter ones that have enough frames without it: no test tells
// some frames that come early or late from chance.
//
// Complexity: O(n log n), and O(n) more for each frame that is off by more than such a step.
// Source: docs/reference/users.md section 1; evaluation/diagnosis/diagnose.h.
//
//   const UsableFrames usable = usable_frames(input.streams[0].frames, true, {});
//   print(usable.frames.size(), usable.left_out);
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "algorithms/ports/time.h"
#include "evaluation/frames/frame_account.h"
#include "recording/recorded_streams.h"

namespace simbench::evaluation {

inline constexpr double kStretchS = 5;
inline constexpr double kJumpSpreads = 3;

struct UsableFrames {
  std::vector<StampedFrame> frames;  // device stamps ascend
  // These two count what is left out, too.
  FrameAccount account{};
  double lost_together = 1;
  std::vector<std::string> left_out;  // a line each: what, and where in seconds from the start
};

// `delivered`: unwrapped.
UsableFrames usable_frames(std::span<const StampedFrame> delivered, bool counted,
                           std::optional<Nanoseconds> warm_up);

// How many frames are lost at a time, as a lost frame sees it: the sum of the squared lengths of
// gaps over the sum of the lengths; 1 without any. Losses that are independent are fewer by that.
double lost_together(std::span<const StampedFrame> frames, bool counted);

}  // namespace simbench::evaluation
