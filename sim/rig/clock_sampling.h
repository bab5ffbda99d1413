// Stands between the world and its observer, and adds what nothing in the world calls for: the
// errors of the hosts' clocks, at the observer's interval.
//
// Samples cost no events. A clock can be read at any past instant, so what is due is read just
// before the next thing is reported, and the rest at the end: with an observer the engine does
// exactly what it does without. A sample at an instant t is read when t is over, after all that is
// done to the clocks then.
//
// Samples are at the start of the world, then every interval from true zero on to the end. A
// service's warm-up may be hours of nothing: before zero the interval is at least a thousandth of
// that time.
//
// Cost: a comparison for everything reported, and one reading of every clock per sample.
//
//   ClockSampling sampling(observer, clocks, engine);
//   sampling.on_world(start);
//   Capture capture(scenario, seed, engine, clocks, outages,
//                   CaptureReports(sink, nullptr, &sampling));
//   engine.run();
//   sampling.finish();
#ifndef SIMBENCH_SIM_RIG_CLOCK_SAMPLING_H_
#define SIMBENCH_SIM_RIG_CLOCK_SAMPLING_H_

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

  // The world has ended, now.
  void finish();

 private:
  // Reports the samples due before `end`.
  void sample_until(TrueTime end);
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

#endif  // SIMBENCH_SIM_RIG_CLOCK_SAMPLING_H_
