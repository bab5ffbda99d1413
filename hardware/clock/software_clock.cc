#include "hardware/clock/software_clock.h"

#include <chrono>
#include <utility>

namespace simbench::hardware {
namespace {

// Past adjustments under which stamps can still be read.
constexpr std::size_t kHistory = 64;

clocks::DisciplinedClock<NodeOscillator> begin_clock(const SoftwareClock::Settings& settings) {
  const PairedReading begin = paired_reading(settings.system_clock, monotonic_now);
  return {settings.host, settings.oscillator, begin.at, begin.reads + settings.offset, kHistory};
}

}  // namespace

SoftwareClock::SoftwareClock(boost::asio::io_context& context, Settings settings)
    : settings_(std::move(settings)), clock_(begin_clock(settings_)), settle_timer_(context) {}

Task<HostTime> SoftwareClock::now() { co_return clock_.read(monotonic_now()); }

Task<void> SoftwareClock::set(HostTime value) {
  clock_.set(monotonic_now(), value);
  settle_in_time();
  co_return;
}

Task<void> SoftwareClock::adjust_frequency(double ppb) {
  clock_.adjust_frequency(monotonic_now(), ppb);
  settle_in_time();
  co_return;
}

Task<void> SoftwareClock::slew(Nanoseconds offset, double max_rate_ppb) {
  clock_.slew(monotonic_now(), offset, max_rate_ppb);
  settle_in_time();
  co_return;
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
