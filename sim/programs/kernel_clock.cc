#include "sim/programs/kernel_clock.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>

namespace simbench::sim {
namespace {

constexpr long kMostFrequency = 500L << 16;
constexpr double kAdjtimeRate = 500e3;  // ppb
constexpr int kReadOnlyStatus = STA_RONLY;

bool is_single_shot(const timex& request) {
  return (request.modes & ADJ_OFFSET_SINGLESHOT) == ADJ_OFFSET_SINGLESHOT;
}

// Larger steps and slews are refused: no clock is off by 30 years.
constexpr long kMostSeconds = 1'000'000'000;

int refusal(const timex& request) {
  if (is_single_shot(request)) {
    const unsigned known = ADJ_OFFSET_SINGLESHOT | ADJ_OFFSET_SS_READ;
    if (std::abs(request.offset / 1'000'000) > kMostSeconds) return EINVAL;
    return (request.modes & ~known) == 0 ? 0 : EINVAL;
  }
  if ((request.modes & ADJ_TICK) != 0 && (request.tick < 9'000 || request.tick > 11'000)) {
    return EINVAL;
  }
  if ((request.modes & ADJ_SETOFFSET) != 0) {
    const long parts = (request.modes & ADJ_NANO) != 0 ? 1'000'000'000 : 1'000'000;
    if (request.time.tv_usec < 0 || request.time.tv_usec >= parts) return EINVAL;
    if (std::abs(request.time.tv_sec / 2) > kMostSeconds / 2) return EINVAL;
  }
  return 0;
}

constexpr long kMostErrorUs = 16'000'000;

}  // namespace

KernelClock::KernelClock(Host& host) : host_(host) {}

double KernelClock::rate_ppb() const {
  return static_cast<double>(frequency_) * 1e3 / 65536 + static_cast<double>(tick_ - 10'000) * 1e5;
}

void KernelClock::keep(const timex& request) {
  const unsigned modes = request.modes;
  if ((modes & ADJ_STATUS) != 0) {
    status_ = (status_ & kReadOnlyStatus) | (request.status & ~kReadOnlyStatus);
  }
  if ((modes & ADJ_NANO) != 0) status_ |= STA_NANO;
  if ((modes & ADJ_MICRO) != 0) status_ &= ~STA_NANO;
  if ((modes & ADJ_FREQUENCY) != 0) {
    frequency_ = std::clamp(request.freq, -kMostFrequency, kMostFrequency);
  }
  if ((modes & ADJ_MAXERROR) != 0) max_error_us_ = request.maxerror;
  if ((modes & ADJ_ESTERROR) != 0) estimated_error_us_ = request.esterror;
  if ((modes & ADJ_TIMECONST) != 0) time_constant_ = std::clamp(request.constant, 0L, 10L);
  if ((modes & ADJ_TAI) != 0) tai_s_ = static_cast<int>(request.constant);
  if ((modes & ADJ_TICK) != 0) tick_ = request.tick;
}

Task<KernelClock::Answer> KernelClock::adjust(timex request) {
  Answer answer{.error = refusal(request), .now = request};
  if (answer.error == 0 && is_single_shot(request)) {
    const bool is_reading = (request.modes & ADJ_OFFSET_SS_READ) == ADJ_OFFSET_SS_READ;
    if (!is_reading) co_await host_.clock().slew(Nanoseconds(request.offset * 1'000), kAdjtimeRate);
  } else if (answer.error == 0) {
    if ((request.modes & ADJ_SETOFFSET) != 0) co_await step(request);
    const double before_ppb = rate_ppb();
    keep(request);
    if (rate_ppb() != before_ppb) co_await host_.clock().adjust_frequency(rate_ppb());
    // The kernel takes an offset only while its loop is on; 0 leaves nothing to do.
    const bool is_loop = (request.modes & ADJ_OFFSET) != 0 && (status_ & STA_PLL) != 0;
    if (is_loop && request.offset != 0) answer.error = EOPNOTSUPP;
  }
  const HostTime reading = co_await host_.clock().now();
  fill(answer, reading);
  co_return answer;
}

void KernelClock::was_set() {
  status_ |= STA_UNSYNC;
  max_error_us_ = kMostErrorUs;
  estimated_error_us_ = kMostErrorUs;
}

Task<void> KernelClock::step(timex request) {
  const bool is_nano = (request.modes & ADJ_NANO) != 0;
  const Nanoseconds by(request.time.tv_sec * kSecondNs +
                       request.time.tv_usec * (is_nano ? 1 : 1'000));
  const HostTime now = co_await host_.clock().now();
  co_await host_.clock().set(now + by);
  was_set();
}

void KernelClock::fill(Answer& answer, HostTime reading) const {
  answer.state = (status_ & STA_UNSYNC) != 0 ? TIME_ERROR : TIME_OK;
  const std::int64_t now_ns = epoch_ns(reading);
  timex& now = answer.now;
  now.offset = 0;
  now.freq = frequency_;
  now.maxerror = max_error_us_;
  now.esterror = estimated_error_us_;
  now.status = status_;
  now.constant = time_constant_;
  now.precision = 1;
  now.tolerance = kMostFrequency;
  now.tick = tick_;
  now.tai = tai_s_;
  now.time.tv_sec = floor_div(now_ns, kSecondNs);
  const std::int64_t part_ns = now_ns - now.time.tv_sec * kSecondNs;
  now.time.tv_usec = (status_ & STA_NANO) != 0 ? part_ns : part_ns / 1'000;
}

}  // namespace simbench::sim
