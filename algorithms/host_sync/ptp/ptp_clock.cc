#include "algorithms/host_sync/ptp/ptp_clock.h"

#include <algorithm>

namespace simbench {
namespace {

constexpr int kStepCalls = 3;
// A step that is off by less is right.
constexpr Nanoseconds kStepTolerance{1'000};
constexpr Nanoseconds kStampTimeout{10'000'000};

// The system clock's lead over the steady clock.
Task<Nanoseconds> system_lead(Host& host) {
  const HostTime reading = co_await host.clock().now();
  co_return offset_between(reading, host.steady_clock().now());
}

ServoSettings servo_settings(const PtpSettings& settings, Nanoseconds interval) {
  return {.interval_s = to_seconds(interval),
          .max_frequency_ppb = settings.max_frequency_ppm * 1e3,
          .first_step_threshold_ns = settings.first_step_threshold_us * 1e3,
          .step_threshold_ns = settings.step_threshold_us * 1e3};
}

}  // namespace

Task<void> step_system_clock(Host& host, Nanoseconds offset) {
  const Nanoseconds before = co_await system_lead(host);
  const Nanoseconds wanted = before + offset;
  Nanoseconds lead = wanted;  // what to ask for, so that `wanted` comes of it
  for (int call = 0; call < kStepCalls; ++call) {
    const SteadyTime now = host.steady_clock().now();
    co_await host.clock().set(HostTime(now.time_since_epoch() + lead));
    const Nanoseconds reached = co_await system_lead(host);
    const Nanoseconds missing = wanted - reached;
    if (missing < kStepTolerance && -missing < kStepTolerance) co_return;
    lead += missing;
  }
}

Task<void> apply_answer(Host& host, ClockKind kind, ServoAnswer answer, Nanoseconds offset) {
  if (answer.state == ServoState::kUnlocked) co_return;
  if (kind == ClockKind::kSystem) {
    co_await host.clock().adjust_frequency(-answer.ppb);
    if (answer.state == ServoState::kJump) co_await step_system_clock(host, -offset);
    co_return;
  }
  co_await host.hardware_clock()->adjust_frequency(-answer.ppb);
  if (answer.state == ServoState::kJump) co_await host.hardware_clock()->step(-offset);
}

Task<std::optional<std::int64_t>> departure_stamp(Host& host, MessageChannel& channel, MessageId id,
                                                  ClockKind kind) {
  const SteadyTime deadline = host.steady_clock().now() + kStampTimeout;
  if (kind == ClockKind::kHardware) {
    const std::optional<HardwareTime> stamp =
        co_await channel.hardware_transmit_stamp(id, deadline);
    if (!stamp) co_return std::nullopt;
    co_return nanoseconds_of(*stamp);
  }
  const std::optional<HostTime> stamp = co_await channel.transmit_stamp(id, deadline);
  if (stamp) co_return nanoseconds_of(*stamp);
  const HostTime now = co_await host.clock().now();
  co_return nanoseconds_of(now);
}

std::optional<std::int64_t> arrival_stamp(const ReceivedMessage& message, ClockKind kind) {
  if (kind == ClockKind::kSystem) return nanoseconds_of(message.received);
  if (!message.received_hardware) return std::nullopt;
  return nanoseconds_of(*message.received_hardware);
}

std::unique_ptr<Servo> make_port_servo(const PtpSettings& settings) {
  const ServoSettings servo = servo_settings(settings, settings.sync_interval);
  if (settings.servo == ServoKind::kLinearRegression) {
    return std::make_unique<LinearRegressionServo>(servo);
  }
  return std::make_unique<PiServo>(
      settings.has_hardware_stamps ? PiServo::kHardwareStamps : PiServo::kSoftwareStamps, servo);
}

ClockCoupling::ClockCoupling(Host& host, ClockKind follower, const PtpSettings& settings)
    : host_(host),
      follower_(follower),
      servo_(PiServo::kHardwareStamps, servo_settings(settings, kInterval)) {}

Task<void> ClockCoupling::update() {
  CrossStamp best;
  Nanoseconds width = Nanoseconds::max();
  for (int i = 0; i < kCrossStamps; ++i) {
    const CrossStamp stamp = co_await host_.hardware_clock()->cross_stamp();
    if (stamp.after - stamp.before >= width) continue;
    best = stamp;
    width = stamp.after - stamp.before;
  }
  const HostTime system = best.before + width / 2;
  const Nanoseconds system_lead = offset_between(system, best.hardware);
  const bool system_follows = follower_ == ClockKind::kSystem;
  const Nanoseconds offset = system_follows ? system_lead : -system_lead;
  const std::int64_t local =
      system_follows ? nanoseconds_of(system) : nanoseconds_of(best.hardware);
  const ServoAnswer answer = servo_.sample(static_cast<double>(offset.count()), local, 1);
  co_await apply_answer(host_, follower_, answer, offset);
  if (answer.state != ServoState::kUnlocked) is_locked_ = true;
}

}  // namespace simbench
