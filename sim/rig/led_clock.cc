#include "sim/rig/led_clock.h"

#include <cstddef>

#include "algorithms/ports/assert.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kLedReading("led_clock/reading");

std::vector<double> rows_of_board(const scenarios::Scenario& scenario, std::uint64_t seed) {
  const double spread = scenario.cameras.led_clock->row_spread_share;
  const auto cameras = static_cast<std::size_t>(scenario.cameras.count);
  std::vector<double> rows;
  rows.reserve(cameras);
  for (std::size_t camera = 0; camera < cameras; ++camera) {
    RandomStream row(seed, "led_clock/row", camera);
    rows.push_back(0.5 + spread * (row.uniform() - 0.5));
  }
  return rows;
}

}  // namespace

LedClock::LedClock(const scenarios::Scenario& scenario, std::uint64_t seed, TrueTime last_exposure)
    : model_(*scenario.cameras.led_clock),
      scored_(scenario.evaluation.stream),
      step_(from_ms(model_.step_ms)),
      interval_(from_ms(model_.interval_ms)),
      first_end_(TrueTime{} + from_ms(model_.first_ms)),
      last_begin_(last_exposure - from_ms(model_.last_ms)),
      readings_(seed, kLedReading),
      skew_(RandomStream(seed, "led_clock/skew").normal(model_.skew_sigma_ppm * 1e-6)),
      rows_(rows_of_board(scenario, seed)),
      next_look_(rows_.size(), TrueTime::min()) {
  RandomStream zero(seed, "led_clock/zero");
  zero_ = from_ns(zero.uniform(1, 2) * to_ns(kRing * step_));
}

Nanoseconds LedClock::at(TrueTime time) const {
  const Nanoseconds elapsed = time.time_since_epoch();
  return zero_ + elapsed + from_ns(to_ns(elapsed) * skew_);
}

bool LedClock::is_in_view(TrueTime time) const {
  const bool always = model_.first_ms == 0 && model_.last_ms == 0;
  return always || time < first_end_ || (model_.last_ms > 0 && time >= last_begin_);
}

bool LedClock::looks(std::uint32_t camera, TrueTime time) {
  if (!is_in_view(time) || time < next_look_[camera]) return false;
  if (interval_ > Nanoseconds(0)) {
    const std::int64_t looked = floor_div(time.time_since_epoch().count(), interval_.count());
    next_look_[camera] = TrueTime{} + (looked + 1) * interval_;
  }
  return true;
}

std::optional<LitArc> LedClock::read(const SimFrame& frame, Nanoseconds readout) {
  SIMBENCH_ASSERT(frame.camera < rows_.size(), "a frame of a camera of this world");
  if (frame.kind != scored_ || !looks(frame.camera, frame.mid_exposure())) return std::nullopt;
  const Nanoseconds from_first_row = from_ns(rows_[frame.camera] * to_ns(readout));
  const Nanoseconds start = at(frame.exposure_start + from_first_row);
  const Nanoseconds end = at(frame.exposure_end - (readout - from_first_row));
  const std::int64_t first = floor_div(start.count(), step_.count());
  const std::int64_t last = floor_div(end.count() - 1, step_.count());
  // RocSync rejects starts up to LED 1 and ends from LED 99 on.
  const std::int64_t turn = floor_div(first, kRing);
  const bool is_legible =
      first - turn * kRing > 1 && last - turn * kRing < kRing - 1 && last >= first;
  RandomStream draw = readings_.of(frame.camera).stream(frame.counter);
  if (draw.chance(model_.missed_probability) || !is_legible) return std::nullopt;
  std::int64_t wrong_steps = 0;
  if (draw.chance(model_.wrong_probability)) wrong_steps = draw.chance(0.5) ? kRing : -kRing;
  return LitArc{.start = (first + wrong_steps) * step_, .end = (last + 1 + wrong_steps) * step_};
}

}  // namespace simbench::sim
