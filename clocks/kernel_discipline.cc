#include "clocks/kernel_discipline.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdlib>

namespace simbench::clocks {
namespace {

constexpr long kMostFrequency = 500L << 16;
constexpr double kFrequencyUnits = 65536e6;  // in a rate of 1
constexpr long kMostAdjtimeUs = 500;         // a second
constexpr long kMostErrorUs = 16'000'000;
constexpr long kErrorGrowthUs = 500;  // a second
constexpr int kMostTaiS = 100'000;
constexpr std::int64_t kDayS = 86'400;
constexpr int kFirstConstant = 2;

bool has(const timex& request, unsigned modes) { return (request.modes & modes) != 0; }

bool is_single_shot(const timex& request) {
  return (request.modes & ADJ_OFFSET_SINGLESHOT) == ADJ_OFFSET_SINGLESHOT;
}

bool is_read_of_single_shot(const timex& request) {
  return (request.modes & ADJ_OFFSET_SS_READ) == ADJ_OFFSET_SS_READ;
}

// Larger steps and slews are refused: no clock is off by 30 years.
constexpr long kMostSeconds = 1'000'000'000;

Nanoseconds step_of(const timex& request) {
  const std::int64_t unit_ns = has(request, ADJ_NANO) ? 1 : 1'000;
  return Nanoseconds(request.time.tv_sec * kSecondNs + request.time.tv_usec * unit_ns);
}

// ADJ_FREQUENCY's and ADJ_TICK's part of the rate.
double rate_ppb_of(double frequency, long tick) {
  return frequency * 1e9 + static_cast<double>(tick - 10'000) * 1e5;
}

double fraction_of(long frequency) {
  return static_cast<double>(std::clamp(frequency, -kMostFrequency, kMostFrequency)) /
         kFrequencyUnits;
}

// The numbers of adjtimex() are rounded down; one that was set reads as it was.
long whole(double value) { return static_cast<long>(std::floor(value + 1e-6)); }

}  // namespace

KernelDiscipline::KernelDiscipline(std::int64_t reading_ns)
    : second_(floor_div(reading_ns, kSecondNs)) {
  loop_.set_constant(kFirstConstant);
}

int KernelDiscipline::refusal(const timex& request) {
  if (is_single_shot(request)) {
    const unsigned known = ADJ_OFFSET_SINGLESHOT | ADJ_OFFSET_SS_READ;
    if (std::abs(request.offset / 1'000'000) > kMostSeconds) return EINVAL;
    return (request.modes & ~known) == 0 ? 0 : EINVAL;
  }
  if (has(request, ADJ_TICK) && (request.tick < 9'000 || request.tick > 11'000)) return EINVAL;
  if (has(request, ADJ_SETOFFSET)) {
    const long parts = has(request, ADJ_NANO) ? 1'000'000'000 : 1'000'000;
    if (request.time.tv_usec < 0 || request.time.tv_usec >= parts) return EINVAL;
    if (std::abs(request.time.tv_sec / 2) > kMostSeconds / 2) return EINVAL;
  }
  return 0;
}

bool KernelDiscipline::changes_clock(const timex& request) const {
  if (is_single_shot(request)) return !is_read_of_single_shot(request);
  const int status = has(request, ADJ_STATUS) ? request.status : status_;
  const double frequency =
      has(request, ADJ_FREQUENCY) ? fraction_of(request.freq) : loop_.frequency();
  const long tick = has(request, ADJ_TICK) ? request.tick : tick_;
  return has(request, ADJ_SETOFFSET) || (has(request, ADJ_OFFSET) && (status & STA_PLL) != 0) ||
         rate_ppb_of(frequency, tick) != base_rate_ppb();
}

void KernelDiscipline::apply(const timex& request, AdjustedClock& clock) {
  move_on(clock);
  const bool only_stops_adjtime = is_single_shot(request) && request.offset == 0;
  if (changes_clock(request) && !only_stops_adjtime) was_steered_ = true;
  if (is_single_shot(request)) {
    if (!is_read_of_single_shot(request)) adjtime_left_us_ = request.offset;
  } else {
    if (has(request, ADJ_SETOFFSET)) {
      clock.leap(step_of(request));
      forget(clock);
    }
    keep(request);
    give_rate(clock);
  }
}

void KernelDiscipline::keep(const timex& request) {
  if (has(request, ADJ_STATUS)) set_status(request.status);
  if (has(request, ADJ_NANO)) status_ |= STA_NANO;
  if (has(request, ADJ_MICRO)) status_ &= ~STA_NANO;
  if (has(request, ADJ_FREQUENCY)) loop_.set_frequency(fraction_of(request.freq));
  if (has(request, ADJ_MAXERROR)) max_error_us_ = std::clamp(request.maxerror, 0L, kMostErrorUs);
  if (has(request, ADJ_ESTERROR)) {
    estimated_error_us_ = std::clamp(request.esterror, 0L, kMostErrorUs);
  }
  if (has(request, ADJ_TIMECONST)) {
    const long constant = std::clamp(request.constant, 0L, long{KernelLoop::kMaxConstant});
    loop_.set_constant(static_cast<int>(constant) + ((status_ & STA_NANO) != 0 ? 0 : 4));
  }
  if (has(request, ADJ_TAI) && request.constant >= 0 && request.constant <= kMostTaiS) {
    tai_s_ = static_cast<int>(request.constant);
  }
  if (has(request, ADJ_OFFSET)) update_offset(request.offset);
  if (has(request, ADJ_TICK)) tick_ = request.tick;
}

void KernelDiscipline::set_status(int status) {
  if ((status_ & STA_PLL) != 0 && (status & STA_PLL) == 0) {
    status_ = STA_UNSYNC;
    leap_state_ = TIME_OK;
    leap_at_s_.reset();
  }
  if ((status_ & STA_PLL) == 0 && (status & STA_PLL) != 0) reference_s_ = second_;
  status_ = (status_ & STA_RONLY) | (status & ~STA_RONLY);
}

void KernelDiscipline::update_offset(long offset) {
  if ((status_ & STA_PLL) == 0) return;
  constexpr long kMost = 1'000'000'000;
  const double unit = (status_ & STA_NANO) != 0 ? 1e-9 : 1e-6;
  const double offset_s = static_cast<double>(std::clamp(offset, -kMost, kMost)) * unit;
  const bool is_held = (status_ & STA_FREQHOLD) != 0;
  const auto passed_s = static_cast<double>(second_ - reference_s_);
  reference_s_ = second_;
  const KernelLoop::Mode mode =
      loop_.update(offset_s, is_held ? 0 : passed_s, (status_ & STA_FLL) != 0);
  status_ = (status_ & ~STA_MODE) | (mode == KernelLoop::Mode::kFll ? STA_MODE : 0);
}

void KernelDiscipline::forget(AdjustedClock& clock) {
  was_steered_ = true;
  loop_.clear();
  adjtime_left_us_ = 0;
  second_rate_ppb_ = 0;
  leap_at_s_.reset();
  status_ |= STA_UNSYNC;
  max_error_us_ = estimated_error_us_ = kMostErrorUs;
  second_ = floor_div(clock.epoch_ns(), kSecondNs);
  give_rate(clock);
}

double KernelDiscipline::base_rate_ppb() const { return rate_ppb_of(loop_.frequency(), tick_); }

void KernelDiscipline::give_rate(AdjustedClock& clock) {
  const double rate_ppb = base_rate_ppb() + second_rate_ppb_;
  if (rate_ppb == given_rate_ppb_) return;
  given_rate_ppb_ = rate_ppb;
  clock.adjust_frequency(rate_ppb);
}

// Its seconds.

bool KernelDiscipline::is_moving() const {
  return loop_.next_part_s() != 0 || adjtime_left_us_ != 0 || second_rate_ppb_ != 0 ||
         leap_state_ != TIME_OK || (status_ & (STA_INS | STA_DEL)) != 0;
}

void KernelDiscipline::move_on(AdjustedClock& clock) {
  const std::int64_t now_s = floor_div(clock.epoch_ns(), kSecondNs);
  const std::int64_t passed_s = now_s - second_;
  second_ = now_s;
  if (passed_s <= 0)
    return;  // also after a leap second of the world, which the kernel does not see
  grow_error(passed_s);
  if (is_moving()) begin_second(clock);
}

void KernelDiscipline::begin_second(AdjustedClock& clock) {
  if (const int seconds = leap(); seconds != 0) {
    clock.leap(std::chrono::seconds(seconds));
    second_ += seconds;
    tai_s_ -= seconds;
  }
  const long adjtime_us = std::clamp(adjtime_left_us_, -kMostAdjtimeUs, kMostAdjtimeUs);
  adjtime_left_us_ -= adjtime_us;
  second_rate_ppb_ = loop_.next_second() * 1e9 + static_cast<double>(adjtime_us) * 1e3;
  give_rate(clock);
}

void KernelDiscipline::grow_error(std::int64_t seconds) {
  const std::int64_t grown_us = max_error_us_ + std::min(seconds, kMostErrorUs) * kErrorGrowthUs;
  if (grown_us > kMostErrorUs) status_ |= STA_UNSYNC;
  max_error_us_ = std::min(grown_us, kMostErrorUs);
}

int KernelDiscipline::leap() {
  switch (leap_state_) {
    case TIME_OK:
      // An inserted second comes before midnight, a deleted one is the last before it.
      if ((status_ & STA_INS) != 0) {
        leap_state_ = TIME_INS;
        leap_at_s_ = (floor_div(second_, kDayS) + 1) * kDayS;
      } else if ((status_ & STA_DEL) != 0) {
        leap_state_ = TIME_DEL;
        leap_at_s_ = (floor_div(second_ + 1, kDayS) + 1) * kDayS - 1;
      }
      return 0;
    case TIME_INS:
      return leap_at(STA_INS);
    case TIME_DEL:
      return leap_at(STA_DEL);
    case TIME_OOP:
      leap_state_ = TIME_WAIT;
      leap_at_s_.reset();
      return 0;
    default:
      if ((status_ & (STA_INS | STA_DEL)) == 0) leap_state_ = TIME_OK;
      return 0;
  }
}

int KernelDiscipline::leap_at(int wanted) {
  if ((status_ & wanted) == 0) {
    leap_state_ = TIME_OK;
    leap_at_s_.reset();
    return 0;
  }
  if (second_ != leap_at_s_) return 0;
  leap_state_ = wanted == STA_INS ? TIME_OOP : TIME_WAIT;
  leap_at_s_.reset();
  return wanted == STA_INS ? -1 : 1;
}

int KernelDiscipline::read(std::int64_t reading_ns, const timex& request, long adjtime_before_us,
                           timex& now) const {
  const bool is_nano = (status_ & STA_NANO) != 0;
  const long offset_ns = whole(loop_.offset_s() * 1e9);
  now.offset = is_nano ? offset_ns : offset_ns / 1'000;
  if (is_single_shot(request)) now.offset = adjtime_before_us;
  now.freq = whole(loop_.frequency() * kFrequencyUnits);
  now.maxerror = max_error_us_;
  now.esterror = estimated_error_us_;
  now.status = status_;
  now.constant = loop_.constant();
  now.precision = 1;
  now.tolerance = kMostFrequency;
  now.tick = tick_;
  now.tai = tai_s_;
  now.time.tv_sec = floor_div(reading_ns, kSecondNs);
  const std::int64_t part_ns = reading_ns - now.time.tv_sec * kSecondNs;
  now.time.tv_usec = is_nano ? part_ns : part_ns / 1'000;
  return (status_ & (STA_UNSYNC | STA_CLOCKERR)) != 0 ? TIME_ERROR : leap_state_;
}

}  // namespace simbench::clocks
