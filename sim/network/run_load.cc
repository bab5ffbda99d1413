#include "sim/network/run_load.h"

#include <algorithm>
#include <string>

namespace simbench::sim {
namespace {

std::string component(std::string_view what, std::string_view load_key) {
  return std::string(what).append(": ").append(load_key);
}

}  // namespace

RunLoad::RunLoad(std::uint64_t run_seed, std::string_view load_key, const scenarios::Hosts& hosts,
                 const scenarios::Network& network)
    : run_seed_(run_seed),
      session_key_(component("session load", load_key)),
      set_cost_key_(component("set cost", load_key)),
      factor_(
          RandomStream(run_seed, component("run load", load_key)).lognormal(hosts.load_log_sigma)),
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

}  // namespace simbench::sim
