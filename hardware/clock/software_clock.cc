#include "hardware/clock/software_clock.h"

#include <boost/random/normal_distribution.hpp>
#include <chrono>
#include <cmath>
#include <random>
#include <thread>
#include <utility>

namespace simbench::hardware {
namespace {

// Past adjustments under which stamps can still be read.
constexpr std::size_t kHistory = 64;

clocks::DisciplinedClock<NodeOscillator> begin_clock(const SoftwareClock::Settings& settings) {
  const PairedReading begin = paired_reading(settings.system_clock, monotonic_now);
  return {settings.host, settings.oscillator, begin.at, begin.reads + settings.offset, kHistory};
}

// Blocks the thread. A sleep ends too late by what waking takes, so the end of it is spent waiting.
void block_until(MonotonicTime at) {
  constexpr Nanoseconds kWakeUp = std::chrono::microseconds(300);
  if (const Nanoseconds left = at - monotonic_now(); left > kWakeUp) {
    std::this_thread::sleep_for(left - kWakeUp);
  }
  while (monotonic_now() < at) {
  }
}

}  // namespace

SoftwareClock::SoftwareClock(boost::asio::io_context& context, Settings settings)
    : settings_(std::move(settings)),
      clock_(begin_clock(settings_)),
      costs_(std::random_device{}()),
      settle_timer_(context) {}

Task<HostTime> SoftwareClock::now() { co_return clock_.read(monotonic_now()); }

template <class Change>
void SoftwareClock::change(const Change& apply) {
  const SetCost& cost = settings_.set_cost;
  if (cost.cost_ms <= 0) {
    apply(monotonic_now());
  } else {
    boost::random::normal_distribution<double> normal;
    const double cost_ms = cost.cost_ms * std::exp(cost.log_sigma * normal(costs_));
    const MonotonicTime begin = monotonic_now();
    block_until(begin + from_ms(cost_ms * cost.effective_fraction));
    apply(monotonic_now());
    block_until(begin + from_ms(cost_ms));
  }
  settle_in_time();
}

Task<void> SoftwareClock::set(HostTime value) {
  change([&](MonotonicTime at) { clock_.set(at, value); });
  co_return;
}

Task<void> SoftwareClock::adjust_frequency(double ppb) {
  change([&](MonotonicTime at) { clock_.adjust_frequency(at, ppb); });
  co_return;
}

Task<void> SoftwareClock::slew(Nanoseconds offset, double max_rate_ppb) {
  change([&](MonotonicTime at) { clock_.slew(at, offset, max_rate_ppb); });
  co_return;
}

std::int64_t SoftwareClock::Steered::epoch_ns() const {
  return nanoseconds_of(clock_.clock_.read(at_));
}

void SoftwareClock::Steered::leap(Nanoseconds offset) { clock_.clock_.leap(at_, offset); }

void SoftwareClock::Steered::adjust_frequency(double ppb) {
  clock_.clock_.adjust_frequency(at_, ppb);
}

void SoftwareClock::Steered::set(std::int64_t epoch_ns) {
  clock_.clock_.set(at_, HostTime(Nanoseconds(epoch_ns)));
}

void SoftwareClock::call(const Steer& steer) {
  change([&](MonotonicTime at) {
    Steered steered(*this, at);
    steer(steered);
  });
}

void SoftwareClock::steer(const Steer& steer) {
  Steered steered(*this, monotonic_now());
  steer(steered);
  settle_in_time();
}

void SoftwareClock::observe(Observer observer) {
  observed_ = observer != nullptr;
  clock_.observe(std::move(observer));
  settle_in_time();
}

void SoftwareClock::restart() {
  const PairedReading begin = paired_reading(settings_.system_clock, monotonic_now);
  clock_.restart(begin.at, begin.reads + settings_.offset);
  settle_in_time();
}

void SoftwareClock::settle_in_time() {
  const std::optional<MonotonicTime> end = clock_.settles_at();
  if (!end || !observed_) {
    settle_timer_.cancel();
    return;
  }
  settle_timer_.expires_at(for_timer(*end));
  settle_timer_.async_wait([this](const boost::system::error_code& error) {
    if (error) return;
    clock_.settle(monotonic_now());
    settle_in_time();
  });
}

}  // namespace simbench::hardware
