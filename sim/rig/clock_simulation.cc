#include "sim/rig/clock_simulation.h"

#include <functional>
#include <span>
#include <variant>
#include <vector>

#include "algorithms/ports/host_sync.h"
#include "recording/recording.h"
#include "recording/world_observer.h"
#include "sim/engine/engine.h"
#include "sim/engine/virtual_executor.h"
#include "sim/host/host_group.h"
#include "sim/rig/synchronisation_run.h"

namespace simbench::sim {
namespace {

using scenarios::Scenario;

// Passes on how the synchronisation ended.
class OutcomesOnly final : public RecordingSink {
 public:
  explicit OutcomesOnly(ClockSink& sink) : sink_(sink) {}
  void on_start(const RigLayout&) override {}
  void on_frames(std::span<const FrameRecord>, std::span<const FrameTruth>) override {}
  void on_event(const RecordingEvent& event) override {
    if (const auto* outcome = std::get_if<SyncOutcome>(&event)) sink_.on_outcome(*outcome);
    if (const auto* failure = std::get_if<ProgramFailure>(&event)) {
      sink_.on_program_failure(*failure);
    }
  }

 private:
  ClockSink& sink_;
};

// Counts the messages that leave before `end`, and passes all on.
class MessageCount final : public WorldObserver {
 public:
  MessageCount(TrueTime end, ClockSink& sink) : end_(end), sink_(sink) {}
  std::uint64_t count() const { return count_; }

  void on_world(TrueTime) override {}
  void on_capture_start(TrueTime) override {}
  void on_pulse(const ObservedPulse&) override {}
  void on_frame(const ObservedFrame&) override {}
  void on_message(const ObservedMessage& message) override {
    count_ += !message.copy && message.left < end_;
    sink_.on_message(message);
  }
  void on_clocks(TrueTime, std::span<const Nanoseconds>) override {}

 private:
  TrueTime end_;
  ClockSink& sink_;
  std::uint64_t count_ = 0;
};

// The world whose master is unreachable from the end of the duration on.
Scenario world_of(const Scenario& scenario, const ClockRequest& request) {
  Scenario world = scenario;
  if (request.master_lost_for > Nanoseconds(0)) {
    world.faults.emplace_back(
        scenarios::LinkStops{.host = 0,
                             .at_ms = to_seconds(request.duration) * 1e3,
                             .duration_ms = to_seconds(request.master_lost_for) * 1e3});
  }
  return world;
}

class ClockRun {
 public:
  ClockRun(const Scenario& scenario, const ClockRequest& request, ClockSink& sink)
      : scenario_(world_of(scenario, request)),
        request_(request),
        sink_(sink),
        messages_(TrueTime{} + request.duration, sink),
        outcomes_(sink),
        engine_({.cancel = request.cancel, .on_poll = share_of_time()}),
        context_(std::make_unique<VirtualContext>(engine_)),
        hosts_(scenario_, request.seed, request.pipeline + "@" + scenario_.name,
               request.host_sync != nullptr ? request.host_sync->initial_clocks()
                                            : InitialClocks::kUnsynchronised,
               *context_, outcomes_),
        synchronisation_(hosts_, *context_),
        clocks_(hosts_.clocks()),
        errors_s_(hosts_.size()) {
    hosts_.network().observe(messages_);
  }
  ClockRun(const ClockRun&) = delete;
  ClockRun& operator=(const ClockRun&) = delete;
  // Coroutines that still wait go first: they use the hosts.
  ~ClockRun() { context_.reset(); }

  ClockCost run() {
    hosts_.begin_faults();
    for (const scenarios::Fault& fault : scenario_.faults) plan(fault);
    read_clocks();
    if (request_.host_sync != nullptr) synchronisation_.start(*request_.host_sync, [] {});
    run_world(engine_);
    if (request_.cancel != nullptr && *request_.cancel) throw RecordingCancelled();
    synchronisation_.check(scenario_, request_.pipeline);
    return {.events = engine_.events(),
            .messages = messages_.count(),
            .trace_hash = engine_.trace_hash()};
  }

 private:
  std::function<void(TrueTime)> share_of_time() const {
    if (!request_.share_done) return {};
    return [this](TrueTime now) {
      request_.share_done(to_seconds(now - TrueTime{}) / to_seconds(end() - TrueTime{}));
    };
  }

  TrueTime end() const {
    const bool is_lost = request_.master_lost_for > Nanoseconds(0);
    return TrueTime{} + request_.duration +
           (is_lost ? request_.master_lost_for + request_.recovery : Nanoseconds(0));
  }

  void plan(const scenarios::Fault& fault) {
    const auto* step = std::get_if<scenarios::ClockStep>(&fault);
    if (step == nullptr) return;
    engine_.call_at(TrueTime{} + from_ms(step->at_ms), [this, step = *step] {
      SystemClock& clock = hosts_.clock(static_cast<std::size_t>(step.host));
      clock.set(engine_.now(), clock.read(engine_.now()) + from_ms(step.step_ms));
    });
  }

  // Now, and at every interval from now on.
  void read_clocks() {
    const double master_ns = clocks_[0]->ahead_ns(engine_.now());
    for (std::size_t host = 0; host < clocks_.size(); ++host) {
      errors_s_[host] = (clocks_[host]->ahead_ns(engine_.now()) - master_ns) * 1e-9;
    }
    sink_.on_master(master_ns * 1e-9);
    sink_.on_errors(engine_.now(), errors_s_);
    const TrueTime next = engine_.now() + request_.interval;
    if (next > end()) return engine_.stop();
    engine_.call_at(next, [this] { read_clocks(); });
  }

  const Scenario scenario_;
  const ClockRequest request_;
  ClockSink& sink_;
  MessageCount messages_;
  OutcomesOnly outcomes_;
  Engine engine_;
  std::unique_ptr<VirtualContext> context_;
  HostGroup hosts_;
  SynchronisationRun synchronisation_;
  std::vector<SystemClock*> clocks_;
  std::vector<double> errors_s_;
};

class ClockSimulation final : public ClockSource {
 public:
  explicit ClockSimulation(const Scenario& scenario) : scenario_(scenario) {}

  ClockCost run(const ClockRequest& request, ClockSink& sink) override {
    return ClockRun(scenario_, request, sink).run();
  }

 private:
  const Scenario& scenario_;
};

}  // namespace

std::unique_ptr<ClockSource> make_clock_simulation(const Scenario& scenario) {
  return std::make_unique<ClockSimulation>(scenario);
}

}  // namespace simbench::sim
