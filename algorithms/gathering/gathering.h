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

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "algorithms/device_time/device_time.h"
#include "algorithms/ports/exchange.h"
#include "algorithms/ports/time.h"

namespace simbench {

struct CodedPulses;  // algorithms/coded_trigger/coded_pulses.h

struct GatherFrame {
  std::uint32_t source = 0;
  std::uint32_t exposure_us = 0;
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
  // For gatherers that want evidence: how many hosts there are, that of each source (empty: one
  // host has all), and how coarse a reading of a host's system clock is.
  std::uint32_t hosts = 0;
  std::vector<std::uint32_t> host_of_source{};
  Nanoseconds host_clock_step{};
  // What the trigger's pulses are, if they are coded; else null.
  std::shared_ptr<const CodedPulses> pulses{};
};

// How the places of the sources in a trigger's code were found: counts, and the worst of all.
struct PlaceSearch {
  std::uint32_t sources = 0;
  std::uint32_t found = 0;         // of them
  std::uint32_t again = 0;         // searches beyond the first of a source
  std::uint32_t frames = 0;        // that the newest search of a source took
  double seconds = 0;              // that these took, on its camera's clock
  double since_first_frame_s = 0;  // until then, from the source's first frame
  double error_probability = 0;    // that a place is wrong

  void add(const PlaceSearch& other) {
    sources += other.sources;
    found += other.found;
    again += other.again;
    frames = std::max(frames, other.frames);
    seconds = std::max(seconds, other.seconds);
    since_first_frame_s = std::max(since_first_frame_s, other.since_first_frame_s);
    error_probability = std::max(error_probability, other.error_probability);
  }
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
  // True for a gatherer that gets what ties the clocks, in order with the frames and from the begin
  // of the capture on: polls of the sources' clocks, exchanges and changes of the hosts'. One that
  // follows an offline estimator gets all of it before the first frame.
  virtual bool wants_evidence() const { return false; }
  virtual void on_poll(std::uint32_t /*source*/, const PollSample& /*poll*/) {}
  virtual void on_exchange(PeerId /*host*/, const Exchange& /*exchange*/) {}
  virtual void on_adjustment(const ClockAdjustment& /*adjustment*/) {}
  // How it found its sources' places in the trigger's code, so far; nothing if it looks for none.
  virtual std::optional<PlaceSearch> place_search() const { return std::nullopt; }
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
