// Where what a capture makes goes: a frame whose way has ended is reported once, and from here to
// all who have to do with it.
//
//  - The recording has every delivered frame.
//  - The frame's host (FrameFeeds) gives it to the programs that asked for frames, and sends a part
//    of it on over the network.
//  - An observer of the world has every frame that was exposed, lost ones too.
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

// A frame at the end of its way.
struct CapturedFrame {
  FrameRecord record{};  // what the host knows only of one that was delivered
  FrameTruth truth{};
  std::uint32_t host = 0;
  double bytes = 0;
  FrameFate fate = FrameFate::kDelivered;
  TrueTime offered{};      // to its USB controller
  TrueTime transferred{};  // the last byte is with the host
  TrueTime copied{};       // to the kernel
  TrueTime delivered{};    // to the program
};

// What hosts do with the frames that were delivered to them, besides recording them.
//
//  - Programs that asked for them get the frames of the scored stream (scenario /evaluation/stream)
//    through their host's feed (sim/host/sim_frame_feed.h).
//  - capture_traffic_share of every frame's bytes, of all streams, leaves through the host's switch
//    port (sim/network/network.h), in phase with the trigger as the frames are.
//
// Cost of a frame that nobody wants: a few comparisons; neither use of frames costs an event.
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

  // The cameras are being started.
  void start(TrueTime at) const;
  // A pulse leaves the main trigger.
  void pulse(std::int64_t slot, TrueTime at) const;
  // A pulse of the frames that are evaluated, for the recording.
  void recorded_pulse(const PulseTruth& pulse) const { sink_.on_pulse(pulse); }
  // The way of a frame has ended, now.
  void frame(const CapturedFrame& frame) const;

 private:
  RecordingSink& sink_;
  FrameFeeds* feeds_;
  WorldObserver* observer_;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_RIG_CAPTURE_REPORTS_H_
