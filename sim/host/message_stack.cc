#include "sim/host/message_stack.h"

#include <algorithm>
#include <cmath>

#include "laws/normal_law.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kSpeed("stack: speed of a host");
constexpr ComponentKey kTransmit("stack: transmit");
constexpr ComponentKey kToCard("stack: transmit to card");
constexpr ComponentKey kReceive("stack: receive");
constexpr ComponentKey kWakeUp("stack: wake up");
constexpr ComponentKey kLoadOfHost("load: factor of a host");
constexpr ComponentKey kColdTransmit("load: cold transmit");
constexpr ComponentKey kColdWakeUp("load: cold wake up");
constexpr ComponentKey kLoadedWakeUp("load: wake up");
constexpr ComponentKey kLoadedReceive("load: receive");
constexpr ComponentKey kIoReceive("disk load: receive");
constexpr ComponentKey kIoWakeUp("disk load: wake up");
constexpr ComponentKey kModeration("stack: interrupt moderation");
constexpr ComponentKey kSleepiness("stack: sleep");

double speed_of(const scenarios::Stack& stack, std::uint64_t run_seed, PeerId host) {
  return RandomStream(run_seed, kSpeed, host).lognormal(stack.speed_log_sigma);
}

}  // namespace

DelayProcess::DelayProcess(const scenarios::DelayLaw& law, std::uint64_t run_seed,
                           ComponentKey name, PeerId host, double factor)
    : law_(&law), draws_(run_seed, name), factor_(factor), table_us_(law.quantiles_us) {
  if (law.common_share <= 0) return;
  common_.emplace(run_seed, name, host, from_ms(law.common_time_ms));
  common_weight_ = std::sqrt(law.common_share);
  own_weight_ = std::sqrt(1 - law.common_share);
}

Nanoseconds DelayProcess::draw(TrueTime at, const MessageKey& key) {
  RandomStream draw = draws_.of(key);
  const double probability = quantile(at, draw);
  double delay_us = table_us_.empty()
                        ? law_->fixed_us - law_->exponential_us * std::log1p(-probability)
                        : table_us_.value_at(probability);
  if (draw.chance(law_->spike_probability)) delay_us += draw.uniform(0, law_->spike_max_us);
  return from_us(factor_ * delay_us);
}

double DelayProcess::quantile(TrueTime at, RandomStream& draw) {
  if (!common_) return draw.uniform();
  // Below 1, whose exponential is infinite.
  constexpr double kMost = 1 - 0x1p-53;
  const double score = common_weight_ * common_->at(at) + draw.normal(own_weight_);
  return std::min(normal_probability(score), kMost);
}

MessageStack::Parts::Parts(const scenarios::Stack& stack, std::uint64_t run_seed, PeerId host,
                           double speed)
    : stated(stack),
      factor(speed),
      transmit(stack.transmit, run_seed, kTransmit, host, speed),
      to_card(stack.transmit_to_card, run_seed, kToCard, host, speed),
      receive(stack.receive, run_seed, kReceive, host, speed),
      wake_up(stack.wake_up, run_seed, kWakeUp, host, speed),
      sleepiness(run_seed, kSleepiness, host, from_ms(stack.sleep_time_ms)) {}

MessageStack::LoadParts::LoadParts(const scenarios::CpuLoad& load, std::uint64_t run_seed,
                                   PeerId host, double factor)
    : cold_after(from_ms(load.cold_after_ms)),
      cold_transmit(load.cold_transmit, run_seed, kColdTransmit, host, factor),
      cold_wake_up(load.cold_wake_up, run_seed, kColdWakeUp, host, factor),
      wake_up(load.wake_up, run_seed, kLoadedWakeUp, host, factor),
      receive(load.receive, run_seed, kLoadedReceive, host, factor) {}

MessageStack::IoParts::IoParts(const scenarios::IoLoad& load, std::uint64_t run_seed, PeerId host)
    : receive(load.receive, run_seed, kIoReceive, host, 1),
      wake_up(load.wake_up, run_seed, kIoWakeUp, host, 1) {}

