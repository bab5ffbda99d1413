#include "sim/rig/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "algorithms/ports/capture_alignment.h"
#include "algorithms/ports/host_sync.h"
#include "recording/forwarding_sink.h"
#include "scenarios/frequency_limit.h"
#include "sim/engine/engine.h"
#include "sim/engine/virtual_executor.h"
#include "sim/host/host_group.h"
#include "sim/rig/camera_stamps.h"
#include "sim/rig/camera_world.h"
#include "sim/rig/capture.h"
#include "sim/rig/capture_reports.h"
#include "sim/rig/clock_sampling.h"
#include "sim/rig/synchronisation_run.h"

namespace simbench::sim {
namespace {

// Lets what the hosts report wait for what the capture has to report before.
class AfterCapture final : public ForwardingSink {
 public:
  using ForwardingSink::ForwardingSink;
  void follow(Capture& capture) { capture_ = &capture; }

  void on_event(const RecordingEvent& event) override {
    if (capture_ != nullptr) capture_->catch_up();
    sink().on_event(event);
  }

 private:
  Capture* capture_ = nullptr;
};

// The cameras' half of the world of a seed, and its stamps by their start, for further runs.
class SharedCameras {
 public:
  SharedCameras(const scenarios::Scenario& scenario, const EngineLimits& limits)
      : scenario_(scenario), limits_(limits) {}

  CameraWorld& world(std::uint64_t seed, TrueTime start) {
    const bool is_other = !world_ || world_->seed() != seed || !world_->is_whole() ||
                          (CameraWorld::depends_on_start(scenario_) && world_->start() != start);
    if (is_other) {
      stamps_.clear();
      world_ = std::make_unique<CameraWorld>(scenario_, seed, start, limits_);
    }
    return *world_;
  }

  // A half of its own, for one run whose cameras are steered.
  std::unique_ptr<CameraWorld> make_steered(std::uint64_t seed, TrueTime start,
                                            Steering steering) const {
    return std::make_unique<CameraWorld>(scenario_, seed, start, limits_, CameraWorld::kKeptBytes,
                                         steering);
  }

  // The present world's stamps of a capture that starts then.
  CameraStamps& stamps(TrueTime start) {
    const auto has_start = [start](const auto& stamps) { return stamps->start() == start; };
    auto found = std::ranges::find_if(stamps_, has_start);
    if (found == stamps_.end()) {
      // Most pipelines have the first start; those of others seldom share one.
      if (stamps_.size() > 1) stamps_.pop_back();
      stamps_.push_back(std::make_unique<CameraStamps>(scenario_, *world_, start));
      found = stamps_.end() - 1;
    }
    return **found;
  }

 private:
  const scenarios::Scenario& scenario_;
  EngineLimits limits_;
  std::unique_ptr<CameraWorld> world_;
  std::vector<std::unique_ptr<CameraStamps>> stamps_;  // at most two
};

std::vector<ClockInterface> interfaces_of(HostGroup& hosts) {
  std::vector<ClockInterface> interfaces;
  for (std::size_t host = 0; host < hosts.size(); ++host) {
    interfaces.push_back(hosts.host(host).clock_interface());
  }
  return interfaces;
}

// One run of the world.
class WorldRun {
 public:
  WorldRun(const scenarios::Scenario& scenario, const RecordingRequest& request,
           const EngineLimits& limits, SharedCameras& cameras, HostOscillators& oscillators,
           RecordingSink& sink)
      : scenario_(scenario),
        host_sync_(request.host_sync),
        alignment_(request.capture_alignment),
        pipeline_(request.pipeline),
        start_(TrueTime{} - service_time().value_or(Nanoseconds(0))),
        cancel_(request.cancel),
        engine_({.max_events = limits.max_events,
                 .max_time = limits.max_time,
                 .cancel = request.cancel,
                 .on_poll = share_of_time(request.share_done)},
                start_),
        seed_(request.seed),
        cameras_(cameras),
        trigger_(scenario.trigger, 0, request.seed),
        context_(std::make_unique<VirtualContext>(engine_)),
        after_capture_(sink),
        hosts_(scenario, request.seed, request.pipeline + "@" + scenario.name, initial_clocks(),
               *context_, after_capture_, &oscillators),
        synchronisation_(hosts_, *context_),
        sampling_(request.observer == nullptr ? std::nullopt
                                              : std::make_optional<ClockSampling>(
                                                    *request.observer, hosts_.clocks(), engine_)),
        frame_feeds_(scenario, hosts_),
        capture_(scenario, engine_, hosts_.clocks(), hosts_.outages(),
                 CaptureReports(sink, &frame_feeds_, sampling_ ? &*sampling_ : nullptr),
                 interfaces_of(hosts_)) {
    const auto catch_up = [this] { capture_.catch_up(); };
    after_capture_.follow(capture_);
    hosts_.frames().connect(
        catch_up, [this] { expect_frame(); },
        [this](std::uint32_t camera, const FrameCommand& command) { steer(camera, command); });
    if (sampling_) hosts_.network().observe(*sampling_);
    if (sampling_ || frame_feeds_.has_traffic()) hosts_.network().before_messages(catch_up);
  }
  WorldRun(const WorldRun&) = delete;
  WorldRun& operator=(const WorldRun&) = delete;
  // Coroutines that still wait go first: they use the hosts.
  ~WorldRun() { context_.reset(); }

