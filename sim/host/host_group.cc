#include "sim/host/host_group.h"

#include "algorithms/ports/assert.h"

namespace simbench::sim {
namespace {

constexpr double kMsPerHour = 3.6e6;
constexpr double kMsPerMinute = 6e4;
constexpr double kSteadyEpochMaxMs = kMsPerHour;

std::string component(std::size_t host, const char* what) {
  return "host" + std::to_string(host) + ": " + what;
}

// How far a slave's clock is off when nothing has synchronised it yet.
double offset_ms(const scenarios::HostClock& clock, const HostGroupOptions& options,
                 std::size_t host, double skew_against_master) {
  if (options.initial_clocks == InitialClocks::kLastSet) {
    RandomStream draw(options.run_seed, component(host, "clock since the last set"));
    const double skew_then = draw.normal(clock.last_set.skew_sigma_ppm * 1e-6);
    return skew_then * clock.last_set.hours_ago * kMsPerHour +
           skew_against_master * clock.last_set.minutes_since_baseline * kMsPerMinute;
  }
  RandomStream draw(options.run_seed, component(host, "initial offset"));
  return draw.normal(clock.initial_offset_sigma_ms);
}

}  // namespace

HostGroup::HostGroup(VirtualContext& context, const scenarios::Hosts& hosts,
                     const scenarios::Network& network, const HostGroupOptions& options,
                     RecordingSink& sink)
    : load_(options.run_seed, options.load_key, hosts, network),
      network_(context.engine(), network, options.run_seed, static_cast<std::size_t>(hosts.count),
               load_) {
  make_clocks(hosts, options);
  const HostWorld world{context, hosts, network, network_, load_, sink, options.run_seed};
  for (std::size_t i = 0; i < clocks_.size(); ++i) {
    hosts_.emplace_back(world, static_cast<PeerId>(i), clocks_[i]);
  }
}

void HostGroup::make_clocks(const scenarios::Hosts& hosts, const HostGroupOptions& options) {
  SIMBENCH_ASSERT(hosts.count >= 1, "a rig has a master");
  for (std::size_t i = 0; i < static_cast<std::size_t>(hosts.count); ++i) {
    OscillatorModel oscillator(hosts.clock.oscillator, options.run_seed,
                               component(i, "oscillator"));
    RandomStream epoch(options.run_seed, component(i, "steady epoch"));
    const SteadyTime steady_epoch{from_ms(epoch.uniform(0, kSteadyEpochMaxMs))};
    Nanoseconds offset{};
    if (i > 0) {
      const double skew = oscillator.skew() - clocks_[0].oscillator().skew();
      offset = from_ms(offset_ms(hosts.clock, options, i, skew));
    }
    clocks_.emplace_back(static_cast<std::uint32_t>(i), std::move(oscillator), offset,
                         steady_epoch);
    if (i > 0 && options.initial_clocks == InitialClocks::kMaster) {
      clocks_[i].follow(clocks_[0]);
    }
  }
}

}  // namespace simbench::sim
