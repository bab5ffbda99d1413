// The part of a RunDetail that only a simulated world shows: host clocks, lost frames, when what
// began. See evaluation/run/run_detail.h.
#ifndef SIMBENCH_EVALUATION_RUN_RUN_WORLD_H_
#define SIMBENCH_EVALUATION_RUN_RUN_WORLD_H_

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "evaluation/run/run_detail.h"
#include "recording/world_observer.h"

namespace simbench::evaluation {

// Of the hosts kept in detail.
ClockErrors clock_errors(TrueTime at, std::span<const Nanoseconds> errors);

class RunWorld final : public WorldObserver {
 public:
  // Frames of `stream` are of interest. `service`: how long a host_sync that does not end runs
  // before the capture. Clocks are sampled every 20 ms, less often the more `hosts` there are and
  // the longer a service runs.
  RunWorld(StreamKind stream, std::int64_t hosts, std::optional<Nanoseconds> service);

  Nanoseconds clock_interval() const override { return clock_interval_; }
  void on_world(TrueTime start) override;
  void on_capture_start(TrueTime at) override;
  void on_pulse(const ObservedPulse& pulse) override;
  void on_frame(const ObservedFrame& frame) override;
  void on_message(const ObservedMessage& message) override;
  void on_clocks(TrueTime at, std::span<const Nanoseconds> errors) override;

  // When the run is over and `run` has its frames, and maybe clocks already.
  void add_to(RunDetail& run, double wait_before_capture_ms);

 private:
  StreamKind stream_;
  bool service_;
  Nanoseconds clock_interval_;
  std::optional<TrueTime> start_;
  std::optional<TrueTime> capture_start_;
  std::vector<LostFrame> lost_;
  std::vector<ClockErrors> clocks_;
};

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_RUN_RUN_WORLD_H_