  RecordingCost run(RecordingSink& sink) {
    sink.on_start(capture_.layout());
    if (sampling_) sampling_->on_world(start_);
    hosts_.report_clocks();
    start_host_sync();
    if (service_time()) start_capture_at(TrueTime{} + wait_before_capture());
    run_world(engine_);
    if (cancel_ != nullptr && *cancel_) throw RecordingCancelled();
    synchronisation_.check(scenario_, pipeline_);
    if (!captured_) throw SimulationError(standstill());
    if (sampling_) sampling_->finish();
    const std::uint64_t trace_hash = engine_.trace_hash() ^ camera_world_->trace_hash();
    return {.events = engine_.events() + camera_world_->events(),
            .simulated_seconds = to_seconds(engine_.now() - start_),
            .trace_hash = trace_hash,
            .messages = hosts_.network().messages(),
            .notes = notes()};
  }

 private:
  // The notes of the walks and ramps that got as far as a clock goes.
  std::vector<std::string> notes() {
    const auto is_limited = [this](const OscillatorModel& oscillator) {
      return oscillator.reached_limit(engine_.now());
    };
    const std::vector<SystemClock*> hosts = hosts_.clocks();
    const auto limited_hosts = std::ranges::count_if(
        hosts, is_limited,
        [](const SystemClock* clock) -> const auto& { return clock->oscillator(); });
    const std::vector<DeviceClock>& cameras = camera_stamps_->clocks();
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
  // The share of the time until the last evaluated pulse. If a protocol ends by itself, nobody
  // knows it.
  std::function<void(TrueTime)> share_of_time(const ShareDone& share_done) const {
    if (!share_done || !service_time()) return {};
    const double pulses = static_cast<double>(evaluated_slots(scenario_).last);
    const double whole_s = to_seconds(*service_time() + wait_before_capture()) +
                           1e-3 * pulses * scenario_.trigger.period_ms();
    return [this, share_done, whole_s](TrueTime now) {
      share_done(std::min(1.0, to_seconds(now - start_) / whole_s));
    };
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
      make_cameras();
      capture_start_ = engine_.now();
      trigger_.start(engine_.now());
      const auto on_end = [this] {
        captured_ = true;
        engine_.stop();
      };
      capture_.start(*camera_world_, *camera_stamps_, on_end, cancel_);
      hosts_.on_capture_start(trigger_, evaluated_slots(scenario_).last);
      if (alignment_ != nullptr) synchronisation_.start(*alignment_);
      if (frame_feeds_.is_awaited()) expect_frame();
    });
  }

  // Cameras that are steered are of this run alone.
  void make_cameras() {
    const TrueTime now = engine_.now();
    if (steering() == Steering::kNone) {
      camera_world_ = &cameras_.world(seed_, now);
      camera_stamps_ = &cameras_.stamps(now);
      return;
    }
    steered_world_ = cameras_.make_steered(seed_, now, steering());
    camera_world_ = steered_world_.get();
    steered_stamps_ = std::make_unique<CameraStamps>(scenario_, *steered_world_, now);
    camera_stamps_ = steered_stamps_.get();
  }

  Steering steering() const {
    return alignment_ != nullptr ? alignment_->steering() : Steering::kNone;
  }

  void steer(std::uint32_t camera, const FrameCommand& command) {
    if (camera_world_ == nullptr) return;  // not started yet
    capture_.catch_up();
    FrameCommand since_start = command;
    since_start.at -= capture_start_.time_since_epoch();
    camera_world_->steer(camera, since_start, engine_.now() - capture_start_.time_since_epoch());
  }

  // While a program waits for a frame, each delivery is an event.
  void expect_frame() {
    if (is_frame_expected_ || capture_.next_at() == TrueTime::max()) return;
    is_frame_expected_ = true;
    engine_.call_at(capture_.next_at(), [this] {
      is_frame_expected_ = false;
      capture_.catch_up();
      if (frame_feeds_.is_awaited()) expect_frame();
    });
  }

  std::string standstill() const {
    std::string what = "host synchronisation came to a standstill before the capture; waiting:";
    for (const std::string& wait : context_->waiting()) what += "\n  " + wait;
    return what;
  }

  const scenarios::Scenario& scenario_;
  HostSync* host_sync_;
  CaptureAlignment* alignment_;
  std::string pipeline_;
  TrueTime start_;
  const std::atomic<bool>* cancel_;
  Engine engine_;
  std::uint64_t seed_;
  SharedCameras& cameras_;
  CameraWorld* camera_world_ = nullptr;  // from the capture's start on
  CameraStamps* camera_stamps_ = nullptr;
  std::unique_ptr<CameraWorld> steered_world_;  // these of steered cameras
  std::unique_ptr<CameraStamps> steered_stamps_;
  TrueTime capture_start_{};
  TriggerTree trigger_;  // for the hosts; its cables to cameras are the other half's
  std::unique_ptr<VirtualContext> context_;
  AfterCapture after_capture_;
  HostGroup hosts_;
  SynchronisationRun synchronisation_;
  std::optional<ClockSampling> sampling_;  // with an observer
  FrameFeeds frame_feeds_;
  Capture capture_;
  bool is_frame_expected_ = false;
  bool captured_ = false;
};

class Simulation final : public RecordingSource {
 public:
  Simulation(const scenarios::Scenario& scenario, const EngineLimits& limits)
      : scenario_(scenario),
        limits_(limits),
        cameras_(scenario, limits),
        oscillators_(scenario.hosts) {}

  RecordingCost record(const RecordingRequest& request, RecordingSink& sink) override {
    return WorldRun(scenario_, request, limits_, cameras_, oscillators_, sink).run(sink);
  }

 private:
  const scenarios::Scenario& scenario_;
  const EngineLimits limits_;
  SharedCameras cameras_;
  HostOscillators oscillators_;
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
