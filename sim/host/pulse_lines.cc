#include "sim/host/pulse_lines.h"

#include <algorithm>
#include <string>

#include "algorithms/ports/assert.h"
#include "sim/engine/random.h"
#include "sim/host/sim_host.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kReceiverJitter("host: error of the receiver's pulse");
constexpr ComponentKey kInterruptFactor("host: factor of its interrupt latency");
constexpr Nanoseconds kSecond = std::chrono::seconds(1);

constexpr std::int64_t kPulsesKept = 1024;

}  // namespace

PpsReceiver::PpsReceiver(const scenarios::PulseLines& lines, std::uint64_t run_seed, PeerId host)
    : run_seed_(run_seed),
      host_(host),
      jitter_sigma_us_(lines.pps_jitter_sigma_us),
      announces_time_(lines.gnss) {}

std::optional<std::int64_t> PpsReceiver::first_from(TrueTime at) const {
  const Nanoseconds gnss = at.time_since_epoch() + kGnssTimeAtTrueZero;
  return std::chrono::ceil<std::chrono::seconds>(gnss).count();
}

std::optional<TrueTime> PpsReceiver::pulse(std::int64_t number) const {
  RandomStream draw(run_seed_, kReceiverJitter, host_, static_cast<std::uint64_t>(number));
  return TrueTime(number * kSecond - kGnssTimeAtTrueZero) +
         from_ms(draw.normal(jitter_sigma_us_) * 1e-3);
}

std::optional<Nanoseconds> PpsReceiver::announced_time(std::int64_t number) const {
  if (!announces_time_) return std::nullopt;
  return number * kSecond;
}

void TriggerLine::start(const TriggerTree& tree, std::int64_t last) {
  tree_ = &tree;
  last_ = last;
}

std::optional<std::int64_t> TriggerLine::first_from(TrueTime at) const {
  if (tree_ == nullptr) return std::nullopt;
  return tree_->first_slot_from(at);
}

SimPulseInput::SimPulseInput(SimHost& host, const PulseSchedule& source, std::string_view name)
    : host_(host),
      source_(source),
      latency_key_(std::string("host: interrupt latency, ").append(name)),
      latency_factor_(RandomStream(host.world().run_seed, kInterruptFactor, host.id())
                          .lognormal(host.world().hosts.pulse_lines.interrupt_latency_log_sigma)),
      opened_at_(host.true_now()),
      changed_(host.world().context, host.name(std::string("next pulse, ").append(name))) {}

Task<std::optional<PulseStamp>> SimPulseInput::next(SteadyTime deadline) {
  const std::optional<Pulse> pulse = co_await next_pulse(deadline);
  if (!pulse) co_return std::nullopt;
  if (pulse->stamp.gnss) host_.report_pulse(pulse->stamp);
  co_return pulse->stamp;
}

Task<std::optional<SimPulseInput::Pulse>> SimPulseInput::next_pulse(SteadyTime deadline) {
  SIMBENCH_ASSERT(!changed_.waiting(), "one wait at a time on a pulse line");
  for (;;) {
    const std::optional<TrueTime> interrupt = next_interrupt();
    if (interrupt && *interrupt <= host_.true_now()) {
      last_interrupt_ = *interrupt;
      const std::int64_t number = (*number_)++;
      co_return Pulse{.number = number,
                      .at = source_.pulse(number).value(),
                      .stamp = stamp(number, *interrupt)};
    }
    if (host_.is_past(deadline)) co_return std::nullopt;
    std::optional<TrueTime> until = host_.next_look(deadline);
    if (interrupt) until = until ? std::min(*until, *interrupt) : *interrupt;
    co_await changed_.wait(until);
  }
}

std::optional<TrueTime> SimPulseInput::next_interrupt() {
  const std::optional<std::int64_t> to_come = source_.first_from(host_.true_now());
  if (!to_come) return std::nullopt;
  if (!number_) number_ = source_.first_from(opened_at_);
  number_ = std::max(*number_, *to_come - kPulsesKept);
  const scenarios::PulseLines& lines = host_.world().hosts.pulse_lines;
  for (; *number_ <= source_.last(); ++*number_) {
    const std::optional<TrueTime> pulse = source_.pulse(*number_);
    if (!pulse) continue;
    RandomStream draw(host_.world().run_seed, latency_key_, host_.id(),
                      static_cast<std::uint64_t>(*number_));
    const double latency_us =
        lines.interrupt_latency_us + draw.exponential(lines.interrupt_latency_exponential_us);
    const TrueTime interrupt =
        std::max(*pulse + from_ms(latency_factor_ * latency_us * 1e-3), last_interrupt_);
    if (!host_.world().outages.host_stopped(host_.id(), interrupt)) return interrupt;
  }
  return std::nullopt;
}

PulseStamp SimPulseInput::stamp(std::int64_t number, TrueTime interrupt) const {
  const SystemClock& clock = host_.system_clock();
  return {.system = host_.clock_interface().tick_of(clock.read(interrupt)),
          .steady = clock.steady(interrupt),
          .gnss = source_.announced_time(number)};
}

}  // namespace simbench::sim
