#include "sim/programs/card_clock.h"

#include <cerrno>
#include <cmath>
#include <cstdlib>

namespace simbench::sim {
namespace {

constexpr double kPpbPerUnit = 1e3 / 65536;
// Larger steps are refused: no clock is off by 30 years.
constexpr long kMostCardSeconds = 1'000'000'000;

}  // namespace

Task<CardClock::Reading> CardClock::read() {
  NicClock* clock = host_.nic();
  if (clock == nullptr) co_return Reading{.error = EOPNOTSUPP};
  const CrossStamp stamp = co_await clock->cross_stamp();
  co_return Reading{.sample = {.before = epoch_ns(stamp.before),
                               .card = nanoseconds_of(stamp.hardware) + kEpochNs,
                               .after = epoch_ns(stamp.after)}};
}

Task<int> CardClock::set(std::int64_t ns) {
  NicClock* clock = host_.nic();
  if (clock == nullptr) co_return EOPNOTSUPP;
  if (std::abs(ns / kSecondNs - kEpochNs / kSecondNs) > kMostCardSeconds) co_return EINVAL;
  co_await clock->set(HardwareTime(Nanoseconds(ns - kEpochNs)));
  co_return 0;
}

int CardClock::refusal(const timex& request) const {
  if (host_.nic() == nullptr) return EOPNOTSUPP;
  if ((request.modes & ADJ_SETOFFSET) != 0) {
    const long parts = (request.modes & ADJ_NANO) != 0 ? 1'000'000'000 : 1'000'000;
    const bool is_time = request.time.tv_usec >= 0 && request.time.tv_usec < parts;
    return is_time && std::abs(request.time.tv_sec / 2) <= kMostCardSeconds / 2 ? 0 : EINVAL;
  }
  if ((request.modes & ADJ_FREQUENCY) != 0) {
    const double ppb = std::abs(static_cast<double>(request.freq) * kPpbPerUnit);
    return ppb <= std::round(host_.nic()->max_frequency_ppb()) ? 0 : ERANGE;
  }
  return request.modes == 0 ? 0 : EOPNOTSUPP;
}

Task<KernelClock::Answer> CardClock::adjust(timex request) {
  KernelClock::Answer answer{.state = 0, .error = refusal(request), .now = request};
  if (answer.error != 0) co_return answer;
  NicClock& clock = *host_.nic();
  if ((request.modes & ADJ_SETOFFSET) != 0) {
    const std::int64_t unit_ns = (request.modes & ADJ_NANO) != 0 ? 1 : 1'000;
    co_await clock.step(
        Nanoseconds(request.time.tv_sec * kSecondNs + request.time.tv_usec * unit_ns));
  } else if ((request.modes & ADJ_FREQUENCY) != 0) {
    frequency_ = request.freq;
    co_await clock.adjust_frequency(static_cast<double>(request.freq) * kPpbPerUnit);
  } else {
    answer.now.freq = frequency_;
  }
  co_return answer;
}

}  // namespace simbench::sim
