// Passes the world's reports to its observer, and adds samples of the errors of the hosts' clocks
// at the observer's interval.
//
// Samples cost no events. A clock can be read at any past instant, so due samples are read just
// before the next report, and the rest at the end: the engine does exactly the same with and
// without an observer. A sample at an instant t is read after t, so that all adjustments at t
// count.
//
// Samples are at the start of the world, then every interval from true zero on to the end. A
// service's warm-up may be hours: before zero the interval is at least a thousandth of that time.
//
// Cost: a comparison per report, and one reading of every clock per sample.
//
//   ClockSampling sampling(observer, clocks, engine);
//   sampling.on_world(start);
//   Capture capture(scenario, engine, clocks, outages, CaptureReports(sink, nullptr, &sampling));
//   engine.run();
//   sampling.finish();
#pragma once

#include <vector>

#include "recording/world_observer.h"
#include "sim/clock/system_clock.h"
#include "sim/engine/engine.h"

namespace simbench::sim {

class ClockSampling final : public WorldObserver {
 public:
  // All of these outlive this.
  ClockSampling(WorldObserver& observer, std::vector<SystemClock*> clocks, const Engine& engine);

  void on_world(TrueTime start) override;
  void on_capture_start(TrueTime at) override;
  void on_pulse(const ObservedPulse& pulse) override;
  void on_frame(const ObservedFrame& frame) override;
  void on_message(const ObservedMessage& message) override;
  void on_clocks(TrueTime at, std::span<const Nanoseconds> errors) override;

  // Reports the samples due before `end`, which is when the next pulse or frame is reported.
  void sample_until(TrueTime end);
  // The world has ended, now.
  void finish();

 private:
  void sample();

  WorldObserver& observer_;
  std::vector<SystemClock*> clocks_;
  const Engine& engine_;
  Nanoseconds interval_;
  Nanoseconds interval_before_zero_{};
  TrueTime next_ = TrueTime::max();
  std::vector<Nanoseconds> errors_;
};

}  // namespace simbench::sim