MessageStack::MessageStack(const scenarios::Hosts& hosts, std::uint64_t run_seed, PeerId host)
    : moderation_(run_seed, kModeration) {
  if (hosts.stack) {
    parts_.emplace(*hosts.stack, run_seed, host, speed_of(*hosts.stack, run_seed, host));
  }
  if (hosts.cpu_load) {
    const double factor =
        RandomStream(run_seed, kLoadOfHost, host).lognormal(hosts.cpu_load->host_log_sigma);
    load_.emplace(*hosts.cpu_load, run_seed, host, factor);
  }
  if (hosts.io_load) io_.emplace(*hosts.io_load, run_seed, host);
  if (hosts.steal) stolen_.emplace(*hosts.steal, run_seed, host);
}

void MessageStack::works(TrueTime at) {
  if (load_) load_->warm_until = std::max(load_->warm_until, at + load_->cold_after);
}

Nanoseconds MessageStack::transmit(TrueTime at, const MessageKey& key) {
  Nanoseconds delay(0);
  if (load_ && is_cold(at)) delay += load_->cold_transmit.draw(at, key);
  if (parts_) {
    delay += parts_->transmit.draw(at, key);
    stay_awake(at + delay);
  }
  if (stolen_) delay += stolen_->wait(at + delay);
  works(at + delay);
  return delay;
}

Nanoseconds MessageStack::to_card(TrueTime left, const MessageKey& key) {
  if (!parts_) return Nanoseconds(0);
  parts_->last_at_card = std::max(parts_->last_at_card, left + parts_->to_card.draw(left, key));
  return parts_->last_at_card - left;
}

TrueTime MessageStack::receive(TrueTime at, const MessageKey& key) {
  Nanoseconds under_load = load_ ? load_->receive.draw(at, key) : Nanoseconds(0);
  if (io_) under_load += io_->receive.draw(at, key);
  if (!parts_) {
    const TrueTime done = at + under_load;
    return stolen_ ? done + stolen_->wait(done) : done;
  }
  TrueTime stamp = interrupt(at, key) + under_load;
  if (sleeps(stamp)) {
    stamp += from_us(parts_->factor * parts_->stated.sleep_exit_us);
  }
  stamp += parts_->receive.draw(at, key);
  if (stolen_) stamp += stolen_->wait(stamp);
  parts_->last_stamp = std::max(parts_->last_stamp, stamp);
  stay_awake(parts_->last_stamp);
  return parts_->last_stamp;
}

bool MessageStack::sleeps(TrueTime at) {
  return at >= parts_->awake_until &&
         normal_probability(parts_->sleepiness.at(at)) < parts_->stated.sleep_share;
}

void MessageStack::stay_awake(TrueTime from) {
  parts_->awake_until = std::max(parts_->awake_until, from + from_us(parts_->stated.awake_us));
}

TrueTime MessageStack::interrupt(TrueTime at, const MessageKey& key) {
  const Nanoseconds period = from_us(parts_->stated.interrupt_moderation_us);
  // The interrupt that is already due serves this message too.
  if (parts_->last_interrupt >= at) return parts_->last_interrupt;
  RandomStream draw = moderation_.of(key);
  const double load = parts_->stated.interrupts_per_s * 1e-9 * static_cast<double>(period.count());
  const bool is_blocked = draw.chance(load / (1 + load));
  const double wait = draw.uniform();
  TrueTime interrupt = at;
  if (is_blocked) interrupt += from_ns(wait * static_cast<double>(period.count()));
  if (parts_->last_interrupt > TrueTime::min()) {
    interrupt = std::max(interrupt, parts_->last_interrupt + period);
  }
  parts_->last_interrupt = interrupt;
  return interrupt;
}

Nanoseconds MessageStack::wake_up(TrueTime stamped, const MessageKey& key) {
  Nanoseconds delay(0);
  if (parts_) delay += parts_->wake_up.draw(stamped, key);
  if (load_) {
    delay += load_->wake_up.draw(stamped, key);
    if (is_cold(stamped)) delay += load_->cold_wake_up.draw(stamped, key);
  }
  if (io_) delay += io_->wake_up.draw(stamped, key);
  if (stolen_) delay += stolen_->wait(stamped + delay);
  works(stamped + delay);
  return delay;
}

}  // namespace simbench::sim
