// The workloads through the API that the models of the simulated world use.
#include "bench/engine_workloads/models.h"
#include "bench/engine_workloads/workload.h"
#include "sim/engine/engine.h"

namespace simbench::bench {
namespace {

TrueTime at_ns(std::int64_t time_ns) { return TrueTime(Nanoseconds(time_ns)); }

class Timers final : public sim::EventHandler {
 public:
  Timers(sim::Engine& engine, std::uint32_t timers, std::uint64_t events)
      : engine_(engine), id_(engine.attach(*this)), model_(timers, events) {
    for (std::uint32_t i = 0; i < timers; ++i)
      engine.schedule(at_ns(first_expiry_ns(i)), id_, 0, i);
  }

  void handle(sim::Event event) override {
    const std::int64_t delay_ns = model_.expire(event.subject);
    if (model_.ended()) {
      engine_.stop();
      return;
    }
    engine_.schedule(event.time + Nanoseconds(delay_ns), id_, 0, event.subject);
    if (model_.warmed_up()) engine_.stop();
  }

  std::uint64_t checksum() const { return model_.checksum(); }

 private:
  sim::Engine& engine_;
  sim::HandlerId id_;
  HoldModel model_;
};

class Rig final : public sim::EventHandler {
 public:
  Rig(sim::Engine& engine, std::uint32_t cameras)
      : engine_(engine),
        id_(engine.attach(*this)),
        model_(cameras),
        warm_up_left_(std::uint64_t{6} * cameras) {
    for (std::uint32_t i = 0; i < cameras; ++i) {
      engine.schedule(at_ns(trigger_phase_ns(i)), id_, RigModel::kTrigger, i);
    }
  }

  void handle(sim::Event event) override {
    const std::int64_t now_ns = event.time.time_since_epoch().count();
    switch (event.kind) {
      case RigModel::kTrigger: {
        const std::uint32_t slot = model_.trigger(event.subject, now_ns);
        advance(event.time, 0, slot);
        engine_.schedule(event.time + Nanoseconds(RigModel::kPeriod_ns), id_, RigModel::kTrigger,
                         event.subject);
        break;
      }
      case RigModel::kDelivery:
        model_.deliver(event.subject, now_ns);
        break;
      default:
        model_.stamp(event.kind, event.subject, now_ns);
        advance(event.time, event.kind, event.subject);
    }
    if (--warm_up_left_ == 0) engine_.stop();
  }

  bool warmed_up() const { return warm_up_left_ == 0; }
  const RigModel& model() const { return model_; }

 private:
  void advance(TrueTime now, std::uint16_t stage, std::uint32_t slot) {
    engine_.schedule(now + Nanoseconds(model_.delay_ns(stage, slot)), id_,
                     static_cast<std::uint16_t>(stage + 1), slot);
  }

  sim::Engine& engine_;
  sim::HandlerId id_;
  RigModel model_;
  std::uint64_t warm_up_left_;
};

}  // namespace

WorkloadResult run_hold(std::uint32_t timers, std::uint64_t events) {
  sim::Engine engine;
  Timers model(engine, timers, events);
  engine.run();  // the warm-up
  const double start = cpu_seconds();
  engine.run();
  return {.events = engine.events() - timers,
          .seconds = cpu_seconds() - start,
          .checksum = model.checksum()};
}

WorkloadResult run_rig(std::uint32_t cameras, std::int64_t duration_ms) {
  const TrueTime end = at_ns(duration_ms * 1'000'000);
  sim::Engine engine;
  Rig rig(engine, cameras);
  engine.run_until(end);  // the warm-up
  if (!rig.warmed_up()) throw_too_short(duration_ms);
  const std::uint64_t warm_up = engine.events();
  const double start = cpu_seconds();
  engine.run_until(end);
  const double seconds = cpu_seconds() - start;
  if (engine.events() == warm_up) throw_too_short(duration_ms);
  return {.events = engine.events() - warm_up,
          .seconds = seconds,
          .checksum = rig.model().checksum(),
          .order_checksum = rig.model().order_checksum()};
}

}  // namespace simbench::bench
