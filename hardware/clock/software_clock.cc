#include "hardware/clock/software_clock.h"

#include <chrono>
#include <utility>

#include "hardware/clock/paired_reading.h"

namespace simbench::hardware {
namespace {

SystemTimeline begin_timeline(const SoftwareClock::Settings& settings) {
  const PairedReading begin = paired_reading(settings.system_clock, monotonic_now);
  return {settings.host, settings.oscillator, begin.at, begin.reads + settings.offset};
}

}  // namespace

HostTime read_system_clock() {
  return HostTime(
      std::chrono::duration_cast<Nanoseconds>(std::chrono::system_clock::now().time_since_epoch()));
}

SoftwareClock::SoftwareClock(boost::asio::io_context& context, Settings settings)
    : settings_(std::move(settings)),
      timeline_(begin_timeline(settings_)),
      settle_timer_(context) {}

Task<HostTime> SoftwareClock::now() { co_return timeline_.read(monotonic_now()); }

Task<void> SoftwareClock::set(HostTime value) {
  timeline_.set(monotonic_now(), value);
  settle_in_time();
  co_return;
}

Task<void> SoftwareClock::adjust_frequency(double ppb) {
  timeline_.adjust_frequency(monotonic_now(), ppb);
  settle_in_time();
  co_return;
}

Task<void> SoftwareClock::slew(Nanoseconds offset, double max_rate_ppb) {
  timeline_.slew(monotonic_now(), offset, max_rate_ppb);
  settle_in_time();
  co_return;
}

void SoftwareClock::observe(Observer observer) {
  observed_ = observer != nullptr;
  timeline_.observe(std::move(observer));
  settle_in_time();
}

void SoftwareClock::restart() {
  const PairedReading begin = paired_reading(settings_.system_clock, monotonic_now);
  timeline_.restart(begin.at, begin.reads + settings_.offset);
  settle_in_time();
}

void SoftwareClock::settle_in_time() {
  const std::optional<MonotonicTime> end = timeline_.settles_at();
  if (!end || !observed_) {
    settle_timer_.cancel();
    return;
  }
  settle_timer_.expires_at(for_timer(*end));
  settle_timer_.async_wait([this](const boost::system::error_code& error) {
    if (error) return;
    timeline_.settle(monotonic_now());
    settle_in_time();
  });
}

}  // namespace simbench::hardware
