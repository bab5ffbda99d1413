#include "algorithms/host_sync/huygens/raw_clock.h"

#include <algorithm>

#include "algorithms/host_sync/cross_stamps.h"

namespace simbench {

Task<void> RawClock::watch() {
  while (is_card()) {
    const CrossStamp stamp = co_await narrowest_cross_stamp(host_);
    const HostTime middle = stamp.before + (stamp.after - stamp.before) / 2;
    if (!system_.is_known()) co_await system_.look();
    add(nanoseconds_of(stamp.hardware), system_.when(middle));
    co_await host_.sleep_for(kInterval);
  }
}

void RawClock::add(std::int64_t raw_ns, SteadyTime at) {
  seen_.push_back({.x = raw_ns, .y = nanoseconds_of(at) - raw_ns});
  if (seen_.size() > kCrossStamps) seen_.pop_front();
}

Task<std::optional<std::int64_t>> RawClock::departure(MessageChannel& channel, MessageId id,
                                                      SteadyTime begin) {
  return is_card() ? stamps_.departure(channel, id) : departure_by_system(channel, id, begin);
}

Task<std::optional<std::int64_t>> RawClock::departure_by_system(MessageChannel& channel,
                                                                MessageId id, SteadyTime begin) {
  const std::optional<std::int64_t> stamp = co_await stamps_.departure(channel, id);
  if (!stamp) co_return std::nullopt;
  const SteadyTime left = system_.when(HostTime(Nanoseconds(*stamp)));
  const SteadyTime now = host_.steady_clock().now();
  // It left between the two; beyond that is what the system clock's reading is uncertain by, and
  // where a call takes no time at all, half of the readings are. More than that was a step.
  const Nanoseconds uncertain = system_.uncertainty();
  if (left < begin - uncertain || left > now + uncertain) co_return std::nullopt;
  co_return nanoseconds_of(std::clamp(left, begin, now));
}

std::optional<std::int64_t> RawClock::arrival(const ReceivedMessage& message) {
  system_.observe(message.received, message.received_steady);
  if (!is_card()) return nanoseconds_of(message.received_steady);
  return stamps_.arrival(message);
}

std::optional<SteadyTime> RawClock::steady_at(std::int64_t raw_ns) const {
  if (!is_card()) return SteadyTime(Nanoseconds(raw_ns));
  if (seen_.empty()) return std::nullopt;
  const LinePoint last = seen_.back();
  LineSums sums(kCrossStamps);
  for (const LinePoint& point : seen_) sums.add({.x = point.x - last.x, .y = point.y - last.y});
  const double ahead = sums.line().at(raw_ns - last.x);
  return SteadyTime(Nanoseconds(raw_ns + last.y) + from_ns(ahead));
}

}  // namespace simbench
