// The control of one camera's frames: what a program may change about when the camera exposes.
//
// A camera without a trigger cable runs free: its sensor begins a frame when the one before has had
// its length. A program moves the exposures by changing lengths, as far as the camera lets it:
//
//  - kAdjustFrame: one frame is longer or shorter, the next ones are as before;
//  - kInsertFrame: one frame of another length, with an exposure as long as that length allows: the
//    picture is brighter or darker;
//  - kFrameLength: all frames from then on have another length;
//  - kStartAt: the camera stops, and its next exposure begins at a time.
//
// Contract
//  - A length is from the begin of one readout to that of the next, as the camera's own oscillator
//    counts. It is rounded to whole multiples of the granularity, and is from `shortest` to
//    `longest`; the exposure has to fit into it. What the camera cannot do is refused with a
//    reason, and changes nothing.
//  - A control takes effect `latency_frames` frames after the one that is in progress when it
//    reaches the camera, or later; no reply tells when. It may be lost. A program that wants to
//    know looks at the stamps that come after.
//  - next_frame() returns each delivered frame once, in order; the last 1024 that came while no
//    coroutine waited are kept. At most one wait on a camera at a time.
//
// Units: nanoseconds, of the camera's own time where lengths are concerned. Cost: a message to the
// camera. Source: docs/reference/capture_alignment.md.
//
//   Task<void> later_by_1_ms(FrameControl& camera) {
//     const FrameControlReply reply = co_await camera.adjust_frame(from_ms(1));
//     if (!reply.is_accepted()) throw std::runtime_error(reply.refused);
//   }
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "algorithms/ports/host.h"
#include "algorithms/ports/time.h"

namespace simbench {

enum class FrameControlKind : std::uint8_t { kAdjustFrame, kInsertFrame, kFrameLength, kStartAt };

inline constexpr std::array<std::string_view, 4> kFrameControlNames = {
    "adjust_frame", "insert_frame", "frame_length", "start_at"};
constexpr std::string_view name_of(FrameControlKind kind) {
  return kFrameControlNames[static_cast<std::size_t>(kind)];
}

struct FrameControlLimits {
  Nanoseconds frame_length{};  // the camera's usual one, of its mode
  Nanoseconds shortest{};
  Nanoseconds longest{};
  Nanoseconds granularity{};  // a line of the sensor, a microsecond, ...
  Nanoseconds exposure{};     // the configured one
  std::uint32_t latency_frames = 0;
  std::array<bool, 4> allowed{};  // by FrameControlKind

  bool allows(FrameControlKind kind) const { return allowed[static_cast<std::size_t>(kind)]; }
  // The nearest length that the camera can make, within its limits.
  Nanoseconds nearest(Nanoseconds length) const {
    const std::int64_t step = granularity.count();
    const std::int64_t low = -floor_div(-shortest.count(), step);
    const std::int64_t high = floor_div(longest.count(), step);
    const std::int64_t steps = floor_div(length.count() + step / 2, step);
    return Nanoseconds(step * (steps < low ? low : steps > high ? high : steps));
  }
};

struct FrameControlReply {
  std::string refused{};  // why, one line; empty: accepted
  Nanoseconds length{};   // that the frame will have (kStartAt: 0)

  bool is_accepted() const { return refused.empty(); }
};

class FrameControl {
 public:
  virtual ~FrameControl() = default;
  // The camera's number on the rig.
  virtual std::uint32_t camera() const = 0;
  virtual const FrameControlLimits& limits() const = 0;
  // The next frame, or nothing once the deadline has passed.
  virtual Task<std::optional<FrameArrival>> next_frame(SteadyTime deadline) = 0;
  // One frame is longer by this, or shorter if it is negative.
  Task<FrameControlReply> adjust_frame(Nanoseconds by) {
    return change(FrameControlKind::kAdjustFrame, by);
  }
  Task<FrameControlReply> insert_frame(Nanoseconds length) {
    return change(FrameControlKind::kInsertFrame, length);
  }
  Task<FrameControlReply> set_frame_length(Nanoseconds length) {
    return change(FrameControlKind::kFrameLength, length);
  }
  // Returns when the camera has begun, or was refused. A time that is past is refused.
  virtual Task<FrameControlReply> start_at(HostTime at) = 0;

 private:
  // Any control but kStartAt.
  virtual Task<FrameControlReply> change(FrameControlKind kind, Nanoseconds length) = 0;
};

// Why the camera refuses a frame of that length, empty if it does not: one home for all that
// implement or ask.
std::string refusal_of(const FrameControlLimits& limits, FrameControlKind kind, Nanoseconds length);
// Why the camera refuses a start at that time, empty if it does not; `now` is by the same clock.
std::string refusal_of_start(const FrameControlLimits& limits, HostTime at, HostTime now);

}  // namespace simbench
