// The lengths of a steered camera's frames, in the simulated and in the real world: what a control
// asks for, and what the controls that have reached the camera make of each frame.
//
// FrameRequests is the sender's side: whether a control is refused, and the length that its frame
// will have. FrameLengths is the camera's: frames have a usual length until a control counts.
//
//   kAdjustFrame, kInsertFrame   the frame has another length, the next ones the usual one; after
//                                an inserted one so many have its length as `insert_stretches` says
//   kFrameLength                 the usual length from that frame on
//
// The picture after an inserted length is exposed for that length less a granule.
//
// A frame has a number, and lasts from the begin of its readout to that of the next. Which frame a
// control counts from, the camera decides. kStartAt changes no length.
//
// Contract: lengths are whole granules within the limits. Frames before forget_before() are not
// asked for any more. Complexity: O(log n) of the n controls that are not forgotten.
// Source: docs/reference/capture_alignment.md.
//
//   FrameControlLimits limits;
//   limits.frame_length = limits.longest = from_ms(33);
//   limits.granularity = Nanoseconds(1);
//   clocks::FrameLengths lengths(limits);
//   const auto kind = FrameControlKind::kAdjustFrame;
//   lengths.set(kind, lengths.wanted(kind, from_ms(-2), 7), 7);
//   const Nanoseconds made = lengths.of(7);  // 31 ms
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "algorithms/ports/frame_control.h"

namespace simbench::clocks {

class FrameRequests {
 public:
  explicit FrameRequests(const FrameControlLimits& limits)
      : limits_(limits), usual_(limits.nearest(limits.frame_length)) {}

  const FrameControlLimits& limits() const { return limits_; }
  // The reply to a control with this length, or with by how much the frame is longer
  // (kAdjustFrame). An accepted kFrameLength is the usual length from then on.
  FrameControlReply reply(FrameControlKind kind, Nanoseconds value);

 private:
  FrameControlLimits limits_;
  Nanoseconds usual_;
};

class FrameLengths {
 public:
  explicit FrameLengths(const FrameControlLimits& limits, std::int64_t insert_stretches = 1);

  // The length of that frame, if the exposure fits into it.
  Nanoseconds of(std::int64_t frame) const;
  // The exposure of that frame's picture, if a control changed it.
  std::optional<Nanoseconds> exposure(std::int64_t frame) const;

  // The length that a control of this value asks for if it counts from that frame.
  Nanoseconds wanted(FrameControlKind kind, Nanoseconds value, std::int64_t frame) const;
  // From that frame on the control counts.
  void set(FrameControlKind kind, Nanoseconds wanted, std::int64_t frame);
  // That frame alone is longer, and need not be whole granules.
  void lengthen(std::int64_t frame, Nanoseconds by) { single_[frame] = of(frame) + by; }
  void forget_before(std::int64_t frame);

 private:
  Nanoseconds usual(std::int64_t frame) const;

  FrameControlLimits limits_;
  std::int64_t insert_stretches_;
  std::map<std::int64_t, Nanoseconds> usual_;      // from that frame on
  std::map<std::int64_t, Nanoseconds> single_;     // of single frames
  std::map<std::int64_t, Nanoseconds> exposures_;  // that controls changed
};

}  // namespace simbench::clocks
