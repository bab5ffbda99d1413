// Stage 3, gathering: which frames belong together?
//
// A gatherer gets the frames of n sources (a source is one stream of one camera) in order of
// arrival and emits sets of frames exposed at the same instant, one frame per source. It never
// reorders a source's frames and uses each at most once; it counts the frames that it discards.
//
// Where a scenario states /evaluation/gathering_queue_frames (`queue_limit`), at most so many
// frames wait per source, and an overflow drops the oldest; else each policy has the queue of the
// program that it models (gatherers.h).
//
//   auto gatherer = make_yoon2021_gatherer({.sources = 18, .period = ..., .interval = ...});
//   gatherer->push({.source = 3, .stamp = stamp, .tag = frame_index}, set_sink);
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "algorithms/ports/time.h"

namespace simbench {

struct GatherFrame {
  std::uint32_t source = 0;
  GlobalTime stamp{};
  GlobalTime arrival{};  // when its host had it, on the global scale
  DeviceTime sensor{};   // unwrapped, for gatherers that order by device time
  std::int64_t tag = 0;  // the caller's name for the frame; carried, not interpreted
};

class FrameSetSink {
 public:
  virtual ~FrameSetSink() = default;
  // One frame per source, in order of source. The span is valid during the call only.
  virtual void on_set(std::span<const GatherFrame> set) = 0;
  // A set that lacks some sources, from policies that emit such; in order of source.
  virtual void on_partial_set(std::span<const GatherFrame> /*set*/) {}
};

// A sink that knows the time: the arrival of the frame whose push is under way.
class TimedSetSink : public FrameSetSink {
 public:
  void advance_to(GlobalTime now) { now_ = now; }
  GlobalTime now() const { return now_; }

 private:
  GlobalTime now_{};
};

struct GatheringSetup {
  std::uint32_t sources = 0;
  Nanoseconds period{};    // nominal frame period
  Nanoseconds interval{};  // T_int, largest range of a set
  // Frames that may wait per source, at least 1; empty: the policy's own.
  std::optional<std::uint32_t> queue_limit{};
};

class Gatherer {
 public:
  virtual ~Gatherer() = default;
  virtual void push(const GatherFrame& frame, FrameSetSink& sink) = 0;
  // Pushes each of a block of frames, in order.
  virtual void push_all(std::span<const GatherFrame> frames, TimedSetSink& sink) {
    for (const GatherFrame& frame : frames) {
      sink.advance_to(frame.arrival);
      push(frame, sink);
    }
  }
  // Frames discarded so far: they will be in no set.
  virtual std::uint64_t discarded() const = 0;
  // True for a gatherer that counts from a camera's first frame: it gets the warm-up too, in which
  // `stamp` is the bare arrival unless the estimator runs there as well.
  virtual bool from_first_frame() const { return false; }
};

// The base of a gatherer whose blocks shall cost no virtual call per frame:
//
//   class Nothing final : public BlockGatherer<Nothing> {
//    public:
//     void push(const GatherFrame&, FrameSetSink&) override { ++pushed_; }
//     std::uint64_t discarded() const override { return pushed_; }
//    private:
//     std::uint64_t pushed_ = 0;
//   };
template <class Policy>
class BlockGatherer : public Gatherer {
 public:
  void push_all(std::span<const GatherFrame> frames, TimedSetSink& sink) final {
    for (const GatherFrame& frame : frames) {
      sink.advance_to(frame.arrival);
      static_cast<Policy&>(*this).Policy::push(frame, sink);
    }
  }
};

}  // namespace simbench
