#include "sim/rig/clock_sampling.h"

#include <algorithm>
#include <utility>

#include "algorithms/ports/assert.h"

namespace simbench::sim {
namespace {

constexpr std::int64_t kMaxSamplesBeforeZero = 1000;

}  // namespace

ClockSampling::ClockSampling(WorldObserver& observer, std::vector<SystemClock*> clocks,
                             const Engine& engine)
    : observer_(observer),
      clocks_(std::move(clocks)),
      engine_(engine),
      interval_(observer.clock_interval()),
      errors_(clocks_.size()) {
  SIMBENCH_ASSERT(interval_.count() >= 0, "an interval is not negative");
}

void ClockSampling::on_world(TrueTime start) {
  observer_.on_world(start);
  if (interval_.count() == 0) return;
  next_ = start;
  interval_before_zero_ = std::max(interval_, (TrueTime{} - start) / kMaxSamplesBeforeZero);
}

void ClockSampling::on_capture_start(TrueTime at) {
  sample_until(engine_.now());
  observer_.on_capture_start(at);
}

void ClockSampling::on_pulse(const ObservedPulse& pulse) { observer_.on_pulse(pulse); }

void ClockSampling::on_frame(const ObservedFrame& frame) { observer_.on_frame(frame); }

void ClockSampling::on_message(const ObservedMessage& message) {
  sample_until(engine_.now());
  observer_.on_message(message);
}

void ClockSampling::on_clocks(TrueTime at, std::span<const Nanoseconds> errors) {
  observer_.on_clocks(at, errors);
}

void ClockSampling::finish() { sample_until(engine_.now() + Nanoseconds(1)); }

void ClockSampling::sample_until(TrueTime end) {
  while (next_ < end) {
    sample();
    next_ = next_ < TrueTime{} ? std::min(next_ + interval_before_zero_, TrueTime{})
                               : next_ + interval_;
  }
}

void ClockSampling::sample() {
  read_errors(clocks_, next_, errors_);
  on_clocks(next_, errors_);
}

}  // namespace simbench::sim
