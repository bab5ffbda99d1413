// Reports of a capture: each frame is reported once, when it is delivered or lost, to
//
//  - the recording, if it was delivered;
//  - its host (FrameFeeds), whose programs may use frames and which sends a part of it on over the
//    network;
//  - an observer of the world, also if it was lost.
//
//   CaptureReports reports(sink, &feeds, request.observer);
//   Capture capture(scenario, seed, engine, clocks, outages, reports);
#ifndef SIMBENCH_SIM_RIG_CAPTURE_REPORTS_H_
#define SIMBENCH_SIM_RIG_CAPTURE_REPORTS_H_

#include <cstdint>

#include "recording/recording.h"
#include "recording/world_observer.h"
#include "scenarios/scenario.h"

namespace simbench::sim {

class HostGroup;

// A frame that was delivered or lost.
struct CapturedFrame {
  FrameRecord record{};  // complete only if the frame was delivered
  FrameTruth truth{};
  std::uint32_t host = 0;
  double bytes = 0;
  FrameFate fate = FrameFate::kDelivered;
  TrueTime offered{};      // to its USB controller
  TrueTime transferred{};  // the last byte is with the host
  TrueTime copied{};       // to the kernel
  TrueTime delivered{};    // to the program
};

// The hosts' use of the frames that were delivered to them, besides recording them.
//
//  - Programs that opened a feed get the frames of the scored stream (scenario /evaluation/stream)
//    through their host's feed (sim/host/sim_host.h).
//  - capture_traffic_share of every frame's bytes, of all streams, leaves through the host's switch
//    port (sim/network/network.h), in phase with the trigger as the frames are.
//
// Cost of a frame without either use: a few comparisons; neither use of frames costs an event.
class FrameFeeds {
 public:
  // `hosts` must outlive this.
  FrameFeeds(const scenarios::Scenario& scenario, HostGroup& hosts);

  void on_delivery(const CapturedFrame& frame);

 private:
  HostGroup& hosts_;
  StreamKind scored_;
  double traffic_share_;
};

class CaptureReports {
 public:
  // All of them outlive this; null where there are none.
  explicit CaptureReports(RecordingSink& sink, FrameFeeds* feeds = nullptr,
                          WorldObserver* observer = nullptr)
      : sink_(sink), feeds_(feeds), observer_(observer) {}

  // The cameras are started.
  void start(TrueTime at) const;
  // A pulse leaves the main trigger.
  void pulse(std::int64_t slot, TrueTime at) const;
  // A pulse of the evaluated frames, for the recording.
  void recorded_pulse(const PulseTruth& pulse) const { sink_.on_pulse(pulse); }
  // A frame is delivered or lost, now.
  void frame(const CapturedFrame& frame) const;

 private:
  RecordingSink& sink_;
  FrameFeeds* feeds_;
  WorldObserver* observer_;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_RIG_CAPTURE_REPORTS_H_
