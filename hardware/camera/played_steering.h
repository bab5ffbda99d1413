// How far the frames of a played camera are moved by the controls of its frames.
//
// A recorded camera ran free, so each of its frames lasted for the usual length. Where a control
// has made a frame longer or shorter (clocks/frame_lengths.h), all later ones are due so much later
// or earlier; these differences add up. A frame that is missing in the recording, by the counters,
// had its length too.
//
// The frame that is in progress is the last one that was passed: a control counts from the frame
// `latency_frames` after it, one at least, as the next exposure may have begun. With a latency
// of 2, the third frame to come is the first that moves.
//
// Pure. Lengths are taken for times of the host: the camera's oscillator, some tens of ppm off,
// would move 10 ms by less than a microsecond.
// Complexity: O(log n) a call of the n controls that have yet to count.
//
//   FrameControlLimits limits;
//   limits.granularity = Nanoseconds(1);
//   PlayedSteering steering({.limits = limits});
//   steering.pass(7);
//   steering.control(FrameControlKind::kAdjustFrame, from_ms(2));
//   const Nanoseconds moved = steering.shift(8);
#pragma once

#include <cstdint>
#include <optional>

#include "algorithms/ports/frame_control.h"
#include "clocks/frame_lengths.h"
#include "hardware/camera/camera.h"

namespace simbench::hardware {

class PlayedSteering {
 public:
  explicit PlayedSteering(const FrameSteering& settings);

  // Frames are named by their counters, of 32 bits: by how much the next frame is later than it was
  // recorded, if it has this one.
  Nanoseconds shift(std::uint32_t counter) const;
  // Its exposure, if a control changed it.
  std::optional<Nanoseconds> exposure(std::uint32_t counter) const;
  // The frame was delivered.
  void pass(std::uint32_t counter);

  // `value`: a length, or by how much a frame is longer (kAdjustFrame).
  FrameControlReply control(FrameControlKind kind, Nanoseconds value);
  // The next frame, of this counter, is later by `shift`, and those after it follow (kStartAt).
  FrameControlReply restart(std::uint32_t counter, Nanoseconds shift);

 private:
  std::int64_t number_of(std::uint32_t counter) const;

  clocks::FrameRequests requests_;
  clocks::FrameLengths lengths_;
  Nanoseconds usual_;
  Nanoseconds shift_{};      // of the frame that was passed last
  std::int64_t frame_ = -1;  // that frame; the first is 0
  std::optional<std::uint32_t> counter_;
};

}  // namespace simbench::hardware
