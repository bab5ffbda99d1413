#include "sim/network/load.h"

#include <algorithm>
#include <string>

namespace simbench::sim {
namespace {

std::string load_component(std::string_view what, std::string_view load_key) {
  return std::string(what).append(": ").append(load_key);
}

constexpr double kDurationsPerCell = 20;
constexpr double kMostAtOnce = 50;

constexpr ComponentKey kLoadBursts("host: bursts of load");

}  // namespace

RunLoad::RunLoad(std::uint64_t run_seed, std::string_view load_key, const scenarios::Hosts& hosts,
                 const scenarios::Network& network)
    : run_seed_(run_seed),
      session_key_(load_component("session load", load_key)),
      set_cost_key_(load_component("set cost", load_key)),
      factor_(RandomStream(run_seed, load_component("run load", load_key))
                  .lognormal(hosts.load_log_sigma)),
      send_cost_mean_ms_(hosts.send_cost_session_exponential_ms * factor_),
      latency_mean_ms_(network.latency_session_exponential_ms * factor_),
      set_cost_log_sigma_(hosts.clock.set_cost_session_log_sigma) {}

SessionLoad RunLoad::session(PeerId from, PeerId to) const {
  RandomStream draw(run_seed_, session_key_, std::min(from, to), std::max(from, to));
  const double lower_send_cost_ms = draw.exponential(send_cost_mean_ms_);
  SessionLoad load;
  load.latency_ms = draw.exponential(latency_mean_ms_);
  load.send_cost_ms = from < to ? lower_send_cost_ms : draw.exponential(send_cost_mean_ms_);
  return load;
}

double RunLoad::set_cost_factor(PeerId host) const {
  return RandomStream(run_seed_, set_cost_key_, host).lognormal(set_cost_log_sigma_);
}

BurstProcess::BurstProcess(const scenarios::Burst& parameters, std::uint64_t run_seed,
                           ComponentKey kind, std::uint64_t number)
    : run_seed_(run_seed),
      kind_(kind),
      number_(number),
      mean_gap_ms_(1e3 / parameters.rate_hz),
      mean_duration_ms_(parameters.duration_exponential_ms) {
  if (parameters.rate_hz == 0 || parameters.duration_exponential_ms == 0) return;
  is_always_active_ = mean_duration_ms_ > kMostAtOnce * mean_gap_ms_;
  if (is_always_active_) return;
  cell_ns_ = std::max<std::int64_t>(1, from_ms(kDurationsPerCell * mean_duration_ms_).count());
  cell_ms_ = to_ms(Nanoseconds(cell_ns_));
}

bool BurstProcess::sampled(TrueTime t) {
  if (cell_ns_ == 0) return is_always_active_;
  const std::int64_t since_zero_ns = t.time_since_epoch().count();
  const std::int64_t cell = floor_div(since_zero_ns, cell_ns_);
  if (!is_sampled_ || cell != cell_) {
    is_sampled_ = true;
    cell_ = cell;
    bursts_.clear();
    sample_cell(cell - 1);
    sample_cell(cell);
  }
  return std::any_of(bursts_.begin(), bursts_.end(),
                     [t](const Interval& burst) { return burst.begin <= t && t < burst.end; });
}

void BurstProcess::sample_cell(std::int64_t cell) {
  RandomStream draw(run_seed_, kind_, number_, static_cast<std::uint64_t>(cell));
  for (double at_ms = draw.exponential(mean_gap_ms_); at_ms < cell_ms_;
       at_ms += draw.exponential(mean_gap_ms_)) {
    const TrueTime begin = TrueTime(Nanoseconds(cell * cell_ns_)) + from_ms(at_ms);
    const double duration_ms = std::min(draw.exponential(mean_duration_ms_), cell_ms_);
    bursts_.push_back({begin, begin + from_ms(duration_ms)});
  }
}

HostLoad::HostLoad(const scenarios::Burst& parameters, std::uint64_t run_seed, PeerId host)
    : run_seed_(run_seed),
      latency_ms_(parameters.latency_ms),
      bursts_(parameters, run_seed, kLoadBursts, host) {}

Nanoseconds HostLoad::drawn(ComponentKey what, std::uint64_t a, std::uint64_t b) const {
  RandomStream draw(run_seed_, what, a, b);
  return from_ms(draw.uniform(0, 2 * latency_ms_));
}

}  // namespace simbench::sim
