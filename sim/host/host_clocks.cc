#include "sim/host/host_clocks.h"

#include <algorithm>
#include <utility>

#include "sim/clock/clock_interface.h"
#include "sim/host/sim_host.h"

namespace simbench::sim {
namespace {

constexpr double kEpochMaxMs = 3.6e6;

const scenarios::Nic& nic_of(const SimHost& host) { return host.world().hosts.nic; }

OscillatorModel oscillator_of(const SimHost& host) {
  RandomStream draw(host.world().run_seed, host.name("network card's oscillator"));
  return OscillatorModel(draw.normal(nic_of(host).skew_sigma_ppm * 1e-6));
}

Nanoseconds epoch_of(const SimHost& host) {
  RandomStream draw(host.world().run_seed, host.name("network card's epoch"));
  return from_ms(draw.uniform(0, kEpochMaxMs));
}

}  // namespace

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

Task<void> ClockPort::change(Apply apply) {
  const Change change = begin_change();
  if (change.effective > true_now()) {
    co_await sleep_until(parts_.context, change.effective, set_label_);
  }
  apply(parts_.clock, true_now());
  settle_in_time();
  if (change.end > true_now()) co_await sleep_until(parts_.context, change.end, set_label_);
}

Task<void> ClockPort::set(HostTime value) {
  const HostTime rounded = interface_.set_to(value);
  return change([rounded](SystemClock& clock, TrueTime at) { clock.set(at, rounded); });
}

Task<void> ClockPort::adjust_frequency(double ppb) {
  return change([ppb](SystemClock& clock, TrueTime at) { clock.adjust_frequency(at, ppb); });
}

Task<void> ClockPort::slew(Nanoseconds offset, double max_rate_ppb) {
  return change([offset, max_rate_ppb](SystemClock& clock, TrueTime at) {
    clock.slew(at, offset, max_rate_ppb);
  });
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
  parts_.context.engine().call_at(*end, [this] { settle(); });
}

void ClockPort::settle() {
  // An event of an older slew is none of the present one's.
  const bool is_due = parts_.clock.settles_at() == true_now();
  parts_.clock.settle(true_now());
  if (is_due) settle_in_time();
}

NicClock::NicClock(SimHost& host)
    : host_(host),
      clock_(host.id(), oscillator_of(host), epoch_of(host)),
      resolution_(from_ns(nic_of(host).stamp_resolution_ns)),
      read_noise_(host.world().run_seed, host.name("network card's readings")),
      bus_noise_(host.world().run_seed, host.name("network card's bus")),
      label_(host.name("network card's clock")) {}

NicClock::Call NicClock::begin_call() {
  const Cpu::Turn turn = host_.cpu().reserve(from_ms(nic_of(host_).cross_stamp_cost_ms));
  return {turn, turn.start + (turn.end - turn.start) / 2};
}

NicClock::Call NicClock::begin_cross_stamp() {
  const scenarios::Nic& nic = nic_of(host_);
  const double spike_us =
      bus_noise_.chance(nic.cross_stamp_spike_probability) ? nic.cross_stamp_spike_max_us : 0;
  const Nanoseconds before = from_us(bus_noise_.uniform(0, spike_us / 2));
  const Nanoseconds after = from_us(bus_noise_.uniform(0, spike_us / 2));
  const Nanoseconds late = from_us(bus_noise_.exponential(nic.cross_stamp_exponential_us));
  const Nanoseconds cost = from_ms(nic.cross_stamp_cost_ms);
  const Cpu::Turn turn = host_.cpu().reserve(before + cost + after);
  const TrueTime middle = turn.start + before + cost / 2;
  return {turn, std::min(middle + late, turn.end)};
}

Task<void> NicClock::wait_until(TrueTime at) {
  if (at > host_.true_now()) co_await sleep_until(host_.world().context, at, label_);
}

Task<CrossStamp> NicClock::cross_stamp() {
  const Call call = begin_cross_stamp();
  co_await wait_until(call.turn.end);
  const SystemClock& system = host_.system_clock();
  const ClockInterface& interface = host_.clock_interface();
  co_return CrossStamp{.before = interface.tick_of(system.read(call.turn.start)),
                       .hardware = stamp(call.touch, read_noise_),
                       .after = interface.tick_of(system.read(call.turn.end))};
}

Task<void> NicClock::step(Nanoseconds offset) {
  const Call call = begin_call();
  co_await wait_until(call.touch);
  clock_.set(host_.true_now(), clock_.read(host_.true_now()) + offset);
  co_await wait_until(call.turn.end);
}

Task<void> NicClock::set(HardwareTime value) {
  const Call call = begin_call();
  co_await wait_until(call.touch);
  clock_.set(host_.true_now(), HostTime(value.time_since_epoch()));
  co_await wait_until(call.turn.end);
}

Task<void> NicClock::adjust_frequency(double ppb) {
  const Call call = begin_call();
  co_await wait_until(call.touch);
  clock_.adjust_frequency(host_.true_now(), ppb);
  co_await wait_until(call.turn.end);
}

double NicClock::max_frequency_ppb() const { return nic_of(host_).max_adjustment_ppm * 1e3; }

HardwareTime NicClock::stamp(TrueTime at, RandomStream& draw) const {
  const scenarios::Nic& nic = nic_of(host_);
  const HardwareTime exact(clock_.read(at).time_since_epoch());
  return resolution_.round_down(exact + from_ns(draw.normal(nic.stamp_jitter_sigma_ns)));
}

}  // namespace simbench::sim
