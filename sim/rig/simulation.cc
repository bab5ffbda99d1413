#include "sim/rig/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/ports/host_sync.h"
#include "scenarios/frequency_limit.h"
#include "sim/engine/engine.h"
#include "sim/engine/virtual_executor.h"
#include "sim/host/host_group.h"
#include "sim/rig/capture.h"
#include "sim/rig/capture_reports.h"
#include "sim/rig/clock_polls.h"
#include "sim/rig/clock_sampling.h"
#include "sim/rig/synchronisation_run.h"

namespace simbench::sim {
namespace {

// One run of the world.
class Run {
 public:
  Run(const scenarios::Scenario& scenario, const RecordingRequest& request,
      const EngineLimits& limits, RecordingSink& sink)
      : scenario_(scenario),
        host_sync_(request.host_sync),
        start_(TrueTime{} - service_time().value_or(Nanoseconds(0))),
        cancel_(request.cancel),
        engine_({.max_events = limits.max_events,
                 .max_time = limits.max_time,
                 .cancel = request.cancel},
                start_),
        context_(std::make_unique<VirtualContext>(engine_)),
        hosts_(scenario, request.seed, request.pipeline + "@" + scenario.name, initial_clocks(),
               *context_, sink),
        synchronisation_(hosts_, *context_),
        sampling_(request.observer == nullptr ? std::nullopt
                                              : std::make_optional<ClockSampling>(
                                                    *request.observer, hosts_.clocks(), engine_)),
        frame_feeds_(scenario, hosts_),
        capture_(scenario, request.seed, engine_, hosts_.clocks(), hosts_.outages(),
                 CaptureReports(sink, &frame_feeds_, sampling_ ? &*sampling_ : nullptr)),
        clock_polls_(scenario, request.seed, engine_, hosts_, capture_, sink) {
    if (sampling_) hosts_.network().observe(*sampling_);
  }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;
  // Coroutines that still wait go first: they use the hosts.
  ~Run() { context_.reset(); }

  RecordingCost run(RecordingSink& sink) {
    sink.on_start(capture_.layout());
    if (sampling_) sampling_->on_world(start_);
    hosts_.report_clocks();
    start_host_sync();
    if (service_time()) start_capture_at(TrueTime{} + wait_before_capture());
    run_world(engine_);
    if (cancel_ != nullptr && *cancel_) throw RecordingCancelled();
    synchronisation_.check();
    if (!captured_) throw SimulationError(standstill());
    if (sampling_) sampling_->finish();
    return {.events = engine_.events(),
            .simulated_seconds = to_seconds(engine_.now() - start_),
            .trace_hash = engine_.trace_hash(),
            .messages = hosts_.network().messages(),
            .notes = notes()};
  }

 private:
  // Of the walks and ramps that got as far as a clock goes.
  std::vector<std::string> notes() {
    const auto is_limited = [this](const OscillatorModel& oscillator) {
      return oscillator.reached_limit(engine_.now());
    };
    const std::vector<SystemClock*> hosts = hosts_.clocks();
    const auto limited_hosts = std::ranges::count_if(
        hosts, is_limited,
        [](const SystemClock* clock) -> const auto& { return clock->oscillator(); });
    const std::vector<DeviceClock>& cameras = capture_.cameras().clocks();
    const auto limited_cameras =
        std::ranges::count_if(cameras, is_limited, &DeviceClock::oscillator);
    std::vector<std::string> notes;
    const auto note = [&notes](auto limited, std::size_t all, const char* devices) {
      if (limited == 0) return;
      notes.push_back(
          fmt::format("the clocks of {} of {} {} reached a frequency error of {:g} %: their random "
                      "walk or ramp goes no further",
                      limited, all, devices, 100 * scenarios::kMostFrequencyError));
    };
    note(limited_hosts, hosts.size(), "hosts");
    note(limited_cameras, cameras.size(), "cameras");
    return notes;
  }

  std::optional<Nanoseconds> service_time() const {
    return host_sync_ != nullptr ? host_sync_->warm_up() : std::nullopt;
  }
  InitialClocks initial_clocks() const {
    return host_sync_ != nullptr ? host_sync_->initial_clocks() : InitialClocks::kUnsynchronised;
  }
  Nanoseconds wait_before_capture() const {
    return from_ms(scenario_.timeline.wait_before_capture_ms);
  }

  void start_host_sync() {
    if (host_sync_ == nullptr) return start_capture_at(engine_.now() + wait_before_capture());
    synchronisation_.start(*host_sync_, [this] {
      if (!service_time()) start_capture_at(engine_.now() + wait_before_capture());
    });
  }

  void start_capture_at(TrueTime at) {
    engine_.call_at(at, [this] {
      capture_.start(engine_.now(), [this] {
        captured_ = true;
        engine_.stop();
      });
      hosts_.on_capture_start(capture_.trigger(), capture_.last_slot());
      clock_polls_.start();
    });
  }

  std::string standstill() const {
    std::string what = "host synchronisation came to a standstill before the capture; waiting:";
    for (const std::string& wait : context_->waiting()) what += "\n  " + wait;
    return what;
  }

  const scenarios::Scenario& scenario_;
  HostSync* host_sync_;
  TrueTime start_;
  const std::atomic<bool>* cancel_;
  Engine engine_;
  std::unique_ptr<VirtualContext> context_;
  HostGroup hosts_;
  SynchronisationRun synchronisation_;
  std::optional<ClockSampling> sampling_;  // with an observer
  FrameFeeds frame_feeds_;
  Capture capture_;
  ClockPolls clock_polls_;
  bool captured_ = false;
};

class Simulation final : public RecordingSource {
 public:
  Simulation(const scenarios::Scenario& scenario, const EngineLimits& limits)
      : scenario_(scenario), limits_(limits) {}

  RecordingCost record(const RecordingRequest& request, RecordingSink& sink) override {
    return Run(scenario_, request, limits_, sink).run(sink);
  }

 private:
  const scenarios::Scenario& scenario_;
  const EngineLimits limits_;
};

}  // namespace

std::unique_ptr<RecordingSource> make_simulation(const scenarios::Scenario& scenario) {
  return make_limited_simulation(scenario, {});
}

std::unique_ptr<RecordingSource> make_limited_simulation(const scenarios::Scenario& scenario,
                                                         const EngineLimits& limits) {
  return std::make_unique<Simulation>(scenario, limits);
}

}  // namespace simbench::sim
