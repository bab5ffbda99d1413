#include "sim/programs/process_timers.h"

#include <algorithm>
#include <utility>

#include "sim/programs/kernel_clock.h"

namespace simbench::sim {
namespace {

using shim::Deadline;

// A system clock may be set while a program waits for it.
constexpr Nanoseconds kLookAgain = std::chrono::seconds(1);

std::int64_t now_of(const SimHost& host, Deadline clock) {
  return clock == Deadline::kAtSystemTime ? epoch_ns(host.system_clock().read(host.true_now()))
                                          : monotonic_ns(host.steady_clock().now());
}

TrueTime look_at_system_time(const SimHost& host, std::int64_t at) {
  const HostTime wanted = from_epoch_ns(at);
  const SystemClock& clock = host.system_clock();
  if (wanted > clock.read(host.true_now()) + kLookAgain) return host.true_now() + kLookAgain;
  return clock.when(wanted, host.true_now());
}

}  // namespace

WakeTime wake_time(const SimHost& host, Deadline kind, std::int64_t at) {
  const std::int64_t limited = std::clamp(at, std::int64_t{0}, kFarthestNs);
  if (kind != Deadline::kAfter) return {kind, limited};
  return {Deadline::kAtMonotonicTime, now_of(host, Deadline::kAtMonotonicTime) + limited};
}

bool is_past(const SimHost& host, const WakeTime& time) {
  return time.clock != Deadline::kNever && now_of(host, time.clock) >= time.at;
}

std::int64_t left_ns(const SimHost& host, const WakeTime& time) {
  if (time.clock == Deadline::kNever) return kFarthestNs;
  return std::max(std::int64_t{0}, time.at - now_of(host, time.clock));
}

std::optional<TrueTime> next_look(const SimHost& host, const WakeTime& time) {
  switch (time.clock) {
    case Deadline::kNever:
      return std::nullopt;
    case Deadline::kAtSystemTime:
      return look_at_system_time(host, time.at);
    default:
      return host.next_look(from_monotonic_ns(time.at));
  }
}

void ProcessTimer::set(const shim::TimerSetting& setting, bool is_absolute) {
  interval_ = std::min(setting.interval, kFarthestNs);
  expirations_ = 0;
  const Deadline own = is_system_ ? Deadline::kAtSystemTime : Deadline::kAtMonotonicTime;
  const Deadline kind = setting.left == 0 ? Deadline::kNever : is_absolute ? own : Deadline::kAfter;
  next_ = wake_time(*host_, kind, setting.left);
}

shim::TimerSetting ProcessTimer::setting() {
  expire();
  const bool is_armed = next_.clock != Deadline::kNever;
  return {.left = is_armed ? left_ns(*host_, next_) : 0, .interval = interval_};
}

std::int64_t ProcessTimer::expirations() {
  expire();
  return expirations_;
}

std::int64_t ProcessTimer::take() {
  expire();
  return std::exchange(expirations_, 0);
}

std::optional<TrueTime> ProcessTimer::next_look() const { return sim::next_look(*host_, next_); }

void ProcessTimer::expire() {
  if (!is_past(*host_, next_)) return;
  const std::int64_t late = now_of(*host_, next_.clock) - next_.at;
  const std::int64_t times = interval_ > 0 ? late / interval_ + 1 : 1;
  expirations_ += times;
  next_.at += times * interval_;
  if (interval_ == 0) next_.clock = Deadline::kNever;
}

}  // namespace simbench::sim
