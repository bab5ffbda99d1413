// Reports of a capture. Each frame is reported once, after it was delivered or lost, to
//
//  - the recording, if it was delivered;
//  - its host (FrameFeeds), whose programs may use frames and which sends a part of it on over the
//    network;
//  - an observer of the world, also if it was lost.
//
//   CaptureReports reports(sink, &feeds, &sampling);
//   Capture capture(scenario, engine, clocks, outages, reports);
#pragma once

#include <cstdint>
#include <span>

#include "recording/recording.h"
#include "scenarios/scenario.h"
#include "sim/rig/camera_world.h"
#include "sim/rig/clock_sampling.h"

namespace simbench::sim {

class HostGroup;

// The hosts' use of the frames that were delivered to them, besides recording them.
//
//  - Programs that opened a feed get the frames of the scored stream (scenario /evaluation/stream)
//    through their host's feed (sim/host/sim_host.h).
//  - capture_traffic_share of every frame's bytes, of all streams, leaves through the host's switch
//    port (sim/network/network.h), in phase with the trigger as the frames are.
class FrameFeeds {
 public:
  // `hosts` must outlive this.
  FrameFeeds(const scenarios::Scenario& scenario, HostGroup& hosts);

  // Whether frames are used now.
  bool is_used() const { return has_traffic() || is_open(); }
  bool has_traffic() const { return traffic_share_ > 0; }
  // Whether a program has opened a feed; whether one waits for a frame.
  bool is_open() const;
  bool is_awaited() const;

  void on_delivery(const FrameRecord& record, const SimStream& stream, TrueTime at);
  void on_poll(const DevicePoll& poll, std::uint32_t host);

 private:
  HostGroup& hosts_;
  StreamKind scored_;
  double traffic_share_;
  bool stamps_on_host_;
};

class CaptureReports {
 public:
  // All of them outlive this; null where there are none.
  explicit CaptureReports(RecordingSink& sink, FrameFeeds* feeds = nullptr,
                          ClockSampling* observer = nullptr)
      : sink_(sink), feeds_(feeds), observer_(observer) {}

  // The cameras are started.
  void start(TrueTime at) const;
  // A pulse leaves the main trigger.
  void pulse(std::int64_t slot, TrueTime at) const;
  // What only the recording has: pulses of the evaluated frames, sightings of the LED clock.
  void recorded(const RecordingEvent& event) const { sink_.on_event(event); }
  void poll(const DevicePoll& poll, std::uint32_t host) const {
    sink_.on_event(poll);
    if (feeds_ != nullptr) feeds_->on_poll(poll, host);
  }
  // Whether somebody besides the recording wants frames: then a block has one frame.
  bool are_single() const {
    return observer_ != nullptr || (feeds_ != nullptr && feeds_->is_used());
  }
  void frames(std::span<const FrameRecord> records, std::span<const FrameTruth> truths) const {
    sink_.on_frames(records, truths);
  }
  // One was recorded.
  void used(const FrameRecord& record, const SimStream& stream, TrueTime at) const {
    if (feeds_ != nullptr) feeds_->on_delivery(record, stream, at);
  }
  // One was delivered or lost; its times are to be shifted.
  void observed(const SimFrame& frame, Nanoseconds shift) const;

 private:
  RecordingSink& sink_;
  FrameFeeds* feeds_;
  ClockSampling* observer_;
};

}  // namespace simbench::sim
