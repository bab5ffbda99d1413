// What became of the frames of a stream: delivered, lost, never exposed, unknown.
//
// A camera counts the frames that it exposes, so a gap of its counter is frames that were lost
// after the camera had counted them. An empty point of its grid (stamp_grid.h) that the counter did
// not count was never exposed. Where the counter starts again or jumps further than the time
// allows, nothing tells what became of the periods between two frames: they are unknown, as are all
// missing periods of a stream without a counter.
//
// The account covers the whole stream, from its first frame to its last. What the camera exposed
// before or after that leaves no trace.
//
//   const FrameAccount account = frame_account(recorded.streams[0]);
//   print(account.delivered, account.lost);
//
// Complexity: O(n). Source: docs/reference/d455.md section 1.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "evaluation/frames/stamp_grid.h"
#include "recording/recorded_streams.h"

namespace simbench::evaluation {

struct FrameAccount {
  std::int64_t delivered = 0;
  std::int64_t lost = 0;           // counted by the camera, but never arrived
  std::int64_t never_exposed = 0;  // periods that the counter did not count
  std::int64_t unknown = 0;        // missing periods of which the counter tells nothing
  // Why periods are unknown.
  std::int64_t counter_restarts = 0;  // the counter stood still or went back
  std::int64_t counter_jumps = 0;     // it went up by more frames than fit into the time
  std::uint64_t largest_jump = 0;     // of the counter
};

// What lies between two successive frames of a stream.
struct FrameGap {
  std::int64_t lost = 0;
  std::int64_t never_exposed = 0;
  std::int64_t unknown = 0;
  bool counter_restarts = false;
  std::uint64_t counter_jump = 0;  // 0: none
};

// Frames in order of delivery, with stamps that are unwrapped (camera_statistics.h). `counted`:
// RecordedStream::counted.
FrameAccount frame_account(std::span<const StampedFrame> frames, bool counted);
// Unwraps the stamps of a stream as recorded, then accounts for its frames.
FrameAccount frame_account(const RecordedStream& stream);

// Gap i lies between frame i and frame i + 1.
std::vector<FrameGap> frame_gaps(std::span<const StampedFrame> frames, bool counted);

// On a grid that is known (of exactly these frames), as where other cameras tell it.
FrameAccount frame_account(std::span<const StampedFrame> frames, bool counted,
                           const StampGrid& grid);
std::vector<FrameGap> frame_gaps(std::span<const StampedFrame> frames, bool counted,
                                 const StampGrid& grid);

}  // namespace simbench::evaluation
