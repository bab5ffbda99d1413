// Watches a camera's streams for what drivers do not report: frames that stopped or were lost.
//
// Pure: takes frames and instants, and reports events to the given handler. One for each camera,
// for all its streams; used by one thread at a time.
//
//  - A stream without a frame for more than max(10 periods, 1 s): kStalled, once; a kNote when
//    frames come again. The first frame may take 4 s, as a camera takes time to start; in a mode
//    that waits for triggers it may take for ever.
//  - A gap of the frame counter (32 bits, it may wrap): a kNote with the loss, then at most one
//    every 10 s with the sum, so that a bus which drops every second frame does not fill a log.
//  - A counter that starts again, and a device clock that leaves the host's by more than a second
//    between two frames, modulo its wrap of 2^32 us: a kNote, at most one every 10 s. Both mean
//    that the camera restarted.
//  - missing_metadata() reports kMissingMetadata once, with how to get it.
//
// Source: docs/reference/d455.md sections 1 and 4.
//
//   StreamWatch watch(settings, /*waits=*/true);
//   watch.start(monotonic_now());
//   watch.on_frame(frame, report);       // every frame
//   watch.check(monotonic_now(), report);  // now and then, at least twice a second
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "hardware/camera/camera.h"

namespace simbench::hardware {

class StreamWatch {
 public:
  // `waits`: the first frame may take for ever (genlock).
  StreamWatch(const CameraSettings& settings, bool waits);

  // The camera was started: forgets the past.
  void start(MonotonicTime now);
  void on_frame(const CameraFrame& frame, const CameraEventHandler& report);
  void check(MonotonicTime now, const CameraEventHandler& report);
  // `what` the frames lack: "SENSOR_TIMESTAMP".
  void missing_metadata(std::string_view what, const CameraEventHandler& report);

  std::uint64_t lost_frames() const { return lost_; }

 private:
  struct Stream {
    bool expected = false;
    Nanoseconds patience{};
    bool seen = false;  // a frame, since start()
    bool stalled = false;
    std::uint32_t counter = 0;
    std::uint32_t stamp_us = 0;
    MonotonicTime last{};
  };

  // At most one every 10 s.
  struct Limit {
    bool used = false;
    MonotonicTime at{};
    bool permits(MonotonicTime now);
  };

  void compare(const Stream& before, const CameraFrame& frame, const CameraEventHandler& report);

  std::array<Stream, 2> streams_;  // by StreamKind
  bool waits_;
  bool reported_metadata_ = false;
  std::uint64_t lost_ = 0;
  Limit losses_;
  Limit restarts_;
};

}  // namespace simbench::hardware
