#include "algorithms/host_sync/ptp/ptp_clocks.h"

#include <algorithm>
#include <utility>

#include "algorithms/host_sync/cross_stamps.h"
#include "algorithms/host_sync/join.h"

namespace simbench {
namespace {

constexpr int kStepCalls = 3;
// An error below this needs no further call.
constexpr Nanoseconds kStepTolerance{1'000};

// The system clock's lead over the steady clock.
Task<Nanoseconds> system_lead(Host& host) {
  const HostTime reading = co_await host.clock().now();
  co_return offset_between(reading, host.steady_clock().now());
}

Task<void> step_system_clock(Host& host, Nanoseconds offset) {
  const Nanoseconds before = co_await system_lead(host);
  const Nanoseconds wanted = before + offset;
  Nanoseconds lead = wanted;  // to be set, so that `wanted` results
  for (int call = 0; call < kStepCalls; ++call) {
    const SteadyTime now = host.steady_clock().now();
    co_await host.clock().set(HostTime(now.time_since_epoch() + lead));
    const Nanoseconds reached = co_await system_lead(host);
    const Nanoseconds missing = wanted - reached;
    if (missing < kStepTolerance && -missing < kStepTolerance) co_return;
    lead += missing;
  }
}

ServoSettings coupling_settings(Host& host, ClockKind follower, ServoSettings settings) {
  settings = limited_by(host, follower, settings);
  settings.interval_s = to_seconds(ClockCoupling::kInterval);
  return settings;
}

}  // namespace

ServoSettings limited_by(Host& host, ClockKind clock, ServoSettings settings) {
  const HardwareClock* const card = host.hardware_clock();
  if (clock == ClockKind::kHardware && card == nullptr) return settings;
  const double most_ppb =
      clock == ClockKind::kHardware ? card->max_frequency_ppb() : host.clock().max_frequency_ppb();
  settings.max_frequency_ppb = std::min(settings.max_frequency_ppb, most_ppb);
  return settings;
}

Task<void> set_frequency(Host& host, ClockKind clock, double ppb) {
  if (clock == ClockKind::kSystem) {
    co_await host.clock().adjust_frequency(ppb);
  } else {
    co_await host.hardware_clock()->adjust_frequency(ppb);
  }
}

Task<void> step_clock(Host& host, ClockKind clock, Nanoseconds offset) {
  if (clock == ClockKind::kSystem) {
    co_await step_system_clock(host, offset);
  } else {
    co_await host.hardware_clock()->step(offset);
  }
}

Task<void> apply_answer(Host& host, ClockKind clock, ServoAnswer answer, Nanoseconds offset) {
  if (answer.state == ServoState::kUnlocked) co_return;
  co_await set_frequency(host, clock, -answer.ppb);
  if (answer.state == ServoState::kJump) co_await step_clock(host, clock, -offset);
}

ClockCoupling::ClockCoupling(Host& host, ClockKind follower, ServoSettings settings)
    : host_(host),
      follower_(follower),
      servo_(PiServo::kHardwareStamps, coupling_settings(host, follower, settings)) {}

Task<void> ClockCoupling::update() {
  const CrossStamp best = co_await narrowest_cross_stamp(host_);
  const HostTime system = best.before + (best.after - best.before) / 2;
  const Nanoseconds system_lead = offset_between(system, best.hardware);
  const bool system_follows = follower_ == ClockKind::kSystem;
  const Nanoseconds offset = system_follows ? system_lead : -system_lead;
  const std::int64_t local =
      system_follows ? nanoseconds_of(system) : nanoseconds_of(best.hardware);
  const ServoAnswer answer = servo_.sample(static_cast<double>(offset.count()), local, 1);
  co_await apply_answer(host_, follower_, answer, offset);
  if (answer.state != ServoState::kUnlocked) is_locked_ = true;
}

Task<void> keep_coupled(Host& host, ClockKind follower, ServoSettings settings,
                        std::shared_ptr<bool> is_locked) {
  ClockCoupling coupling(host, follower, settings);
  while (true) {
    co_await coupling.update();
    *is_locked = coupling.is_locked();
    co_await host.sleep_for(ClockCoupling::kInterval);
  }
}

Task<void> serve_slaves_of_relay(std::vector<PeerId> slaves, std::shared_ptr<const bool> is_ready,
                                 ServeSlave serve) {
  std::vector<Task<void>> tasks;
  tasks.reserve(slaves.size());
  for (const PeerId slave : slaves) tasks.push_back(serve(slave, is_ready));
  co_await join_all(std::move(tasks));
}

Task<void> serve_slaves(Host& host, std::vector<PeerId> slaves, StampSource stamps,
                        ServoSettings settings, ServeSlave serve) {
  const bool needs_card = stamps == StampSource::kCard;
  if (needs_card && host.hardware_clock() == nullptr) co_return;
  auto is_ready = std::make_shared<bool>(!needs_card);
  std::vector<Task<void>> tasks;
  tasks.reserve(slaves.size() + 1);
  for (const PeerId slave : slaves) tasks.push_back(serve(slave, is_ready));
  if (needs_card) {
    tasks.push_back(keep_coupled(host, ClockKind::kHardware, settings, is_ready));
  }
  co_await join_all(std::move(tasks));
}

}  // namespace simbench
