#include "sim/host/clock_port.h"

#include <algorithm>
#include <utility>

namespace simbench::sim {

ClockPort::ClockPort(const Parts& parts, const ClockInterface& interface, double set_cost_factor,
                     RandomStream draws, const std::string& host_name)
    : parts_(parts),
      interface_(interface),
      read_cost_(from_ms(parts.parameters.read_cost_ms)),
      set_cost_ms_(parts.parameters.set_cost_ms * set_cost_factor),
      draws_(std::move(draws)),
      get_label_(host_name + ": get clock"),
      set_label_(host_name + ": set clock") {}

Task<HostTime> ClockPort::now() {
  const Cpu::Turn turn = parts_.cpu.reserve(read_cost_);
  if (turn.end > true_now()) co_await sleep_until(parts_.context, turn.end, get_label_);
  co_return interface_.read(parts_.clock.read(turn.start));
}

Task<void> ClockPort::set(HostTime value) {
  const Change change = begin_change();
  if (change.effective > true_now()) {
    co_await sleep_until(parts_.context, change.effective, set_label_);
  }
  parts_.clock.set(true_now(), interface_.set_to(value));
  if (change.end > true_now()) co_await sleep_until(parts_.context, change.end, set_label_);
}

Task<void> ClockPort::adjust_frequency(double ppb) {
  const Change change = begin_change();
  if (change.effective > true_now()) {
    co_await sleep_until(parts_.context, change.effective, set_label_);
  }
  parts_.clock.adjust_frequency(true_now(), ppb);
  settle_in_time();
  if (change.end > true_now()) co_await sleep_until(parts_.context, change.end, set_label_);
}

Task<void> ClockPort::slew(Nanoseconds offset, double max_rate_ppb) {
  const Change change = begin_change();
  if (change.effective > true_now()) {
    co_await sleep_until(parts_.context, change.effective, set_label_);
  }
  parts_.clock.slew(true_now(), offset, max_rate_ppb);
  settle_in_time();
  if (change.end > true_now()) co_await sleep_until(parts_.context, change.end, set_label_);
}

ClockPort::Change ClockPort::begin_change() {
  const double cost_ms = set_cost_ms_ * draws_.lognormal(parts_.parameters.set_cost_call_log_sigma);
  const Cpu::Turn turn = parts_.cpu.reserve(from_ms(cost_ms));
  const Nanoseconds until_effective = from_ms(cost_ms * parts_.parameters.set_effective_fraction);
  return {std::min(turn.start + until_effective, turn.end), turn.end};
}

void ClockPort::settle_in_time() {
  const std::optional<TrueTime> end = parts_.clock.settles_at();
  if (!end) return;
  Engine& engine = parts_.context.engine();
  engine.call_at(*end, [&engine, &clock = parts_.clock] { clock.settle(engine.now()); });
}

}  // namespace simbench::sim
